/**
 * @file
 * P14: the seal covers every word of the state. Of two states that differ in one word, whichever it is and in
 * whatever bits, the digests differ; or it is the seal itself, and the digests are the same. So both are
 * never sound: a single flipped bit, and any damage within one word, is noticed.
 *
 * The two states are followed at once: reading a word says whether the two differ in it, and the mixing step,
 * which can be undone in each argument (proof seal_mix), says whether the digests differ after it.
 */
#include "integrity.c"
#include "proof.h"

#define STATE_WORDS (sizeof(ilk_state_t) / sizeof(uint32_t))
/** Each word but the seal, and one lane into the other. */
#define MIXES STATE_WORDS

/** Where the two states differ. The seal's seed is another value, and the same for both. */
#define DIFFERS 1u
#define SAME 0u

static ilk_state_t both;
static uint32_t place;
static uint32_t mixes;
static uint32_t reads;

/** Stands for `word_at`: reading the word at this place of the two states. */
uint32_t read_both(const unsigned char bytes[4]) {
  SHOW(__CPROVER_same_object(bytes, &both) && (__CPROVER_POINTER_OFFSET(bytes) == (4u * reads)),
       "P14: each word is read once, in the order of memory");
  const uint32_t word = (reads == place) ? DIFFERS : SAME;
  reads++;
  return word;
}

uint32_t mix_both(uint32_t digest, uint32_t word) {
  uint32_t either;
  const bool digest_differs = digest == DIFFERS;
  const bool word_differs = word == DIFFERS;
  GIVEN(either <= DIFFERS);
  mixes++;
  return (digest_differs && word_differs) ? either : ((digest_differs || word_differs) ? DIFFERS : SAME);
}

void harness(void) {
  uint32_t any_place;
  place = any_place;
  ilk_state_seal(&both);
  const uint32_t digest = both.seal;
  SHOW(mixes == MIXES, "P14: as many mixing steps as there are words");
  SHOW(reads == (STATE_WORDS - 1u), "P14: every word but the seal, which is the last, is read");
  SHOW((digest == DIFFERS) == (place < (STATE_WORDS - 1u)), "P14: each word but the seal changes the digest");
  reads = 0u;
  mixes = 0u;
  uint32_t written;
  both.seal = written;
  SHOW((ilk_state_is_sealed(&both) == (written == digest)) || (place < (STATE_WORDS - 1u)),
       "P14: sealed is what carries the digest of its words");
  GOAL(goal_first_word, (digest == DIFFERS) && (place == 0u));
  GOAL(goal_last_word_of_last_axis, (digest == DIFFERS) && (place == (STATE_WORDS - 2u)));
  GOAL(goal_seal_itself, (digest == SAME) && (place == (STATE_WORDS - 1u)));
  GOAL(never_uncovered, (digest == SAME) && (place < (STATE_WORDS - 1u)));
}
