#include "mode.h"

#include "arith.h"
#include "axis.h"

#define CLOSED 1u
#define OPEN 0u

void ilk_pedal_disarm(ilk_state_t *state) {
  state->pedal_armed = 0u;
  state->pedal_pressed_ticks = 0u;
  state->pedal_released_ticks = 0u;
}

/*@ requires valid: \valid(axis);
  @ assigns  axis->state, axis->setpoint_counts, axis->drive, axis->amplitude, axis->lease_ticks,
  @          axis->homing_phase, axis->setpoint_changed, axis->press_travel_counts;
  @ ensures  P12_no_leap: axis->homing_phase == ILK_HOMING_NONE && axis->drive == 0 && axis->amplitude == 0
  @   && axis->lease_ticks == 0 && axis->setpoint_counts == 0;
  @ ensures  P8_latch: axis->state == state_entering(mode, \old(axis->state));
  @ ensures  P7_travel: axis->press_travel_counts == (mode == ILK_MODE_MOTION ? 0
  @   : \old(axis->press_travel_counts));
  @ ensures  P5_stall: axis->setpoint_changed ==
  @   (axis->stall_driven_ticks != 0 ? 1 : \old(axis->setpoint_changed));
  @*/
static void enter_axis(ilk_axis_t *axis, ilk_mode_t mode) {
  ilk_axis_drop_motion(axis);
  if (mode == ILK_MODE_LOCKED) {
    ilk_axis_disable(axis);
  }
  if (mode == ILK_MODE_MOTION) {
    axis->press_travel_counts = 0;
  }
}

/** The axis of one slot, and no other. */
/*@ requires valid: \valid(state) && slot < ILK_SLOTS;
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P12_no_leap: quiet(&state->axis[slot]);
  @ ensures  P8_latch: state->axis[slot].state == state_entering(mode, \old(state->axis[slot].state));
  @ ensures  P7_travel: state->axis[slot].press_travel_counts ==
  @   (mode == ILK_MODE_MOTION ? 0 : \old(state->axis[slot].press_travel_counts));
  @ ensures  P5_stall: state->axis[slot].setpoint_changed ==
  @   (\old(state->axis[slot].stall_driven_ticks) != 0 ? 1 : \old(state->axis[slot].setpoint_changed));
  @ ensures  P8_faults: fault_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P4_place: place_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P5_progress: progress_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P6_marks: marks_kept{Pre, Post}(&state->axis[slot]);
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
static void enter_slot(ilk_state_t *state, uint32_t slot, ilk_mode_t mode) {
  enter_axis(&state->axis[slot], mode);
}

/*@ requires valid: \valid(state);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P12_no_leap: all_quiet(state);
  @ ensures  P8_latch: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   state->axis[slot].state == state_entering(mode, \old(state->axis[slot].state));
  @ ensures  P7_travel: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   state->axis[slot].press_travel_counts ==
  @   (mode == ILK_MODE_MOTION ? 0 : \old(state->axis[slot].press_travel_counts));
  @ ensures  P5_stall: \forall integer slot; 0 <= slot < ILK_SLOTS ==> state->axis[slot].setpoint_changed ==
  @   (\old(state->axis[slot].stall_driven_ticks) != 0 ? 1 : \old(state->axis[slot].setpoint_changed));
  @ ensures  P8_faults: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   fault_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P4_place: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   place_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P5_progress: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   progress_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P6_marks: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   marks_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P8_first_cause: cause_kept{Pre, Post}(state);
  @ ensures  P10_silence: state->app_age_ticks == \old(state->app_age_ticks)
  @   && state->holder == \old(state->holder);
  @*/
static void enter_axes(ilk_state_t *state, ilk_mode_t mode) {
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P12_homing: \forall integer done; 0 <= done < slot ==>
    @   state->axis[done].homing_phase == ILK_HOMING_NONE && state->axis[done].lease_ticks == 0;
    @ loop invariant P12_drive: \forall integer done; 0 <= done < slot ==>
    @   state->axis[done].drive == 0 && state->axis[done].amplitude == 0;
    @ loop invariant P12_setpoint: \forall integer done; 0 <= done < slot ==>
    @   state->axis[done].setpoint_counts == 0;
    @ loop invariant P8_latch: \forall integer done; 0 <= done < slot ==>
    @   state->axis[done].state == state_entering(mode, \at(state->axis[done].state, Pre));
    @ loop invariant P7_travel: \forall integer done; 0 <= done < slot ==>
    @   state->axis[done].press_travel_counts ==
    @   (mode == ILK_MODE_MOTION ? 0 : \at(state->axis[done].press_travel_counts, Pre));
    @ loop invariant P5_stall: \forall integer done; 0 <= done < slot ==>
    @   state->axis[done].setpoint_changed ==
    @   (\at(state->axis[done].stall_driven_ticks, Pre) != 0 ? 1
    @   : \at(state->axis[done].setpoint_changed, Pre));
    @ loop invariant unchanged: \forall integer left; slot <= left < ILK_SLOTS ==>
    @   state->axis[left].state == \at(state->axis[left].state, Pre);
    @ loop invariant left: \forall integer left; slot <= left < ILK_SLOTS ==>
    @   state->axis[left].press_travel_counts == \at(state->axis[left].press_travel_counts, Pre)
    @   && state->axis[left].setpoint_changed == \at(state->axis[left].setpoint_changed, Pre);
    @ loop invariant P8_faults: \forall integer any; 0 <= any < ILK_SLOTS ==>
    @   fault_kept{Pre, Here}(&state->axis[any]);
    @ loop invariant P4_place: \forall integer any; 0 <= any < ILK_SLOTS ==>
    @   place_kept{Pre, Here}(&state->axis[any]);
    @ loop invariant P5_progress: \forall integer any; 0 <= any < ILK_SLOTS ==>
    @   progress_kept{Pre, Here}(&state->axis[any]);
    @ loop invariant P6_marks: \forall integer any; 0 <= any < ILK_SLOTS ==>
    @   marks_kept{Pre, Here}(&state->axis[any]);
    @ loop assigns slot, state->axis[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    enter_slot(state, slot, mode);
  }
}

void ilk_mode_enter(ilk_state_t *state, ilk_mode_t mode) {
  state->mode = (uint32_t)mode;
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
  enter_axes(state, mode);
}

/** From another mode into LOCKED. */
/*@ requires valid: \valid(state);
  @ requires cause: ILK_CAUSE_NONE < cause < ILK_CAUSE_COUNT;
  @ assigns  state->mode, state->cause, state->cause_tick, state->cause_value,
  @          state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks,
  @          state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P2_stop: state->mode == ILK_MODE_LOCKED;
  @ ensures  P8_first_cause: state->cause == cause && state->cause_tick == state->tick
  @   && state->cause_value == value;
  @ ensures  P8_listed: state->causes_seen == \old(state->causes_seen);
  @ ensures  P8_faults: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   fault_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P4_place: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   place_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P5_progress: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   progress_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P6_marks: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   marks_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P8_states: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   state->axis[slot].state == state_entering(ILK_MODE_LOCKED, \old(state->axis[slot].state));
  @ ensures  P9_consent: state->pedal_armed == 0 && state->pedal_pressed_ticks == 0
  @   && state->pedal_released_ticks == 0;
  @ ensures  P12_no_leap: all_quiet(state);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @*/
static void become_locked(ilk_state_t *state, ilk_cause_t cause, uint32_t value) {
  state->cause = (uint32_t)cause;
  state->cause_tick = state->tick;
  state->cause_value = value;
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
  /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
  ilk_mode_enter(state, ILK_MODE_LOCKED);
}

bool ilk_cause_is_present(const ilk_state_t *state) {
  return (state->estop != 0u) || (state->bus_bad_ticks != 0u) || (state->overruns_in_row != 0u) ||
         (state->config_sound == 0u) || (state->app_alive == 0u);
}

/** Any reading that is neither clearly pressed nor clearly released is a disagreement. */
/*@ requires readable: \valid_read(config) && \valid_read(in);
  @ assigns  \nothing;
  @ ensures  P2_pedal: \result == pedal_reading(config, in);
  @*/
static ilk_pedal_t pedal_reading(const ilk_config_t *config, const ilk_inputs_t *in) {
  const bool single = config->pedal_channels == 1u;
  const bool nc_says_pressed = single || (in->pedal_nc_closed == OPEN);
  const bool nc_says_released = single || (in->pedal_nc_closed == CLOSED);
  ilk_pedal_t pedal = ILK_PEDAL_DISAGREE;
  if ((in->pedal_no_closed == CLOSED) && nc_says_pressed) {
    pedal = ILK_PEDAL_PRESSED;
  } else if ((in->pedal_no_closed == OPEN) && nc_says_released) {
    pedal = ILK_PEDAL_RELEASED;
  } else {
    pedal = ILK_PEDAL_DISAGREE;
  }
  return pedal;
}

/** How long a condition has held, when so far it had for `ticks`. */
/*@ assigns \nothing;
  @ ensures exact: \result == (holds ? \min(ticks + 1, ceiling) : 0);
  @*/
static uint32_t ticks_in_row(bool holds, uint32_t ticks, uint32_t ceiling) {
  uint32_t next = 0u;
  if (holds) {
    next = count_up(ticks, ceiling);
  }
  return next;
}

/*@ requires valid: \valid(state);
  @ requires known: pedal < ILK_PEDAL_COUNT;
  @ assigns  state->pedal, state->pedal_disagree_ticks, state->pedal_released_ticks,
  @          state->pedal_pressed_ticks;
  @ ensures  P2_pedal: state->pedal == pedal;
  @ ensures  disagreement: state->pedal_disagree_ticks == (state->pedal == ILK_PEDAL_DISAGREE
  @   ? \min(\old(state->pedal_disagree_ticks) + 1, UINT32_MAX) : 0);
  @ ensures  P9_release: state->pedal_released_ticks ==
  @   (state->pedal == ILK_PEDAL_RELEASED && state->mode == ILK_MODE_READY && state->app_alive != 0
  @     ? \min(\old(state->pedal_released_ticks) + 1, debounce_ticks) : 0);
  @ ensures  P9_press: state->pedal_pressed_ticks == (state->pedal == ILK_PEDAL_PRESSED
  @   && state->pedal_armed != 0
  @   ? \min(\old(state->pedal_pressed_ticks) + 1, debounce_ticks) : 0);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @ ensures  P8_kept: mode_kept{Pre, Post}(state);
  @*/
static void observe_pedal(ilk_state_t *state, ilk_pedal_t pedal, uint32_t debounce_ticks) {
  const bool may_arm = (state->mode == (uint32_t)ILK_MODE_READY) && (state->app_alive != 0u);
  const bool armed = state->pedal_armed != 0u;
  state->pedal = (uint32_t)pedal;
  state->pedal_disagree_ticks =
      ticks_in_row(pedal == ILK_PEDAL_DISAGREE, state->pedal_disagree_ticks, UINT32_MAX);
  state->pedal_released_ticks =
      ticks_in_row((pedal == ILK_PEDAL_RELEASED) && may_arm, state->pedal_released_ticks, debounce_ticks);
  state->pedal_pressed_ticks =
      ticks_in_row((pedal == ILK_PEDAL_PRESSED) && armed, state->pedal_pressed_ticks, debounce_ticks);
}

/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(in);
  @ requires apart: \separated(state, config) && \separated(state, in);
  @ assigns  state->link_generation, state->last_sequence, state->app_age_ticks, state->app_alive;
  @ ensures  P10_silence: state->app_alive == (state->app_age_ticks < \old(config->app_timeout_ticks) ? 1
  @   : 0);
  @ ensures  P10_age: state->app_age_ticks == (\old(in->link_generation) == \old(state->link_generation)
  @   ? \min(\old(state->app_age_ticks) + 1, UINT32_MAX) : UINT32_MAX);
  @ ensures  attachment: state->link_generation == \old(in->link_generation) && state->last_sequence ==
  @   (\old(in->link_generation) == \old(state->link_generation) ? \old(state->last_sequence) : 0);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @ ensures  P8_kept: mode_kept{Pre, Post}(state);
  @*/
static void observe_app(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in) {
  if (in->link_generation != state->link_generation) {
    state->link_generation = in->link_generation;
    state->last_sequence = 0u;
    state->app_age_ticks = UINT32_MAX;
  }
  state->app_age_ticks = count_up(state->app_age_ticks, UINT32_MAX);
  state->app_alive = flag_of(state->app_age_ticks < config->app_timeout_ticks);
}

/*@ requires valid: \valid(state);
  @ assigns  state->overruns_in_row, state->overruns;
  @ ensures  in_row: state->overruns_in_row == (missed
  @   ? \min(\old(state->overruns_in_row) + 1, UINT32_MAX) : 0);
  @ ensures  ever: state->overruns ==
  @   (missed ? \min(\old(state->overruns) + 1, UINT32_MAX) : \old(state->overruns));
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @ ensures  P8_kept: mode_kept{Pre, Post}(state);
  @*/
static void observe_deadline(ilk_state_t *state, bool missed) {
  state->overruns_in_row = ticks_in_row(missed, state->overruns_in_row, UINT32_MAX);
  if (missed) {
    state->overruns = count_up(state->overruns, UINT32_MAX);
  }
}

/** The inputs are read before anything is written. */
void ilk_observe_system(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in) {
  const ilk_pedal_t pedal = pedal_reading(config, in);
  const uint32_t debounce_ticks = config->pedal_debounce_ticks;
  const bool missed = in->deadline_missed != 0u;
  state->estop = flag_of(in->estop_loop_closed != CLOSED);
  /*@ assert P15_axes: \at(sound_axes(state), Pre) ==> sound_axes(state); */
  observe_app(config, state, in);
  observe_pedal(state, pedal, debounce_ticks);
  observe_deadline(state, missed);
}

/** The contacts as read: normally open in bit 0, normally closed in bit 1. */
/*@ requires readable: \valid_read(in);
  @ assigns  \nothing;
  @ ensures  exact: \result == (in->pedal_no_closed != 0 ? 1 : 0) + (in->pedal_nc_closed != 0 ? 2 : 0);
  @*/
static uint32_t contacts(const ilk_inputs_t *in) {
  return ((in->pedal_no_closed == OPEN) ? 0u : 1u) + ((in->pedal_nc_closed == OPEN) ? 0u : 2u);
}

/** A damaged configuration may have counted the wrong way until it was found. */
/*@ requires valid: \valid(state);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P14_references: \forall integer slot; 0 <= slot < ILK_SLOTS ==> state->axis[slot].homed == 0;
  @ ensures  P12_motion: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   motion_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P8_latch: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   fault_latched{Pre, Post}(&state->axis[slot]);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @ ensures  P8_kept: state->mode == \old(state->mode) && state->causes_seen == \old(state->causes_seen)
  @   && cause_kept{Pre, Post}(state) && consent_kept{Pre, Post}(state);
  @ ensures  P15_mode: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(fits_mode(&state->axis[slot], state->mode)) ==> fits_mode(&state->axis[slot], state->mode);
  @*/
static void lose_references(ilk_state_t *state) {
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant lost: \forall integer done; 0 <= done < slot ==> state->axis[done].homed == 0;
    @ loop invariant P12_motion: \forall integer any; 0 <= any < ILK_SLOTS ==>
    @   motion_kept{Pre, Here}(&state->axis[any]);
    @ loop invariant P8_latch: \forall integer any; 0 <= any < ILK_SLOTS ==>
    @   fault_latched{Pre, Here}(&state->axis[any]);
    @ loop invariant P15_axis: \forall integer any; 0 <= any < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[any]), Pre) ==> sound_axis(&state->axis[any]);
    @ loop assigns slot, state->axis[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    state->axis[slot].homed = 0u;
  }
}

/** What locks in a tick: the first cause with its value, or NONE, and all causes that are there, a bit each.
 */
typedef struct {
  ilk_cause_t first;
  uint32_t value;
  uint32_t all;
} causes_t;

/** One more cause, when it is there. */
/*@ requires cause: ILK_CAUSE_ESTOP <= cause < ILK_CAUSE_COUNT;
  @ assigns  \nothing;
  @ ensures  P8_first_cause: present && before.first == ILK_CAUSE_NONE
  @   ? \result.first == cause && \result.value == value
  @   : \result.first == before.first && \result.value == before.value;
  @ ensures  P8_listed: \result.all == (present ? (before.all | (1 << cause)) : before.all);
  @*/
static causes_t with_cause(causes_t before, bool present, ilk_cause_t cause, uint32_t value) {
  /*@ assert estop: cause == ILK_CAUSE_ESTOP ==> (1 << cause) == 4; */
  /*@ assert bus: cause == ILK_CAUSE_BUS ==> (1 << cause) == 8; */
  /*@ assert pedal: cause == ILK_CAUSE_PEDAL ==> (1 << cause) == 16; */
  /*@ assert integrity: cause == ILK_CAUSE_INTEGRITY ==> (1 << cause) == 32; */
  /*@ assert overrun: cause == ILK_CAUSE_OVERRUN ==> (1 << cause) == 64; */
  causes_t causes = before;
  if (present) {
    if (before.first == ILK_CAUSE_NONE) {
      causes.first = cause;
      causes.value = value;
    }
    causes.all = before.all | (1u << (uint32_t)cause);
  }
  return causes;
}

/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(alarms) && \valid_read(in);
  @ assigns  \nothing;
  @ ensures  P8_first_cause: \result.first == first_cause(config, state, alarms);
  @ ensures  P8_value: \result.value == first_value(config, state, alarms, in);
  @ ensures  P8_listed: \result.all == all_causes(config, state, alarms);
  @*/
static causes_t causes_present(const ilk_config_t *config, const ilk_state_t *state,
                               const ilk_alarms_t *alarms, const ilk_inputs_t *in) {
  causes_t causes = {.first = ILK_CAUSE_NONE, .value = 0u, .all = 0u};
  causes = with_cause(causes, alarms->configuration_damaged, ILK_CAUSE_INTEGRITY, alarms->configuration_crc);
  causes = with_cause(causes, state->estop != 0u, ILK_CAUSE_ESTOP, in->estop_loop_closed);
  causes = with_cause(causes, state->bus_bad_ticks >= config->bad_frame_limit, ILK_CAUSE_BUS,
                      state->bus_bad_ticks);
  causes = with_cause(causes, state->pedal_disagree_ticks > config->pedal_disagree_ticks, ILK_CAUSE_PEDAL,
                      contacts(in));
  causes = with_cause(causes, state->overruns_in_row >= config->overrun_limit, ILK_CAUSE_OVERRUN,
                      state->overruns_in_row);
  return causes;
}

/** LOCKED, unless LOCKED already, when there is a cause; all causes join the list of those seen. */
/*@ requires valid: \valid(state);
  @ requires cause: ILK_CAUSE_NONE <= causes.first < ILK_CAUSE_COUNT;
  @ assigns  state->mode, state->cause, state->cause_tick, state->cause_value, state->causes_seen,
  @          state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks,
  @          state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P8_locked: state->mode == (causes.first != ILK_CAUSE_NONE ? ILK_MODE_LOCKED : \old(state->mode));
  @ ensures  P8_first_cause: causes.first != ILK_CAUSE_NONE && \old(state->mode) != ILK_MODE_LOCKED ==>
  @   state->cause == causes.first && state->cause_tick == state->tick && state->cause_value == causes.value;
  @ ensures  P8_latch: \old(state->mode) == ILK_MODE_LOCKED || causes.first == ILK_CAUSE_NONE ==>
  @   cause_kept{Pre, Post}(state);
  @ ensures  P8_listed: state->causes_seen == (causes.first == ILK_CAUSE_NONE ? \old(state->causes_seen)
  @   : (\old(state->causes_seen) | causes.all));
  @ ensures  P9_again: state->mode != \old(state->mode) ==> state->pedal_armed == 0
  @   && state->pedal_pressed_ticks == 0 && state->pedal_released_ticks == 0;
  @ ensures  P9_still: state->mode == \old(state->mode) ==> consent_kept{Pre, Post}(state);
  @ ensures  P12_no_leap: state->mode != \old(state->mode) ==> all_quiet(state);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @ ensures  P15_mode: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(fits_mode(&state->axis[slot], state->mode)) ==> fits_mode(&state->axis[slot], state->mode);
  @ ensures  P8_still: \old(state->mode) == ILK_MODE_LOCKED || causes.first == ILK_CAUSE_NONE ==>
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> motion_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P14_references: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   state->axis[slot].homed == \old(state->axis[slot].homed);
  @*/
static void lock(ilk_state_t *state, causes_t causes) {
  if (causes.first != ILK_CAUSE_NONE) {
    state->causes_seen |= causes.all;
    if (state->mode != (uint32_t)ILK_MODE_LOCKED) {
      become_locked(state, causes.first, causes.value);
    }
  }
}

/** Damage costs every reference; a cause locks. */
/*@ requires valid: \valid(state);
  @ requires cause: ILK_CAUSE_NONE <= causes.first < ILK_CAUSE_COUNT;
  @ assigns  state->mode, state->cause, state->cause_tick, state->cause_value, state->causes_seen,
  @          state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks,
  @          state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P8_locked: state->mode == (causes.first != ILK_CAUSE_NONE ? ILK_MODE_LOCKED : \old(state->mode));
  @ ensures  P8_first_cause: causes.first != ILK_CAUSE_NONE && \old(state->mode) != ILK_MODE_LOCKED ==>
  @   state->cause == causes.first && state->cause_tick == state->tick && state->cause_value == causes.value;
  @ ensures  P8_latch: \old(state->mode) == ILK_MODE_LOCKED || causes.first == ILK_CAUSE_NONE ==>
  @   cause_kept{Pre, Post}(state);
  @ ensures  P8_listed: state->causes_seen == (causes.first == ILK_CAUSE_NONE ? \old(state->causes_seen)
  @   : (\old(state->causes_seen) | causes.all));
  @ ensures  P9_again: state->mode != \old(state->mode) ==> state->pedal_armed == 0
  @   && state->pedal_pressed_ticks == 0 && state->pedal_released_ticks == 0;
  @ ensures  P9_still: state->mode == \old(state->mode) ==> consent_kept{Pre, Post}(state);
  @ ensures  P12_no_leap: state->mode != \old(state->mode) ==> all_quiet(state);
  @ ensures  P14_references: damaged ==>
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> state->axis[slot].homed == 0;
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @ ensures  P15_mode: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(fits_mode(&state->axis[slot], state->mode)) ==> fits_mode(&state->axis[slot], state->mode);
  @*/
static void lock_on(ilk_state_t *state, bool damaged, causes_t causes) {
  if (damaged) {
    lose_references(state);
  }
  lock(state, causes);
}

/** MOTION holds only while the pedal is pressed, the app lives and nothing new is wrong. */
/*@ requires readable: \valid_read(state) && \valid_read(alarms);
  @ assigns  \nothing;
  @ ensures  P2_stop: \result <==> state->pedal != ILK_PEDAL_PRESSED || state->app_alive == 0
  @   || alarms->new_fault != 0 || alarms->required_card_lost != 0;
  @*/
static bool motion_must_end(const ilk_state_t *state, const ilk_alarms_t *alarms) {
  return (state->pedal != (uint32_t)ILK_PEDAL_PRESSED) || (state->app_alive == 0u) || alarms->new_fault ||
         alarms->required_card_lost;
}

/** A release counts as arming only when seen whole in READY with the app alive; without the app no consent
 * lasts. */
/*@ requires valid: \valid_read(config) && \valid(state) && \separated(config, state);
  @ assigns  state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks;
  @ ensures  P9_silence: state->app_alive == 0 ==> state->pedal_armed == 0 && state->pedal_pressed_ticks == 0
  @   && state->pedal_released_ticks == 0;
  @ ensures  P9_armed: state->app_alive != 0 ==> state->pedal_armed ==
  @     (state->pedal_released_ticks >= config->pedal_debounce_ticks ? 1 : \old(state->pedal_armed))
  @   && state->pedal_pressed_ticks == \old(state->pedal_pressed_ticks)
  @   && state->pedal_released_ticks == \old(state->pedal_released_ticks);
  @ ensures  P8_first_cause: cause_kept{Pre, Post}(state);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @*/
static void arm_pedal(const ilk_config_t *config, ilk_state_t *state) {
  if (state->app_alive == 0u) {
    ilk_pedal_disarm(state);
  } else if (state->pedal_released_ticks >= config->pedal_debounce_ticks) {
    state->pedal_armed = 1u;
  } else {
    /* Consent given earlier still stands. */
  }
}

/** Asked after `arm_pedal`: a pedal that is armed says that the app lives. */
/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(alarms);
  @ assigns  \nothing;
  @ ensures  P9_consent: \result <==> state->pedal_armed != 0 && state->pedal == ILK_PEDAL_PRESSED
  @   && state->pedal_pressed_ticks >= config->pedal_debounce_ticks
  @   && alarms->required_card_lost == 0;
  @*/
static bool motion_may_begin(const ilk_config_t *config, const ilk_state_t *state,
                             const ilk_alarms_t *alarms) {
  return (state->pedal_armed != 0u) && (state->pedal == (uint32_t)ILK_PEDAL_PRESSED) &&
         (state->pedal_pressed_ticks >= config->pedal_debounce_ticks) && !alarms->required_card_lost;
}

/** Consent begins MOTION, its loss ends it. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(alarms);
  @ requires apart: \separated(state, config) && \separated(state, alarms);
  @ assigns  state->mode, state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks,
  @          state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P2_stop: \old(state->mode) == ILK_MODE_MOTION ==>
  @   (\old(must_end(state, alarms)) ? state->mode == ILK_MODE_READY : state->mode == ILK_MODE_MOTION);
  @ ensures  P9_consent: \old(state->mode) == ILK_MODE_READY ==>
  @   (\old(may_begin(config, state, alarms)) ? state->mode == ILK_MODE_MOTION
  @                                           : state->mode == ILK_MODE_READY);
  @ ensures  P8_latch: \old(state->mode) != ILK_MODE_MOTION && \old(state->mode) != ILK_MODE_READY ==>
  @   state->mode == \old(state->mode);
  @ ensures  P10_silence: state->mode == ILK_MODE_MOTION ==> state->app_alive != 0;
  @ ensures  P12_no_leap: state->mode != \old(state->mode) ==> all_quiet(state);
  @ ensures  P12_still: state->mode == \old(state->mode) ==> (\old(all_quiet(state)) ==> all_quiet(state));
  @ ensures  P14_homed: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   state->axis[slot].homed == \old(state->axis[slot].homed);
  @ ensures  P15_kept: words_kept{Pre, Post}(state);
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @ ensures  P15_mode: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(fits_mode(&state->axis[slot], state->mode)) ==> fits_mode(&state->axis[slot], state->mode);
  @ ensures  P8_first_cause: cause_kept{Pre, Post}(state);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @*/
static void follow_consent(const ilk_config_t *config, ilk_state_t *state, const ilk_alarms_t *alarms) {
  switch (state->mode) {
    case (uint32_t)ILK_MODE_MOTION:
      if (motion_must_end(state, alarms)) {
        ilk_mode_enter(state, ILK_MODE_READY);
      }
      break;
    case (uint32_t)ILK_MODE_READY:
      arm_pedal(config, state);
      /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
        @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
      if (motion_may_begin(config, state, alarms)) {
        ilk_mode_enter(state, ILK_MODE_MOTION);
      }
      break;
    default:
      /* INIT and LOCKED are left by ilk_init and by RESET alone. */
      break;
  }
}

void ilk_change_mode(const ilk_config_t *config, ilk_state_t *state, const ilk_alarms_t *alarms,
                     const ilk_inputs_t *in) {
  const causes_t causes = causes_present(config, state, alarms, in);
  lock_on(state, alarms->configuration_damaged, causes);
  /*@ assert P9_consent: \at(state->mode, Pre) == state->mode ==>
    @   (\at(may_begin(config, state, alarms), Pre) <==> may_begin(config, state, alarms)); */
  follow_consent(config, state, alarms);
}
