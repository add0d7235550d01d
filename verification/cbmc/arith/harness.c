/**
 * @file
 * The arithmetic on which everything rests, against the same in 64 bits.
 */
#include "arith.h"
#include "counts.h"
#include "proof.h"

void harness(void) {
  ilk_axis_config_t config;
  int32_t a;
  int32_t b;
  uint32_t u;
  uint32_t v;
  uint32_t direction;

  SHOW(count_up(u, v) == one_more(u, v), "P15: counts up to a ceiling");
  SHOW(count_down(u) == one_less(u), "P15: counts down to zero");
  SHOW(add_saturating(a, b) == held((int64_t)a + b), "P15: a sum stops at the ends");
  SHOW(negate_saturating(a) == held(-(int64_t)a), "P15: the opposite stops at the ends");
  SHOW(magnitude(a) == distance(a), "P15: the distance from zero of every number");
  SHOW(signed_of(u) == (((int64_t)u > INT32_MAX) ? ((int64_t)u - ((int64_t)1 << 32)) : (int64_t)u),
       "P15: a word in two's complement");
  SHOW(travel_between(&config, u, v) == travelled(&config, u, v), "P6: motion is a difference modulo 2^32");
  SHOW(along(direction, a) == held(directed(direction, a)), "P6: travel along a direction");
  SHOW(flag_of(a != b) == ((a != b) ? 1u : 0u), "a truth is 1 or 0");

  GOAL(goal_sum_stops, add_saturating(a, b) == INT32_MAX && b == 1);
  GOAL(goal_counter_wraps, (travel_between(&config, u, v) > 0) && (v < u));
  GOAL(never_a_negative_distance, distance(a) < 0);
}
