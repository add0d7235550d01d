#include "request.h"

#include "arith.h"
#include "axis.h"
#include "homing.h"
#include "mode.h"

/** A new holder finds no consent and no motion. */
/*@ requires valid: \valid(state);
  @ assigns  state->app_age_ticks, state->holder, state->mode, state->pedal_armed, state->pedal_pressed_ticks,
  @          state->pedal_released_ticks, state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P8_first_cause: cause_kept{Pre, Post}(state) && state->causes_seen == \old(state->causes_seen);
  @ ensures  P10_silence: state->app_age_ticks == 0;
  @ ensures  holder: state->holder == holder;
  @ ensures  P9_consent: \old(state->holder) != holder ==>
  @   state->mode != ILK_MODE_MOTION && state->pedal_armed == 0
  @   && state->pedal_pressed_ticks == 0 && state->pedal_released_ticks == 0;
  @ ensures  P9_still: \old(state->holder) == holder ==> consent_kept{Pre, Post}(state);
  @ ensures  P8_latch: state->mode == (\old(state->holder) != holder && \old(state->mode) == ILK_MODE_MOTION
  @   ? ILK_MODE_READY : \old(state->mode));
  @ ensures  P12_no_leap: state->mode != \old(state->mode) ==> all_quiet(state);
  @ ensures  P8_still: state->mode == \old(state->mode) ==> \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   motion_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P8_states: state->mode != \old(state->mode) ==> \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   state->axis[slot].state == state_entering(ILK_MODE_READY, \old(state->axis[slot].state));
  @ ensures  P8_faults: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   fault_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P4_place: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   place_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P5_progress: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   progress_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P6_marks: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   marks_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @*/
static void apply_heartbeat(ilk_state_t *state, uint32_t holder) {
  state->app_age_ticks = 0u;
  if (state->holder != holder) {
    state->holder = holder;
    ilk_pedal_disarm(state);
    /*@ assert motion: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
      @   motion_kept{Pre, Here}(&state->axis[slot]); */
    /*@ assert P8_faults: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
      @   fault_kept{Pre, Here}(&state->axis[slot]); */
    /*@ assert P4_place: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
      @   place_kept{Pre, Here}(&state->axis[slot]); */
    /*@ assert P5_progress: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
      @   progress_kept{Pre, Here}(&state->axis[slot]); */
    /*@ assert P6_marks: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
      @   marks_kept{Pre, Here}(&state->axis[slot]); */
    if (state->mode == (uint32_t)ILK_MODE_MOTION) {
      ilk_mode_enter(state, ILK_MODE_READY);
    }
  }
}

/*@ requires valid: \valid(state);
  @ assigns  state->mode, state->pedal_armed, state->pedal_pressed_ticks,
  @          state->pedal_released_ticks, state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P8_first_cause: cause_kept{Pre, Post}(state) && state->causes_seen == \old(state->causes_seen);
  @ ensures  P2_stop: state->mode == (\old(state->mode) == ILK_MODE_MOTION ? ILK_MODE_READY
  @   : \old(state->mode));
  @ ensures  P9_consent: \old(state->mode) == ILK_MODE_MOTION ==> state->pedal_armed == 0
  @   && state->pedal_pressed_ticks == 0 && state->pedal_released_ticks == 0;
  @ ensures  P9_still: \old(state->mode) != ILK_MODE_MOTION ==> consent_kept{Pre, Post}(state);
  @ ensures  P12_no_leap: \old(state->mode) == ILK_MODE_MOTION ==> all_quiet(state);
  @ ensures  P8_still: \old(state->mode) != ILK_MODE_MOTION ==>
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   motion_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P8_states: \old(state->mode) == ILK_MODE_MOTION ==>
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   state->axis[slot].state == state_entering(ILK_MODE_READY, \old(state->axis[slot].state));
  @ ensures  P8_faults: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   fault_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P4_place: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   place_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P5_progress: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   progress_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P6_marks: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   marks_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @*/
static void apply_stop(ilk_state_t *state) {
  if (state->mode == (uint32_t)ILK_MODE_MOTION) {
    ilk_mode_enter(state, ILK_MODE_READY);
  }
}

/*@ requires valid: \valid(state);
  @ assigns  state->cause, state->cause_tick, state->cause_value, state->causes_seen, state->mode,
  @          state->pedal_armed, state->pedal_pressed_ticks,
  @          state->pedal_released_ticks, state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P8_latch: state->mode == ILK_MODE_READY && state->cause == ILK_CAUSE_NONE
  @   && state->cause_tick == 0
  @   && state->cause_value == 0 && state->causes_seen == 0;
  @ ensures  P9_consent: state->pedal_armed == 0 && state->pedal_pressed_ticks == 0
  @   && state->pedal_released_ticks == 0;
  @ ensures  P12_no_leap: all_quiet(state);
  @ ensures  P8_states: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   state->axis[slot].state == state_entering(ILK_MODE_READY, \old(state->axis[slot].state));
  @ ensures  P8_faults: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   fault_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P4_place: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   place_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P5_progress: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   progress_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P6_marks: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   marks_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @*/
static void apply_reset(ilk_state_t *state) {
  state->cause = (uint32_t)ILK_CAUSE_NONE;
  state->cause_tick = 0u;
  state->cause_value = 0u;
  state->causes_seen = 0u;
  /*@ assert motion: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   motion_kept{Pre, Here}(&state->axis[slot]); */
  /*@ assert P8_faults: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   fault_kept{Pre, Here}(&state->axis[slot]); */
  /*@ assert P4_place: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   place_kept{Pre, Here}(&state->axis[slot]); */
  /*@ assert P5_progress: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   progress_kept{Pre, Here}(&state->axis[slot]); */
  /*@ assert P6_marks: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   marks_kept{Pre, Here}(&state->axis[slot]); */
  ilk_mode_enter(state, ILK_MODE_READY);
}

/*@ requires valid: \valid(axis);
  @ assigns  axis->state;
  @ ensures  exact: axis->state == (\old(axis->state) == ILK_AXIS_DISABLED ? ILK_AXIS_ENABLED
  @   : \old(axis->state));
  @*/
static void apply_enable(ilk_axis_t *axis) {
  if (axis->state == (uint32_t)ILK_AXIS_DISABLED) {
    axis->state = (uint32_t)ILK_AXIS_ENABLED;
  }
}

/** The stall count starts anew only after a stall: no other fault excuses an axis that makes no progress. */
/*@ requires valid: \valid(axis);
  @ assigns  axis->state, axis->fault, axis->fault_tick, axis->fault_value, axis->stall_driven_ticks,
  @          axis->setpoint_changed;
  @ ensures  P8_latch: axis->state == ILK_AXIS_DISABLED && axis->fault == ILK_FAULT_NONE
  @   && axis->fault_tick == 0
  @   && axis->fault_value == 0;
  @ ensures  P5_stall: axis->stall_driven_ticks ==
  @   (\old(axis->fault) == ILK_FAULT_STALL ? 0 : \old(axis->stall_driven_ticks));
  @ ensures  P5_setpoint: axis->setpoint_changed ==
  @   (\old(axis->fault) == ILK_FAULT_STALL ? 0 : \old(axis->setpoint_changed));
  @*/
static void apply_clear_fault(ilk_axis_t *axis) {
  if (axis->fault == (uint32_t)ILK_FAULT_STALL) {
    axis->stall_driven_ticks = 0u;
    axis->setpoint_changed = 0u;
  }
  axis->state = (uint32_t)ILK_AXIS_DISABLED;
  axis->fault = (uint32_t)ILK_FAULT_NONE;
  axis->fault_tick = 0u;
  axis->fault_value = 0;
}

/*@ requires valid: \valid(axis) && \valid_read(request) && \separated(axis, request);
  @ assigns  axis->state, axis->setpoint_counts, axis->drive, axis->amplitude, axis->lease_ticks,
  @          axis->setpoint_changed;
  @ ensures  move: axis->state == ILK_AXIS_MOVING && axis->setpoint_counts == \old(request->target_counts);
  @ ensures  P7_drive: axis->drive == \old(request->drive) && axis->amplitude == \old(request->amplitude);
  @ ensures  P1_lease: axis->lease_ticks == \old(request->lease_ticks);
  @ ensures  P5_stall: axis->setpoint_changed ==
  @   (\old(axis->setpoint_counts) != \old(request->target_counts) && \old(axis->stall_driven_ticks) != 0
  @     ? 1 : \old(axis->setpoint_changed));
  @*/
static void apply_move(ilk_axis_t *axis, const ilk_request_t *request) {
  if ((axis->setpoint_counts != request->target_counts) && (axis->stall_driven_ticks != 0u)) {
    axis->setpoint_changed = 1u;
  }
  axis->state = (uint32_t)ILK_AXIS_MOVING;
  axis->setpoint_counts = request->target_counts;
  axis->drive = request->drive;
  axis->amplitude = request->amplitude;
  axis->lease_ticks = request->lease_ticks;
}

/*@ requires valid: \valid_read(config) && \valid(axis) && \valid_read(request);
  @ requires apart: \separated(axis, config) && \separated(axis, request);
  @ requires accepted: suits_axis(axis, request);
  @ requires sound: sound_axis(axis);
  @ assigns  *axis;
  @ ensures  P15_invariant: sound_axis(axis);
  @ ensures  P8_latch: \old(request->kind) != ILK_REQUEST_CLEAR_FAULT ==> axis->fault == \old(axis->fault)
  @   && axis->fault_tick == \old(axis->fault_tick) && axis->fault_value == \old(axis->fault_value);
  @ ensures  P8_states: axis->state == state_requested(\old(request->kind), \old(axis->state));
  @ ensures  P8_cleared: \old(request->kind) == ILK_REQUEST_CLEAR_FAULT ==> axis->fault == ILK_FAULT_NONE;
  @ ensures  P12_disabled: \old(request->kind) == ILK_REQUEST_DISABLE ==> quiet(axis);
  @ ensures  P7_drive: \old(request->kind) == ILK_REQUEST_MOVE ==>
  @   axis->setpoint_counts == \old(request->target_counts) && axis->drive == \old(request->drive)
  @   && axis->amplitude == \old(request->amplitude) && axis->lease_ticks == \old(request->lease_ticks);
  @ ensures  P7_homing: \old(request->kind) == ILK_REQUEST_HOME ==>
  @   axis->homed == 0 && axis->lease_ticks == 0;
  @ ensures  P4_position: axis->position_counts == (\old(request->kind) == ILK_REQUEST_SET_HOME ? 0
  @   : \old(request->kind) == ILK_REQUEST_RESTORE ? \old(request->target_counts)
  @   : \old(axis->position_counts));
  @ ensures  P4_homed: axis->homed == (\old(request->kind) == ILK_REQUEST_SET_HOME ? 1
  @   : \old(request->kind) == ILK_REQUEST_RESTORE || \old(request->kind) == ILK_REQUEST_HOME ? 0
  @   : \old(axis->homed));
  @ ensures  P5_stall: axis->stall_driven_ticks == (\old(request->kind) == ILK_REQUEST_CLEAR_FAULT
  @   && \old(axis->fault) == ILK_FAULT_STALL ? 0 : \old(axis->stall_driven_ticks));
  @*/
static void apply_to_axis(const ilk_axis_config_t *config, ilk_axis_t *axis, const ilk_request_t *request) {
  switch (request->kind) {
    case (uint32_t)ILK_REQUEST_DISABLE:
      ilk_axis_disable(axis);
      break;
    case (uint32_t)ILK_REQUEST_ENABLE:
      apply_enable(axis);
      break;
    case (uint32_t)ILK_REQUEST_CLEAR_FAULT:
      apply_clear_fault(axis);
      break;
    case (uint32_t)ILK_REQUEST_MOVE:
      apply_move(axis, request);
      break;
    case (uint32_t)ILK_REQUEST_HOME:
      ilk_homing_begin(config, axis);
      break;
    case (uint32_t)ILK_REQUEST_SET_HOME:
      axis->position_counts = 0;
      axis->homed = 1u;
      break;
    case (uint32_t)ILK_REQUEST_RESTORE:
      axis->position_counts = request->target_counts;
      axis->homed = 0u;
      break;
    default:
      /* Every request that names an axis is above. */
      break;
  }
}

/** The axis of one slot, and no other. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(request) && slot < ILK_SLOTS;
  @ requires apart: \separated(state, config) && \separated(state, request);
  @ requires accepted: suits_axis(&state->axis[slot], request);
  @ requires sound: sound_axis(&state->axis[slot]);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P15_invariant: sound_axis(&state->axis[slot]);
  @ ensures  P8_states: state->axis[slot].state ==
  @   state_requested(\old(request->kind), \old(state->axis[slot].state));
  @ ensures  P8_latch: \old(request->kind) != ILK_REQUEST_CLEAR_FAULT ==>
  @   state->axis[slot].fault == \old(state->axis[slot].fault)
  @   && state->axis[slot].fault_tick == \old(state->axis[slot].fault_tick)
  @   && state->axis[slot].fault_value == \old(state->axis[slot].fault_value);
  @ ensures  P7_drive: \old(request->kind) == ILK_REQUEST_MOVE ==>
  @   state->axis[slot].setpoint_counts == \old(request->target_counts)
  @   && state->axis[slot].drive == \old(request->drive)
  @   && state->axis[slot].amplitude == \old(request->amplitude)
  @   && state->axis[slot].lease_ticks == \old(request->lease_ticks);
  @ ensures  P4_homed: state->axis[slot].homed == (\old(request->kind) == ILK_REQUEST_SET_HOME ? 1
  @   : \old(request->kind) == ILK_REQUEST_RESTORE || \old(request->kind) == ILK_REQUEST_HOME ? 0
  @                                               : \old(state->axis[slot].homed));
  @ ensures  P4_position: state->axis[slot].position_counts ==
  @   (\old(request->kind) == ILK_REQUEST_SET_HOME  ? 0
  @   : \old(request->kind) == ILK_REQUEST_RESTORE ? \old(request->target_counts)
  @                                               : \old(state->axis[slot].position_counts));
  @ ensures  motion_below: \forall integer other; 0 <= other < slot ==>
  @   motion_kept{Pre, Post}(&state->axis[other]);
  @ ensures  P8_faults_below: \forall integer other; 0 <= other < slot ==>
  @   fault_kept{Pre, Post}(&state->axis[other]);
  @ ensures  P4_place_below: \forall integer other; 0 <= other < slot ==>
  @   place_kept{Pre, Post}(&state->axis[other]);
  @ ensures  P5_progress_below: \forall integer other; 0 <= other < slot ==>
  @   progress_kept{Pre, Post}(&state->axis[other]);
  @ ensures  P6_marks_below: \forall integer other; 0 <= other < slot ==>
  @   marks_kept{Pre, Post}(&state->axis[other]);
  @ ensures  motion_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   motion_kept{Pre, Post}(&state->axis[other]);
  @ ensures  P8_faults_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   fault_kept{Pre, Post}(&state->axis[other]);
  @ ensures  P4_place_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   place_kept{Pre, Post}(&state->axis[other]);
  @ ensures  P5_progress_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   progress_kept{Pre, Post}(&state->axis[other]);
  @ ensures  P6_marks_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   marks_kept{Pre, Post}(&state->axis[other]);
  @*/
static void apply_to_slot(const ilk_axis_config_t *config, ilk_state_t *state, uint32_t slot,
                          const ilk_request_t *request) {
  apply_to_axis(config, &state->axis[slot], request);
}

void ilk_request_apply(const ilk_config_t *config, ilk_state_t *state, const ilk_request_t *request) {
  switch (request->kind) {
    case (uint32_t)ILK_REQUEST_HEARTBEAT:
      apply_heartbeat(state, request->holder);
      /*@ assert P15_system: \at(sound_system(state), Pre) ==> sound_system(state); */
      /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
        @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
      /*@ assert P15_mode: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
        @   \at(sound_axis(&state->axis[slot]) && fits_mode(&state->axis[slot], state->mode), Pre)
        @   ==> fits_mode(&state->axis[slot], state->mode); */
      break;
    case (uint32_t)ILK_REQUEST_STOP:
      apply_stop(state);
      /*@ assert P15_system: \at(sound_system(state), Pre) ==> sound_system(state); */
      /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
        @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
      /*@ assert P15_mode: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
        @   \at(sound_axis(&state->axis[slot]) && fits_mode(&state->axis[slot], state->mode), Pre)
        @   ==> fits_mode(&state->axis[slot], state->mode); */
      break;
    case (uint32_t)ILK_REQUEST_RESET:
      apply_reset(state);
      /*@ assert P15_system: \at(sound_system(state), Pre) ==> sound_system(state); */
      /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
        @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
      /*@ assert P15_mode: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
        @   \at(sound_axis(&state->axis[slot]) && fits_mode(&state->axis[slot], state->mode), Pre)
        @   ==> fits_mode(&state->axis[slot], state->mode); */
      break;
    default:
      if (request->axis < (uint32_t)ILK_SLOTS) {
        apply_to_slot(&config->axis[request->axis], state, request->axis, request);
        /*@ assert P15_system: \at(sound_system(state), Pre) ==> sound_system(state); */
        /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
          @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
        /*@ assert P15_mode: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
          @   \at(sound_axis(&state->axis[slot]) && fits_mode(&state->axis[slot], state->mode), Pre)
          @   ==> fits_mode(&state->axis[slot], state->mode); */
      }
      break;
  }
}
