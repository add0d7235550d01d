/**
 * @file
 * Whole ticks that must give zero drive: from a state that fails its check, whatever bits it holds; with a
 * configuration in which something changed of what P1 to P3 rest on, whatever else changed; and in INIT.
 * Check, comparison of the configuration, phases that judge frames, verdicts and their effects are arbitrary
 * within what their own proofs show; phases 1, 3, 5, 7 and 8 are the real ones. Configuration, inputs and
 * requests are arbitrary bits.
 */
#include "axis.h"
#include "frame.h"
#include "integrity.c"
#include "interlock/kernel.h"
#include "proof.h"
#include "request.h"

static ilk_config_t config;
static ilk_state_t state;
static ilk_inputs_t in;
static ilk_outputs_t out;
static ilk_request_t requests[ILK_REQUESTS_PER_TICK];
static bool passes_check;
static bool passes_comparison;
static uint32_t settled_mode;

bool some_check(const ilk_state_t* now) {
  (void)now;
  return passes_check;
}

/** A change of what P1 to P3 rest on is noticed and ends trust (proof `basis`). */
bool some_comparison(const ilk_config_t* own, ilk_state_t* now) {
  (void)own;
  if (!passes_comparison) {
    now->config_sound = 0u;
  }
  return passes_comparison;
}

/** Sealing changes the seal alone. */
void some_seal(ilk_state_t* now) {
  uint32_t seal;
  now->seal = seal;
}

uint32_t some_finish(uint32_t crc) {
  uint32_t finished;
  (void)crc;
  return finished;
}

ilk_config_verdict_t some_validation(const ilk_config_t* own) {
  ilk_config_verdict_t verdict;
  (void)own;
  return verdict;
}

uint32_t some_axis_crc(uint32_t crc, const ilk_axis_config_t* axis) {
  uint32_t next;
  (void)crc;
  (void)axis;
  return next;
}

uint32_t some_system_crc(uint32_t crc, const ilk_config_t* own) {
  uint32_t next;
  (void)crc;
  (void)own;
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

uint32_t some_frequency(uint32_t drive) {
  uint32_t word;
  (void)drive;
  return word;
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

bool some_axis(const ilk_config_t* own, const ilk_axis_config_t* axis_config, ilk_axis_t* axis,
               const ilk_reading_t* reading, uint32_t tick) {
  uint32_t faulted;
  (void)own;
  (void)axis_config;
  (void)reading;
  (void)tick;
  become_any(axis);
  return (faulted & 1u) != 0u;
}

/** From phase 6 on only the mode of the case at hand is left. Saying so by a constant spares the solver the
 * work of finding it out for every request and axis. */
static void settle_mode(void) {
  SHOW(state.mode == settled_mode, "P2, P14: LOCKED, or INIT if it was INIT, before requests and drive");
  GIVEN(state.mode == settled_mode);
  state.mode = settled_mode;
}

/** In INIT nothing is accepted (proof `init_requests`), and no RESET without trust in the configuration. */
ilk_verdict_t some_verdict(const ilk_config_t* own, const ilk_state_t* now, const ilk_request_t* request) {
  const bool reset = request->kind == ILK_REQUEST_RESET;
  uint32_t verdict;
  (void)own;
  settle_mode();
  SHOW((now->mode == ILK_MODE_INIT) || (now->config_sound == 0u), "P14: the configuration is not trusted");
  GIVEN(verdict < ILK_VERDICT_COUNT);
  GIVEN((verdict != ILK_VERDICT_ACCEPTED) || ((now->mode == ILK_MODE_LOCKED) && !reset));
  return (ilk_verdict_t)verdict;
}

/** In LOCKED, whatever is not a RESET leaves mode and cause (proof `requests`); of the axes it may make
 * anything. */
void some_effect(const ilk_config_t* own, ilk_state_t* now, const ilk_request_t* request) {
  (void)own;
  SHOW((now->mode == ILK_MODE_LOCKED) && (request->kind != ILK_REQUEST_RESET),
       "P14: no RESET is carried out");
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    become_any(&now->axis[slot]);
  }
}

ilk_command_t some_wish(const ilk_axis_config_t* own, const ilk_axis_t* axis) {
  ilk_command_t wish;
  (void)own;
  (void)axis;
  settle_mode();
  return wish;
}

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
  settled_mode = ILK_MODE_LOCKED;
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

/** From any state that passes its check, whatever else of the configuration changed. */
static void show_damaged_configuration(uint32_t count) {
  const uint32_t mode_before = state.mode;
  const uint32_t cause_before = state.cause;
  GIVEN((mode_before < ILK_MODE_COUNT) && (mode_before != ILK_MODE_INIT));
  passes_check = true;
  passes_comparison = false;
  settled_mode = ILK_MODE_LOCKED;
  ilk_step(&config, &state, &in, requests, count, &out);
  SHOW((state.mode == ILK_MODE_LOCKED) &&
           (state.cause == ((mode_before == ILK_MODE_LOCKED) ? cause_before : ILK_CAUSE_INTEGRITY)),
       "P8, P14: LOCKED in that very tick, for INTEGRITY unless locked before");
  SHOW(((state.causes_seen >> ILK_CAUSE_INTEGRITY) & 1u) == 1u, "P8, P14: INTEGRITY is listed");
  SHOW(state.config_sound == 0u, "P13: the configuration is not trusted");
  show_zero_drive();
  GOAL(goal_locked_before, cause_before == ILK_CAUSE_ESTOP);
  GOAL(goal_in_motion, mode_before == ILK_MODE_MOTION);
  GOAL(never_driven_on, state.mode == ILK_MODE_MOTION);
}

static void show_init(uint32_t count) {
  passes_check = true;
  state.mode = ILK_MODE_INIT;
  settled_mode = ILK_MODE_INIT;
  ilk_step(&config, &state, &in, requests, count, &out);
  SHOW(state.mode == ILK_MODE_INIT, "P13: INIT is not left by a step");
  show_zero_drive();
  GOAL(goal_refuses, (out.verdict_count == 16u) && (state.requests_refused == 16u));
  GOAL(never_accepts, (out.verdict_count > 7u) && (out.verdict[7].verdict == ILK_VERDICT_ACCEPTED));
}

void harness(void) {
  uint32_t count;
  uint32_t choice;
  uint32_t compared;
  passes_comparison = compared != 0u;
  __CPROVER_havoc_object(&config);
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
