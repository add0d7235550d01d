/**
 * @file
 * Counts and directions in 64-bit arithmetic, where nothing wraps or saturates unless it says so. Written
 * apart from the kernel's arith.h.
 */
#ifndef ILK_PROOF_COUNTS_H
#define ILK_PROOF_COUNTS_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/types.h"

/** The nearest value that an `int32_t` can hold. */
static int64_t held(int64_t value) {
  return (value > INT32_MAX) ? INT32_MAX : (value < INT32_MIN) ? INT32_MIN : value;
}

static int64_t distance(int64_t value) { return (value < 0) ? -value : value; }

/** Travel counted along a direction; none without a direction. Nothing is multiplied: that costs a prover
 * most. */
static int64_t directed(uint32_t direction, int64_t travel) {
  return (direction == ILK_DIRECTION_INCREASING)   ? travel
         : (direction == ILK_DIRECTION_DECREASING) ? -travel
                                                   : 0;
}

/** One more, stopping at `ceiling`. */
static int64_t one_more(int64_t value, int64_t ceiling) { return (value < ceiling) ? (value + 1) : ceiling; }

/** One less, stopping at zero. */
static int64_t one_less(int64_t value) { return (value > 0) ? (value - 1) : 0; }

/** Motion between two readings of a counter modulo 2^32, in the sense of the position. */
static int64_t travelled(const ilk_axis_config_t* config, uint32_t from_raw, uint32_t to_raw) {
  const int64_t turn = (int64_t)1 << 32;
  const int64_t plain = (int64_t)to_raw - (int64_t)from_raw;
  const int64_t sensed = (config->direction_correction != 0u) ? -plain : plain;
  return (sensed > INT32_MAX) ? (sensed - turn) : (sensed < INT32_MIN) ? (sensed + turn) : sensed;
}

#endif
