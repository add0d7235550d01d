/**
 * @file
 * What the next tick will probably give to the kernel. Only the words that come differently are recorded, so
 * that counters and checksums, which change in every tick, take no room.
 *
 * A word is expected to go on as it did twice in a row: to stay, or to change by the same amount. The
 * checksum of a card's frame is replaced by its error, which is 0 in a sound frame. Nothing is lost by
 * either.
 */
#ifndef INTERLOCK_EXPECTATION_H
#define INTERLOCK_EXPECTATION_H

#include <stdint.h>

#include "interlock/recording.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What was given, word by word. Begins with zeros, as each block does. */
typedef struct {
  uint32_t newest[ILK_GIVEN_WORDS];
  uint32_t change[ILK_GIVEN_WORDS]; /**< from the tick before to the newest */
  uint32_t step[ILK_GIVEN_WORDS];   /**< change that is expected */
} ilk_expectation_t;

/** Words that a tick with so many requests gives. */
static inline uint32_t ilk_given_words(uint32_t request_count) {
  return (uint32_t)ILK_INPUT_WORDS + (request_count * (uint32_t)ILK_REQUEST_WORDS);
}

/** Takes in the words that were given; sets each of `missed` to 0 where they were as expected. */
void ilk_expectation_follow(ilk_expectation_t *expectation, const uint32_t given[], uint32_t count,
                            uint32_t missed[]);

/** Writes the inputs as words, checksums as their error. */
void ilk_given_from_inputs(uint32_t given[], const ilk_inputs_t *inputs);

/** Undoes `ilk_given_from_inputs`. */
void ilk_given_to_inputs(const uint32_t given[], ilk_inputs_t *inputs);

#ifdef __cplusplus
}
#endif

#endif
