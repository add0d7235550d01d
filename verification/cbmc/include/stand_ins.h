/**
 * @file
 * Stand-ins for arithmetic of the kernel: any function of the same arguments. What is shown with them holds
 * for the real ones. A goal must not be reached by a freak, so they are the real ones there, which the proof
 * `arith` shows to be those of counts.h.
 */
#ifndef ILK_PROOF_STAND_INS_H
#define ILK_PROOF_STAND_INS_H

#include "counts.h"

int32_t __CPROVER_uninterpreted_travel(bool corrected, uint32_t from_raw, uint32_t to_raw);
int32_t __CPROVER_uninterpreted_sum(int32_t a, int32_t b);
uint32_t __CPROVER_uninterpreted_product(uint32_t a, uint32_t b);

/** Stands for `travel_between`. */
int32_t some_travel(const ilk_axis_config_t* config, uint32_t from_raw, uint32_t to_raw) {
#ifdef ILK_COVER
  return (int32_t)travelled(config, from_raw, to_raw);
#else
  return __CPROVER_uninterpreted_travel(config->direction_correction != 0u, from_raw, to_raw);
#endif
}

/** Stands for `add_saturating`. */
int32_t some_sum(int32_t a, int32_t b) {
#ifdef ILK_COVER
  return (int32_t)held((int64_t)a + b);
#else
  return __CPROVER_uninterpreted_sum(a, b);
#endif
}

/** Stands for `multiply_saturating`. */
uint32_t some_product(uint32_t a, uint32_t b) {
#ifdef ILK_COVER
  const uint64_t product = (uint64_t)a * (uint64_t)b;
  return (product > UINT32_MAX) ? UINT32_MAX : (uint32_t)product;
#else
  return __CPROVER_uninterpreted_product(a, b);
#endif
}

#endif
