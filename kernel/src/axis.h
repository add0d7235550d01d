/**
 * @file
 * One axis: what its card says, what it did, what that means (properties P5, P6, P7).
 */
#ifndef ILK_AXIS_H
#define ILK_AXIS_H

#include <stdbool.h>
#include <stdint.h>

#include "frame.h"
#include "interlock/acsl.h"
#include "interlock/types.h"

/** Ends a move or homing; the axis stays enabled. */
/*@ requires valid: \valid(axis);
  @ assigns  axis->state, axis->setpoint_counts, axis->drive, axis->amplitude, axis->lease_ticks,
  @          axis->homing_phase, axis->setpoint_changed;
  @ ensures  P12_no_leap: quiet(axis);
  @ ensures  state: axis->state == (\old(axis->state) == ILK_AXIS_MOVING || \old(axis->state) == ILK_AXIS_HOMING
  @   ? ILK_AXIS_ENABLED : \old(axis->state));
  @ ensures  P5_stall: axis->setpoint_changed ==
  @   (axis->stall_driven_ticks != 0 ? 1 : \old(axis->setpoint_changed));
  @*/
void ilk_axis_drop_motion(ilk_axis_t *axis);

/** Takes the axis out of motion. A FAULTED axis stays FAULTED. */
/*@ requires valid: \valid(axis);
  @ assigns  axis->state, axis->setpoint_counts, axis->drive, axis->amplitude, axis->lease_ticks,
  @          axis->homing_phase, axis->setpoint_changed;
  @ ensures  P12_no_leap: quiet(axis);
  @ ensures  P8_latch: axis->state ==
  @   (\old(axis->state) == ILK_AXIS_FAULTED ? ILK_AXIS_FAULTED : ILK_AXIS_DISABLED);
  @ ensures  P5_stall: axis->setpoint_changed ==
  @   (axis->stall_driven_ticks != 0 ? 1 : \old(axis->setpoint_changed));
  @*/
void ilk_axis_disable(ilk_axis_t *axis);

/** True when the card has given `bad_frame_limit` bad frames in a row. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> axis->bad_frames >= config->bad_frame_limit;
  @*/
bool ilk_card_is_lost(const ilk_config_t *config, const ilk_axis_t *axis);

/** Phase 2: judges a card's frame and counts bad ones. */
/*@ requires valid: \valid(axis) && \valid_read(reading) && \separated(axis, reading);
  @ assigns  axis->card_valid, axis->bad_frames, axis->heartbeat, axis->card_time_us, axis->card_status,
  @          axis->checksum_failures, axis->ticks_since_frame;
  @ ensures  since: axis->ticks_since_frame ==
  @   (\old(axis->card_valid) != 0 ? 1 : \min(\old(axis->ticks_since_frame) + 1, UINT32_MAX));
  @ ensures  P16_used: axis->card_valid ==
  @   (received && reading->intact && (tick < 2 || reading->tick_echo == tick - 2)
  @    && (axis->card_seen == 0 || reading->heartbeat != \old(axis->heartbeat)) ? 1 : 0);
  @ ensures  in_row: axis->bad_frames ==
  @   (axis->card_valid != 0 ? 0 : \min(\old(axis->bad_frames) + 1, UINT32_MAX));
  @ ensures  heard: axis->card_valid != 0 ==> axis->heartbeat == reading->heartbeat
  @   && axis->card_time_us == reading->card_time_us && axis->card_status == reading->card_status;
  @ ensures  P16_unused: axis->card_valid == 0 ==> axis->heartbeat == \old(axis->heartbeat)
  @   && axis->card_time_us == \old(axis->card_time_us) && axis->card_status == \old(axis->card_status);
  @ ensures  failures: axis->checksum_failures == (received && !reading->intact
  @   ? \min(\old(axis->checksum_failures) + 1, UINT32_MAX) : \old(axis->checksum_failures));
  @*/
void ilk_observe_card(ilk_axis_t *axis, const ilk_reading_t *reading, bool received, uint32_t tick);

/** Phase 4: a card without an axis is seen or lost, nothing more. */
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ assigns  axis->card_seen;
  @ ensures  exact: axis->card_seen == (axis->card_valid != 0 ? 1
  @   : axis->bad_frames >= config->bad_frame_limit ? 0 : \old(axis->card_seen));
  @*/
void ilk_observe_sensor(const ilk_config_t *config, ilk_axis_t *axis);

/**
 * Phase 4: follows the axis and judges what it did since its last valid frame.
 *
 * @return true when the axis faulted in this tick.
 */
/*@ requires valid: \valid_read(config) && \valid_read(axis_config) && \valid(axis) && \valid_read(reading);
  @ requires apart: \separated(config, axis, reading) && \separated(axis_config, axis, reading);
  @ requires sound: sound_axis(axis);
  @ assigns  *axis;
  @ ensures  P15_invariant: sound_axis(axis);
  @ ensures  new: \result <==> \old(axis->state) != ILK_AXIS_FAULTED && axis->state == ILK_AXIS_FAULTED;
  @ ensures  P8_latch: \old(axis->state) == ILK_AXIS_FAULTED ==> axis->state == ILK_AXIS_FAULTED
  @   && axis->fault == \old(axis->fault) && axis->fault_tick == \old(axis->fault_tick)
  @   && axis->fault_value == \old(axis->fault_value);
  @ ensures  P3_switch: axis->switch_triggered == (\old(axis_config->limit_side) != ILK_LIMIT_NONE
  @   && (\old(axis->card_valid) == 0 || \old(reading->switch_triggered)) ? 1 : 0);
  @ ensures  P5_stall: axis->card_valid != 0 && in_service(axis) ==>
  @   axis->stall_driven_ticks < \old(axis_config->stall_ticks);
  @ ensures  card_lost: axis->card_valid == 0 && axis->bad_frames >= \old(config->bad_frame_limit) ==>
  @   axis->state == ILK_AXIS_FAULTED && axis->homed == 0 && axis->card_seen == 0;
  @ ensures  mode: axis->state == \old(axis->state) || axis->state == ILK_AXIS_FAULTED
  @   || axis->state == ILK_AXIS_ENABLED;
  @ ensures  idle: \old(axis->state) == ILK_AXIS_DISABLED ==> axis->state != ILK_AXIS_ENABLED;
  @ ensures  frames: axis->card_valid == \old(axis->card_valid) && axis->bad_frames == \old(axis->bad_frames);
  @*/
bool ilk_observe_axis(const ilk_config_t *config, const ilk_axis_config_t *axis_config, ilk_axis_t *axis,
                      const ilk_reading_t *reading, uint32_t tick);

/** Notes that the axis is driven in this tick. */
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ assigns  axis->reverse_direction, axis->reverse_mark_raw, axis->stall_direction, axis->stall_mark_raw,
  @          axis->stall_driven_ticks, axis->driven_direction;
  @ ensures  directions: axis->driven_direction == direction && axis->reverse_direction == direction
  @   && axis->stall_direction == direction;
  @ ensures  P5_stall: axis->stall_driven_ticks == \min(\old(axis->stall_driven_ticks) + 1, UINT32_MAX);
  @ ensures  P5_mark: axis->stall_mark_raw == (axis->undriven_ticks >= config->settle_ticks
  @   || \old(axis->stall_direction) != direction ? axis->raw : \old(axis->stall_mark_raw));
  @ ensures  P6_mark: axis->reverse_mark_raw == (axis->undriven_ticks >= config->settle_ticks
  @   || \old(axis->reverse_direction) != direction ? axis->raw : \old(axis->reverse_mark_raw));
  @*/
void ilk_axis_note_drive(const ilk_axis_config_t *config, ilk_axis_t *axis, uint32_t direction);

/** Notes that the axis stands in the deadband of its setpoint. */
/*@ requires valid: \valid(axis);
  @ assigns  axis->stall_driven_ticks, axis->setpoint_changed, axis->stall_mark_raw;
  @ ensures  P5_stall: \old(axis->setpoint_changed) != 0 ==>
  @   axis->stall_driven_ticks == \old(axis->stall_driven_ticks)
  @   && axis->stall_mark_raw == \old(axis->stall_mark_raw) && axis->setpoint_changed == \old(axis->setpoint_changed);
  @ ensures  arrived: \old(axis->setpoint_changed) == 0 ==> axis->stall_driven_ticks == 0
  @   && axis->stall_mark_raw == axis->raw && axis->setpoint_changed == 0;
  @*/
void ilk_axis_note_arrival(ilk_axis_t *axis);

#endif
