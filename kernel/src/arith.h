/**
 * @file
 * Saturating arithmetic and the modular encoder difference.
 */
#ifndef ILK_ARITH_H
#define ILK_ARITH_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/types.h"

/** `value + 1`, stopping at `ceiling`; a value beyond the ceiling comes back to it. */
static inline uint32_t count_up(uint32_t value, uint32_t ceiling) {
  uint32_t next = ceiling;
  if (value < ceiling) {
    next = value + 1u;
  }
  return next;
}

/** `value - 1`, stopping at zero. */
static inline uint32_t count_down(uint32_t value) {
  uint32_t next = 0u;
  if (value > 0u) {
    next = value - 1u;
  }
  return next;
}

/** A truth as the word that stands for it: 1 or 0. */
static inline uint32_t flag_of(bool truth) {
  uint32_t flag = 0u;
  if (truth) {
    flag = 1u;
  }
  return flag;
}

/** Sum, stopping at the ends of `int32_t`. */
static inline int32_t add_saturating(int32_t a, int32_t b) {
  const int64_t sum = (int64_t)a + (int64_t)b;
  int32_t result = (int32_t)0;
  if (sum > (int64_t)INT32_MAX) {
    result = INT32_MAX;
  } else if (sum < (int64_t)INT32_MIN) {
    result = (int32_t)INT32_MIN;
  } else {
    result = (int32_t)sum;
  }
  return result;
}

/** Sum, stopping at the largest `uint32_t`. */
static inline uint32_t sum_saturating(uint32_t a, uint32_t b) {
  return (a > (UINT32_MAX - b)) ? UINT32_MAX : (a + b);
}

/** What is left of `whole` when `used` is gone, stopping at zero. */
static inline uint32_t left_of(uint32_t whole, uint32_t used) { return (whole > used) ? (whole - used) : 0u; }

/** The opposite, stopping at the largest `int32_t`. */
static inline int32_t negate_saturating(int32_t value) { return (value == INT32_MIN) ? INT32_MAX : -value; }

/** Product, stopping at the largest `uint32_t`. */
static inline uint32_t multiply_saturating(uint32_t a, uint32_t b) {
  const uint64_t product = (uint64_t)a * (uint64_t)b;
  return (product > (uint64_t)UINT32_MAX) ? UINT32_MAX : (uint32_t)product;
}

/** Distance from zero, defined for every value. */
static inline uint32_t magnitude(int32_t value) {
  return (value < 0) ? (0u - (uint32_t)value) : (uint32_t)value;
}

/** The two's complement value of a word, without implementation-defined conversion. */
static inline int32_t signed_of(uint32_t word) {
  const uint32_t complement = UINT32_MAX - word;
  return (word <= (uint32_t)INT32_MAX) ? (int32_t)word : (-(int32_t)complement - 1);
}

/** Motion from one counter reading to another, modulo 2^32, in the sense of the position. */
static inline int32_t travel_between(const ilk_axis_config_t *config, uint32_t from_raw, uint32_t to_raw) {
  uint32_t difference = to_raw - from_raw;
  if (config->direction_correction != 0u) {
    difference = from_raw - to_raw;
  }
  return signed_of(difference);
}

/** `travel` counted positive along `direction`; zero for no direction. */
static inline int32_t along(uint32_t direction, int32_t travel) {
  int32_t result = 0;
  if (direction == (uint32_t)ILK_DIRECTION_INCREASING) {
    result = travel;
  } else if (direction == (uint32_t)ILK_DIRECTION_DECREASING) {
    result = negate_saturating(travel);
  } else {
    result = 0;
  }
  return result;
}

/** The other way; none for none. */
static inline uint32_t opposite_of(uint32_t direction) {
  uint32_t other = (uint32_t)ILK_DIRECTION_NONE;
  if (direction == (uint32_t)ILK_DIRECTION_INCREASING) {
    other = (uint32_t)ILK_DIRECTION_DECREASING;
  } else if (direction == (uint32_t)ILK_DIRECTION_DECREASING) {
    other = (uint32_t)ILK_DIRECTION_INCREASING;
  } else {
    other = (uint32_t)ILK_DIRECTION_NONE;
  }
  return other;
}

/** True for 1 to `most`. */
static inline bool count_of(uint32_t value, uint32_t most) { return (value != 0u) && (value <= most); }

/** True for an axis that has a switch. */
static inline bool has_switch(const ilk_axis_config_t *config) {
  return config->limit_side != (uint32_t)ILK_LIMIT_NONE;
}

/** True for a slot that holds a motor card. */
static inline bool has_axis(const ilk_axis_config_t *config) {
  return (config->card == (uint32_t)ILK_CARD_PWM) || (config->card == (uint32_t)ILK_CARD_NON_PWM) ||
         (config->card == (uint32_t)ILK_CARD_ANALOG) || (config->card == (uint32_t)ILK_CARD_HIGH_FREQUENCY);
}

/** True for a slot that holds any card. */
static inline bool has_card(const ilk_axis_config_t *config) {
  return has_axis(config) || (config->card == (uint32_t)ILK_CARD_SENSOR);
}

#endif
