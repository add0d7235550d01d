/**
 * @file
 * The words that the kernel's contracts share. ACSL only: a compiler sees comments. docs/wp.md says how to
 * read them.
 */
#ifndef INTERLOCK_ACSL_H
#define INTERLOCK_ACSL_H

#include "interlock/types.h"

/* Arithmetic. */

/*@ // Conversion to a word is modulo 2^32 (C11 6.3.1.3), which the provers' library leaves open beyond the word.
  @ axiomatic Words {
  @   axiom word_from_below: \forall integer value;
  @     -4294967296 <= value < 0 ==> (uint32_t)value == value + 4294967296;
  @   axiom word_from_above: \forall integer value;
  @     4294967296 <= value < 8589934592 ==> (uint32_t)value == value - 4294967296;
  @ }
  @
  @ logic integer clamped(integer value) = \max(INT32_MIN, \min(value, INT32_MAX));
  @
  @ // The value that is equal to the difference of two words modulo 2^32 and fits int32_t.
  @ logic integer wrapped(integer difference) = difference > INT32_MAX   ? difference - 4294967296
  @                                             : difference < INT32_MIN ? difference + 4294967296
  @                                                                      : difference;
  @
  @ // Motion from one counter reading to another, in the sense of the position.
  @ logic integer travel(ilk_axis_config_t *config, integer from_raw, integer to_raw) =
  @   config->direction_correction != 0 ? wrapped(from_raw - to_raw) : wrapped(to_raw - from_raw);
  @
  @ // Travel counted positive along a direction.
  @ logic integer advance(integer direction, integer travelled) =
  @   direction == ILK_DIRECTION_INCREASING   ? travelled
  @   : direction == ILK_DIRECTION_DECREASING ? clamped(-travelled)
  @                                           : 0;
  @*/

/* Configuration. */

/*@ predicate carries_axis(ilk_axis_config_t *config) =
  @   config->card == ILK_CARD_PWM || config->card == ILK_CARD_NON_PWM || config->card == ILK_CARD_ANALOG
  @   || config->card == ILK_CARD_HIGH_FREQUENCY;
  @
  @ predicate carries_card(ilk_axis_config_t *config) = carries_axis(config) || config->card == ILK_CARD_SENSOR;
  @
  @ // Largest drive that the words of a card can carry.
  @ logic integer card_drive(integer card) =
  @   card == ILK_CARD_PWM || card == ILK_CARD_ANALOG ? 0x7fffffff
  @   : card == ILK_CARD_NON_PWM                      ? 0x3fffffff
  @   : card == ILK_CARD_HIGH_FREQUENCY               ? 397785
  @                                                   : 0;
  @
  @ // The direction that presses on the switch.
  @ logic integer switch_direction(ilk_axis_config_t *config) =
  @   config->limit_side == ILK_LIMIT_UPPER   ? ILK_DIRECTION_INCREASING
  @   : config->limit_side == ILK_LIMIT_LOWER ? ILK_DIRECTION_DECREASING
  @                                           : ILK_DIRECTION_NONE;
  @*/

/* Axis. */

/*@ predicate in_service(ilk_axis_t *axis) =
  @   axis->state == ILK_AXIS_ENABLED || axis->state == ILK_AXIS_MOVING || axis->state == ILK_AXIS_HOMING;
  @
  @ // A move whose lease lives, or homing.
  @ predicate held(ilk_axis_t *axis) =
  @   (axis->state == ILK_AXIS_MOVING && axis->lease_ticks != 0) || axis->state == ILK_AXIS_HOMING;
  @
  @ // Towards the setpoint, none within the deadband.
  @ logic integer setpoint_direction(ilk_axis_config_t *config, ilk_axis_t *axis) =
  @   axis->setpoint_counts - axis->position_counts > config->deadband_counts   ? ILK_DIRECTION_INCREASING
  @   : axis->position_counts - axis->setpoint_counts > config->deadband_counts ? ILK_DIRECTION_DECREASING
  @                                                                             : ILK_DIRECTION_NONE;
  @
  @ // Away from the switch, then towards it; a side that is not UPPER counts as LOWER.
  @ logic integer homing_direction(ilk_axis_config_t *config, ilk_axis_t *axis) =
  @   axis->homing_phase == ILK_HOMING_SEEK
  @     ? (config->limit_side == ILK_LIMIT_UPPER ? ILK_DIRECTION_INCREASING : ILK_DIRECTION_DECREASING)
  @   : axis->homing_phase == ILK_HOMING_BACK_OFF
  @     ? (config->limit_side == ILK_LIMIT_UPPER ? ILK_DIRECTION_DECREASING : ILK_DIRECTION_INCREASING)
  @     : ILK_DIRECTION_NONE;
  @
  @ // How far the axis has come along a direction since a reading.
  @ logic integer progress(ilk_axis_config_t *config, ilk_axis_t *axis, integer mark_raw, integer direction) =
  @   advance(direction, travel(config, mark_raw, axis->raw));
  @
  @ // P6: farther than the axis can move since its last valid frame; a product beyond uint32_t is no bound.
  @ predicate jumped(ilk_axis_config_t *config, ilk_axis_t *axis) =
  @   \abs(axis->delta_counts) > \min(config->max_delta_counts * axis->ticks_since_frame, UINT32_MAX);
  @
  @ // P6: too far against the command since the farthest point.
  @ predicate reversed(ilk_axis_config_t *config, ilk_axis_t *axis) = axis->driven_direction != ILK_DIRECTION_NONE
  @   && progress(config, axis, axis->reverse_mark_raw, axis->reverse_direction) < -config->reverse_counts;
  @
  @ // P5 and P6: undriven for so long that motion is no drive's doing.
  @ predicate settled(ilk_axis_config_t *config, ilk_axis_t *axis) =
  @   axis->driven_direction == ILK_DIRECTION_NONE && axis->undriven_ticks >= config->settle_ticks;
  @
  @ // P6: too far from where the undriven axis had settled.
  @ predicate drifted(ilk_axis_config_t *config, ilk_axis_t *axis) =
  @   axis->state != ILK_AXIS_DISABLED && axis->state != ILK_AXIS_FAULTED
  @   && settled(config, axis)
  @   && \abs(travel(config, axis->drift_mark_raw, axis->raw)) > config->drift_counts;
  @
  @ // P5: driven for too long without progress.
  @ predicate stalled(ilk_axis_config_t *config, ilk_axis_t *axis) =
  @   axis->state != ILK_AXIS_DISABLED && axis->state != ILK_AXIS_FAULTED
  @   && axis->stall_driven_ticks >= config->stall_ticks;
  @
  @ // P7: farthest travel of a phase of homing.
  @ logic integer homing_bound(ilk_axis_config_t *config, ilk_axis_t *axis) =
  @   axis->homing_phase == ILK_HOMING_BACK_OFF ? config->home_backoff_counts : config->home_travel_counts;
  @
  @ // Codes that the catalog knows.
  @ predicate known_codes(ilk_axis_t *axis) =
  @   axis->state < ILK_AXIS_COUNT && axis->fault < ILK_FAULT_COUNT && axis->homing_phase < ILK_HOMING_COUNT
  @   && axis->driven_direction < ILK_DIRECTION_COUNT && axis->stall_direction < ILK_DIRECTION_COUNT
  @   && axis->reverse_direction < ILK_DIRECTION_COUNT && axis->homed <= 1;
  @
  @ // Known codes, and each state with exactly the company that belongs to it (the invariant).
  @ predicate sound_axis(ilk_axis_t *axis) = known_codes(axis)
  @   && (axis->state == ILK_AXIS_FAULTED <==> axis->fault != ILK_FAULT_NONE)
  @   && (axis->state == ILK_AXIS_MOVING <==> axis->lease_ticks != 0)
  @   && (axis->state == ILK_AXIS_HOMING <==> axis->homing_phase != ILK_HOMING_NONE)
  @   && (axis->state == ILK_AXIS_HOMING ==> axis->homed == 0);
  @
  @ // What a mode lets an axis be (the invariant).
  @ predicate fits_mode(ilk_axis_t *axis, integer mode) =
  @   mode == ILK_MODE_MOTION
  @   || (mode == ILK_MODE_READY && axis->state != ILK_AXIS_MOVING && axis->state != ILK_AXIS_HOMING)
  @   || axis->state == ILK_AXIS_DISABLED || axis->state == ILK_AXIS_FAULTED;
  @
  @ // P12: no move, no homing, nothing that could start one.
  @ predicate quiet(ilk_axis_t *axis) =
  @   axis->state != ILK_AXIS_MOVING && axis->state != ILK_AXIS_HOMING && axis->homing_phase == ILK_HOMING_NONE
  @   && axis->drive == 0 && axis->amplitude == 0 && axis->lease_ticks == 0 && axis->setpoint_counts == 0;
  @
  @ // P8: what ending motion leaves alone: the fault, the reference, every reading and every mark.
  @ predicate kept{Before, After}(ilk_axis_t *axis) =
  @   (\at(axis->state, After) == ILK_AXIS_FAULTED <==> \at(axis->state, Before) == ILK_AXIS_FAULTED)
  @   && \at(axis->fault, After) == \at(axis->fault, Before)
  @   && \at(axis->fault_tick, After) == \at(axis->fault_tick, Before)
  @   && \at(axis->fault_value, After) == \at(axis->fault_value, Before)
  @   && \at(axis->homed, After) == \at(axis->homed, Before)
  @   && \at(axis->switch_triggered, After) == \at(axis->switch_triggered, Before)
  @   && \at(axis->card_valid, After) == \at(axis->card_valid, Before)
  @   && \at(axis->card_seen, After) == \at(axis->card_seen, Before)
  @   && \at(axis->bad_frames, After) == \at(axis->bad_frames, Before)
  @   && \at(axis->checksum_failures, After) == \at(axis->checksum_failures, Before)
  @   && \at(axis->heartbeat, After) == \at(axis->heartbeat, Before)
  @   && \at(axis->card_time_us, After) == \at(axis->card_time_us, Before)
  @   && \at(axis->card_status, After) == \at(axis->card_status, Before)
  @   && \at(axis->ticks_since_frame, After) == \at(axis->ticks_since_frame, Before)
  @   && \at(axis->raw, After) == \at(axis->raw, Before)
  @   && \at(axis->position_counts, After) == \at(axis->position_counts, Before)
  @   && \at(axis->delta_counts, After) == \at(axis->delta_counts, Before)
  @   && \at(axis->driven_direction, After) == \at(axis->driven_direction, Before)
  @   && \at(axis->stall_driven_ticks, After) == \at(axis->stall_driven_ticks, Before)
  @   && \at(axis->stall_mark_raw, After) == \at(axis->stall_mark_raw, Before)
  @   && \at(axis->stall_direction, After) == \at(axis->stall_direction, Before)
  @   && \at(axis->reverse_mark_raw, After) == \at(axis->reverse_mark_raw, Before)
  @   && \at(axis->reverse_direction, After) == \at(axis->reverse_direction, Before)
  @   && \at(axis->drift_mark_raw, After) == \at(axis->drift_mark_raw, Before)
  @   && \at(axis->undriven_ticks, After) == \at(axis->undriven_ticks, Before)
  @   && \at(axis->homing_ticks, After) == \at(axis->homing_ticks, Before)
  @   && \at(axis->homing_mark_raw, After) == \at(axis->homing_mark_raw, Before)
  @   && \at(axis->rest_ticks, After) == \at(axis->rest_ticks, Before);
  @
  @ logic integer drive_bound(ilk_axis_config_t *config, ilk_axis_t *axis) =
  @   axis->homed != 0 ? config->max_drive : config->unhomed_max_drive;
  @*/

/* System. */

/*@ // What the pedal's contacts say together; anything not clearly pressed or released is a disagreement.
  @ logic integer pedal_reading(ilk_config_t *config, ilk_inputs_t *in) =
  @   in->pedal_no_closed == 1 && (config->pedal_channels == 1 || in->pedal_nc_closed == 0)   ? ILK_PEDAL_PRESSED
  @   : in->pedal_no_closed == 0 && (config->pedal_channels == 1 || in->pedal_nc_closed == 1) ? ILK_PEDAL_RELEASED
  @                                                                                           : ILK_PEDAL_DISAGREE;
  @
  @ predicate sound_system(ilk_state_t *state) =
  @   state->mode < ILK_MODE_COUNT && state->cause < ILK_CAUSE_COUNT && state->pedal < ILK_PEDAL_COUNT
  @   && state->config_slice < ILK_SLOTS && (state->mode == ILK_MODE_LOCKED <==> state->cause != ILK_CAUSE_NONE);
  @
  @ predicate sound_axes(ilk_state_t *state) =
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> sound_axis(&state->axis[slot]);
  @
  @ predicate axes_fit_mode(ilk_state_t *state) =
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> fits_mode(&state->axis[slot], state->mode);
  @
  @ // The invariant of the step, besides the seal.
  @ predicate sound(ilk_state_t *state) = sound_system(state) && sound_axes(state) && axes_fit_mode(state);
  @
  @ // P12
  @ predicate all_quiet(ilk_state_t *state) =
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> quiet(&state->axis[slot]);
  @
  @ // P8: the fault of an axis, when and with what it came, and the reference that it may have cost.
  @ predicate fault_kept{Before, After}(ilk_axis_t *axis) =
  @   \at(axis->fault, After) == \at(axis->fault, Before)
  @   && \at(axis->fault_tick, After) == \at(axis->fault_tick, Before)
  @   && \at(axis->fault_value, After) == \at(axis->fault_value, Before)
  @   && \at(axis->homed, After) == \at(axis->homed, Before);
  @
  @ // P8: a fault that was there stays, with its tick and its value.
  @ predicate fault_latched{Before, After}(ilk_axis_t *axis) =
  @   \at(axis->state, Before) == ILK_AXIS_FAULTED ==> \at(axis->state, After) == ILK_AXIS_FAULTED
  @   && \at(axis->fault, After) == \at(axis->fault, Before)
  @   && \at(axis->fault_tick, After) == \at(axis->fault_tick, Before)
  @   && \at(axis->fault_value, After) == \at(axis->fault_value, Before);
  @
  @ // P4, P16: where the axis stands, by what its card said.
  @ predicate place_kept{Before, After}(ilk_axis_t *axis) =
  @   \at(axis->position_counts, After) == \at(axis->position_counts, Before)
  @   && \at(axis->raw, After) == \at(axis->raw, Before)
  @   && \at(axis->delta_counts, After) == \at(axis->delta_counts, Before)
  @   && \at(axis->switch_triggered, After) == \at(axis->switch_triggered, Before)
  @   && \at(axis->card_valid, After) == \at(axis->card_valid, Before)
  @   && \at(axis->card_seen, After) == \at(axis->card_seen, Before)
  @   && \at(axis->bad_frames, After) == \at(axis->bad_frames, Before);
  @
  @ // P5: the count that ends in a stall, and from where progress is measured.
  @ predicate progress_kept{Before, After}(ilk_axis_t *axis) =
  @   \at(axis->stall_driven_ticks, After) == \at(axis->stall_driven_ticks, Before)
  @   && \at(axis->stall_mark_raw, After) == \at(axis->stall_mark_raw, Before)
  @   && \at(axis->stall_direction, After) == \at(axis->stall_direction, Before);
  @
  @ // P6: from where motion against the command and drift are measured.
  @ predicate marks_kept{Before, After}(ilk_axis_t *axis) =
  @   \at(axis->reverse_mark_raw, After) == \at(axis->reverse_mark_raw, Before)
  @   && \at(axis->reverse_direction, After) == \at(axis->reverse_direction, Before)
  @   && \at(axis->drift_mark_raw, After) == \at(axis->drift_mark_raw, Before)
  @   && \at(axis->undriven_ticks, After) == \at(axis->undriven_ticks, Before)
  @   && \at(axis->driven_direction, After) == \at(axis->driven_direction, Before)
  @   && \at(axis->ticks_since_frame, After) == \at(axis->ticks_since_frame, Before);
  @
  @ // P15: the words of the system that no change of mode touches and that the invariant speaks of.
  @ predicate words_kept{Before, After}(ilk_state_t *state) =
  @   \at(state->pedal, After) == \at(state->pedal, Before)
  @   && \at(state->config_slice, After) == \at(state->config_slice, Before)
  @   && \at(state->app_alive, After) == \at(state->app_alive, Before);
  @
  @ // P12: what entering a mode may change.
  @ predicate motion_kept{Before, After}(ilk_axis_t *axis) =
  @   \at(axis->state, After) == \at(axis->state, Before)
  @   && \at(axis->setpoint_counts, After) == \at(axis->setpoint_counts, Before)
  @   && \at(axis->drive, After) == \at(axis->drive, Before)
  @   && \at(axis->amplitude, After) == \at(axis->amplitude, Before)
  @   && \at(axis->lease_ticks, After) == \at(axis->lease_ticks, Before)
  @   && \at(axis->homing_phase, After) == \at(axis->homing_phase, Before)
  @   && \at(axis->setpoint_changed, After) == \at(axis->setpoint_changed, Before)
  @   && \at(axis->press_travel_counts, After) == \at(axis->press_travel_counts, Before);
  @
  @ // P8, P12: the state in which entering a mode leaves an axis that was in another. A fault stays.
  @ logic integer state_entering(integer mode, integer state) =
  @   state == ILK_AXIS_FAULTED                                ? ILK_AXIS_FAULTED
  @   : mode == ILK_MODE_LOCKED                                ? ILK_AXIS_DISABLED
  @   : state == ILK_AXIS_MOVING || state == ILK_AXIS_HOMING ? ILK_AXIS_ENABLED
  @                                                            : state;
  @
  @ // P9: the consent that the pedal gave.
  @ predicate consent_kept{Before, After}(ilk_state_t *state) =
  @   \at(state->pedal_armed, After) == \at(state->pedal_armed, Before)
  @   && \at(state->pedal_pressed_ticks, After) == \at(state->pedal_pressed_ticks, Before)
  @   && \at(state->pedal_released_ticks, After) == \at(state->pedal_released_ticks, Before);
  @
  @ // P8: the cause that locked, its tick and its value.
  @ predicate cause_kept{Before, After}(ilk_state_t *state) =
  @   \at(state->cause, After) == \at(state->cause, Before)
  @   && \at(state->cause_tick, After) == \at(state->cause_tick, Before)
  @   && \at(state->cause_value, After) == \at(state->cause_value, Before);
  @
  @ // P8: mode, cause and trust in the configuration, which seeing alone does not change.
  @ predicate mode_kept{Before, After}(ilk_state_t *state) =
  @   \at(state->mode, After) == \at(state->mode, Before) && cause_kept{Before, After}(state)
  @   && \at(state->config_sound, After) == \at(state->config_sound, Before);
  @
  @ // P1, P2: what the system decided before anything is driven.
  @ predicate decision_kept{Before, After}(ilk_state_t *state) =
  @   mode_kept{Before, After}(state) && \at(state->pedal, After) == \at(state->pedal, Before)
  @   && \at(state->estop, After) == \at(state->estop, Before);
  @*/

/* Requests. */

/*@ predicate names_axis(integer kind) = ILK_REQUEST_DISABLE <= kind <= ILK_REQUEST_RESTORE;
  @
  @ predicate reset_allowed(ilk_state_t *state) =
  @   state->mode == ILK_MODE_LOCKED && state->pedal == ILK_PEDAL_RELEASED && state->estop == 0
  @   && state->bus_bad_ticks == 0 && state->overruns_in_row == 0 && state->config_sound != 0
  @   && state->app_alive != 0;
  @
  @ predicate disable_allowed(ilk_state_t *state, ilk_axis_t *axis) =
  @   state->mode != ILK_MODE_INIT && axis->state != ILK_AXIS_FAULTED;
  @
  @ predicate enable_allowed(ilk_state_t *state, ilk_axis_t *axis) =
  @   (state->mode == ILK_MODE_READY || state->mode == ILK_MODE_MOTION) && axis->state != ILK_AXIS_FAULTED
  @   && axis->card_valid != 0;
  @
  @ predicate clear_fault_allowed(ilk_state_t *state, ilk_axis_t *axis) =
  @   state->mode != ILK_MODE_INIT && axis->state == ILK_AXIS_FAULTED && axis->card_valid != 0
  @   && axis->fault_tick != state->tick && state->pedal == ILK_PEDAL_RELEASED;
  @
  @ predicate motion_allowed(ilk_state_t *state, ilk_axis_t *axis) =
  @   state->mode == ILK_MODE_MOTION && axis->state != ILK_AXIS_FAULTED && axis->state != ILK_AXIS_DISABLED
  @   && axis->state != ILK_AXIS_HOMING;
  @
  @ // P4 and P7: coasting beyond the setpoint stays within the soft limits, or within the unhomed travel.
  @ predicate setpoint_allowed(ilk_axis_config_t *config, ilk_axis_t *axis, integer setpoint) =
  @   axis->homed != 0
  @     ? config->min_counts + config->coast_counts <= setpoint <= config->max_counts - config->coast_counts
  @     : \abs(setpoint - (axis->position_counts - axis->press_travel_counts))
  @         <= config->unhomed_travel_counts - config->coast_counts;
  @
  @ predicate drive_allowed(ilk_axis_config_t *config, ilk_axis_t *axis, ilk_request_t *request) =
  @   request->drive <= drive_bound(config, axis) && request->amplitude <= config->max_amplitude;
  @
  @ predicate move_allowed(ilk_config_t *config, ilk_state_t *state, ilk_request_t *request) =
  @   motion_allowed(state, &state->axis[request->axis]) && 0 < request->lease_ticks <= config->lease_max_ticks
  @   && drive_allowed(&config->axis[request->axis], &state->axis[request->axis], request)
  @   && setpoint_allowed(&config->axis[request->axis], &state->axis[request->axis], request->target_counts);
  @
  @ // Neither driven nor moved since the last tick, which had a valid frame, too.
  @ predicate at_rest(ilk_axis_t *axis) =
  @   axis->undriven_ticks > 0 && axis->ticks_since_frame == 1 && axis->delta_counts == 0;
  @
  @ predicate declare_allowed(ilk_axis_config_t *config, ilk_state_t *state, ilk_axis_t *axis, integer position) =
  @   state->mode == ILK_MODE_READY && state->pedal == ILK_PEDAL_RELEASED && axis->state != ILK_AXIS_FAULTED
  @   && axis->card_valid != 0 && at_rest(axis) && config->min_counts <= position <= config->max_counts;
  @
  @ // The row of the request table that the kind of the request names.
  @ predicate acceptable(ilk_config_t *config, ilk_state_t *state, ilk_request_t *request) =
  @   (request->kind == ILK_REQUEST_HEARTBEAT || request->kind == ILK_REQUEST_STOP ==> state->mode != ILK_MODE_INIT)
  @   && (request->kind == ILK_REQUEST_RESET ==> reset_allowed(state))
  @   && (request->kind == ILK_REQUEST_DISABLE ==> disable_allowed(state, &state->axis[request->axis]))
  @   && (request->kind == ILK_REQUEST_ENABLE ==> enable_allowed(state, &state->axis[request->axis]))
  @   && (request->kind == ILK_REQUEST_CLEAR_FAULT ==> clear_fault_allowed(state, &state->axis[request->axis]))
  @   && (request->kind == ILK_REQUEST_MOVE ==> move_allowed(config, state, request))
  @   && (request->kind == ILK_REQUEST_HOME ==> motion_allowed(state, &state->axis[request->axis])
  @       && config->axis[request->axis].limit_side != ILK_LIMIT_NONE)
  @   && (request->kind == ILK_REQUEST_SET_HOME ==>
  @       declare_allowed(&config->axis[request->axis], state, &state->axis[request->axis], 0))
  @   && (request->kind == ILK_REQUEST_RESTORE ==> declare_allowed(
  @       &config->axis[request->axis], state, &state->axis[request->axis], request->target_counts));
  @*/

/*@ // The state in which an accepted request leaves the axis that it names.
  @ logic integer state_requested(integer kind, integer state) =
  @   kind == ILK_REQUEST_DISABLE      ? (state == ILK_AXIS_FAULTED ? ILK_AXIS_FAULTED : ILK_AXIS_DISABLED)
  @   : kind == ILK_REQUEST_ENABLE      ? (state == ILK_AXIS_DISABLED ? ILK_AXIS_ENABLED : state)
  @   : kind == ILK_REQUEST_CLEAR_FAULT ? ILK_AXIS_DISABLED
  @   : kind == ILK_REQUEST_MOVE        ? ILK_AXIS_MOVING
  @   : kind == ILK_REQUEST_HOME        ? ILK_AXIS_HOMING
  @                                     : state;
  @
  @ // What acceptance says of the axis that a request names.
  @ predicate suits_axis(ilk_axis_t *axis, ilk_request_t *request) =
  @   (request->kind == ILK_REQUEST_CLEAR_FAULT ==> axis->state == ILK_AXIS_FAULTED)
  @   && (request->kind == ILK_REQUEST_MOVE || request->kind == ILK_REQUEST_HOME ==>
  @       axis->state == ILK_AXIS_ENABLED || axis->state == ILK_AXIS_MOVING)
  @   && (request->kind == ILK_REQUEST_MOVE ==> request->lease_ticks != 0)
  @   && (request->kind == ILK_REQUEST_SET_HOME ==> axis->state != ILK_AXIS_HOMING);
  @
  @ // What is left of acceptance for carrying a request out.
  @ predicate applicable(ilk_state_t *state, ilk_request_t *request) =
  @   (request->kind == ILK_REQUEST_RESET ==> state->mode == ILK_MODE_LOCKED)
  @   && (request->kind == ILK_REQUEST_ENABLE ==> state->mode == ILK_MODE_READY || state->mode == ILK_MODE_MOTION)
  @   && (request->kind == ILK_REQUEST_MOVE || request->kind == ILK_REQUEST_HOME ==>
  @       state->mode == ILK_MODE_MOTION)
  @   && (names_axis(request->kind) ==>
  @       request->axis < ILK_SLOTS && suits_axis(&state->axis[request->axis], request));
  @*/

/* The output gate. */

/*@ // P1: what must hold now for any drive: on the side of the system ...
  @ predicate consented(ilk_state_t *state) =
  @   state->mode == ILK_MODE_MOTION && state->pedal == ILK_PEDAL_PRESSED && state->estop == 0;
  @
  @ // ... and on the side of the axis.
  @ predicate may_drive(ilk_state_t *state, ilk_axis_t *axis) =
  @   consented(state) && axis->card_valid != 0 && in_service(axis) && held(axis);
  @
  @ predicate asks_for_motion(ilk_command_t *wanted) = wanted->drive != 0 &&
  @   (wanted->direction == ILK_DIRECTION_INCREASING || wanted->direction == ILK_DIRECTION_DECREASING);
  @
  @ // P3: not towards a triggered switch.
  @ predicate clear_of_switch(ilk_axis_config_t *config, ilk_axis_t *axis, integer direction) =
  @   axis->switch_triggered != 0 && direction != ILK_DIRECTION_NONE ==> direction != switch_direction(config);
  @
  @ // P4: coasting from here ends within the soft limits.
  @ predicate within_soft_range(ilk_axis_config_t *config, ilk_axis_t *axis, integer direction) =
  @   axis->homed != 0 ==>
  @     (direction == ILK_DIRECTION_INCREASING ==> axis->position_counts + config->coast_counts < config->max_counts)
  @     && (direction == ILK_DIRECTION_DECREASING ==> axis->position_counts - config->coast_counts > config->min_counts);
  @
  @ // P7: coasting from here ends within the travel that one press of the pedal gives an axis that is not homed.
  @ predicate within_unhomed_travel(ilk_axis_config_t *config, ilk_axis_t *axis, integer direction) =
  @   axis->homed == 0 && axis->state != ILK_AXIS_HOMING ==>
  @     advance(direction, axis->press_travel_counts) + config->coast_counts < config->unhomed_travel_counts;
  @
  @ // P7: no more than the axis may, nor than the words of its card can carry.
  @ predicate within_drive(ilk_axis_config_t *config, ilk_axis_t *axis, ilk_command_t *wanted) =
  @   wanted->drive <= drive_bound(config, axis) && wanted->drive <= card_drive(config->card)
  @   && wanted->amplitude <= config->max_amplitude && wanted->amplitude <= 255;
  @
  @ predicate within_limits(ilk_axis_config_t *config, ilk_axis_t *axis, ilk_command_t *wanted) =
  @   clear_of_switch(config, axis, wanted->direction) && within_soft_range(config, axis, wanted->direction)
  @   && within_unhomed_travel(config, axis, wanted->direction) && within_drive(config, axis, wanted);
  @
  @ // P16: the words that move a motor are zero.
  @ predicate still_frame(uint32_t *frame) =
  @   frame[2] == 0 && frame[3] == 0 && frame[4] == 0 && frame[5] == 0 && frame[6] == 0 && frame[14] == 0;
  @*/

/* The step. */

/*@ // P16: the card of this slot answered in this tick.
  @ predicate card_answered(ilk_inputs_t *in, integer slot) =
  @   in->transaction_done == 1 && ((in->frames_received >> slot) & 1) != 0;
  @
  @ // P11: the one answer to a request.
  @ predicate records(ilk_verdict_record_t *entry, integer tick, ilk_request_t *request, integer verdict) =
  @   entry->tick == tick && entry->sequence == request->sequence && entry->kind == request->kind
  @   && entry->axis == request->axis && entry->verdict == verdict;
  @
  @ predicate blank_record(ilk_verdict_record_t *entry) =
  @   entry->tick == 0 && entry->sequence == 0 && entry->kind == 0 && entry->axis == 0 && entry->verdict == 0;
  @
  @ predicate record_kept{Before, After}(ilk_verdict_record_t *entry) =
  @   \at(entry->tick, After) == \at(entry->tick, Before)
  @   && \at(entry->sequence, After) == \at(entry->sequence, Before)
  @   && \at(entry->kind, After) == \at(entry->kind, Before)
  @   && \at(entry->axis, After) == \at(entry->axis, Before)
  @   && \at(entry->verdict, After) == \at(entry->verdict, Before);
  @
  @ predicate some_fault(ilk_state_t *state, integer slots, integer fault) =
  @   \exists integer slot; 0 <= slot < slots && state->axis[slot].fault == fault;
  @
  @ predicate free_of_faults(ilk_state_t *state, integer slots) =
  @   \forall integer slot; 0 <= slot < slots ==> state->axis[slot].fault == ILK_FAULT_NONE;
  @
  @ predicate zero_drive(ilk_command_t *command) =
  @   command->direction == ILK_DIRECTION_NONE && command->drive == 0 && command->amplitude == 0;
  @
  @ // P1: only through an open gate, else zero drive.
  @ predicate passed(ilk_state_t *state, integer slot, integer gate) =
  @   gate == ILK_GATE_OPEN ==> may_drive(state, &state->axis[slot]);
  @
  @ predicate stopped(integer gate, ilk_command_t *command) = gate != ILK_GATE_OPEN ==> zero_drive(command);
  @
  @ // P3, P4 and P7 of what leaves an open gate.
  @ predicate off_switch(ilk_config_t *config, ilk_state_t *state, integer slot, integer gate,
  @                      ilk_command_t *command) =
  @   gate == ILK_GATE_OPEN ==>
  @     clear_of_switch(&config->axis[slot], &state->axis[slot], command->direction);
  @
  @ predicate in_soft_range(ilk_config_t *config, ilk_state_t *state, integer slot, integer gate,
  @                         ilk_command_t *command) =
  @   gate == ILK_GATE_OPEN ==>
  @     within_soft_range(&config->axis[slot], &state->axis[slot], command->direction);
  @
  @ predicate in_unhomed_travel(ilk_config_t *config, ilk_state_t *state, integer slot, integer gate,
  @                             ilk_command_t *command) =
  @   gate == ILK_GATE_OPEN ==>
  @     within_unhomed_travel(&config->axis[slot], &state->axis[slot], command->direction);
  @
  @ predicate in_drive(ilk_config_t *config, ilk_state_t *state, integer slot, integer gate,
  @                    ilk_command_t *command) =
  @   gate == ILK_GATE_OPEN ==> within_drive(&config->axis[slot], &state->axis[slot], command);
  @
  @ // All of these of one slot, and a direction that the catalog knows.
  @ predicate gated(ilk_config_t *config, ilk_state_t *state, integer slot, integer gate,
  @                 ilk_command_t *command) =
  @   passed(state, slot, gate) && stopped(gate, command) && off_switch(config, state, slot, gate, command)
  @   && in_soft_range(config, state, slot, gate, command)
  @   && in_unhomed_travel(config, state, slot, gate, command) && in_drive(config, state, slot, gate, command)
  @   && command->direction < ILK_DIRECTION_COUNT;
  @
  @ // P16: a command of zero drive is a frame that moves nothing.
  @ predicate stills(ilk_command_t *command, uint32_t *frame) = zero_drive(command) ==> still_frame(frame);
  @
  @ predicate at_zero(ilk_outputs_t *out) =
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> zero_drive(&out->command[slot]);
  @
  @ predicate all_still(ilk_outputs_t *out) =
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> still_frame(&out->frame[slot][0]);
  @*/

/* Integrity (P14). */

/*@ // An axis of which nothing is known and that nothing drives.
  @ predicate blank_axis(ilk_axis_t *axis) =
  @   axis->state == ILK_AXIS_DISABLED && axis->fault == ILK_FAULT_NONE && axis->homed == 0
  @   && axis->card_valid == 0 && axis->card_seen == 0 && axis->lease_ticks == 0
  @   && axis->homing_phase == ILK_HOMING_NONE && axis->driven_direction == ILK_DIRECTION_NONE
  @   && axis->stall_direction == ILK_DIRECTION_NONE && axis->reverse_direction == ILK_DIRECTION_NONE;
  @
  @ predicate blank_axes(ilk_state_t *state) =
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> blank_axis(&state->axis[slot]);
  @
  @ // What one more word makes of the digest.
  @ logic integer mixed(integer running, integer next) = \let changed = (uint32_t)(running ^ next);
  @   (uint32_t)(((uint32_t)(changed << 13) | (changed >> 19)) * 0x9e3779b1);
  @
  @ // Every word of an axis, in two lanes, ...
  @ logic integer axis_seal_even(ilk_axis_t *axis) =
  @   mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(
  @   mixed(mixed(0x494c4b31, axis->state), axis->fault_tick), axis->homed), axis->card_valid),
  @     axis->bad_frames), axis->heartbeat), axis->card_status), axis->raw), (uint32_t)axis->delta_counts),
  @     axis->drive), axis->lease_ticks), (uint32_t)axis->press_travel_counts), axis->stall_mark_raw),
  @     axis->setpoint_changed), axis->reverse_direction), axis->undriven_ticks), axis->homing_ticks),
  @     axis->rest_ticks);
  @
  @ logic integer axis_seal_odd(ilk_axis_t *axis) =
  @   mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(
  @   mixed(mixed(0x494c4b32, axis->fault), (uint32_t)axis->fault_value), axis->switch_triggered),
  @     axis->card_seen),
  @     axis->checksum_failures), axis->card_time_us), axis->ticks_since_frame),
  @     (uint32_t)axis->position_counts), (uint32_t)axis->setpoint_counts), axis->amplitude),
  @     axis->driven_direction), axis->stall_driven_ticks), axis->stall_direction), axis->reverse_mark_raw),
  @     axis->drift_mark_raw), axis->homing_phase), axis->homing_mark_raw), axis->wiring);
  @
  @ logic integer axis_seal(ilk_axis_t *axis) = mixed(axis_seal_even(axis), axis_seal_odd(axis));
  @
  @ // ... every word of the system but the seal, ...
  @ logic integer system_seal_even(ilk_state_t *state) =
  @   mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(
  @   mixed(0x494c4b31, state->mode),
  @     state->cause_tick), state->causes_seen), state->pedal_armed), state->pedal_released_ticks),
  @     state->estop), state->app_alive), state->link_generation), state->overruns_in_row),
  @     state->bus_bad_ticks), state->config_slice), state->config_sound), state->app_timeout_ticks),
  @     state->requests_refused);
  @
  @ logic integer system_seal_odd(ilk_state_t *state) =
  @   mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(mixed(
  @   mixed(0x494c4b32, state->tick),
  @     state->cause), state->cause_value), state->pedal), state->pedal_pressed_ticks),
  @     state->pedal_disagree_ticks), state->app_age_ticks), state->holder), state->last_sequence),
  @     state->overruns), state->config_crc), state->config_partial_crc), state->pedal_channels),
  @     state->requests_accepted);
  @
  @ // ... then the first axes.
  @ logic integer seal_of(ilk_state_t *state, integer slots) =
  @   slots <= 0 ? mixed(system_seal_even(state), system_seal_odd(state))
  @              : mixed(seal_of(state, slots - 1), axis_seal(&state->axis[slots - 1]));
  @
  @ predicate sealed(ilk_state_t *state) = state->seal == seal_of(state, ILK_SLOTS);
  @
  @ // What direction on the wire and switch mean: card, switch end, motor sense, each below 2^8 or all unknown.
  @ logic integer wiring(ilk_axis_config_t *axis) =
  @   axis->card > 255 || axis->limit_side > 255 || axis->motor_direction > 255 ? UINT32_MAX
  @   : axis->card + 256 * axis->limit_side + 65536 * axis->motor_direction;
  @
  @ // The words of the configuration that P1 to P3 rest on are those of the start.
  @ predicate basis_kept(ilk_config_t *config, ilk_state_t *state) =
  @   config->pedal_channels == state->pedal_channels && config->app_timeout_ticks == state->app_timeout_ticks
  @   && \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @        state->axis[slot].wiring == wiring(&config->axis[slot]);
  @*/

#endif
