/**
 * @file
 * The arithmetic on which everything rests, against the same in 64 bits.
 */
#include "arith.h"
#include "proof.h"

/** The nearest value that an `int32_t` can hold. */
static int64_t held(int64_t value) {
  return (value > INT32_MAX) ? INT32_MAX : (value < INT32_MIN) ? INT32_MIN : value;
}

/** The nearest value that a `uint32_t` can hold. */
static int64_t held_unsigned(int64_t value) {
  return (value > UINT32_MAX) ? UINT32_MAX : (value < 0) ? 0 : value;
}

/** The value of `value` modulo 2^32 that an `int32_t` can hold. */
static int64_t wrapped(int64_t value) {
  const int64_t turn = (int64_t)1 << 32;
  return (value > INT32_MAX) ? (value - turn) : (value < INT32_MIN) ? (value + turn) : value;
}

void harness(void) {
  ilk_axis_config_t config;
  int32_t a;
  int32_t b;
  uint32_t u;
  uint32_t v;
  const int64_t plain = (int64_t)v - (int64_t)u;
  const int64_t sensed = (config.direction_correction != 0u) ? -plain : plain;

  SHOW(count_up(u, v) == ((u < v) ? ((int64_t)u + 1) : (int64_t)v), "P15: counts up to a ceiling");
  SHOW(add_saturating(a, b) == held((int64_t)a + b), "P15: a sum stops at the ends");
  SHOW(sum_saturating(u, v) == held_unsigned((int64_t)u + v), "P15: a sum of words stops at the end");
  SHOW(left_of(u, v) == held_unsigned((int64_t)u - v), "P7: what is left of a budget stops at zero");
  SHOW(negate_saturating(a) == held(-(int64_t)a), "P15: the opposite stops at the ends");
  SHOW(magnitude(a) == ((a < 0) ? -(int64_t)a : (int64_t)a), "P15: the distance from zero of every number");
  SHOW(signed_of(u) == wrapped((int64_t)u), "P15: a word in two's complement");
  SHOW(travel_between(&config, u, v) == wrapped(sensed), "P6: motion is a difference modulo 2^32");
  SHOW(along(ILK_DIRECTION_INCREASING, a) == a, "P6: travel along the direction of the position");
  SHOW(along(ILK_DIRECTION_DECREASING, a) == held(-(int64_t)a), "P6: travel against it");
  SHOW(along(ILK_DIRECTION_NONE, a) == 0, "P6: no direction, no travel");
  SHOW(coast_as_read(&config) == held_unsigned((int64_t)config.coast_counts + config.noise_counts),
       "P7: what a budget keeps back");
  SHOW(has_axis(&config) == ((config.card == ILK_CARD_PWM) || (config.card == ILK_CARD_NON_PWM) ||
                             (config.card == ILK_CARD_ANALOG) || (config.card == ILK_CARD_HIGH_FREQUENCY)),
       "P1: the cards that hold a motor");
  SHOW(has_card(&config) == (has_axis(&config) || (config.card == ILK_CARD_SENSOR)), "P1: the cards");
  SHOW(towards_switch(&config) == ((config.limit_side == ILK_LIMIT_UPPER)   ? ILK_DIRECTION_INCREASING
                                   : (config.limit_side == ILK_LIMIT_LOWER) ? ILK_DIRECTION_DECREASING
                                                                            : ILK_DIRECTION_NONE),
       "P3: where the switch lies");
  SHOW(count_of(u, v) == ((u >= 1u) && (u <= v)), "P15: 1 to a largest");

  GOAL(goal_sum_stops, add_saturating(a, b) == INT32_MAX && b == 1);
  GOAL(goal_counter_wraps, (travel_between(&config, u, v) > 0) && (v < u));
  GOAL(never_a_distance_beyond_the_smallest, magnitude(a) > 0x80000000u);
}
