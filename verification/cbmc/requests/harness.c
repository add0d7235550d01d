/**
 * @file
 * One request (phase 6), of any bits, for any slot: its verdict by the table of kernel.md, and what an
 * accepted one does to the words of the system. What it does to the axis that it names is in `axis_requests`.
 */
#include "axis_effects.h"
#include "proof.h"
#include "request.c"
#include "request_table.h"
#include "sound.h"

static uint32_t right_crc;

/** Modes entered, and axes acted upon. */
static struct {
  uint32_t entries;
  uint32_t actions;
  const ilk_axis_config_t* config;
  const ilk_axis_t* axis;
  const ilk_request_t* request;
} seen;

/** Stands for `ilk_mode_enter`: what it does to the words of the system. */
void some_entry(ilk_state_t* state, ilk_mode_t mode) {
  state->mode = (uint32_t)mode;
  state->pedal_armed = 0u;
  state->pedal_pressed_ticks = 0u;
  state->pedal_released_ticks = 0u;
  seen.entries++;
}

/** Stands for `apply_to_axis`: only that it is called, and with what. */
void some_action(const ilk_axis_config_t* config, ilk_axis_t* axis, const ilk_request_t* request) {
  seen.config = config;
  seen.axis = axis;
  seen.request = request;
  seen.actions++;
}

/** Stands for `ilk_request_crc`: whatever word the CRC of this one request is. */
uint32_t some_request_crc(const ilk_request_t* request) {
  (void)request;
  return right_crc;
}

static uint32_t expected_verdict(const ilk_config_t* config, const ilk_state_t* state,
                                 const ilk_request_t* request) {
  const int64_t apart = (int64_t)request->sequence - state->last_sequence;
  const int64_t ahead = (apart < 0) ? (apart + ((int64_t)1 << 32)) : apart;
  CHECK(request->crc == right_crc, CHECKSUM);
  CHECK(between(ahead, 1, INT32_MAX), SEQUENCE);
  CHECK(between(request->kind, 1, ILK_REQUEST_COUNT), UNKNOWN);
  if (!names_slot(request)) {
    return check_system(state, request);
  }
  CHECK(request->axis < ILK_SLOTS, AXIS);
  const ilk_axis_config_t limits = config->axis[request->axis];
  const ilk_axis_t axis = state->axis[request->axis];
  CHECK(is_motor_card(limits.card), AXIS);
  return check_axis(config, &limits, state, &axis, request);
}

/** The words of the system after an accepted request. */
static void expect_system(ilk_state_t* state, const ilk_request_t* request) {
  const bool changes_holder = (request->kind == ILK_REQUEST_HEARTBEAT) && (request->holder != state->holder);
  const bool stops = changes_holder || (request->kind == ILK_REQUEST_STOP);
  const bool resets = request->kind == ILK_REQUEST_RESET;
  const bool enters_ready = resets || (stops && (state->mode == ILK_MODE_MOTION));
  if (request->kind == ILK_REQUEST_HEARTBEAT) {
    state->app_age_ticks = 0u;
    state->holder = request->holder;
  }
  if (resets) {
    state->cause = ILK_CAUSE_NONE;
    state->cause_tick = 0u;
    state->cause_value = 0u;
    state->causes_seen = 0u;
  }
  if (enters_ready) {
    state->mode = ILK_MODE_READY;
  }
  if (enters_ready || changes_holder) {
    state->pedal_armed = 0u;
    state->pedal_pressed_ticks = 0u;
    state->pedal_released_ticks = 0u;
  }
}

static void show_accepted(const ilk_config_t* config, ilk_state_t* state, const ilk_request_t* request) {
  const ilk_state_t before = *state;
  ilk_state_t wanted = before;
  expect_system(&wanted, request);
  ilk_request_apply(config, state, request);
  show_same_system(state, &wanted);
  SHOW(!sound_system(&before) || sound_system(state), "P15: the invariant is kept");
  SHOW((before.mode != ILK_MODE_LOCKED) || (state->mode == ILK_MODE_LOCKED) ||
           (request->kind == ILK_REQUEST_RESET),
       "P8: LOCKED is left only by RESET");
  SHOW((before.mode == ILK_MODE_MOTION) || (state->mode != ILK_MODE_MOTION), "P9: no request enters MOTION");
  SHOW((before.holder == state->holder) || ((state->pedal_armed == 0u) && (state->mode != ILK_MODE_MOTION)),
       "P9: a change of holder withdraws consent and ends MOTION");
  SHOW(seen.entries == ((state->mode != before.mode) ? 1u : 0u), "P12: a mode is entered when it changes");
  SHOW(seen.actions == (names_slot(request) ? 1u : 0u), "P11: an axis is acted upon when it is named");
  SHOW(!names_slot(request) || ((seen.config == &config->axis[request->axis]) &&
                                (seen.axis == &state->axis[request->axis]) && (seen.request == request)),
       "P11: and no other");
  GOAL(goal_new_holder_ends_motion,
       (request->kind == ILK_REQUEST_HEARTBEAT) && (before.mode == ILK_MODE_MOTION) && (seen.entries == 1u));
  GOAL(goal_new_holder_disarms, (before.mode == ILK_MODE_READY) && (before.pedal_armed == 1u) &&
                                    (request->kind == ILK_REQUEST_HEARTBEAT) && (state->pedal_armed == 0u));
  GOAL(goal_same_holder, (request->kind == ILK_REQUEST_HEARTBEAT) && (state->mode == ILK_MODE_MOTION));
  GOAL(goal_stop, (request->kind == ILK_REQUEST_STOP) && (seen.entries == 1u));
  GOAL(goal_reset, (request->kind == ILK_REQUEST_RESET) && (before.cause == ILK_CAUSE_ESTOP));
  GOAL(goal_axis, (seen.actions == 1u) && (request->axis == 9u) && (request->kind == ILK_REQUEST_RESTORE));
  GOAL(never_reset_with_the_pedal_down,
       (request->kind == ILK_REQUEST_RESET) && (before.pedal != ILK_PEDAL_RELEASED));
}

void harness(void) {
  ilk_config_t config;
  ilk_state_t state;
  ilk_request_t request;
  uint32_t crc;
  right_crc = crc;
  const uint32_t slot = (request.axis < ILK_SLOTS) ? request.axis : 0u;
  const ilk_axis_t observed = state.axis[slot];
  /* Phase 4 leaves no axis with a valid frame driven: proof `observe_axis`. */
  GIVEN((observed.card_valid == 0u) || (observed.driven_direction == ILK_DIRECTION_NONE));

  const uint32_t expected = expected_verdict(&config, &state, &request);
  const uint32_t verdict = (uint32_t)ilk_request_judge(&config, &state, &request);
  SHOW(verdict == expected, "P11: the first check of the table that fails is the verdict");
  SHOW(verdict < ILK_VERDICT_COUNT, "P11, P15: one verdict, whatever the request");
  GOAL(goal_checksum, verdict == ILK_VERDICT_CHECKSUM);
  GOAL(goal_sequence_returns, (verdict == ILK_VERDICT_SEQUENCE) && (request.sequence > state.last_sequence));
  GOAL(goal_no_motor, (verdict == ILK_VERDICT_AXIS) && (request.axis == 3u));
  GOAL(goal_no_slot, (verdict == ILK_VERDICT_AXIS) && (request.axis == 77u));
  GOAL(goal_unknown, (verdict == ILK_VERDICT_UNKNOWN) && (request.axis == 77u));
  GOAL(goal_mode, verdict == ILK_VERDICT_MODE);
  GOAL(goal_pedal_down, verdict == ILK_VERDICT_PEDAL_DOWN);
  GOAL(goal_cause_present,
       (verdict == ILK_VERDICT_CAUSE_PRESENT) && (request.kind == ILK_REQUEST_CLEAR_FAULT));
  GOAL(goal_faulted, verdict == ILK_VERDICT_FAULTED);
  GOAL(goal_card, verdict == ILK_VERDICT_CARD);
  GOAL(goal_no_fault, verdict == ILK_VERDICT_NO_FAULT);
  GOAL(goal_disabled, verdict == ILK_VERDICT_DISABLED);
  GOAL(goal_busy, (verdict == ILK_VERDICT_BUSY) && (request.kind == ILK_REQUEST_SET_HOME));
  GOAL(goal_lease, verdict == ILK_VERDICT_LEASE);
  GOAL(goal_drive, verdict == ILK_VERDICT_DRIVE);
  GOAL(goal_range, (verdict == ILK_VERDICT_RANGE) && (request.kind == ILK_REQUEST_MOVE));
  GOAL(goal_no_switch, verdict == ILK_VERDICT_NO_SWITCH);
  GOAL(never_accepted_with_a_wrong_crc, (verdict == ILK_VERDICT_ACCEPTED) && (request.crc != right_crc));
  GOAL(never_moved_outside_motion, (verdict == ILK_VERDICT_ACCEPTED) && (request.kind == ILK_REQUEST_MOVE) &&
                                       (state.mode != ILK_MODE_MOTION));
  if (verdict == ILK_VERDICT_ACCEPTED) {
    show_accepted(&config, &state, &request);
  }
}
