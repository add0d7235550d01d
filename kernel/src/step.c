#include "parts.h"

/** Phase 2: checksum and freshness of each card's frame, and whether the bus says anything at all. */
static void read_frames(const ilk_config_t *config, const ilk_inputs_t *in, ilk_reading_t readings[ILK_SLOTS],
                        ilk_state_t *state) {
  bool any_valid = false;
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const bool answered = (in->transaction_done == 1u) && (((in->frames_received >> slot) & 1u) != 0u);
    readings[slot] = ilk_frame_unpack(in->frame[slot]);
    if (has_card(&config->axis[slot])) {
      ilk_card_observe(&state->system, &readings[slot], answered, &state->axis[slot]);
      any_valid = any_valid || (state->axis[slot].card_valid != 0u);
    }
  }
  state->system.bus_bad_ticks = ticks_in_row(!any_valid, state->system.bus_bad_ticks, UINT32_MAX);
}

/** Phase 4: each axis, judged by what this tick's frames say. */
static void observe_axes(const ilk_config_t *config, const ilk_inputs_t *in,
                         const ilk_reading_t readings[ILK_SLOTS], ilk_state_t *state, ilk_alarms_t *alarms) {
  const uint32_t periods = count_up(in->deadlines_missed, UINT32_MAX);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const ilk_axis_config_t *axis_config = &config->axis[slot];
    ilk_axis_t *axis = &state->axis[slot];
    if (has_axis(axis_config) &&
        ilk_axis_observe(&config->common, axis_config, &state->system, &readings[slot], periods, axis)) {
      alarms->new_fault = true;
    }
    if ((axis_config->required != 0u) && ilk_card_is_lost(&config->common, axis)) {
      alarms->required_card_lost = true;
    }
  }
}

/** Phase 6: requests in their order, one verdict each; entries that none of them fills say nothing. */
static void answer_requests(const ilk_config_t *config, const ilk_request_t requests[], uint32_t count,
                            ilk_state_t *state, ilk_outputs_t *out) {
  static const ilk_verdict_record_t nothing = {0};
  out->verdict_count = (count < (uint32_t)ILK_REQUESTS_PER_TICK) ? count : (uint32_t)ILK_REQUESTS_PER_TICK;
  for (uint32_t index = 0u; index < (uint32_t)ILK_REQUESTS_PER_TICK; index++) {
    out->verdict[index] =
        (index < out->verdict_count) ? ilk_request_take(config, &requests[index], state) : nothing;
  }
}

/** Phase 7: what each axis wants goes through the output gate, or is zero drive; its marks follow. */
static void drive_axes(const ilk_config_t *config, ilk_state_t *state, ilk_outputs_t *out) {
  static const ilk_command_t zero_drive = {
      .direction = (uint32_t)ILK_DIRECTION_NONE, .drive = 0u, .amplitude = 0u};
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const ilk_axis_config_t *axis_config = &config->axis[slot];
    ilk_axis_t *axis = &state->axis[slot];
    const ilk_command_t wanted = ilk_wanted_command(axis_config, axis);
    const ilk_gate_t gate = ilk_output_gate(axis_config, &state->system, axis, &wanted);
    out->gate[slot] = (uint32_t)gate;
    out->command[slot] = (gate == ILK_GATE_OPEN) ? wanted : zero_drive;
    if (gate == ILK_GATE_OPEN) {
      ilk_axis_note_drive(&wanted, axis);
    }
    if ((gate == ILK_GATE_SETPOINT) && (axis->state == (uint32_t)ILK_AXIS_MOVING)) {
      ilk_axis_note_arrival(axis_config, axis);
    }
  }
}

static ilk_colour_t pedal_colour(const ilk_system_t *system) {
  const bool motion = system->mode == (uint32_t)ILK_MODE_MOTION;
  const ilk_colour_t released = motion ? ILK_COLOUR_GREEN : ILK_COLOUR_OFF;
  return (system->estop != 0u) ? ILK_COLOUR_RED : released;
}

/** PURPLE for a stall, AMBER for any other fault. */
static ilk_colour_t fault_colour(const ilk_state_t *state) {
  bool stall = false;
  bool other = false;
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    stall = stall || (state->axis[slot].fault == (uint32_t)ILK_FAULT_STALL);
    other = other || (state->axis[slot].fault != (uint32_t)ILK_FAULT_NONE);
  }
  const ilk_colour_t not_stall = other ? ILK_COLOUR_AMBER : ILK_COLOUR_OFF;
  return stall ? ILK_COLOUR_PURPLE : not_stall;
}

/** Phase 8: frames, power and lamps. */
static void write_outputs(const ilk_config_t *config, const ilk_state_t *state, ilk_outputs_t *out) {
  const bool power = ilk_power_is_on(&state->system);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    ilk_frame_pack(&config->axis[slot], &out->command[slot], state->system.tick, out->frame[slot]);
  }
  out->power = flag_of(power);
  out->lamp[ILK_LAMP_PEDAL] = (uint32_t)pedal_colour(&state->system);
  out->lamp[ILK_LAMP_NETWORK] =
      (uint32_t)((state->system.app_alive != 0u) ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  out->lamp[ILK_LAMP_CONTROLLER] = (uint32_t)(power ? ILK_COLOUR_GREEN : ILK_COLOUR_RED);
  out->lamp[ILK_LAMP_STALL] = (uint32_t)fault_colour(state);
}

/** Phase 8: what the next tick counts from. */
static void close_tick(const ilk_common_config_t *common, ilk_system_t *system) {
  system->powered_ticks =
      ticks_in_row(ilk_power_is_on(system), system->powered_ticks, common->power_up_ticks);
  system->frames_sent = count_up(system->frames_sent, ILK_LATENCY_TICKS);
  system->tick++;
}

void ilk_step(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
              const ilk_request_t requests[], uint32_t count, ilk_outputs_t *out) {
  ilk_alarms_t alarms = ilk_integrity_check(config, state);
  if (state->system.mode != (uint32_t)ILK_MODE_INIT) {
    ilk_reading_t readings[ILK_SLOTS];
    read_frames(config, in, readings, state);
    ilk_system_observe(&config->common, in, &state->system);
    observe_axes(config, in, readings, state, &alarms);
    ilk_mode_decide(config, in, &alarms, state);
  }
  answer_requests(config, requests, count, state, out);
  drive_axes(config, state, out);
  write_outputs(config, state, out);
  close_tick(&config->common, &state->system);
  ilk_state_seal(state);
}
