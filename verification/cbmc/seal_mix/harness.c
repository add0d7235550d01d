/**
 * @file
 * The step of the seal forgets nothing: with one of its arguments kept, another digest or another word always
 * mixes to another digest. Shown by giving its inverse.
 */
#include "integrity.c"
#include "proof.h"

/** Times SEAL_FACTOR it is 1, modulo 2^32. */
#define SEAL_FACTOR_INVERSE 0x0e8b2f51u

/** The exclusive-or of the digest and the word from which `mixed` came. */
static uint32_t unmixed(uint32_t mixed) {
  const uint32_t rotated = mixed * SEAL_FACTOR_INVERSE;
  return (rotated >> 13) | (rotated << 19);
}

void harness(void) {
  uint32_t digest;
  uint32_t word;
  const uint32_t mixed = mix(digest, word);
  SHOW((unmixed(mixed) ^ word) == digest, "P14: the digest before can be told from that after and the word");
  SHOW((unmixed(mixed) ^ digest) == word, "P14: the word can be told from the digests before and after");
  GOAL(goal_mixes_to_zero, (mixed == 0u) && (word == 1u));
  GOAL(never_zero_of_zero_and_one, (mixed == 0u) && (digest == 0u) && (word == 1u));
}
