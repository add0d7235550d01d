#include <stdbool.h>

#include "arith.h"
#include "axis.h"
#include "frame.h"
#include "gate.h"
#include "integrity.h"
#include "interlock/kernel.h"
#include "mode.h"
#include "request.h"

/** Phase 1: state and a slice of the configuration. Nothing else of a damaged state is looked at. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid(alarms);
  @ requires apart: \separated(config, state, alarms);
  @ assigns  *state, alarms->configuration_damaged, alarms->configuration_crc;
  @ ensures  P14_contained: !\old(sealed(state) && sound(state)) ==>
  @   state->mode == ILK_MODE_LOCKED && state->cause == ILK_CAUSE_INTEGRITY;
  @ ensures  P13_untrusted: !\old(sealed(state) && sound(state)) ==> state->config_sound == 0;
  @*/
static void check_integrity(const ilk_config_t *config, ilk_state_t *state, ilk_alarms_t *alarms) {
  if (!ilk_state_is_sound(state)) {
    ilk_state_rebuild(state, config, ILK_CAUSE_INTEGRITY, state->seal);
  }
  if (state->mode != (uint32_t)ILK_MODE_INIT) {
    const ilk_config_check_t check = ilk_config_check_slice(config, state);
    alarms->configuration_damaged = check.damaged;
    alarms->configuration_crc = check.crc;
  }
}

/** True when the card of this slot answered in this tick. */
/*@ requires readable: \valid_read(in) && slot < ILK_SLOTS;
  @ assigns  \nothing;
  @ ensures  P16_answered: \result <==> card_answered(in, slot);
  @*/
static bool answered(const ilk_inputs_t *in, uint32_t slot) {
  return (in->transaction_done == 1u) && (((in->frames_received >> slot) & 1u) != 0u);
}

/** Phase 2: checksum, freshness and counters of each card, and whether the bus says anything at all. */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(in)
  @   && \valid(readings + (0 .. ILK_SLOTS - 1));
  @ requires apart: \separated(config, state, readings + (0 .. ILK_SLOTS - 1))
  @   && \separated(in, state, readings + (0 .. ILK_SLOTS - 1));
  @ assigns  state->axis[0 .. ILK_SLOTS - 1], state->bus_bad_ticks, readings[0 .. ILK_SLOTS - 1];
  @ ensures  P2_bus: state->bus_bad_ticks == 0
  @   || state->bus_bad_ticks == \min(\old(state->bus_bad_ticks) + 1, UINT32_MAX);
  @*/
static void read_frames(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
                        ilk_reading_t readings[ILK_SLOTS]) {
  bool any_valid = false;
  /*@ loop invariant range: 0 <= slot <= ILK_SLOTS;
    @ loop assigns slot, any_valid, state->axis[0 .. ILK_SLOTS - 1], readings[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    readings[slot] = ilk_frame_unpack(in->frame[slot]);
    if (has_card(&config->axis[slot])) {
      ilk_observe_card(&state->axis[slot], &readings[slot], answered(in, slot), state->tick);
      any_valid = any_valid || (state->axis[slot].card_valid != 0u);
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

/** Phase 6: requests in their order, one verdict each. */
static void answer_requests(const ilk_config_t *config, ilk_state_t *state, const ilk_request_t requests[],
                            uint32_t count, ilk_outputs_t *out) {
  out->verdict_count = 0u;
  for (uint32_t index = 0u; (index < count) && (index < (uint32_t)ILK_REQUESTS_PER_TICK); index++) {
    const ilk_request_t *request = &requests[index];
    const ilk_verdict_t verdict = ilk_request_judge(config, state, request);
    if (verdict == ILK_VERDICT_ACCEPTED) {
      ilk_request_apply(config, state, request);
    }
    count_verdict(state, request, verdict);
    answer(state, request, verdict, out);
  }
  clear_unused_verdicts(out);
}

/** Phase 7: what each axis wants goes through the output gate, or is zero drive. */
static void drive_axes(const ilk_config_t *config, ilk_state_t *state, ilk_outputs_t *out) {
  static const ilk_command_t zero_drive = {
      .direction = (uint32_t)ILK_DIRECTION_NONE, .drive = 0u, .amplitude = 0u};
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const ilk_axis_config_t *axis_config = &config->axis[slot];
    ilk_axis_t *axis = &state->axis[slot];
    const ilk_command_t wanted = ilk_wanted_command(axis_config, axis);
    const ilk_gate_t gate = ilk_output_gate(axis_config, state, axis, &wanted);
    out->gate[slot] = (uint32_t)gate;
    out->command[slot] = (gate == ILK_GATE_OPEN) ? wanted : zero_drive;
    if (gate == ILK_GATE_OPEN) {
      ilk_axis_note_drive(axis_config, axis, wanted.direction);
    } else if ((gate == ILK_GATE_SETPOINT) && (axis->state == (uint32_t)ILK_AXIS_MOVING) &&
               (wanted.direction == (uint32_t)ILK_DIRECTION_NONE)) {
      ilk_axis_note_arrival(axis);
    } else {
      /* Undriven: the stall count pauses. */
    }
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

/*@ requires valid: \valid_read(state) && \valid(out) && \separated(state, out);
  @ assigns  out->lamp[0 .. ILK_LAMP_COUNT - 1];
  @ ensures  pedal: out->lamp[ILK_LAMP_PEDAL] == (state->estop != 0 ? ILK_COLOUR_RED
  @   : state->mode == ILK_MODE_MOTION ? ILK_COLOUR_GREEN : ILK_COLOUR_OFF);
  @ ensures  network: out->lamp[ILK_LAMP_NETWORK] ==
  @   (state->app_alive != 0 ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  @ ensures  controller: out->lamp[ILK_LAMP_CONTROLLER] ==
  @   (state->mode == ILK_MODE_READY || state->mode == ILK_MODE_MOTION ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  @ ensures  stall: out->lamp[ILK_LAMP_STALL] == ILK_COLOUR_PURPLE
  @   <==> some_fault(state, ILK_SLOTS, ILK_FAULT_STALL);
  @ ensures  fault: out->lamp[ILK_LAMP_STALL] == ILK_COLOUR_OFF <==> free_of_faults(state, ILK_SLOTS);
  @*/
static void light_lamps(const ilk_state_t *state, ilk_outputs_t *out) {
  const bool unlocked =
      (state->mode == (uint32_t)ILK_MODE_READY) || (state->mode == (uint32_t)ILK_MODE_MOTION);
  out->lamp[ILK_LAMP_PEDAL] = (uint32_t)pedal_colour(state);
  out->lamp[ILK_LAMP_NETWORK] = (uint32_t)((state->app_alive != 0u) ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  out->lamp[ILK_LAMP_CONTROLLER] = (uint32_t)(unlocked ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  out->lamp[ILK_LAMP_STALL] = (uint32_t)stall_colour(state);
}

/** Phase 8: frames, lamps, seal. */
static void publish(const ilk_config_t *config, ilk_state_t *state, ilk_outputs_t *out) {
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    ilk_frame_pack(&config->axis[slot], &out->command[slot], state->tick, out->frame[slot]);
  }
  light_lamps(state, out);
  state->tick++;
  ilk_state_seal(state);
}

void ilk_step(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
              const ilk_request_t requests[], uint32_t count, ilk_outputs_t *out) {
  ilk_alarms_t alarms = {.new_fault = false};

  check_integrity(config, state, &alarms);
  if (state->mode != (uint32_t)ILK_MODE_INIT) {
    ilk_reading_t readings[ILK_SLOTS];
    read_frames(config, state, in, readings);
    ilk_observe_system(config, state, in);
    observe_axes(config, state, readings, &alarms);
    ilk_change_mode(config, state, &alarms, in);
  }
  answer_requests(config, state, requests, count, out);
  drive_axes(config, state, out);
  publish(config, state, out);
}
