/**
 * @file
 * The saturating product, for a solver that knows products.
 */
#include "arith.h"
#include "proof.h"

void harness(void) {
  uint32_t a;
  uint32_t b;
  const uint64_t product = (uint64_t)a * (uint64_t)b;
  const uint32_t result = multiply_saturating(a, b);
  SHOW(result == ((product > UINT32_MAX) ? UINT32_MAX : product), "P6: a product stops at the end");
  GOAL(goal_stops, (a > 1u) && (b > 1u) && (result == UINT32_MAX));
  GOAL(never_below_a_factor, (a > 0u) && (b > 0u) && (result < a));
}
