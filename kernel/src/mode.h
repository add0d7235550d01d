/**
 * @file
 * System modes: the only writer of `mode` and of the cause (properties P2, P8, P9, P12).
 */
#ifndef ILK_MODE_H
#define ILK_MODE_H

#include <stdbool.h>

#include "interlock/acsl.h"
#include "interlock/types.h"

/** What the tick has seen that ends MOTION or locks, besides what the state itself tells. */
typedef struct {
  bool new_fault;             /**< an axis faulted in this tick */
  bool required_card_lost;    /**< a required card is lost */
  bool configuration_damaged; /**< a pass ended with another CRC, or what P1 to P3 rest on changed */
  uint32_t configuration_crc; /**< the CRC that the pass found; 0 within a pass */
} ilk_alarms_t;

/*@ // P8: the first cause that is there, in the order in which they are looked for; ...
  @ logic integer first_cause(ilk_config_t *config, ilk_state_t *state, ilk_alarms_t *alarms) =
  @   alarms->configuration_damaged != 0                              ? ILK_CAUSE_INTEGRITY
  @   : state->estop != 0                                             ? ILK_CAUSE_ESTOP
  @   : state->bus_bad_ticks >= config->bad_frame_limit               ? ILK_CAUSE_BUS
  @   : state->pedal_disagree_ticks > config->pedal_disagree_ticks    ? ILK_CAUSE_PEDAL
  @   : state->overruns_in_row >= config->overrun_limit               ? ILK_CAUSE_OVERRUN
  @                                                                   : ILK_CAUSE_NONE;
  @
  @ // ... what was seen of it; ...
  @ logic integer first_value(
  @     ilk_config_t *config, ilk_state_t *state, ilk_alarms_t *alarms, ilk_inputs_t *in) =
  @   alarms->configuration_damaged != 0                              ? alarms->configuration_crc
  @   : state->estop != 0                                             ? in->estop_loop_closed
  @   : state->bus_bad_ticks >= config->bad_frame_limit               ? state->bus_bad_ticks
  @   : state->pedal_disagree_ticks > config->pedal_disagree_ticks
  @     ? (in->pedal_no_closed != 0 ? 1 : 0) + (in->pedal_nc_closed != 0 ? 2 : 0)
  @   : state->overruns_in_row >= config->overrun_limit               ? state->overruns_in_row
  @                                                                   : 0;
  @
  @ // ... and all that are there, a bit each.
  @ logic integer listed(integer causes, boolean present, integer bit) = present ? (causes | bit) : causes;
  @
  @ logic integer all_causes(ilk_config_t *config, ilk_state_t *state, ilk_alarms_t *alarms) =
  @   listed(listed(listed(listed(listed(0, alarms->configuration_damaged != 0, 32), state->estop != 0, 4),
  @     state->bus_bad_ticks >= config->bad_frame_limit, 8),
  @     state->pedal_disagree_ticks > config->pedal_disagree_ticks, 16),
  @     state->overruns_in_row >= config->overrun_limit, 64);
  @
  @ // P2: what ends MOTION without locking.
  @ predicate must_end(ilk_state_t *state, ilk_alarms_t *alarms) =
  @   state->pedal != ILK_PEDAL_PRESSED || state->app_alive == 0 || alarms->new_fault != 0
  @   || alarms->required_card_lost != 0;
  @
  @ // P9: a whole release seen in READY, then a whole press, while the app lives.
  @ predicate may_begin(ilk_config_t *config, ilk_state_t *state, ilk_alarms_t *alarms) =
  @   state->app_alive != 0
  @   && (state->pedal_armed != 0 || state->pedal_released_ticks >= config->pedal_debounce_ticks)
  @   && state->pedal == ILK_PEDAL_PRESSED && state->pedal_pressed_ticks >= config->pedal_debounce_ticks
  @   && alarms->required_card_lost == 0;
  @*/

/** Enters `mode` and drops what does not survive the change. */
/*@ requires valid: \valid(state);
  @ assigns  state->mode, state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks,
  @          state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  mode: state->mode == mode;
  @ ensures  P9_consent: state->pedal_armed == 0 && state->pedal_pressed_ticks == 0
  @   && state->pedal_released_ticks == 0;
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
  @ ensures  P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @ ensures  P8_first_cause: cause_kept{Pre, Post}(state);
  @ ensures  P10_silence: state->app_age_ticks == \old(state->app_age_ticks)
  @   && state->holder == \old(state->holder);
  @*/
void ilk_mode_enter(ilk_state_t *state, ilk_mode_t mode);

/** Takes back the consent that the pedal gave: it must be released and pressed anew. */
/*@ requires valid: \valid(state);
  @ assigns  state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks;
  @ ensures  P9_consent: state->pedal_armed == 0 && state->pedal_pressed_ticks == 0
  @   && state->pedal_released_ticks == 0;
  @*/
void ilk_pedal_disarm(ilk_state_t *state);

/** True while something that locks is there, or the app or the bus is not (RESET: CAUSE_PRESENT). */
/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P8_latch: \result <==> state->estop != 0 || state->bus_bad_ticks != 0 || state->overruns_in_row != 0
  @   || state->config_sound == 0 || state->app_alive == 0;
  @*/
bool ilk_cause_is_present(const ilk_state_t *state);

/** Phase 3: pedal, E-stop, age of the app, overruns. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(in);
  @ requires apart: \separated(state, config) && \separated(state, in);
  @ assigns  state->link_generation, state->last_sequence, state->app_age_ticks, state->app_alive,
  @          state->pedal, state->pedal_disagree_ticks, state->pedal_released_ticks,
  @          state->pedal_pressed_ticks, state->overruns_in_row, state->overruns, state->estop;
  @ ensures  P2_estop: state->estop == (\old(in->estop_loop_closed) == 1 ? 0 : 1);
  @ ensures  P2_pedal: state->pedal == \old(pedal_reading(config, in));
  @ ensures  P10_silence: state->app_alive == (state->app_age_ticks < \old(config->app_timeout_ticks) ? 1
  @   : 0);
  @ ensures  P10_age: state->app_age_ticks == (\old(in->link_generation) == \old(state->link_generation)
  @   ? \min(\old(state->app_age_ticks) + 1, UINT32_MAX) : UINT32_MAX);
  @ ensures  P9_release: state->pedal_released_ticks ==
  @   (state->pedal == ILK_PEDAL_RELEASED && state->mode == ILK_MODE_READY && state->app_alive != 0
  @     ? \min(\old(state->pedal_released_ticks) + 1, \old(config->pedal_debounce_ticks)) : 0);
  @ ensures  P9_press: state->pedal_pressed_ticks == (state->pedal == ILK_PEDAL_PRESSED
  @   && state->pedal_armed != 0
  @   ? \min(\old(state->pedal_pressed_ticks) + 1, \old(config->pedal_debounce_ticks)) : 0);
  @ ensures  disagreement: state->pedal_disagree_ticks == (state->pedal == ILK_PEDAL_DISAGREE
  @   ? \min(\old(state->pedal_disagree_ticks) + 1, UINT32_MAX) : 0);
  @ ensures  overruns_in_row: state->overruns_in_row ==
  @   (\old(in->deadline_missed) != 0 ? \min(\old(state->overruns_in_row) + 1, UINT32_MAX) : 0);
  @ ensures  overruns: state->overruns == (\old(in->deadline_missed) != 0
  @   ? \min(\old(state->overruns) + 1, UINT32_MAX) : \old(state->overruns));
  @ ensures  attachment: state->link_generation == \old(in->link_generation) && state->last_sequence ==
  @   (\old(in->link_generation) == \old(state->link_generation) ? \old(state->last_sequence) : 0);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @ ensures  P8_kept: mode_kept{Pre, Post}(state);
  @*/
void ilk_observe_system(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in);

/** Phase 5: at most one transition per rule of the mode table. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(alarms) && \valid_read(in);
  @ requires apart: \separated(state, config) && \separated(state, alarms) && \separated(state, in);
  @ assigns  state->mode, state->cause, state->cause_tick, state->cause_value, state->causes_seen,
  @          state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks,
  @          state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P8_locked: \old(first_cause(config, state, alarms)) != ILK_CAUSE_NONE ==>
  @   state->mode == ILK_MODE_LOCKED;
  @ ensures  P8_first_cause: \old(first_cause(config, state, alarms)) != ILK_CAUSE_NONE
  @   && \old(state->mode) != ILK_MODE_LOCKED ==>
  @   state->cause == \old(first_cause(config, state, alarms)) && state->cause_tick == state->tick
  @   && state->cause_value == \old(first_value(config, state, alarms, in));
  @ ensures  P8_latch: \old(state->mode) == ILK_MODE_LOCKED ==>
  @   state->mode == ILK_MODE_LOCKED && cause_kept{Pre, Post}(state);
  @ ensures  P8_listed: state->causes_seen == (\old(first_cause(config, state, alarms)) == ILK_CAUSE_NONE
  @   ? \old(state->causes_seen)
  @   : (\old(state->causes_seen) | \old(all_causes(config, state, alarms))));
  @ ensures  P2_stop: \old(first_cause(config, state, alarms)) == ILK_CAUSE_NONE
  @   && \old(state->mode) == ILK_MODE_MOTION ==>
  @   (\old(must_end(state, alarms)) ? state->mode == ILK_MODE_READY : state->mode == ILK_MODE_MOTION);
  @ ensures  P9_consent: \old(first_cause(config, state, alarms)) == ILK_CAUSE_NONE
  @   && \old(state->mode) == ILK_MODE_READY ==>
  @   (\old(may_begin(config, state, alarms)) ? state->mode == ILK_MODE_MOTION
  @                                           : state->mode == ILK_MODE_READY);
  @ ensures  P10_silence: state->mode == ILK_MODE_MOTION ==> state->app_alive != 0;
  @ ensures  P12_no_leap: state->mode != \old(state->mode) ==> all_quiet(state);
  @ ensures  P13_begun: state->mode == ILK_MODE_INIT ==> \old(state->mode) == ILK_MODE_INIT;
  @ ensures  P14_references: alarms->configuration_damaged != 0 ==>
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> state->axis[slot].homed == 0;
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @ ensures  P13_untrusted: state->config_sound == \old(state->config_sound);
  @*/
void ilk_change_mode(const ilk_config_t *config, ilk_state_t *state, const ilk_alarms_t *alarms,
                     const ilk_inputs_t *in);

#endif
