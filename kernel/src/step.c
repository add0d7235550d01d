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
static bool answered(const ilk_inputs_t *in, uint32_t slot) {
  return (in->transaction_done == 1u) && (((in->frames_received >> slot) & 1u) != 0u);
}

/** Phase 2: checksum, freshness and counters of each card, and whether the bus says anything at all. */
static void read_frames(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
                        ilk_reading_t readings[ILK_SLOTS]) {
  bool any_valid = false;
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    readings[slot] = ilk_frame_unpack(in->frame[slot]);
    if (has_card(&config->axis[slot])) {
      ilk_observe_card(&state->axis[slot], &readings[slot], answered(in, slot), state->tick);
      any_valid = any_valid || (state->axis[slot].card_valid != 0u);
    }
  }
  state->bus_bad_ticks = any_valid ? 0u : count_up(state->bus_bad_ticks, UINT32_MAX);
}

/** Phase 4: each axis, judged by what this tick's frames say. */
static void observe_axes(const ilk_config_t *config, ilk_state_t *state,
                         const ilk_reading_t readings[ILK_SLOTS], ilk_alarms_t *alarms) {
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const ilk_axis_config_t *axis_config = &config->axis[slot];
    ilk_axis_t *axis = &state->axis[slot];
    if (has_axis(axis_config)) {
      const bool faulted = ilk_observe_axis(config, axis_config, axis, &readings[slot], state->tick);
      alarms->new_fault = alarms->new_fault || faulted;
    } else {
      ilk_observe_sensor(config, axis);
    }
    if ((axis_config->required != 0u) && ilk_card_is_lost(config, axis)) {
      alarms->required_card_lost = true;
    }
  }
}

static void answer(const ilk_state_t *state, const ilk_request_t *request, ilk_verdict_t verdict,
                   ilk_outputs_t *out) {
  ilk_verdict_record_t *record = &out->verdict[out->verdict_count];
  record->tick = state->tick;
  record->sequence = request->sequence;
  record->kind = request->kind;
  record->axis = request->axis;
  record->verdict = (uint32_t)verdict;
  out->verdict_count++;
}

/** Every request that is intact and in order uses up its number, whatever the verdict. */
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

/** Entries that no request of this tick fills say nothing. */
static void clear_unused_verdicts(ilk_outputs_t *out) {
  static const ilk_verdict_record_t none = {0};
  for (uint32_t index = out->verdict_count; index < (uint32_t)ILK_REQUESTS_PER_TICK; index++) {
    out->verdict[index] = none;
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

static ilk_colour_t stall_colour(const ilk_state_t *state) {
  ilk_colour_t colour = ILK_COLOUR_OFF;
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
