#include <stdbool.h>

#include "arith.h"
#include "axis.h"
#include "frame.h"
#include "gate.h"
#include "integrity.h"
#include "interlock/kernel.h"
#include "mode.h"
#include "request.h"

/** Nothing of a state that fails its check is used. */
/*@ requires valid: \valid_read(config) && \valid(state) && \separated(config, state);
  @ assigns  *state;
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @ ensures  P14_contained: !\old(sealed(state) && sound(state)) ==>
  @   state->mode == ILK_MODE_LOCKED && state->cause == ILK_CAUSE_INTEGRITY;
  @ ensures  P13_untrusted: !\old(sealed(state) && sound(state)) ==>
  @   state->config_sound == 0 && state->config_slice == 0;
  @ ensures  P8_latch: \old(sealed(state) && sound(state)) ==>
  @   state->mode == \old(state->mode) && cause_kept{Pre, Post}(state);
  @ ensures  P14_basis: \old(sealed(state) && sound(state)) && !\old(basis_kept(config, state)) ==>
  @   !basis_kept(config, state);
  @*/
static void check_state(const ilk_config_t *config, ilk_state_t *state) {
  if (!ilk_state_is_sound(state)) {
    ilk_state_rebuild(state, config, ILK_CAUSE_INTEGRITY, state->seal);
  }
}

/** A slice of the configuration, and what P1 to P3 rest on. */
/*@ requires valid: \valid_read(config) && \valid(state) && \separated(config, state);
  @ requires sound: sound_system(state) && sound_axes(state) && axes_fit_mode(state);
  @ assigns  state->config_partial_crc, state->config_slice, state->config_sound;
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @ ensures  P13_untrusted: \old(state->config_sound) == 0 && \old(state->config_slice) == 0 ==>
  @   state->config_sound == 0;
  @ ensures  P14_basis: !\old(basis_kept(config, state)) ==>
  @   \result.damaged != 0 && state->config_sound == 0;
  @*/
static ilk_config_check_t check_configuration(const ilk_config_t *config, ilk_state_t *state) {
  ilk_config_check_t check = ilk_config_check_slice(config, state);
  /*@ assert P14_state: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].wiring == \at(state->axis[slot].wiring, Pre); */
  /*@ assert P14_card: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   config->axis[slot].card == \at(config->axis[slot].card, Pre); */
  /*@ assert P14_limit: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   config->axis[slot].limit_side == \at(config->axis[slot].limit_side, Pre); */
  /*@ assert P14_motor: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   config->axis[slot].motor_direction == \at(config->axis[slot].motor_direction, Pre); */
  /*@ assert P14_wiring: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   wiring(&config->axis[slot]) == \at(wiring(&config->axis[slot]), Pre); */
  /*@ assert P14_words: config->pedal_channels == state->pedal_channels
    @   ==> \at(config->pedal_channels, Pre) == \at(state->pedal_channels, Pre); */
  /*@ assert P14_words: config->app_timeout_ticks == state->app_timeout_ticks
    @   ==> \at(config->app_timeout_ticks, Pre) == \at(state->app_timeout_ticks, Pre); */
  /*@ assert P14_slots: (\forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].wiring == wiring(&config->axis[slot])) ==> (\forall integer slot; 0 <= slot < ILK_SLOTS
    @   ==> \at(state->axis[slot].wiring, Pre) == \at(wiring(&config->axis[slot]), Pre)); */
  /*@ assert P14_basis: basis_kept(config, state) ==> \at(basis_kept(config, state), Pre); */
  check.damaged = !ilk_config_check_basis(config, state) || check.damaged;
  return check;
}

/** Phase 1: state, a slice of the configuration, and what P1 to P3 rest on. Nothing else of a damaged state
   is looked at. */
/*@ requires valid: \valid_read(config) && \valid(state) && \separated(config, state);
  @ assigns  *state;
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @ ensures  P14_contained: !\old(sealed(state) && sound(state)) ==>
  @   state->mode == ILK_MODE_LOCKED && state->cause == ILK_CAUSE_INTEGRITY;
  @ ensures  P13_untrusted: !\old(sealed(state) && sound(state)) ==> state->config_sound == 0;
  @ ensures  P8_latch: \old(sealed(state) && sound(state)) ==> state->mode == \old(state->mode);
  @ ensures  P8_first_cause: \old(sealed(state) && sound(state)) ==> state->cause == \old(state->cause);
  @ ensures  P14_basis: \old(sealed(state) && sound(state)) && \old(state->mode) != ILK_MODE_INIT
  @   && !\old(basis_kept(config, state)) ==> \result.damaged != 0 && state->config_sound == 0;
  @*/
static ilk_config_check_t check_integrity(const ilk_config_t *config, ilk_state_t *state) {
  ilk_config_check_t check = {.damaged = false, .crc = 0u};
  check_state(config, state);
  if (state->mode != (uint32_t)ILK_MODE_INIT) {
    check = check_configuration(config, state);
  }
  return check;
}

/** True when the card of this slot answered in this tick. */
/*@ requires readable: \valid_read(in) && slot < ILK_SLOTS;
  @ assigns  \nothing;
  @ ensures  P16_answered: \result <==> card_answered(in, slot);
  @*/
static bool answered(const ilk_inputs_t *in, uint32_t slot) {
  return (in->transaction_done == 1u) && (((in->frames_received >> slot) & 1u) != 0u);
}

/** What the frame of each slot says. */
/*@ requires valid: \valid_read(in) && \valid(readings + (0 .. ILK_SLOTS - 1));
  @ requires apart: \separated(in, readings + (0 .. ILK_SLOTS - 1));
  @ assigns  readings[0 .. ILK_SLOTS - 1];
  @ ensures  P16_raw: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   readings[slot].raw == in->frame[slot][3];
  @*/
static void unpack_frames(const ilk_inputs_t *in, ilk_reading_t readings[ILK_SLOTS]) {
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P16_raw: \forall integer done; 0 <= done < slot ==>
    @   readings[done].raw == in->frame[done][3];
    @ loop assigns slot, readings[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    readings[slot] = ilk_frame_unpack(in->frame[slot]);
  }
}

/**
 * The card of one slot, and no other.
 *
 * @return true when there is one and its frame is valid.
 */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(in) && \valid_read(reading)
  @   && slot < ILK_SLOTS;
  @ requires apart: \separated(state, config) && \separated(state, in) && \separated(state, reading);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P16_used: \result ==> card_answered(in, slot);
  @ ensures  P16_unused: carries_card(&config->axis[slot]) && !card_answered(in, slot) ==>
  @   state->axis[slot].card_valid == 0;
  @ ensures  P15_axis: \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @ ensures  P15_below: \forall integer other; 0 <= other < slot ==>
  @   \old(sound_axis(&state->axis[other])) ==> sound_axis(&state->axis[other]);
  @ ensures  P15_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[other])) ==> sound_axis(&state->axis[other]);
  @ ensures  P15_state: state->axis[slot].state == \old(state->axis[slot].state);
  @ ensures  P15_state_below: \forall integer other; 0 <= other < slot ==>
  @   state->axis[other].state == \old(state->axis[other].state);
  @ ensures  P15_state_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   state->axis[other].state == \old(state->axis[other].state);
  @*/
static bool read_card(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in, uint32_t slot,
                      const ilk_reading_t *reading) {
  bool valid = false;
  if (has_card(&config->axis[slot])) {
    ilk_observe_card(&state->axis[slot], reading, answered(in, slot), state->tick);
    valid = state->axis[slot].card_valid != 0u;
  }
  return valid;
}

/** Phase 2: checksum, freshness and counters of each card, and whether the bus says anything at all. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(in)
  @   && \valid(readings + (0 .. ILK_SLOTS - 1));
  @ requires apart: \separated(state, config, readings + (0 .. ILK_SLOTS - 1))
  @   && \separated(state, in) && \separated(in, readings + (0 .. ILK_SLOTS - 1));
  @ requires sound: sound_axes(state) && axes_fit_mode(state);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1], state->bus_bad_ticks, readings[0 .. ILK_SLOTS - 1];
  @ ensures  P2_bus: state->bus_bad_ticks == 0
  @   || state->bus_bad_ticks == \min(\old(state->bus_bad_ticks) + 1, UINT32_MAX);
  @ ensures  P2_transaction: in->transaction_done != 1 ==> state->bus_bad_ticks != 0;
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @ ensures  P8_kept: mode_kept{Pre, Post}(state);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @*/
static void read_frames(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
                        ilk_reading_t readings[ILK_SLOTS]) {
  bool any_valid = false;
  unpack_frames(in, readings);
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P15_axes: sound_axes(state);
    @ loop invariant P15_mode: axes_fit_mode(state);
    @ loop invariant P2_transaction: any_valid ==> in->transaction_done == 1;
    @ loop assigns slot, any_valid, state->axis[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    if (read_card(config, state, in, slot, &readings[slot])) {
      any_valid = true;
    }
  }
  state->bus_bad_ticks = any_valid ? 0u : count_up(state->bus_bad_ticks, UINT32_MAX);
}

/**
 * The axis or sensor of one slot, and no other.
 *
 * @return true when the axis faulted in this tick.
 */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(reading) && slot < ILK_SLOTS;
  @ requires apart: \separated(config, state, reading);
  @ requires sound: sound_axis(&state->axis[slot]) && axes_fit_mode(state);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P15_axis: sound_axis(&state->axis[slot]);
  @ ensures  P15_mode: fits_mode(&state->axis[slot], state->mode);
  @ ensures  P15_mode_below: \forall integer other; 0 <= other < slot ==>
  @   fits_mode(&state->axis[other], state->mode);
  @ ensures  P15_mode_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   fits_mode(&state->axis[other], state->mode);
  @ ensures  P8_latch: fault_latched{Pre, Post}(&state->axis[slot]);
  @ ensures  P6_new: \result ==> state->axis[slot].state == ILK_AXIS_FAULTED;
  @ ensures  P6_seen: \old(state->axis[slot].state) != ILK_AXIS_FAULTED
  @   && state->axis[slot].state == ILK_AXIS_FAULTED ==> \result;
  @ ensures  P8_below: \forall integer other; 0 <= other < slot ==>
  @   fault_latched{Pre, Post}(&state->axis[other]);
  @ ensures  P6_below: \forall integer other; 0 <= other < slot ==>
  @   state->axis[other].state == \old(state->axis[other].state);
  @ ensures  P15_below: \forall integer other; 0 <= other < slot ==>
  @   \old(sound_axis(&state->axis[other])) ==> sound_axis(&state->axis[other]);
  @ ensures  P8_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   fault_latched{Pre, Post}(&state->axis[other]);
  @ ensures  P6_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   state->axis[other].state == \old(state->axis[other].state);
  @ ensures  P15_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[other])) ==> sound_axis(&state->axis[other]);
  @*/
static bool observe_slot(const ilk_config_t *config, ilk_state_t *state, uint32_t slot,
                         const ilk_reading_t *reading) {
  const ilk_axis_config_t *axis_config = &config->axis[slot];
  bool faulted = false;
  if (has_axis(axis_config)) {
    faulted = ilk_observe_axis(config, axis_config, &state->axis[slot], reading, state->tick);
  } else {
    ilk_observe_sensor(config, &state->axis[slot]);
  }
  return faulted;
}

/** Phase 4: each axis, judged by what this tick's frames say. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(readings + (0 .. ILK_SLOTS - 1))
  @   && \valid(alarms);
  @ requires apart: \separated(config, state, readings + (0 .. ILK_SLOTS - 1), alarms);
  @ requires sound: sound_axes(state) && axes_fit_mode(state);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1], alarms->new_fault, alarms->required_card_lost;
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @ ensures  P8_latch: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   fault_latched{Pre, Post}(&state->axis[slot]);
  @ ensures  P6_new: \forall integer slot; 0 <= slot < ILK_SLOTS
  @   && \old(state->axis[slot].state) != ILK_AXIS_FAULTED
  @   && state->axis[slot].state == ILK_AXIS_FAULTED ==> alarms->new_fault != 0;
  @ ensures  P8_kept: mode_kept{Pre, Post}(state);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @*/
static void observe_axes(const ilk_config_t *config, ilk_state_t *state,
                         const ilk_reading_t readings[ILK_SLOTS], ilk_alarms_t *alarms) {
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P15_axes: sound_axes(state);
    @ loop invariant P15_mode: axes_fit_mode(state);
    @ loop invariant P8_latch: \forall integer any; 0 <= any < ILK_SLOTS ==>
    @   fault_latched{Pre, Here}(&state->axis[any]);
    @ loop invariant P6_new: \forall integer done; 0 <= done < slot
    @   && \at(state->axis[done].state, Pre) != ILK_AXIS_FAULTED
    @   && state->axis[done].state == ILK_AXIS_FAULTED ==> alarms->new_fault != 0;
    @ loop invariant P6_left: \forall integer left; slot <= left < ILK_SLOTS ==>
    @   state->axis[left].state == \at(state->axis[left].state, Pre);
    @ loop assigns slot, state->axis[0 .. ILK_SLOTS - 1], alarms->new_fault, alarms->required_card_lost;
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const bool faulted = observe_slot(config, state, slot, &readings[slot]);
    alarms->new_fault = alarms->new_fault || faulted;
    if ((config->axis[slot].required != 0u) && ilk_card_is_lost(config, &state->axis[slot])) {
      alarms->required_card_lost = true;
    }
  }
}

/*@ requires readable: \valid_read(request);
  @ assigns  \nothing;
  @ ensures  P11_one_verdict: \result.tick == tick && \result.sequence == request->sequence
  @   && \result.kind == request->kind && \result.axis == request->axis && \result.verdict == verdict;
  @*/
static ilk_verdict_record_t record_of(uint32_t tick, const ilk_request_t *request, ilk_verdict_t verdict) {
  const ilk_verdict_record_t record = {.tick = tick,
                                       .sequence = request->sequence,
                                       .kind = request->kind,
                                       .axis = request->axis,
                                       .verdict = (uint32_t)verdict};
  return record;
}

/*@ requires valid: \valid_read(state) && \valid_read(request) && \valid(out);
  @ requires apart: \separated(out, state) && \separated(out, request);
  @ requires room: out->verdict_count < ILK_REQUESTS_PER_TICK;
  @ assigns  out->verdict_count, out->verdict[0 .. ILK_REQUESTS_PER_TICK - 1];
  @ ensures  P11_counted: out->verdict_count == \old(out->verdict_count) + 1;
  @ ensures  P11_one_verdict: records(&out->verdict[\old(out->verdict_count)], state->tick, request, verdict);
  @ ensures  P11_earlier: \forall integer index; 0 <= index < \old(out->verdict_count) ==>
  @   record_kept{Pre, Post}(&out->verdict[index]);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @*/
static void answer(const ilk_state_t *state, const ilk_request_t *request, ilk_verdict_t verdict,
                   ilk_outputs_t *out) {
  out->verdict[out->verdict_count] = record_of(state->tick, request, verdict);
  out->verdict_count++;
}

/** Every request that is intact and in order uses up its number, whatever the verdict. */
/*@ requires valid: \valid(state) && \valid_read(request) && \separated(state, request);
  @ assigns  state->last_sequence, state->requests_accepted, state->requests_refused;
  @ ensures  P11_number: state->last_sequence ==
  @   (verdict == ILK_VERDICT_CHECKSUM || verdict == ILK_VERDICT_SEQUENCE ? \old(state->last_sequence)
  @   : request->sequence);
  @ ensures  P11_accepted: state->requests_accepted == (verdict == ILK_VERDICT_ACCEPTED
  @   ? \min(\old(state->requests_accepted) + 1, UINT32_MAX) : \old(state->requests_accepted));
  @ ensures  P11_refused: state->requests_refused == (verdict == ILK_VERDICT_ACCEPTED
  @   ? \old(state->requests_refused) : \min(\old(state->requests_refused) + 1, UINT32_MAX));
  @ ensures  P8_latch: state->mode == \old(state->mode) && cause_kept{Pre, Post}(state)
  @   && state->config_sound == \old(state->config_sound);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @*/
static void count_verdict(ilk_state_t *state, const ilk_request_t *request, ilk_verdict_t verdict) {
  if ((verdict != ILK_VERDICT_CHECKSUM) && (verdict != ILK_VERDICT_SEQUENCE)) {
    state->last_sequence = request->sequence;
  }
  if (verdict == ILK_VERDICT_ACCEPTED) {
    state->requests_accepted = count_up(state->requests_accepted, UINT32_MAX);
  } else {
    state->requests_refused = count_up(state->requests_refused, UINT32_MAX);
  }
}

/*@ assigns \nothing;
  @ ensures P11_unused: \result.tick == 0 && \result.sequence == 0 && \result.kind == 0 && \result.axis == 0
  @   && \result.verdict == 0;
  @*/
static ilk_verdict_record_t no_record(void) {
  static const ilk_verdict_record_t none = {0};
  return none;
}

/** Entries that no request of this tick fills say nothing. */
/*@ requires valid: \valid(out);
  @ requires given: out->verdict_count <= ILK_REQUESTS_PER_TICK;
  @ assigns  out->verdict[0 .. ILK_REQUESTS_PER_TICK - 1];
  @ ensures  P11_given: \forall integer index; 0 <= index < out->verdict_count ==>
  @   record_kept{Pre, Post}(&out->verdict[index]);
  @ ensures  P11_unused: \forall integer index; out->verdict_count <= index < ILK_REQUESTS_PER_TICK ==>
  @   blank_record(&out->verdict[index]);
  @*/
static void clear_unused_verdicts(ilk_outputs_t *out) {
  /*@ loop invariant range: out->verdict_count <= index <= ILK_REQUESTS_PER_TICK;
    @ loop invariant P11_given: \forall integer given; 0 <= given < out->verdict_count ==>
    @   record_kept{Pre, Here}(&out->verdict[given]);
    @ loop invariant P11_unused: \forall integer cleared; out->verdict_count <= cleared < index ==>
    @   blank_record(&out->verdict[cleared]);
    @ loop assigns index, out->verdict[0 .. ILK_REQUESTS_PER_TICK - 1];
    @ loop variant ILK_REQUESTS_PER_TICK - index;
    @*/
  for (uint32_t index = out->verdict_count; index < (uint32_t)ILK_REQUESTS_PER_TICK; index++) {
    out->verdict[index] = no_record();
  }
}

/** One request: its verdict, and its effect if it is accepted. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(request);
  @ requires apart: \separated(state, config) && \separated(state, request);
  @ requires sound: sound(state);
  @ assigns  *state;
  @ ensures  P8_latch: \old(state->mode) == ILK_MODE_LOCKED && \old(state->config_sound) == 0 ==>
  @   state->mode == ILK_MODE_LOCKED && cause_kept{Pre, Post}(state);
  @ ensures  P8_untrusted: state->config_sound == \old(state->config_sound);
  @ ensures  P9_consent: state->mode == ILK_MODE_MOTION ==> \old(state->mode) == ILK_MODE_MOTION;
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @*/
static ilk_verdict_t take_request(const ilk_config_t *config, ilk_state_t *state,
                                  const ilk_request_t *request) {
  const ilk_verdict_t verdict = ilk_request_judge(config, state, request);
  if (verdict == ILK_VERDICT_ACCEPTED) {
    /*@ assert applicable: applicable(state, request); */
    ilk_request_apply(config, state, request);
  }
  count_verdict(state, request, verdict);
  return verdict;
}

/** One request and its record. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(request) && \valid(out);
  @ requires apart: \separated(state, config) && \separated(state, request) && \separated(out, state)
  @   && \separated(out, request);
  @ requires room: out->verdict_count < ILK_REQUESTS_PER_TICK;
  @ requires sound: sound(state);
  @ assigns  *state, out->verdict_count, out->verdict[0 .. ILK_REQUESTS_PER_TICK - 1];
  @ ensures  P11_counted: out->verdict_count == \old(out->verdict_count) + 1;
  @ ensures  P8_latch: \old(state->mode) == ILK_MODE_LOCKED && \old(state->config_sound) == 0 ==>
  @   state->mode == ILK_MODE_LOCKED && cause_kept{Pre, Post}(state);
  @ ensures  P8_untrusted: state->config_sound == \old(state->config_sound);
  @ ensures  P9_consent: state->mode == ILK_MODE_MOTION ==> \old(state->mode) == ILK_MODE_MOTION;
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @*/
static void answer_request(const ilk_config_t *config, ilk_state_t *state, const ilk_request_t *request,
                           ilk_outputs_t *out) {
  const ilk_verdict_t verdict = take_request(config, state, request);
  answer(state, request, verdict, out);
}

/** Phase 6: requests in their order, one verdict each. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid(out)
  @   && \valid_read(requests + (0 .. count - 1)) && count <= ILK_REQUESTS_PER_TICK;
  @ requires apart: \separated(state, config) && \separated(out, state)
  @   && \separated(state, requests + (0 .. count - 1)) && \separated(out, requests + (0 .. count - 1));
  @ requires sound: sound(state);
  @ assigns  *state, out->verdict_count, out->verdict[0 .. ILK_REQUESTS_PER_TICK - 1];
  @ ensures  P11_one_verdict: out->verdict_count == count;
  @ ensures  P8_latch: \old(state->mode) == ILK_MODE_LOCKED && \old(state->config_sound) == 0 ==>
  @   state->mode == ILK_MODE_LOCKED && cause_kept{Pre, Post}(state);
  @ ensures  P9_consent: state->mode == ILK_MODE_MOTION ==> \old(state->mode) == ILK_MODE_MOTION;
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @*/
static void answer_requests(const ilk_config_t *config, ilk_state_t *state, const ilk_request_t requests[],
                            uint32_t count, ilk_outputs_t *out) {
  out->verdict_count = 0u;
  /*@ assert P15_system: \at(sound_system(state), Pre) ==> sound_system(state); */
  /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
  /*@ assert P15_axes: \at(sound_axes(state), Pre) ==> sound_axes(state); */
  /*@ assert P15_mode: \at(axes_fit_mode(state), Pre) ==> axes_fit_mode(state); */
  /*@ loop invariant range: 0 <= index <= count;
    @ loop invariant P11_counted: out->verdict_count == index;
    @ loop invariant P8_latch: \at(state->mode, Pre) == ILK_MODE_LOCKED
    @   && \at(state->config_sound, Pre) == 0 ==>
    @   state->mode == ILK_MODE_LOCKED && cause_kept{Pre, Here}(state);
    @ loop invariant P8_untrusted: state->config_sound == \at(state->config_sound, Pre);
    @ loop invariant P9_consent: state->mode == ILK_MODE_MOTION ==> \at(state->mode, Pre) == ILK_MODE_MOTION;
    @ loop invariant P15_system: sound_system(state);
    @ loop invariant P15_axes: sound_axes(state);
    @ loop invariant P15_mode: axes_fit_mode(state);
    @ loop assigns index, *state, out->verdict_count, out->verdict[0 .. ILK_REQUESTS_PER_TICK - 1];
    @ loop variant count - index;
    @*/
  for (uint32_t index = 0u; index < count; index++) {
    answer_request(config, state, &requests[index], out);
  }
}

/** What one axis wants if the output gate lets it through, else zero drive; and the first gate that blocks.
 */
typedef struct {
  ilk_gate_t gate;
  ilk_command_t command;
} decision_t;

/*@ requires readable: \valid_read(config) && \valid_read(state) && slot < ILK_SLOTS;
  @ assigns  \nothing;
  @ ensures  P1_gate: \result.gate == ILK_GATE_OPEN ==> may_drive(state, &state->axis[slot]);
  @ ensures  P2_stop: \result.gate != ILK_GATE_OPEN ==> \result.command.direction == ILK_DIRECTION_NONE
  @   && \result.command.drive == 0 && \result.command.amplitude == 0;
  @ ensures  P3_hard_limit: \result.gate == ILK_GATE_OPEN ==>
  @   clear_of_switch(&config->axis[slot], &state->axis[slot], \result.command.direction);
  @ ensures  P4_soft_limit: \result.gate == ILK_GATE_OPEN ==>
  @   within_soft_range(&config->axis[slot], &state->axis[slot], \result.command.direction);
  @ ensures  P7_travel: \result.gate == ILK_GATE_OPEN ==>
  @   within_unhomed_travel(&config->axis[slot], &state->axis[slot], \result.command.direction);
  @ ensures  P7_drive: \result.gate == ILK_GATE_OPEN ==>
  @   \result.command.drive <= drive_bound(&config->axis[slot], &state->axis[slot])
  @   && \result.command.drive <= card_drive(config->axis[slot].card)
  @   && \result.command.amplitude <= config->axis[slot].max_amplitude && \result.command.amplitude <= 255;
  @ ensures  known: \result.command.direction < ILK_DIRECTION_COUNT && \result.gate < ILK_GATE_COUNT;
  @*/
static decision_t decide(const ilk_config_t *config, const ilk_state_t *state, uint32_t slot) {
  static const ilk_command_t zero_drive = {
      .direction = (uint32_t)ILK_DIRECTION_NONE, .drive = 0u, .amplitude = 0u};
  const ilk_command_t wanted = ilk_wanted_command(&config->axis[slot], &state->axis[slot]);
  const ilk_gate_t gate = ilk_output_gate(&config->axis[slot], state, &state->axis[slot], &wanted);
  const decision_t decision = {.gate = gate, .command = (gate == ILK_GATE_OPEN) ? wanted : zero_drive};
  return decision;
}

/** What the axis of one slot wants goes through the output gate, or is zero drive. */
/*@ requires valid: \valid_read(config) && \valid_read(state) && \valid(command + (0 .. ILK_SLOTS - 1))
  @   && \valid(gate + (0 .. ILK_SLOTS - 1)) && slot < ILK_SLOTS;
  @ requires apart: \separated(command + (0 .. ILK_SLOTS - 1), gate + (0 .. ILK_SLOTS - 1), config)
  @   && \separated(command + (0 .. ILK_SLOTS - 1), gate + (0 .. ILK_SLOTS - 1), state);
  @ assigns  command[0 .. ILK_SLOTS - 1], gate[0 .. ILK_SLOTS - 1];
  @ ensures  P1_gate: gated(config, state, slot, gate[slot], &command[slot]);
  @ ensures  P1_below: \forall integer other; 0 <= other < slot ==>
  @   \old(gated(config, state, other, gate[other], &command[other]))
  @   ==> gated(config, state, other, gate[other], &command[other]);
  @*/
static void pass_slot(const ilk_config_t *config, const ilk_state_t *state, uint32_t slot,
                      ilk_command_t command[ILK_SLOTS], uint32_t gate[ILK_SLOTS]) {
  const decision_t decision = decide(config, state, slot);
  command[slot] = decision.command;
  gate[slot] = (uint32_t)decision.gate;
  /*@ assert P1_gate: gated(config, state, slot, gate[slot], &command[slot]); */
  /*@ assert P1_passed: \forall integer other; 0 <= other < slot ==>
    @   \at(passed(state, other, gate[other]), Pre) ==> passed(state, other, gate[other]); */
  /*@ assert P2_stopped: \forall integer other; 0 <= other < slot ==>
    @   \at(stopped(gate[other], &command[other]), Pre) ==> stopped(gate[other], &command[other]); */
  /*@ assert P3_off_switch: \forall integer other; 0 <= other < slot ==>
    @   \at(off_switch(config, state, other, gate[other], &command[other]), Pre) ==> off_switch(config, state, other, gate[other], &command[other]); */
  /*@ assert P4_soft_range: \forall integer other; 0 <= other < slot ==>
    @   \at(in_soft_range(config, state, other, gate[other], &command[other]), Pre) ==> in_soft_range(config, state, other, gate[other], &command[other]); */
  /*@ assert P7_travel: \forall integer other; 0 <= other < slot ==>
    @   \at(in_unhomed_travel(config, state, other, gate[other], &command[other]), Pre) ==> in_unhomed_travel(config, state, other, gate[other], &command[other]); */
  /*@ assert P7_drive: \forall integer other; 0 <= other < slot ==>
    @   \at(in_drive(config, state, other, gate[other], &command[other]), Pre) ==> in_drive(config, state, other, gate[other], &command[other]); */
  /*@ assert known: \forall integer other; 0 <= other < slot ==>
    @   \at(command[other].direction < ILK_DIRECTION_COUNT, Pre) ==> command[other].direction < ILK_DIRECTION_COUNT; */
}

/** Phase 7: what each axis wants goes through the output gate, or is zero drive. */
/*@ requires valid: \valid_read(config) && \valid_read(state) && \valid(command + (0 .. ILK_SLOTS - 1))
  @   && \valid(gate + (0 .. ILK_SLOTS - 1));
  @ requires apart: \separated(command + (0 .. ILK_SLOTS - 1), gate + (0 .. ILK_SLOTS - 1), config)
  @   && \separated(command + (0 .. ILK_SLOTS - 1), gate + (0 .. ILK_SLOTS - 1), state);
  @ assigns  command[0 .. ILK_SLOTS - 1], gate[0 .. ILK_SLOTS - 1];
  @ ensures  P1_gate: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   gated(config, state, slot, gate[slot], &command[slot]);
  @ ensures  P2_stop: !consented(state) ==>
  @   \forall integer slot; 0 <= slot < ILK_SLOTS ==> zero_drive(&command[slot]);
  @ ensures  P2_decided: decision_kept{Pre, Post}(state);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @*/
static void pass_commands(const ilk_config_t *config, const ilk_state_t *state,
                          ilk_command_t command[ILK_SLOTS], uint32_t gate[ILK_SLOTS]) {
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P1_gate: \forall integer done; 0 <= done < slot ==>
    @   gated(config, state, done, gate[done], &command[done]);
    @ loop assigns slot, command[0 .. ILK_SLOTS - 1], gate[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    pass_slot(config, state, slot, command, gate);
  }
  /*@ assert P2_mode: state->mode == \at(state->mode, Pre); */
  /*@ assert P8_cause: cause_kept{Pre, Here}(state); */
  /*@ assert P13_trust: state->config_sound == \at(state->config_sound, Pre); */
  /*@ assert P2_pedal: state->pedal == \at(state->pedal, Pre) && state->estop == \at(state->estop, Pre); */
}

/** A move that stands in the deadband of its setpoint. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> axis->state == ILK_AXIS_MOVING
  @   && setpoint_direction(config, axis) == ILK_DIRECTION_NONE;
  @*/
static bool has_arrived(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return (axis->state == (uint32_t)ILK_AXIS_MOVING) &&
         (ilk_wanted_command(config, axis).direction == (uint32_t)ILK_DIRECTION_NONE);
}

/** What being driven, or standing at the setpoint, means for the marks of one slot, and of no other. */
/*@ requires valid: \valid_read(config) && \valid(state) && slot < ILK_SLOTS && \separated(config, state);
  @ requires known: direction < ILK_DIRECTION_COUNT;
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P15_axis: \old(sound_axis(&state->axis[slot])) ==> sound_axis(&state->axis[slot]);
  @ ensures  P15_below: \forall integer other; 0 <= other < slot ==>
  @   \old(sound_axis(&state->axis[other])) ==> sound_axis(&state->axis[other]);
  @ ensures  P15_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   \old(sound_axis(&state->axis[other])) ==> sound_axis(&state->axis[other]);
  @ ensures  P15_state: state->axis[slot].state == \old(state->axis[slot].state);
  @ ensures  P15_state_below: \forall integer other; 0 <= other < slot ==>
  @   state->axis[other].state == \old(state->axis[other].state);
  @ ensures  P15_state_above: \forall integer other; slot < other < ILK_SLOTS ==>
  @   state->axis[other].state == \old(state->axis[other].state);
  @*/
static void note_slot(const ilk_config_t *config, ilk_state_t *state, uint32_t slot, uint32_t gate,
                      uint32_t direction) {
  const ilk_axis_config_t *axis_config = &config->axis[slot];
  ilk_axis_t *axis = &state->axis[slot];
  if (gate == (uint32_t)ILK_GATE_OPEN) {
    ilk_axis_note_drive(axis_config, axis, direction);
  } else if ((gate == (uint32_t)ILK_GATE_SETPOINT) && has_arrived(axis_config, axis)) {
    ilk_axis_note_arrival(axis);
  } else {
    /* Undriven: the stall count pauses. */
  }
}

/** Marks and counts follow what left the output gate. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(out);
  @ requires apart: \separated(config, state, out);
  @ requires known: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   out->command[slot].direction < ILK_DIRECTION_COUNT;
  @ requires sound: sound_axes(state) && axes_fit_mode(state);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P2_stop: \old(at_zero(out)) ==> at_zero(out);
  @ ensures  P2_decided: decision_kept{Pre, Post}(state);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @*/
static void note_commands(const ilk_config_t *config, ilk_state_t *state, const ilk_outputs_t *out) {
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P15_axes: sound_axes(state);
    @ loop invariant P15_mode: axes_fit_mode(state);
    @ loop assigns slot, state->axis[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    note_slot(config, state, slot, out->gate[slot], out->command[slot].direction);
  }
}

/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  exact: \result == (state->estop != 0 ? ILK_COLOUR_RED
  @   : state->mode == ILK_MODE_MOTION ? ILK_COLOUR_GREEN : ILK_COLOUR_OFF);
  @*/
static ilk_colour_t pedal_colour(const ilk_state_t *state) {
  ilk_colour_t colour = ILK_COLOUR_OFF;
  if (state->estop != 0u) {
    colour = ILK_COLOUR_RED;
  } else if (state->mode == (uint32_t)ILK_MODE_MOTION) {
    colour = ILK_COLOUR_GREEN;
  } else {
    colour = ILK_COLOUR_OFF;
  }
  return colour;
}

/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P5_stall: \result == ILK_COLOUR_PURPLE <==> some_fault(state, ILK_SLOTS, ILK_FAULT_STALL);
  @ ensures  none: \result == ILK_COLOUR_OFF <==> free_of_faults(state, ILK_SLOTS);
  @ ensures  known: \result == ILK_COLOUR_OFF || \result == ILK_COLOUR_AMBER
  @   || \result == ILK_COLOUR_PURPLE;
  @*/
static ilk_colour_t stall_colour(const ilk_state_t *state) {
  ilk_colour_t colour = ILK_COLOUR_OFF;
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P5_stall: colour == ILK_COLOUR_PURPLE <==> some_fault(state, slot, ILK_FAULT_STALL);
    @ loop invariant none: colour == ILK_COLOUR_OFF <==> free_of_faults(state, slot);
    @ loop invariant known: colour == ILK_COLOUR_OFF || colour == ILK_COLOUR_AMBER
    @   || colour == ILK_COLOUR_PURPLE;
    @ loop assigns slot, colour;
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    if (state->axis[slot].fault == (uint32_t)ILK_FAULT_STALL) {
      colour = ILK_COLOUR_PURPLE;
    } else if ((state->axis[slot].fault != (uint32_t)ILK_FAULT_NONE) && (colour == ILK_COLOUR_OFF)) {
      colour = ILK_COLOUR_AMBER;
    } else {
      /* A fault seen earlier keeps its colour. */
    }
  }
  return colour;
}

/*@ requires valid: \valid_read(state) && \valid(lamp + (0 .. ILK_LAMP_COUNT - 1))
  @   && \separated(state, lamp + (0 .. ILK_LAMP_COUNT - 1));
  @ assigns  lamp[0 .. ILK_LAMP_COUNT - 1];
  @ ensures  pedal: lamp[ILK_LAMP_PEDAL] == (state->estop != 0 ? ILK_COLOUR_RED
  @   : state->mode == ILK_MODE_MOTION ? ILK_COLOUR_GREEN : ILK_COLOUR_OFF);
  @ ensures  network: lamp[ILK_LAMP_NETWORK] == (state->app_alive != 0 ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  @ ensures  controller: lamp[ILK_LAMP_CONTROLLER] ==
  @   (state->mode == ILK_MODE_READY || state->mode == ILK_MODE_MOTION ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  @ ensures  stall: lamp[ILK_LAMP_STALL] == ILK_COLOUR_PURPLE
  @   <==> some_fault(state, ILK_SLOTS, ILK_FAULT_STALL);
  @ ensures  fault: lamp[ILK_LAMP_STALL] == ILK_COLOUR_OFF <==> free_of_faults(state, ILK_SLOTS);
  @*/
static void light_lamps(const ilk_state_t *state, uint32_t lamp[ILK_LAMP_COUNT]) {
  const bool unlocked =
      (state->mode == (uint32_t)ILK_MODE_READY) || (state->mode == (uint32_t)ILK_MODE_MOTION);
  lamp[ILK_LAMP_PEDAL] = (uint32_t)pedal_colour(state);
  lamp[ILK_LAMP_NETWORK] = (uint32_t)((state->app_alive != 0u) ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  lamp[ILK_LAMP_CONTROLLER] = (uint32_t)(unlocked ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  lamp[ILK_LAMP_STALL] = (uint32_t)stall_colour(state);
}

/** The frame of one slot, and no other. */
/*@ requires readable: \valid_read(config) && \valid_read(command + (0 .. ILK_SLOTS - 1)) && slot < ILK_SLOTS;
  @ requires writable: \valid(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1));
  @ requires apart: \separated(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1), command + (0 .. ILK_SLOTS - 1))
  @   && \separated(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1), config) && \separated(command + (0 .. ILK_SLOTS - 1), config);
  @ assigns  *(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1));
  @ ensures  P16_zero_drive: stills(command + slot, &frame[slot][0]);
  @ ensures  P16_below: \forall integer other; 0 <= other < slot ==>
  @   \old(stills(&command[other], &frame[other][0])) ==> stills(&command[other], &frame[other][0]);
  @*/
static void pack_slot(const ilk_config_t *config, const ilk_command_t command[ILK_SLOTS], uint32_t tick,
                      uint32_t slot, uint32_t frame[ILK_SLOTS][ILK_FRAME_WORDS]) {
  ilk_frame_pack(&config->axis[slot], &command[slot], tick, frame[slot]);
}

/** The frames of all slots. */
/*@ requires readable: \valid_read(config) && \valid_read(command + (0 .. ILK_SLOTS - 1));
  @ requires writable: \valid(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1));
  @ requires apart: \separated(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1), command + (0 .. ILK_SLOTS - 1))
  @   && \separated(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1), config) && \separated(command + (0 .. ILK_SLOTS - 1), config);
  @ assigns  *(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1));
  @ ensures  P16_zero_drive: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
  @   stills(command + slot, &frame[slot][0]);
  @*/
static void pack_frames(const ilk_config_t *config, const ilk_command_t command[ILK_SLOTS], uint32_t tick,
                        uint32_t frame[ILK_SLOTS][ILK_FRAME_WORDS]) {
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P16_zero_drive: \forall integer done; 0 <= done < slot ==>
    @   stills(&command[done], &frame[done][0]);
    @ loop assigns slot, *(&frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1));
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    pack_slot(config, command, tick, slot, frame);
  }
}

/** Frames and lamps; entries that no request of this tick fills say nothing. */
/*@ requires valid: \valid_read(config) && \valid_read(state) && \valid(out);
  @ requires apart: \separated(config, out) && \separated(state, out);
  @ requires given: out->verdict_count <= ILK_REQUESTS_PER_TICK;
  @ assigns  *(&out->frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1)), out->lamp[0 .. ILK_LAMP_COUNT - 1],
  @          out->verdict[0 .. ILK_REQUESTS_PER_TICK - 1];
  @ ensures  P11_unused: \forall integer index; out->verdict_count <= index < ILK_REQUESTS_PER_TICK ==>
  @   blank_record(&out->verdict[index]);
  @ ensures  P2_stop: \old(at_zero(out)) ==> at_zero(out);
  @ ensures  P16_zero_drive: \old(at_zero(out)) ==> all_still(out);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @ ensures  P2_decided: decision_kept{Pre, Post}(state);
  @ ensures  P11_kept: out->verdict_count == \old(out->verdict_count);
  @*/
static void write_outputs(const ilk_config_t *config, const ilk_state_t *state, ilk_outputs_t *out) {
  light_lamps(state, out->lamp);
  /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
  /*@ assert P15_system: \at(sound_system(state), Pre) ==> sound_system(state); */
  /*@ assert P2_stop: \at(at_zero(out), Pre) ==> at_zero(out); */
  pack_frames(config, out->command, state->tick, out->frame);
  /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
  /*@ assert P2_stop: \at(at_zero(out), Pre) ==> at_zero(out); */
  /*@ assert P16_zero_drive: \at(at_zero(out), Pre) ==> all_still(out); */
  clear_unused_verdicts(out);
  /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
  /*@ assert P2_stop: \at(at_zero(out), Pre) ==> at_zero(out); */
  /*@ assert P2_mode: state->mode == \at(state->mode, Pre); */
  /*@ assert P8_cause: cause_kept{Pre, Here}(state); */
  /*@ assert P13_trust: state->config_sound == \at(state->config_sound, Pre); */
  /*@ assert P2_pedal: state->pedal == \at(state->pedal, Pre) && state->estop == \at(state->estop, Pre); */
}

/** The end of a tick: it is counted, and the state sealed. */
/*@ requires valid: \valid(state);
  @ assigns  state->tick, state->seal;
  @ ensures  tick: state->tick == (\old(state->tick) == UINT32_MAX ? 0 : \old(state->tick) + 1);
  @ ensures  P15_invariant: \old(sound(state)) ==> sound(state);
  @ ensures  P2_decided: decision_kept{Pre, Post}(state);
  @*/
static void close_tick(ilk_state_t *state) {
  state->tick++;
  /*@ assert P15_system: \at(sound_system(state), Pre) ==> sound_system(state); */
  /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
  /*@ assert P15_axes: \at(sound_axes(state), Pre) ==> sound_axes(state); */
  /*@ assert P15_mode: \at(axes_fit_mode(state), Pre) ==> axes_fit_mode(state); */
  ilk_state_seal(state);
}

/** Phase 8: frames, lamps, the count of ticks, seal. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid(out);
  @ requires apart: \separated(config, state, out);
  @ requires given: out->verdict_count <= ILK_REQUESTS_PER_TICK;
  @ requires sound: sound(state);
  @ assigns  *(&out->frame[0][0] + (0 .. ILK_SLOTS * ILK_FRAME_WORDS - 1)), out->lamp[0 .. ILK_LAMP_COUNT - 1],
  @          out->verdict[0 .. ILK_REQUESTS_PER_TICK - 1], state->tick, state->seal;
  @ ensures  P2_stop: \old(at_zero(out)) ==> at_zero(out);
  @ ensures  P16_zero_drive: \old(at_zero(out)) ==> all_still(out);
  @ ensures  P2_decided: decision_kept{Pre, Post}(state);
  @ ensures  P11_kept: out->verdict_count == \old(out->verdict_count);
  @ ensures  P15_invariant: sound(state);
  @*/
static void publish(const ilk_config_t *config, ilk_state_t *state, ilk_outputs_t *out) {
  write_outputs(config, state, out);
  close_tick(state);
}

/** Phases 2 to 4: what cards and contacts say, and what that means for each axis. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(in) && \valid(alarms);
  @ requires apart: \separated(config, state, alarms) && \separated(in, state) && \separated(in, alarms);
  @ requires sound: sound(state);
  @ assigns  *state, alarms->new_fault, alarms->required_card_lost;
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @ ensures  P8_kept: mode_kept{Pre, Post}(state);
  @*/
static void observe(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
                    ilk_alarms_t *alarms) {
  ilk_reading_t readings[ILK_SLOTS];
  read_frames(config, state, in, readings);
  ilk_observe_system(config, state, in);
  observe_axes(config, state, readings, alarms);
}

/** Phases 2 to 5: what is seen, and the mode that it demands. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(in);
  @ requires apart: \separated(config, state) && \separated(in, state);
  @ requires sound: sound(state);
  @ assigns  *state;
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @ ensures  P8_latch: \old(state->mode) == ILK_MODE_LOCKED ==>
  @   state->mode == ILK_MODE_LOCKED && cause_kept{Pre, Post}(state);
  @ ensures  P13_untrusted: state->config_sound == \old(state->config_sound);
  @ ensures  P14_damaged: check.damaged != 0 ==> state->mode == ILK_MODE_LOCKED
  @   && (\old(state->mode) != ILK_MODE_LOCKED ==> state->cause == ILK_CAUSE_INTEGRITY);
  @*/
static void observe_and_decide(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
                               ilk_config_check_t check) {
  ilk_alarms_t alarms = {.configuration_damaged = check.damaged, .configuration_crc = check.crc};
  /*@ assert P8_kept: mode_kept{Pre, Here}(state); */
  /*@ assert P15_system: \at(sound_system(state), Pre) ==> sound_system(state); */
  /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
  observe(config, state, in, &alarms);
  /*@ assert P8_mode: state->mode == \at(state->mode, Pre); */
  /*@ assert P8_cause: cause_kept{Pre, Here}(state); */
  /*@ assert P13_trust: state->config_sound == \at(state->config_sound, Pre); */
  ilk_change_mode(config, state, &alarms, in);
}

/** Phase 7: what each axis wants goes through the output gate, and its marks follow what left. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid(out);
  @ requires apart: \separated(config, state, out);
  @ requires sound: sound(state);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1], out->command[0 .. ILK_SLOTS - 1], out->gate[0 .. ILK_SLOTS - 1];
  @ ensures  P2_stop: !consented(state) ==> at_zero(out);
  @ ensures  P15_system: sound_system(state);
  @ ensures  P15_axes: sound_axes(state);
  @ ensures  P15_mode: axes_fit_mode(state);
  @ ensures  P2_decided: decision_kept{Pre, Post}(state);
  @ ensures  P11_kept: out->verdict_count == \old(out->verdict_count);
  @*/
static void drive_axes(const ilk_config_t *config, ilk_state_t *state, ilk_outputs_t *out) {
  pass_commands(config, state, out->command, out->gate);
  /*@ assert P15_state: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].state == \at(state->axis[slot].state, Pre); */
  /*@ assert P15_fault: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].fault == \at(state->axis[slot].fault, Pre); */
  /*@ assert P15_lease: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].lease_ticks == \at(state->axis[slot].lease_ticks, Pre); */
  /*@ assert P15_phase: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].homing_phase == \at(state->axis[slot].homing_phase, Pre); */
  /*@ assert P15_homed: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].homed == \at(state->axis[slot].homed, Pre); */
  /*@ assert P15_driven: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].driven_direction == \at(state->axis[slot].driven_direction, Pre); */
  /*@ assert P15_stalled: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].stall_direction == \at(state->axis[slot].stall_direction, Pre); */
  /*@ assert P15_reversed: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   state->axis[slot].reverse_direction == \at(state->axis[slot].reverse_direction, Pre); */
  /*@ assert P15_axis: \forall integer slot; 0 <= slot < ILK_SLOTS ==>
    @   \at(sound_axis(&state->axis[slot]), Pre) ==> sound_axis(&state->axis[slot]); */
  note_commands(config, state, out);
}

void ilk_step(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
              const ilk_request_t requests[], uint32_t count, ilk_outputs_t *out) {
  const uint32_t taken = (count < (uint32_t)ILK_REQUESTS_PER_TICK) ? count : (uint32_t)ILK_REQUESTS_PER_TICK;
  const ilk_config_check_t check = check_integrity(config, state);
  /*@ assert P14_basis: \at(state->mode, Pre) != ILK_MODE_INIT && !\at(basis_kept(config, state), Pre) ==>
    @   state->mode != ILK_MODE_INIT && state->config_sound == 0
    @   && ((state->mode == ILK_MODE_LOCKED && state->cause == ILK_CAUSE_INTEGRITY)
    @       || (check.damaged != 0 && state->mode == \at(state->mode, Pre))); */
  if (state->mode != (uint32_t)ILK_MODE_INIT) {
    observe_and_decide(config, state, in, check);
  }
  /*@ assert P14_basis: \at(state->mode, Pre) != ILK_MODE_INIT && !\at(basis_kept(config, state), Pre) ==>
    @   state->mode == ILK_MODE_LOCKED && state->config_sound == 0
    @   && (\at(state->mode, Pre) != ILK_MODE_LOCKED ==> state->cause == ILK_CAUSE_INTEGRITY); */
  answer_requests(config, state, requests, taken, out);
  /*@ assert P14_basis: \at(state->mode, Pre) != ILK_MODE_INIT && !\at(basis_kept(config, state), Pre) ==>
    @   state->mode == ILK_MODE_LOCKED
    @   && (\at(state->mode, Pre) != ILK_MODE_LOCKED ==> state->cause == ILK_CAUSE_INTEGRITY); */
  drive_axes(config, state, out);
  publish(config, state, out);
}
