/**
 * @file
 * Saturating arithmetic, the modular encoder difference, and what a slot of the configuration holds.
 */
#ifndef ILK_ARITH_H
#define ILK_ARITH_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/types.h"

/** `value + 1`, stopping at `ceiling`; a value beyond the ceiling comes back to it. */
static inline uint32_t count_up(uint32_t value, uint32_t ceiling) {
  return (value >= ceiling) ? ceiling : (value + 1u);
}

/** How long a condition has held, when so far it had for `ticks`. */
static inline uint32_t ticks_in_row(bool holds, uint32_t ticks, uint32_t ceiling) {
  return holds ? count_up(ticks, ceiling) : 0u;
}

/** A truth as the word that stands for it: 1 or 0. */
static inline uint32_t flag_of(bool truth) { return truth ? 1u : 0u; }

/** Sum, stopping at the ends of `int32_t`. */
static inline int32_t add_saturating(int32_t a, int32_t b) {
  const int64_t sum = (int64_t)a + (int64_t)b;
  const int64_t bounded = (sum < (int64_t)INT32_MIN) ? (int64_t)INT32_MIN : sum;
  return (bounded > (int64_t)INT32_MAX) ? INT32_MAX : (int32_t)bounded;
}

/** Sum, stopping at the largest `uint32_t`. */
static inline uint32_t sum_saturating(uint32_t a, uint32_t b) {
  return (a > (UINT32_MAX - b)) ? UINT32_MAX : (a + b);
}

/** What is left of `whole` when `used` is gone, stopping at zero. */
static inline uint32_t left_of(uint32_t whole, uint32_t used) {
  return (whole <= used) ? 0u : (whole - used);
}

/** The opposite, stopping at the largest `int32_t`. */
static inline int32_t negate_saturating(int32_t value) { return (value == INT32_MIN) ? INT32_MAX : -value; }

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
  const uint32_t forth = to_raw - from_raw;
  return signed_of((config->direction_correction == 0u) ? forth : (from_raw - to_raw));
}

/** `travel` counted positive along `direction`; zero for no direction. */
static inline int32_t along(uint32_t direction, int32_t travel) {
  const int32_t directed =
      (direction == (uint32_t)ILK_DIRECTION_INCREASING) ? travel : negate_saturating(travel);
  return (direction == (uint32_t)ILK_DIRECTION_NONE) ? 0 : directed;
}

/** What a budget keeps back: the coast, and noise, by which the point that is followed may lag. */
static inline uint32_t coast_as_read(const ilk_axis_config_t *config) {
  return sum_saturating(config->coast_counts, config->noise_counts);
}

/** True for 1 to `most`. */
static inline bool count_of(uint32_t value, uint32_t most) { return (value != 0u) && (value <= most); }

/** True for a slot that holds a motor card: every kind of card before SENSOR. */
static inline bool has_axis(const ilk_axis_config_t *config) {
  return count_of(config->card, (uint32_t)ILK_CARD_HIGH_FREQUENCY);
}

/** True for a slot that holds any card. */
static inline bool has_card(const ilk_axis_config_t *config) {
  return count_of(config->card, (uint32_t)ILK_CARD_SENSOR);
}

/** True for an axis that has a switch. */
static inline bool has_switch(const ilk_axis_config_t *config) {
  return config->limit_side != (uint32_t)ILK_LIMIT_NONE;
}

/** Direction in which the switch of the axis lies; NONE without one. */
static inline uint32_t towards_switch(const ilk_axis_config_t *config) {
  const bool upper = config->limit_side == (uint32_t)ILK_LIMIT_UPPER;
  const uint32_t direction = (uint32_t)(upper ? ILK_DIRECTION_INCREASING : ILK_DIRECTION_NONE);
  const bool lower = config->limit_side == (uint32_t)ILK_LIMIT_LOWER;
  return lower ? (uint32_t)ILK_DIRECTION_DECREASING : direction;
}

#endif
