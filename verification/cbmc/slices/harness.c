/**
 * @file
 * P14: damage to the configuration is met. Whichever one word of it changes, in whatever bits and whenever in
 * a pass, the end of this pass or of the next one tells it: within 20 ticks. What is told ends trust, and
 * trust comes back only by a pass that agrees and by validation (P13).
 *
 * The configuration as it is and as it was at start are followed at once: a word of it says whether the two
 * differ in that word, and the step of the CRC, which can be undone in each argument (proof crc32), says
 * whether the running CRCs differ after it.
 */
#include "config.c"
#include "integrity.c"
#include "proof.h"

#define CONFIG_WORDS (sizeof(ilk_config_t) / sizeof(uint32_t))
#define STEPS (CONFIG_WORDS - 1u)
#define SYSTEM_WORDS 10u
#define AXIS_WORDS 29u

/** Where the two configurations differ. The start of a CRC is another value, and the same for both. */
#define DIFFERS 1u
#define SAME 0u

static uint32_t steps;
static uint32_t validation;
static bool validated;

uint32_t step_both(uint32_t crc, uint32_t word) {
  uint32_t either;
  const bool crc_differs = crc == DIFFERS;
  const bool word_differs = word == DIFFERS;
  GIVEN(either <= DIFFERS);
  steps++;
  return (crc_differs && word_differs) ? either : ((crc_differs || word_differs) ? DIFFERS : SAME);
}

uint32_t finish_both(uint32_t crc) { return crc; }

ilk_config_verdict_t some_verdict(const ilk_config_t* config) {
  const ilk_config_verdict_t verdict = {.error = validation, .slot = 0u};
  validated = true;
  (void)config;
  return verdict;
}

/** The slice that reads a word; the CRC itself is compared at the end. */
static uint32_t slice_of(uint32_t place) {
  uint32_t slice = 0u;
  for (uint32_t axis = 1u; axis < ILK_SLOTS; axis++) {
    slice = (place >= (SYSTEM_WORDS + (axis * AXIS_WORDS))) ? axis : slice;
  }
  return slice;
}

void harness(void) {
  ilk_config_t as_at_start;
  ilk_config_t changed;
  ilk_state_t state;
  uint32_t place;
  uint32_t change; /* the tick of the pass from which on the word is another one; 10: not in this pass */
  uint32_t arbitrary_validation;
  GIVEN((place < CONFIG_WORDS) && (change <= ILK_SLOTS) && (state.config_sound <= 1u));
  for (uint32_t index = 0u; index < CONFIG_WORDS; index++) {
    ((uint32_t*)&as_at_start)[index] = SAME;
    ((uint32_t*)&changed)[index] = (index == place) ? DIFFERS : SAME;
  }
  validation = arbitrary_validation;
  const uint32_t trusted = state.config_sound;
  state.config_slice = 0u;
  state.config_crc = SAME;

  ilk_config_check_t check;
  for (uint32_t tick = 0u; tick < ILK_SLOTS; tick++) {
    SHOW(state.config_slice == tick, "P14: a pass takes the slices one after another");
    check = ilk_config_check_slice((tick < change) ? &as_at_start : &changed, &state);
    SHOW(IMPLIES(tick < (ILK_SLOTS - 1u),
                 !check.damaged && (check.crc == 0u) && (state.config_sound == trusted)),
         "P14: a pass is judged at its end");
  }
  SHOW((steps == STEPS) && (state.config_slice == 0u) && (state.config_partial_crc == ILK_CRC32_START),
       "P14: a pass covers every word once and starts anew");
  SHOW(check.damaged == (slice_of(place) >= change),
       "P14: damage ahead of a pass is met at its end, so all damage is at the end of the next one");
  SHOW(check.crc == ((check.damaged && (place < STEPS)) ? DIFFERS : SAME),
       "P14: the CRC that was found is told");
  SHOW(IMPLIES(check.damaged, (state.config_sound == 0u) && !validated), "P13: damage ends trust");
  SHOW(IMPLIES(!check.damaged,
               (state.config_sound == 1u) == ((trusted == 1u) || (validation == ILK_CONFIG_ERROR_NONE))),
       "P13: trust is kept by a pass that agrees, and comes back only with a valid configuration");
  SHOW(state.config_sound <= 1u, "P13: trust is a flag");
  GOAL(goal_met_by_the_next_pass, !check.damaged && (change == 9u) && (place == 9u));
  GOAL(goal_met_at_once, check.damaged && (place == (STEPS - 1u)) && (change == 9u));
  GOAL(goal_crc_word, check.damaged && (place == STEPS));
  GOAL(goal_trusted_again, validated && (state.config_sound == 1u));
  GOAL(never_unmet_by_a_whole_pass, !check.damaged && (change == 0u));
}
