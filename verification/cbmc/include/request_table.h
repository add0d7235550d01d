/**
 * @file
 * The table of requests, from kernel.md ("Requests"): the first check of a row that fails is the verdict.
 */
#ifndef ILK_PROOF_REQUEST_TABLE_H
#define ILK_PROOF_REQUEST_TABLE_H

#include "interlock/types.h"
#include "valid.h"

#define CHECK(holds, reason)       \
  do {                             \
    if (!(holds)) {                \
      return ILK_VERDICT_##reason; \
    }                              \
  } while (false)

/** The right half of the row MOVE. */
static uint32_t check_bounds(const ilk_config_t* config, const ilk_axis_config_t* limits,
                             const ilk_axis_t* axis, const ilk_request_t* request) {
  const bool homed = axis->homed != 0u;
  const int64_t target = request->target_counts;
  const int64_t coast = limits->coast_counts;
  const int64_t pressed_at = (int64_t)axis->position_counts - axis->press_travel_counts;
  const int64_t reach = (int64_t)limits->unhomed_travel_counts - coast;
  CHECK(between(request->lease_ticks, 1, config->lease_max_ticks), LEASE);
  CHECK(request->drive <= (homed ? limits->max_drive : limits->unhomed_max_drive), DRIVE);
  CHECK(request->amplitude <= limits->max_amplitude, DRIVE);
  CHECK(!homed || between(target, limits->min_counts + coast, limits->max_counts - coast), RANGE);
  CHECK(homed || between(target - pressed_at, -reach, reach), RANGE);
  return ILK_VERDICT_ACCEPTED;
}

/** MOVE and HOME. */
static uint32_t check_motion(const ilk_config_t* config, const ilk_axis_config_t* limits,
                             const ilk_state_t* state, const ilk_axis_t* axis, const ilk_request_t* request) {
  CHECK(state->mode == ILK_MODE_MOTION, MODE);
  CHECK(axis->state != ILK_AXIS_FAULTED, FAULTED);
  CHECK(axis->state != ILK_AXIS_DISABLED, DISABLED);
  CHECK(axis->state != ILK_AXIS_HOMING, BUSY);
  if (request->kind == ILK_REQUEST_MOVE) {
    return check_bounds(config, limits, axis, request);
  }
  CHECK(limits->limit_side != ILK_LIMIT_NONE, NO_SWITCH);
  return ILK_VERDICT_ACCEPTED;
}

/** SET_HOME and RESTORE: nowhere outside of the soft limits. */
static uint32_t check_declaration(const ilk_axis_config_t* limits, const ilk_state_t* state,
                                  const ilk_axis_t* axis, const ilk_request_t* request) {
  const int32_t position = (request->kind == ILK_REQUEST_RESTORE) ? request->target_counts : 0;
  CHECK(state->mode == ILK_MODE_READY, MODE);
  CHECK(state->pedal == ILK_PEDAL_RELEASED, PEDAL_DOWN);
  CHECK(axis->state != ILK_AXIS_FAULTED, FAULTED);
  CHECK(axis->card_valid != 0u, CARD);
  CHECK((axis->undriven_ticks > 0u) && (axis->ticks_since_frame == 1u) && (axis->delta_counts == 0), BUSY);
  CHECK(between(position, limits->min_counts, limits->max_counts), RANGE);
  return ILK_VERDICT_ACCEPTED;
}

/** A request that names this axis. */
static uint32_t check_axis(const ilk_config_t* config, const ilk_axis_config_t* limits,
                           const ilk_state_t* state, const ilk_axis_t* axis, const ilk_request_t* request) {
  switch (request->kind) {
    case ILK_REQUEST_DISABLE:
      CHECK(state->mode != ILK_MODE_INIT, MODE);
      CHECK(axis->state != ILK_AXIS_FAULTED, FAULTED);
      return ILK_VERDICT_ACCEPTED;
    case ILK_REQUEST_ENABLE:
      CHECK((state->mode == ILK_MODE_READY) || (state->mode == ILK_MODE_MOTION), MODE);
      CHECK(axis->state != ILK_AXIS_FAULTED, FAULTED);
      CHECK(axis->card_valid != 0u, CARD);
      return ILK_VERDICT_ACCEPTED;
    case ILK_REQUEST_CLEAR_FAULT:
      CHECK(state->mode != ILK_MODE_INIT, MODE);
      CHECK(axis->state == ILK_AXIS_FAULTED, NO_FAULT);
      CHECK((axis->card_valid != 0u) && (axis->fault_tick != state->tick), CAUSE_PRESENT);
      CHECK(state->pedal == ILK_PEDAL_RELEASED, PEDAL_DOWN);
      return ILK_VERDICT_ACCEPTED;
    case ILK_REQUEST_MOVE:
    case ILK_REQUEST_HOME:
      return check_motion(config, limits, state, axis, request);
    default:
      return check_declaration(limits, state, axis, request);
  }
}

/** A request that names no axis. */
static uint32_t check_system(const ilk_state_t* state, const ilk_request_t* request) {
  if (request->kind == ILK_REQUEST_RESET) {
    CHECK(state->mode == ILK_MODE_LOCKED, MODE);
    CHECK(state->pedal == ILK_PEDAL_RELEASED, PEDAL_DOWN);
    CHECK((state->estop == 0u) && (state->config_sound != 0u) && (state->overruns_in_row == 0u),
          CAUSE_PRESENT);
    CHECK((state->app_alive != 0u) && (state->bus_bad_ticks == 0u), CAUSE_PRESENT);
    return ILK_VERDICT_ACCEPTED;
  }
  CHECK(state->mode != ILK_MODE_INIT, MODE);
  return ILK_VERDICT_ACCEPTED;
}

static bool names_slot(const ilk_request_t* request) { return request->kind >= ILK_REQUEST_DISABLE; }

#endif
