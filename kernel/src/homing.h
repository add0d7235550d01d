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
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ requires idle: axis->homing_phase == ILK_HOMING_NONE;
  @ assigns  axis->state, axis->homed, axis->lease_ticks, axis->homing_phase, axis->homing_ticks,
  @          axis->homing_mark_raw, axis->rest_ticks;
  @ ensures  P7_not_homed: axis->state == ILK_AXIS_HOMING && axis->homed == 0;
  @ ensures  switch_first_seen_open: axis->homing_phase ==
  @   (axis->switch_triggered != 0 ? ILK_HOMING_BACK_OFF : ILK_HOMING_SEEK);
  @ ensures  bounds: axis->homing_ticks == config->home_timeout_ticks && axis->homing_mark_raw == axis->raw;
  @ ensures  fresh: axis->lease_ticks == 0 && axis->rest_ticks == 0;
  @*/
void ilk_homing_begin(const ilk_axis_config_t *config, ilk_axis_t *axis);

/** Advances homing by what the last frame said. Does nothing on an axis that is not homing. */
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ requires phase: axis->homing_phase < ILK_HOMING_COUNT;
  @ requires company: axis->state == ILK_AXIS_HOMING <==> axis->homing_phase != ILK_HOMING_NONE;
  @ assigns  axis->state, axis->homed, axis->position_counts, axis->homing_phase, axis->homing_ticks,
  @          axis->homing_mark_raw, axis->rest_ticks;
  @ ensures  company: axis->state == ILK_AXIS_HOMING <==> axis->homing_phase != ILK_HOMING_NONE;
  @ ensures  phase: axis->homing_phase < ILK_HOMING_COUNT;
  @ ensures  idle: \old(axis->state) != ILK_AXIS_HOMING ==> \result.fault == ILK_FAULT_NONE
  @   && axis->state == \old(axis->state) && axis->homed == \old(axis->homed)
  @   && axis->position_counts == \old(axis->position_counts) && axis->homing_ticks == \old(axis->homing_ticks);
  @ ensures  ends: axis->state == \old(axis->state)
  @   || (\old(axis->state) == ILK_AXIS_HOMING && axis->state == ILK_AXIS_ENABLED);
  @ ensures  homed_at_rest: axis->homed == \old(axis->homed) || (axis->homed == 1 && axis->state == ILK_AXIS_ENABLED
  @   && \old(axis->homing_phase) == ILK_HOMING_REST && axis->card_valid != 0);
  @ ensures  reference: axis->position_counts == \old(axis->position_counts)
  @   || (axis->position_counts == config->home_offset_counts && \old(axis->homing_phase) == ILK_HOMING_SEEK
  @       && axis->homing_phase == ILK_HOMING_REST && axis->card_valid != 0 && axis->switch_triggered != 0);
  @ ensures  no_frame: axis->card_valid == 0 ==> axis->homing_phase == \old(axis->homing_phase);
  @ ensures  P7_travel: axis->state == ILK_AXIS_HOMING ==>
  @   (\abs(travel(config, axis->homing_mark_raw, axis->raw)) > homing_bound(config, axis)
  @    <==> \result.fault == ILK_FAULT_HOMING_TRAVEL);
  @ ensures  timeout: axis->state == ILK_AXIS_HOMING && \result.fault == ILK_FAULT_NONE ==> axis->homing_ticks > 0;
  @ ensures  countdown: \old(axis->state) == ILK_AXIS_HOMING ==>
  @   axis->homing_ticks == \max(\old(axis->homing_ticks) - 1, 0);
  @ ensures  late: \result.fault == ILK_FAULT_HOMING_TIMEOUT ==> axis->homing_ticks == 0;
  @ ensures  fault: \result.fault != ILK_FAULT_NONE ==> axis->state == ILK_AXIS_HOMING
  @   && (\result.fault == ILK_FAULT_HOMING_TRAVEL || \result.fault == ILK_FAULT_HOMING_TIMEOUT);
  @ ensures  value: (\result.fault == ILK_FAULT_HOMING_TRAVEL ==>
  @     \result.value == travel(config, axis->homing_mark_raw, axis->raw))
  @   && (\result.fault == ILK_FAULT_HOMING_TIMEOUT ==> \result.value == axis->homing_phase)
  @   && (\result.fault == ILK_FAULT_NONE ==> \result.value == 0);
  @*/
ilk_homing_result_t ilk_homing_advance(const ilk_axis_config_t *config, ilk_axis_t *axis);

/** Direction in which homing wants to drive now; ilk_direction_t. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result == homing_direction(config, axis);
  @ ensures  P3_hard_limit: axis->homing_phase == ILK_HOMING_BACK_OFF ==> \result != switch_direction(config);
  @*/
uint32_t ilk_homing_direction(const ilk_axis_config_t *config, const ilk_axis_t *axis);

#endif
