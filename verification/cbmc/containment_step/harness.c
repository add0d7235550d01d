/**
 * @file
 * Whole ticks that must give zero drive: from a state that fails its check, whatever bits it holds; with a
 * configuration in which something changed of what P1 to P3 rest on, whatever else changed; and in INIT.
 * Check, phases that judge frames, verdicts and their effects are arbitrary within what their own proofs
 * show; phases 1, 3, 5, 7 and 8 are the real ones. Configuration, inputs and requests are arbitrary bits.
 */
#include "axis.h"
#include "frame.h"
#include "integrity.c"
#include "interlock/kernel.h"
#include "proof.h"
#include "request.h"

static bool passes_check;

bool some_check(const ilk_state_t* state) {
  (void)state;
  return passes_check;
}

/** Sealing changes the seal alone. */
void some_seal(ilk_state_t* state) {
  uint32_t seal;
  state->seal = seal;
}

uint32_t some_axis_crc(uint32_t crc, const ilk_axis_config_t* axis) {
  uint32_t next;
  (void)crc;
  (void)axis;
  return next;
}

uint32_t some_system_crc(uint32_t crc, const ilk_config_t* config) {
  uint32_t next;
  (void)crc;
  (void)config;
  return next;
}

ilk_reading_t some_reading(const uint32_t frame[ILK_FRAME_WORDS]) {
  ilk_reading_t reading;
  uint32_t bits;
  (void)frame;
  reading.intact = (bits & 1u) != 0u;
  reading.switch_triggered = (bits & 2u) != 0u;
  return reading;
}

static void become_any(ilk_axis_t* axis) {
  ilk_axis_t any_axis;
  *axis = any_axis;
}

void some_card(ilk_axis_t* axis, const ilk_reading_t* reading, bool received, uint32_t tick) {
  (void)reading;
  (void)received;
  (void)tick;
  become_any(axis);
}

bool some_axis(const ilk_config_t* config, const ilk_axis_config_t* axis_config, ilk_axis_t* axis,
               const ilk_reading_t* reading, uint32_t tick) {
  uint32_t faulted;
  (void)config;
  (void)axis_config;
  (void)reading;
  (void)tick;
  become_any(axis);
  return (faulted & 1u) != 0u;
}

/** In INIT nothing is accepted (proof `init_requests`), and no RESET without trust in the configuration. */
ilk_verdict_t some_verdict(const ilk_config_t* config, const ilk_state_t* state,
                           const ilk_request_t* request) {
  const bool reset = request->kind == ILK_REQUEST_RESET;
  uint32_t verdict;
  (void)config;
  SHOW((state->mode == ILK_MODE_INIT) || (state->mode == ILK_MODE_LOCKED),
       "P14: no request is judged elsewhere");
  SHOW((state->mode == ILK_MODE_INIT) || (state->config_sound == 0u),
       "P14: the configuration is not trusted");
  GIVEN(verdict < ILK_VERDICT_COUNT);
  GIVEN((verdict != ILK_VERDICT_ACCEPTED) || ((state->mode == ILK_MODE_LOCKED) && !reset));
  return (ilk_verdict_t)verdict;
}

/** In LOCKED, whatever is not a RESET leaves mode and cause (proof `requests`); of the axes it may make
 * anything. */
void some_effect(const ilk_config_t* config, ilk_state_t* state, const ilk_request_t* request) {
  (void)config;
  SHOW((state->mode == ILK_MODE_LOCKED) && (request->kind != ILK_REQUEST_RESET),
       "P14: no RESET is carried out");
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    become_any(&state->axis[slot]);
  }
}

static ilk_config_t config;
static ilk_config_t before;
static ilk_state_t state;
static ilk_inputs_t in;
static ilk_outputs_t out;
static ilk_request_t requests[ILK_REQUESTS_PER_TICK];

static void show_zero_drive(void) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_command_t* command = &out.command[slot];
    const uint32_t* frame = out.frame[slot];
    SHOW(out.gate[slot] == ILK_GATE_MODE, "P2: the mode closes every gate");
    SHOW((command->direction == ILK_DIRECTION_NONE) && (command->drive == 0u) && (command->amplitude == 0u),
         "P2, P14: zero drive is commanded");
    SHOW((frame[2] | frame[3] | frame[4] | frame[5] | frame[6] | frame[14]) == 0u,
         "P2, P14: zero drive in every frame out");
  }
}

static void show_damaged(uint32_t count) {
  const uint32_t damaged_seal = state.seal;
  passes_check = false;
  ilk_step(&config, &state, &in, requests, count, &out);
  SHOW((state.mode == ILK_MODE_LOCKED) && (state.cause == ILK_CAUSE_INTEGRITY), "P14: LOCKED (INTEGRITY)");
  SHOW((state.cause_value == damaged_seal) && (state.cause_tick == 0u), "P14: the damaged seal is told");
  SHOW((state.tick == 1u) && (state.config_sound == 0u) && (state.pedal_armed == 0u) &&
           (state.app_alive == 0u),
       "P14: ticks, trust, consent and app start anew");
  show_zero_drive();
  GOAL(goal_accepts_something,
       (out.verdict_count == 16u) && (out.verdict[3].verdict == ILK_VERDICT_ACCEPTED));
  GOAL(goal_estop_too, state.causes_seen != (1u << ILK_CAUSE_INTEGRITY));
  GOAL(goal_axis_enabled, state.axis[9].state == ILK_AXIS_MOVING);
  GOAL(never_unlocked, state.mode != ILK_MODE_LOCKED);
}

/** Any bits of the configuration may have changed, and of these words any. */
static bool some_word_changed(void) {
  bool changed = (config.pedal_channels != before.pedal_channels) ||
                 (config.app_timeout_ticks != before.app_timeout_ticks);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* now = &config.axis[slot];
    const ilk_axis_config_t* then = &before.axis[slot];
    GIVEN((then->card < ILK_CARD_COUNT) && (then->limit_side < ILK_LIMIT_COUNT) &&
          (then->motor_direction <= 1u)); /* proof `config_slot` */
    changed = changed || (now->card != then->card) || (now->limit_side != then->limit_side) ||
              (now->motor_direction != then->motor_direction);
  }
  return changed;
}

/** From any state that passes its check and remembers a configuration that was valid. */
static void show_damaged_configuration(uint32_t count) {
  const uint32_t mode_before = state.mode;
  const uint32_t cause_before = state.cause;
  remember_basis(&state, &before);
  GIVEN(some_word_changed());
  GIVEN((mode_before < ILK_MODE_COUNT) && (mode_before != ILK_MODE_INIT));
  passes_check = true;
  ilk_step(&config, &state, &in, requests, count, &out);
  SHOW((state.mode == ILK_MODE_LOCKED) &&
           (state.cause == ((mode_before == ILK_MODE_LOCKED) ? cause_before : ILK_CAUSE_INTEGRITY)),
       "P8, P14: LOCKED in that very tick, for INTEGRITY unless locked before");
  SHOW(((state.causes_seen >> ILK_CAUSE_INTEGRITY) & 1u) == 1u, "P8, P14: INTEGRITY is listed");
  SHOW(state.config_sound == 0u, "P13: the configuration is not trusted");
  show_zero_drive();
  GOAL(goal_locked_before, cause_before == ILK_CAUSE_ESTOP);
  GOAL(goal_last_switch_end, (mode_before == ILK_MODE_MOTION) && (config.axis[9].limit_side == 258u));
  GOAL(never_driven_on, state.mode == ILK_MODE_MOTION);
}

static void show_init(uint32_t count) {
  passes_check = true;
  state.mode = ILK_MODE_INIT;
  ilk_step(&config, &state, &in, requests, count, &out);
  SHOW(state.mode == ILK_MODE_INIT, "P13: INIT is not left by a step");
  show_zero_drive();
  GOAL(goal_refuses, (out.verdict_count == 16u) && (state.requests_refused == 16u));
  GOAL(never_accepts, (out.verdict_count > 7u) && (out.verdict[7].verdict == ILK_VERDICT_ACCEPTED));
}

void harness(void) {
  uint32_t count;
  uint32_t choice;
  __CPROVER_havoc_object(&config);
  __CPROVER_havoc_object(&before);
  __CPROVER_havoc_object(&state);
  __CPROVER_havoc_object(&in);
  __CPROVER_havoc_object(&out);
  __CPROVER_havoc_object(requests);
  if (choice == 0u) {
    show_init(count);
  } else if (choice == 1u) {
    show_damaged_configuration(count);
  } else {
    show_damaged(count);
  }
}
