/**
 * @file
 * What leaving MOTION, locking and disabling do to an axis, from kernel.md ("Modes", "Axes").
 */
#ifndef ILK_PROOF_AXIS_EFFECTS_H
#define ILK_PROOF_AXIS_EFFECTS_H

#include "interlock/types.h"
#include "proof.h"

/** Without setpoint, lease and homing; a setpoint that is gone counts as changed while the stall count runs.
 */
static ilk_axis_t dropped(ilk_axis_t axis) {
  if ((axis.state == ILK_AXIS_MOVING) || (axis.state == ILK_AXIS_HOMING)) {
    axis.state = ILK_AXIS_ENABLED;
  }
  if (axis.stall_driven_ticks != 0u) {
    axis.setpoint_changed = 1u;
  }
  axis.setpoint_counts = 0;
  axis.drive = 0u;
  axis.amplitude = 0u;
  axis.lease_ticks = 0u;
  axis.homing_phase = ILK_HOMING_NONE;
  return axis;
}

/** Out of motion; a fault is never cleared by that. */
static ilk_axis_t disabled(ilk_axis_t axis) {
  ilk_axis_t result = dropped(axis);
  result.state = (axis.state == ILK_AXIS_FAULTED) ? ILK_AXIS_FAULTED : ILK_AXIS_DISABLED;
  return result;
}

/** An axis after the system has entered a mode. */
static ilk_axis_t after_entering(uint32_t mode, ilk_axis_t axis) {
  ilk_axis_t result = (mode == ILK_MODE_LOCKED) ? disabled(axis) : dropped(axis);
  result.press_travel_counts = (mode == ILK_MODE_MOTION) ? 0 : axis.press_travel_counts;
  return result;
}

/** Shows field by field that two axes are the same. */
static void show_same_axis(const ilk_axis_t* after, const ilk_axis_t* expected) {
  SHOW((after->state == expected->state) && (after->homed == expected->homed), "axis: state and homed");
  SHOW((after->fault == expected->fault) && (after->fault_tick == expected->fault_tick) &&
           (after->fault_value == expected->fault_value),
       "P8: axis: the first fault and its values");
  SHOW((after->setpoint_counts == expected->setpoint_counts) && (after->drive == expected->drive) &&
           (after->amplitude == expected->amplitude) && (after->lease_ticks == expected->lease_ticks),
       "P12: axis: setpoint, drive, amplitude and lease");
  SHOW((after->homing_phase == expected->homing_phase) && (after->homing_ticks == expected->homing_ticks) &&
           (after->homing_mark_raw == expected->homing_mark_raw) &&
           (after->rest_ticks == expected->rest_ticks),
       "axis: homing");
  SHOW((after->stall_driven_ticks == expected->stall_driven_ticks) &&
           (after->stall_mark_raw == expected->stall_mark_raw) &&
           (after->stall_direction == expected->stall_direction) &&
           (after->setpoint_changed == expected->setpoint_changed),
       "P5: axis: the stall count");
  SHOW((after->reverse_mark_raw == expected->reverse_mark_raw) &&
           (after->reverse_direction == expected->reverse_direction) &&
           (after->drift_mark_raw == expected->drift_mark_raw) &&
           (after->undriven_ticks == expected->undriven_ticks) &&
           (after->driven_direction == expected->driven_direction),
       "P6: axis: the marks");
  SHOW((after->position_counts == expected->position_counts) && (after->raw == expected->raw) &&
           (after->delta_counts == expected->delta_counts) &&
           (after->press_travel_counts == expected->press_travel_counts),
       "P4, P7: axis: position and travel");
  SHOW(after->wiring == expected->wiring, "P14: axis: how it is wired");
  SHOW((after->switch_triggered == expected->switch_triggered) &&
           (after->card_valid == expected->card_valid) && (after->card_seen == expected->card_seen) &&
           (after->bad_frames == expected->bad_frames) &&
           (after->checksum_failures == expected->checksum_failures) &&
           (after->heartbeat == expected->heartbeat) && (after->card_time_us == expected->card_time_us) &&
           (after->card_status == expected->card_status) &&
           (after->ticks_since_frame == expected->ticks_since_frame),
       "axis: switch and card");
}

/** Shows field by field that the words of the system are the same. */
static void show_same_system(const ilk_state_t* after, const ilk_state_t* expected) {
  SHOW(after->mode == expected->mode, "P2, P8, P9, P10: the mode");
  SHOW((after->cause == expected->cause) && (after->cause_tick == expected->cause_tick) &&
           (after->cause_value == expected->cause_value),
       "P8: the first cause, its tick and value");
  SHOW(after->causes_seen == expected->causes_seen, "P8: the list of causes");
  SHOW((after->pedal == expected->pedal) && (after->pedal_disagree_ticks == expected->pedal_disagree_ticks),
       "P2: the pedal, and for how long its channels disagree");
  SHOW((after->pedal_armed == expected->pedal_armed) &&
           (after->pedal_pressed_ticks == expected->pedal_pressed_ticks) &&
           (after->pedal_released_ticks == expected->pedal_released_ticks),
       "P9: consent");
  SHOW(after->estop == expected->estop, "P2: the E-stop");
  SHOW((after->app_age_ticks == expected->app_age_ticks) && (after->app_alive == expected->app_alive),
       "P10: the age of the app");
  SHOW((after->holder == expected->holder) && (after->link_generation == expected->link_generation) &&
           (after->last_sequence == expected->last_sequence),
       "P11: holder, attachment and sequence");
  SHOW((after->overruns_in_row == expected->overruns_in_row) && (after->overruns == expected->overruns) &&
           (after->bus_bad_ticks == expected->bus_bad_ticks),
       "P2: overruns and the bus");
  SHOW((after->tick == expected->tick) && (after->config_crc == expected->config_crc) &&
           (after->config_slice == expected->config_slice) &&
           (after->config_partial_crc == expected->config_partial_crc) &&
           (after->config_sound == expected->config_sound) && (after->seal == expected->seal),
       "P13, P14: tick, configuration and seal");
  SHOW((after->pedal_channels == expected->pedal_channels) &&
           (after->app_timeout_ticks == expected->app_timeout_ticks),
       "P14: what P2 rests on");
  SHOW((after->requests_accepted == expected->requests_accepted) &&
           (after->requests_refused == expected->requests_refused),
       "P11: the counters of requests");
}

#endif
