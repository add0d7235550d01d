/**
 * @file
 * P14: damage to the configuration is met. Whichever one word of it changes, in whatever bits and whenever in
 * a pass, the end of this pass or of the next one tells it: within 20 ticks. What P1 to P3 rest on is
 * compared in every tick: whichever of these words, and however many at once, hold other bits. Either ends
 * trust, and trust comes back only by a pass that agrees and by validation (P13).
 *
 * The configuration as it is and as it was at start are followed at once: a word of it says whether the two
 * differ in that word, and the step of the CRC, which can be undone in each argument (proof crc32), says
 * whether the running CRCs differ after it.
 */
#include "integrity.c"
#include "proof.h"

#define CONFIG_WORDS (sizeof(ilk_config_t) / sizeof(uint32_t))
#define STEPS (CONFIG_WORDS - 1u)
#define COMMON_WORDS (sizeof(ilk_common_config_t) / sizeof(uint32_t))
#define AXIS_WORDS (sizeof(ilk_axis_config_t) / sizeof(uint32_t))

/** Where the two configurations differ. The start of a CRC is another value, and the same for both. */
#define DIFFERS 1u
#define SAME 0u
/** What is stored of a running CRC. */
#define STORED(crc) ((crc) ^ 0xffffffffu)

static bool passes;
static ilk_config_t as_at_start;
static ilk_config_t changed;
static uint32_t place;
static uint32_t steps;
static uint32_t validation;
static bool validated;

/** Stands for `word_at`: whether the two configurations differ in the word at this place. */
uint32_t read_both(const unsigned char bytes[4]) {
  const bool of_changed = __CPROVER_same_object(bytes, &changed);
  SHOW(IMPLIES(passes, (of_changed || __CPROVER_same_object(bytes, &as_at_start)) &&
                           (__CPROVER_POINTER_OFFSET(bytes) == (4u * steps))),
       "P14: a pass reads each word once, in the order of memory");
  return (of_changed && (steps == place)) ? DIFFERS : SAME;
}

uint32_t step_both(uint32_t crc, uint32_t word) {
  uint32_t either;
  const bool crc_differs = crc == DIFFERS;
  const bool word_differs = word == DIFFERS;
  GIVEN(either <= DIFFERS);
  steps++;
  return (crc_differs && word_differs) ? either : ((crc_differs || word_differs) ? DIFFERS : SAME);
}

ilk_config_verdict_t some_verdict(const ilk_config_t* config) {
  const ilk_config_verdict_t verdict = {.error = validation, .slot = 0u};
  validated = true;
  (void)config;
  return verdict;
}

bool always_sealed(const ilk_state_t* state) {
  (void)state;
  return true;
}

void unsealed(ilk_state_t* state) { (void)state; }

/** The slice that reads a word; the CRC itself is compared at the end. */
static uint32_t slice_of(uint32_t place) {
  uint32_t slice = 0u;
  for (uint32_t axis = 1u; axis < ILK_SLOTS; axis++) {
    slice = (place >= (COMMON_WORDS + (axis * AXIS_WORDS))) ? axis : slice;
  }
  return slice;
}

static void show_slices(void) {
  ilk_state_t state;
  uint32_t any_place;
  uint32_t change; /* the tick of the pass from which on the word is another one; 10: not in this pass */
  uint32_t arbitrary_validation;
  place = any_place;
  passes = true;
  GIVEN((place < CONFIG_WORDS) && (change <= ILK_SLOTS) && (state.system.config_sound <= 1u));
  as_at_start.crc = STORED(SAME);
  changed.crc = STORED((place == STEPS) ? DIFFERS : SAME);
  validation = arbitrary_validation;
  const uint32_t trusted = state.system.config_sound;
  state.system.config_slice = 0u;
  state.system.config_crc = STORED(SAME);

  ilk_alarms_t alarms;
  for (uint32_t tick = 0u; tick < ILK_SLOTS; tick++) {
    const ilk_alarms_t none = {.configuration_damaged = false};
    alarms = none;
    SHOW(state.system.config_slice == tick, "P14: a pass takes the slices one after another");
    check_slice((tick < change) ? &as_at_start : &changed, &state.system, &alarms);
    SHOW(IMPLIES(tick < (ILK_SLOTS - 1u), !alarms.configuration_damaged && (alarms.configuration_crc == 0u) &&
                                              (state.system.config_sound == trusted)),
         "P14: a pass is judged at its end");
  }
  const bool damaged = alarms.configuration_damaged;
  SHOW((steps == STEPS) && (state.system.config_slice == 0u), "P14: a pass covers every word once");
  SHOW(damaged == (slice_of(place) >= change),
       "P14: damage ahead of a pass is met at its end, so all damage is at the end of the next one");
  SHOW(alarms.configuration_crc == STORED((damaged && (place < STEPS)) ? DIFFERS : SAME),
       "P14: the CRC that was found is told");
  SHOW(IMPLIES(damaged, (state.system.config_sound == 0u) && !validated), "P13: damage ends trust");
  SHOW(IMPLIES(!damaged, (state.system.config_sound == 1u) ==
                             ((trusted == 1u) || (validation == ILK_CONFIG_ERROR_NONE))),
       "P13: trust is kept by a pass that agrees, and comes back only with a valid configuration");
  SHOW(state.system.config_sound <= 1u, "P13: trust is a flag");
  GOAL(goal_met_by_the_next_pass, !damaged && (change == 9u) && (place == 9u));
  GOAL(goal_met_at_once, damaged && (place == (STEPS - 1u)) && (change == 9u));
  GOAL(goal_crc_word, damaged && (place == STEPS));
  GOAL(goal_trusted_again, validated && (state.system.config_sound == 1u));
  GOAL(never_unmet_by_a_whole_pass, !damaged && (change == 0u));
}

static bool same_axis(const ilk_axis_config_t* a, const ilk_axis_config_t* b) {
  return (a->card == b->card) && (a->limit_side == b->limit_side) &&
         (a->motor_direction == b->motor_direction);
}

/** Within a pass, so that the slice alone tells nothing. */
static void show_basis(void) {
  ilk_config_t at_start;
  ilk_config_t now;
  ilk_state_t state;
  bool same = (at_start.common.pedal_channels == now.common.pedal_channels) &&
              (at_start.common.app_timeout_ticks == now.common.app_timeout_ticks);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    GIVEN((at_start.axis[slot].card < ILK_CARD_COUNT) && (at_start.axis[slot].limit_side < ILK_LIMIT_COUNT) &&
          (at_start.axis[slot].motor_direction <= 1u)); /* proof `config_slot` */
    same = same && same_axis(&at_start.axis[slot], &now.axis[slot]);
  }
  validation = ILK_CONFIG_ERROR_NONE;
  (void)ilk_init(&at_start, &state);
  uint32_t slice;
  GIVEN(slice < (ILK_SLOTS - 1u));
  state.system.config_slice = slice;
  const ilk_alarms_t alarms = ilk_integrity_check(&now, &state);
  SHOW(alarms.configuration_damaged == !same,
       "P14: every change of what P1 to P3 rest on is noticed in its tick, and nothing else");
  SHOW(state.system.config_sound == (same ? 1u : 0u), "P13: a change ends trust");
  GOAL(goal_kept, same);
  GOAL(goal_last_motor, !same && same_axis(&at_start.axis[8], &now.axis[8]) &&
                            (now.axis[9].motor_direction == (at_start.axis[9].motor_direction + 256u)));
  GOAL(goal_carry, !same && (now.axis[0].card == (at_start.axis[0].card + 256u)) &&
                       (now.axis[0].limit_side == (at_start.axis[0].limit_side - 1u)));
  GOAL(never_aliased, !alarms.configuration_damaged && (now.axis[3].card > 255u));
}

void harness(void) {
  bool slices;
  if (slices) {
    show_slices();
  } else {
    show_basis();
  }
}
