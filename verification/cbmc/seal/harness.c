/**
 * @file
 * P14: the seal covers every word of the state. Of two states that differ in one word, whichever it is and in
 * whatever bits, the digests differ; or it is the seal itself, and the digests are the same. So both are
 * never sound: a single flipped bit, and any damage within one word, is noticed.
 *
 * The two states are followed at once: a word of this state says whether the two differ in that word, and the
 * mixing step, which can be undone in each argument (proof seal_mix), says whether the digests differ after
 * it.
 */
#include "integrity.c"
#include "proof.h"

#define STATE_WORDS (sizeof(ilk_state_t) / sizeof(uint32_t))
/** Each word but the seal; one lane into the other for each part; each axis into the whole. */
#define MIXES ((STATE_WORDS - 1u) + (1u + ILK_SLOTS) + ILK_SLOTS)

/** Where the two states differ. The seal's seed is another value, and the same for both. */
#define DIFFERS 1u
#define SAME 0u

static uint32_t mixes;

uint32_t mix_both(uint32_t digest, uint32_t word) {
  uint32_t either;
  const bool digest_differs = digest == DIFFERS;
  const bool word_differs = word == DIFFERS;
  GIVEN(either <= DIFFERS);
  mixes++;
  return (digest_differs && word_differs) ? either : ((digest_differs || word_differs) ? DIFFERS : SAME);
}

void harness(void) {
  ilk_state_t both;
  uint32_t place;
  for (uint32_t index = 0u; index < STATE_WORDS; index++) {
    ((uint32_t*)&both)[index] = (index == place) ? DIFFERS : SAME;
  }
  const uint32_t digest = state_digest(&both);
  SHOW(mixes == MIXES, "P14: as many mixing steps as there are words and parts");
  SHOW((digest == DIFFERS) == (place < (STATE_WORDS - 1u)), "P14: each word but the seal changes the digest");
  SHOW((both.seal == DIFFERS) == (place == (STATE_WORDS - 1u)), "P14: the seal is the last word");
  GOAL(goal_first_word, (digest == DIFFERS) && (place == 0u));
  GOAL(goal_last_word_of_last_axis, (digest == DIFFERS) && (place == (STATE_WORDS - 2u)));
  GOAL(goal_seal_itself, (digest == SAME) && (place == (STATE_WORDS - 1u)));
  GOAL(never_uncovered, (digest == SAME) && (place < (STATE_WORDS - 1u)));
}
