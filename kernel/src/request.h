/**
 * @file
 * Requests: one verdict each, and their effects (property P11).
 */
#ifndef ILK_REQUEST_H
#define ILK_REQUEST_H

#include "interlock/acsl.h"
#include "interlock/types.h"

/** Judges a request. Changes nothing. */
/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(request);
  @ assigns  \nothing;
  @ ensures  P11_inert_refusal: 0 <= \result < ILK_VERDICT_COUNT;
  @ ensures  known: \result == ILK_VERDICT_ACCEPTED ==>
  @   ILK_REQUEST_HEARTBEAT <= request->kind <= ILK_REQUEST_RESTORE;
  @ ensures  axis: \result == ILK_VERDICT_ACCEPTED && names_axis(request->kind) ==>
  @   request->axis < ILK_SLOTS && carries_axis(&config->axis[request->axis]);
  @ ensures  row: \result == ILK_VERDICT_ACCEPTED ==> acceptable(config, state, request);
  @*/
ilk_verdict_t ilk_request_judge(const ilk_config_t *config, const ilk_state_t *state,
                                const ilk_request_t *request);

/** Carries out a request that was judged ACCEPTED in this state. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(request);
  @ requires apart: \separated(state, config) && \separated(state, request);
  @ requires known: ILK_REQUEST_HEARTBEAT <= request->kind <= ILK_REQUEST_RESTORE;
  @ requires accepted: applicable(state, request);
  @ requires sound: sound(state);
  @ assigns  state->app_age_ticks, state->holder, state->mode, state->cause, state->cause_tick,
  @          state->cause_value, state->causes_seen, state->pedal_armed,
  @          state->pedal_pressed_ticks, state->pedal_released_ticks,
  @          state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P2_stop: \old(request->kind) == ILK_REQUEST_STOP ==> state->mode != ILK_MODE_MOTION;
  @ ensures  P8_latch: \old(state->mode) == ILK_MODE_LOCKED ==>
  @   (state->mode == ILK_MODE_LOCKED <==> \old(request->kind) != ILK_REQUEST_RESET);
  @ ensures  P8_first_cause: \old(request->kind) != ILK_REQUEST_RESET ==>
  @   cause_kept{Pre, Post}(state) && state->causes_seen == \old(state->causes_seen);
  @ ensures  P9_consent: state->mode == ILK_MODE_MOTION ==> \old(state->mode) == ILK_MODE_MOTION;
  @ ensures  P9_holder: state->holder != \old(state->holder) ==>
  @   state->mode != ILK_MODE_MOTION && state->pedal_armed == 0;
  @ ensures  P10_silence: \old(request->kind) != ILK_REQUEST_HEARTBEAT ==>
  @   state->app_age_ticks == \old(state->app_age_ticks);
  @ ensures  P12_no_leap: state->mode != \old(state->mode) ==> all_quiet(state);
  @ ensures  P8_faults: !names_axis(\old(request->kind)) ==> \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   fault_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P8_fault: names_axis(\old(request->kind)) && \old(request->kind) != ILK_REQUEST_CLEAR_FAULT ==>
  @   state->axis[\old(request->axis)].fault == \old(state->axis[request->axis].fault)
  @   && state->axis[\old(request->axis)].fault_tick == \old(state->axis[request->axis].fault_tick)
  @   && state->axis[\old(request->axis)].fault_value == \old(state->axis[request->axis].fault_value);
  @ ensures  P11_others: names_axis(\old(request->kind)) ==> \forall integer slot; 0 <= slot < ILK_SLOTS
  @   && slot != \old(request->axis) ==> motion_kept{Pre, Post}(&state->axis[slot])
  @   && fault_kept{Pre, Post}(&state->axis[slot]) && place_kept{Pre, Post}(&state->axis[slot]);
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @*/
void ilk_request_apply(const ilk_config_t *config, ilk_state_t *state, const ilk_request_t *request);

#endif
