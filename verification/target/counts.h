/**
 * @file
 * What happened in the ticks of an image, by code, so that one in which nothing happens is noticed.
 */
#ifndef ILK_TARGET_COUNTS_H
#define ILK_TARGET_COUNTS_H

#include "interlock/types.h"

typedef struct {
  uint32_t mode[ILK_MODE_COUNT];
  uint32_t cause[ILK_CAUSE_COUNT];
  uint32_t fault[ILK_FAULT_COUNT];
  uint32_t verdict[ILK_VERDICT_COUNT];
  uint32_t gate[ILK_GATE_COUNT];
} counts_t;

void count_tick(counts_t *counts, const ilk_state_t *state, const ilk_outputs_t *out);

/** One line for each kind of code: its name, then a count for each code in order. */
void say_counts(const counts_t *counts);

#endif
