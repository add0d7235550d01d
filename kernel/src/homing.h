/**
 * @file
 * Homing at the limit switch, run by the kernel (properties P3, P7, L2).
 */
#ifndef ILK_HOMING_H
#define ILK_HOMING_H

#include <stdint.h>

#include "interlock/acsl.h"
#include "interlock/types.h"

/** Why homing failed, or NONE. */
typedef struct {
  ilk_fault_t fault;
  int32_t value;
} ilk_homing_result_t;

/** Begins homing: away from a switch that is triggered, else towards it. */
void ilk_homing_begin(const ilk_axis_config_t *config, ilk_axis_t *axis);

/** Advances homing by what the last frame said. Does nothing on an axis that is not homing. */
ilk_homing_result_t ilk_homing_advance(const ilk_axis_config_t *config, ilk_axis_t *axis);

/** Direction in which homing wants to drive now; ilk_direction_t. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result == homing_direction(config, axis);
  @ ensures  P3_hard_limit: axis->homing_phase == ILK_HOMING_BACK_OFF ==> \result != switch_direction(config);
  @*/
uint32_t ilk_homing_direction(const ilk_axis_config_t *config, const ilk_axis_t *axis);

#endif
