/**
 * @file
 * P14, P15: whole ticks by the real `ilk_step`, for one slot and one request. Configuration, state, inputs,
 * request and outputs before are arbitrary bits: nothing is taken for granted of them, so no state needs to
 * be sound for a tick to be defined. Three cases give zero drive: a state that fails its check, whatever bits
 * it holds; a change of what P1 to P3 rest on, whatever else changed; and INIT.
 *
 * Digest, CRC and validation are replaced by arbitrary answers. The variant `ten` is ten slots and sixteen
 * requests, with what is done for one axis, one request or one frame replaced by anything: each of these is
 * shown for arbitrary bits with one slot.
 */
#include "proof.h"
#include "step.c"

#define ilk_request_take take_really
#include "request.c"
#undef ilk_request_take

static ilk_config_t config;
static ilk_state_t state;
static ilk_inputs_t in;
static ilk_outputs_t out;
static ilk_request_t requests[ILK_REQUESTS_PER_TICK];
static bool passes_check;
static uint32_t requests_taken;

bool some_check(const ilk_state_t* now) {
  (void)now;
  return passes_check;
}

/** Sealing changes the seal alone. */
void some_seal(ilk_state_t* now) {
  uint32_t seal;
  now->seal = seal;
}

uint32_t some_crc(uint32_t crc, const unsigned char bytes[], uint32_t words) {
  uint32_t next;
  (void)crc;
  SHOW(__CPROVER_r_ok(bytes, 4u * words), "P15: a CRC is taken over memory that is there");
  return next;
}

ilk_config_verdict_t some_validation(const ilk_config_t* own) {
  ilk_config_verdict_t verdict;
  (void)own;
  return verdict;
}

uint32_t some_frequency(uint32_t drive) {
  uint32_t word;
  (void)drive;
  return word;
}

static bool any_truth(void) {
  uint32_t bits;
  return (bits & 1u) != 0u;
}

static uint32_t slot_of(const ilk_axis_t* axis) {
  uint32_t slot = 0u;
  while ((slot < ILK_SLOTS) && (axis != &state.axis[slot])) {
    slot++;
  }
  SHOW(slot < ILK_SLOTS, "P15: an axis of the state");
  return slot;
}

ilk_reading_t some_reading(const uint32_t frame[ILK_FRAME_WORDS]) {
  ilk_reading_t reading;
  SHOW(__CPROVER_r_ok(frame, sizeof(in.frame[0])), "P15: a whole frame");
  reading.intact = any_truth();
  reading.switch_triggered = any_truth();
  return reading;
}

void some_card(const ilk_system_t* system, const ilk_reading_t* reading, bool received, ilk_axis_t* axis) {
  uint32_t valid;
  (void)system;
  (void)reading;
  (void)received;
  state.axis[slot_of(axis)].card_valid = valid;
}

bool some_axis(const ilk_common_config_t* common, const ilk_axis_config_t* own, const ilk_system_t* system,
               const ilk_reading_t* reading, uint32_t periods, ilk_axis_t* axis) {
  ilk_axis_t any_axis;
  const uint32_t slot = slot_of(axis);
  (void)common;
  (void)system;
  (void)reading;
  (void)periods;
  SHOW(own == &config.axis[slot], "P18: an axis is judged by its own configuration");
  state.axis[slot] = any_axis;
  return any_truth();
}

/** With one request the real thing; with sixteen anything, for that one is any, in any state. */
ilk_verdict_record_t ilk_request_take(const ilk_config_t* own, const ilk_request_t* request,
                                      ilk_state_t* now) {
  ilk_verdict_record_t record;
  const uint32_t taken = requests_taken;
  requests_taken++;
#ifdef TEN
  SHOW(request == &requests[taken], "P11: the requests are taken in their order, sixteen at most");
  (void)own;
  (void)now;
#else
  if (request == &requests[0]) {
    SHOW(taken == 0u, "P11: each request is taken once");
    record = take_really(own, request, now);
  } else {
    SHOW(false, "P11: no more requests are taken than there are");
  }
#endif
  return record;
}

ilk_command_t some_wish(const ilk_axis_config_t* own, const ilk_axis_t* axis) {
  ilk_command_t wish;
  SHOW(own == &config.axis[slot_of(axis)], "P18: an axis wishes by its own configuration");
  return wish;
}

ilk_gate_t some_gate(const ilk_axis_config_t* own, const ilk_system_t* system, const ilk_axis_t* axis,
                     const ilk_command_t* wish) {
  uint32_t gate;
  (void)wish;
  SHOW(own == &config.axis[slot_of(axis)], "P18: an axis is let through by its own configuration");
  GIVEN(gate < ILK_GATE_COUNT);
  GIVEN((gate != ILK_GATE_OPEN) || (system->mode == ILK_MODE_MOTION)); /* proof `gate` */
  return (ilk_gate_t)gate;
}

void some_note(const ilk_command_t* command, ilk_axis_t* axis) {
  (void)command;
  (void)slot_of(axis);
}

void some_arrival(const ilk_axis_config_t* own, ilk_axis_t* axis) {
  (void)own;
  (void)slot_of(axis);
}

/** The words of the wiring that the state remembers, each a byte. */
static bool basis_changed(void) {
  bool same = (config.common.pedal_channels == state.system.pedal_channels) &&
              (config.common.app_timeout_ticks == state.system.app_timeout_ticks);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* axis = &config.axis[slot];
    const uint32_t wiring = state.axis[slot].wiring;
    same = same && (axis->card == (wiring & 0xffu)) && (axis->limit_side == ((wiring >> 8) & 0xffu)) &&
           (axis->motor_direction == (wiring >> 16));
  }
  return !same;
}

static void show_zero_drive(void) {
  uint32_t slot;
  GIVEN(slot < ILK_SLOTS);
  const ilk_command_t* command = &out.command[slot];
  const uint32_t* frame = out.frame[slot];
  SHOW((command->direction == ILK_DIRECTION_NONE) && (command->drive == 0u) && (command->amplitude == 0u),
       "P2, P14: zero drive is commanded");
  SHOW((frame[2] | frame[3] | frame[4] | frame[5] | frame[6] | frame[14]) == 0u,
       "P2, P14: zero drive in every frame out");
  SHOW(out.power == 0u, "P14: power is off");
}

void harness(void) {
  uint32_t count;
  __CPROVER_havoc_object(&config);
  __CPROVER_havoc_object(&state);
  __CPROVER_havoc_object(&in);
  __CPROVER_havoc_object(&out);
  __CPROVER_havoc_object(requests);
  passes_check = any_truth();
#ifndef TEN
  GIVEN(count <= 1u);
#endif
  const uint32_t seal_before = state.seal;
  const uint32_t mode_before = state.system.mode;
  const uint32_t cause_before = state.system.cause;
  const bool changed = basis_changed();
  ilk_step(&config, &state, &in, requests, count, &out);
  const uint32_t mode = state.system.mode;
  const bool locked = mode == ILK_MODE_LOCKED;
  SHOW(out.verdict_count == ((count < ILK_REQUESTS_PER_TICK) ? count : ILK_REQUESTS_PER_TICK),
       "P11: one verdict for each request taken");
  if (!passes_check) {
    SHOW(locked && (state.system.cause == ILK_CAUSE_INTEGRITY), "P14: LOCKED (INTEGRITY)");
    SHOW((state.system.cause_value == seal_before) && (state.system.cause_tick == 0u),
         "P14: the damaged seal is told");
    SHOW((state.system.tick == 1u) && (state.system.pedal_armed == 0u) && (state.system.consent == 0u),
         "P9, P14: ticks and consent start anew");
    show_zero_drive();
  } else if (mode_before == ILK_MODE_INIT) {
    SHOW(mode == ILK_MODE_INIT, "P13: INIT is not left by a step");
    show_zero_drive();
  } else if (changed) {
    SHOW(locked &&
             (state.system.cause == ((mode_before == ILK_MODE_LOCKED) ? cause_before : ILK_CAUSE_INTEGRITY)),
         "P8, P14: LOCKED in that very tick, for INTEGRITY unless locked before");
    SHOW(((state.system.causes_seen >> ILK_CAUSE_INTEGRITY) & 1u) == 1u, "P8, P14: INTEGRITY is listed");
    SHOW(state.system.config_sound == 0u, "P13: the configuration is not trusted");
    show_zero_drive();
  } else {
    SHOW(IMPLIES(out.command[0].drive != 0u, mode == ILK_MODE_MOTION), "P1: drive in MOTION only");
  }
  GOAL(goal_damaged_state, !passes_check && (in.estop_loop_closed == 0u));
  GOAL(goal_damaged_in_motion, passes_check && changed && (mode_before == ILK_MODE_MOTION));
  GOAL(goal_init, passes_check && (mode_before == ILK_MODE_INIT));
  GOAL(goal_drives_on, passes_check && (out.command[0].drive == 7u) && (count == 1u));
  GOAL(goal_enters_motion, (mode_before == ILK_MODE_READY) && (mode == ILK_MODE_MOTION));
  GOAL(never_damaged_and_not_locked, !passes_check && !locked);
  GOAL(never_damaged_and_driven, !passes_check && (out.command[0].drive != 0u));
}
