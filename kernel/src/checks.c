#include <stdbool.h>

#include "arith.h"
#include "interlock/kernel.h"
#include "mode.h"
#include "request.h"

/*@ assigns \nothing;
  @ ensures exact: \result <==> names_axis(kind);
  @*/
static bool names_axis(uint32_t kind) {
  return (kind >= (uint32_t)ILK_REQUEST_DISABLE) && (kind <= (uint32_t)ILK_REQUEST_RESTORE);
}

/** Newer by less than half of the number space; gaps are allowed, repeats and returns are not. */
/*@ assigns \nothing;
  @ ensures exact: \result <==> 0 < (sequence >= last ? sequence - last : sequence - last + 4294967296) <= INT32_MAX;
  @*/
static bool is_newer(uint32_t sequence, uint32_t last) {
  const uint32_t ahead = sequence - last;
  return (ahead != 0u) && (ahead <= (uint32_t)INT32_MAX);
}

/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> state->mode == mode;
  @*/
static bool mode_is(const ilk_state_t *state, ilk_mode_t mode) { return state->mode == (uint32_t)mode; }

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> axis->state == state;
  @*/
static bool axis_is(const ilk_axis_t *axis, ilk_axis_state_t state) { return axis->state == (uint32_t)state; }

/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> state->pedal == ILK_PEDAL_RELEASED;
  @*/
static bool pedal_is_up(const ilk_state_t *state) { return state->pedal == (uint32_t)ILK_PEDAL_RELEASED; }

/** Not driven in the last tick, and the counter did not change since then, as frames of both ticks tell. */
/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> at_rest(axis);
  @*/
static bool is_at_rest(const ilk_axis_t *axis) {
  return (axis->undriven_ticks > 0u) && (axis->ticks_since_frame == 1u) && (axis->delta_counts == 0);
}

/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P8_latch: \result == ILK_VERDICT_ACCEPTED <==> reset_allowed(state);
  @ ensures  mode: \result == ILK_VERDICT_MODE <==> state->mode != ILK_MODE_LOCKED;
  @ ensures  P9_pedal: \result == ILK_VERDICT_PEDAL_DOWN <==>
  @   state->mode == ILK_MODE_LOCKED && state->pedal != ILK_PEDAL_RELEASED;
  @ ensures  verdict: \result == ILK_VERDICT_ACCEPTED || \result == ILK_VERDICT_MODE
  @   || \result == ILK_VERDICT_PEDAL_DOWN || \result == ILK_VERDICT_CAUSE_PRESENT;
  @*/
static ilk_verdict_t check_reset(const ilk_state_t *state) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  if (!mode_is(state, ILK_MODE_LOCKED)) {
    verdict = ILK_VERDICT_MODE;
  } else if (!pedal_is_up(state)) {
    verdict = ILK_VERDICT_PEDAL_DOWN;
  } else if (ilk_cause_is_present(state)) {
    verdict = ILK_VERDICT_CAUSE_PRESENT;
  } else {
    verdict = ILK_VERDICT_ACCEPTED;
  }
  return verdict;
}

/*@ requires readable: \valid_read(state) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  accepted: \result == ILK_VERDICT_ACCEPTED <==> disable_allowed(state, axis);
  @ ensures  mode: \result == ILK_VERDICT_MODE <==> state->mode == ILK_MODE_INIT;
  @ ensures  verdict: \result == ILK_VERDICT_ACCEPTED || \result == ILK_VERDICT_MODE
  @   || \result == ILK_VERDICT_FAULTED;
  @*/
static ilk_verdict_t check_disable(const ilk_state_t *state, const ilk_axis_t *axis) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  if (mode_is(state, ILK_MODE_INIT)) {
    verdict = ILK_VERDICT_MODE;
  } else if (axis_is(axis, ILK_AXIS_FAULTED)) {
    verdict = ILK_VERDICT_FAULTED;
  } else {
    verdict = ILK_VERDICT_ACCEPTED;
  }
  return verdict;
}

/*@ requires readable: \valid_read(state) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  accepted: \result == ILK_VERDICT_ACCEPTED <==> enable_allowed(state, axis);
  @ ensures  mode: \result == ILK_VERDICT_MODE <==>
  @   state->mode != ILK_MODE_READY && state->mode != ILK_MODE_MOTION;
  @ ensures  faulted: \result == ILK_VERDICT_FAULTED <==> axis->state == ILK_AXIS_FAULTED
  @   && (state->mode == ILK_MODE_READY || state->mode == ILK_MODE_MOTION);
  @ ensures  verdict: \result == ILK_VERDICT_ACCEPTED || \result == ILK_VERDICT_MODE
  @   || \result == ILK_VERDICT_FAULTED || \result == ILK_VERDICT_CARD;
  @*/
static ilk_verdict_t check_enable(const ilk_state_t *state, const ilk_axis_t *axis) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  if (!mode_is(state, ILK_MODE_READY) && !mode_is(state, ILK_MODE_MOTION)) {
    verdict = ILK_VERDICT_MODE;
  } else if (axis_is(axis, ILK_AXIS_FAULTED)) {
    verdict = ILK_VERDICT_FAULTED;
  } else if (axis->card_valid == 0u) {
    verdict = ILK_VERDICT_CARD;
  } else {
    verdict = ILK_VERDICT_ACCEPTED;
  }
  return verdict;
}

/*@ requires readable: \valid_read(state) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P8_latch: \result == ILK_VERDICT_ACCEPTED <==> clear_fault_allowed(state, axis);
  @ ensures  mode: \result == ILK_VERDICT_MODE <==> state->mode == ILK_MODE_INIT;
  @ ensures  no_fault: \result == ILK_VERDICT_NO_FAULT <==>
  @   state->mode != ILK_MODE_INIT && axis->state != ILK_AXIS_FAULTED;
  @ ensures  cause_present: \result == ILK_VERDICT_CAUSE_PRESENT <==> state->mode != ILK_MODE_INIT
  @   && axis->state == ILK_AXIS_FAULTED && (axis->card_valid == 0 || axis->fault_tick == state->tick);
  @ ensures  verdict: \result == ILK_VERDICT_ACCEPTED || \result == ILK_VERDICT_MODE
  @   || \result == ILK_VERDICT_NO_FAULT || \result == ILK_VERDICT_CAUSE_PRESENT
  @   || \result == ILK_VERDICT_PEDAL_DOWN;
  @*/
static ilk_verdict_t check_clear_fault(const ilk_state_t *state, const ilk_axis_t *axis) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  if (mode_is(state, ILK_MODE_INIT)) {
    verdict = ILK_VERDICT_MODE;
  } else if (!axis_is(axis, ILK_AXIS_FAULTED)) {
    verdict = ILK_VERDICT_NO_FAULT;
  } else if ((axis->card_valid == 0u) || (axis->fault_tick == state->tick)) {
    verdict = ILK_VERDICT_CAUSE_PRESENT;
  } else if (!pedal_is_up(state)) {
    verdict = ILK_VERDICT_PEDAL_DOWN;
  } else {
    verdict = ILK_VERDICT_ACCEPTED;
  }
  return verdict;
}

/** What MOVE and HOME ask of mode and axis alike. */
/*@ requires readable: \valid_read(state) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  accepted: \result == ILK_VERDICT_ACCEPTED <==> motion_allowed(state, axis);
  @ ensures  mode: \result == ILK_VERDICT_MODE <==> state->mode != ILK_MODE_MOTION;
  @ ensures  faulted: \result == ILK_VERDICT_FAULTED <==>
  @   state->mode == ILK_MODE_MOTION && axis->state == ILK_AXIS_FAULTED;
  @ ensures  disabled: \result == ILK_VERDICT_DISABLED <==>
  @   state->mode == ILK_MODE_MOTION && axis->state == ILK_AXIS_DISABLED;
  @ ensures  verdict: \result == ILK_VERDICT_ACCEPTED || \result == ILK_VERDICT_MODE
  @   || \result == ILK_VERDICT_FAULTED || \result == ILK_VERDICT_DISABLED || \result == ILK_VERDICT_BUSY;
  @*/
static ilk_verdict_t check_may_move(const ilk_state_t *state, const ilk_axis_t *axis) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  if (!mode_is(state, ILK_MODE_MOTION)) {
    verdict = ILK_VERDICT_MODE;
  } else if (axis_is(axis, ILK_AXIS_FAULTED)) {
    verdict = ILK_VERDICT_FAULTED;
  } else if (axis_is(axis, ILK_AXIS_DISABLED)) {
    verdict = ILK_VERDICT_DISABLED;
  } else if (axis_is(axis, ILK_AXIS_HOMING)) {
    verdict = ILK_VERDICT_BUSY;
  } else {
    verdict = ILK_VERDICT_ACCEPTED;
  }
  return verdict;
}

/*@ requires readable: \valid_read(config) && \valid_read(axis) && \valid_read(request);
  @ assigns  \nothing;
  @ ensures  P7_bounds: \result <==> drive_allowed(config, axis, request);
  @*/
static bool drive_is_within(const ilk_axis_config_t *config, const ilk_axis_t *axis,
                            const ilk_request_t *request) {
  const uint32_t bound = (axis->homed != 0u) ? config->max_drive : config->unhomed_max_drive;
  return (request->drive <= bound) && (request->amplitude <= config->max_amplitude);
}

/** A setpoint from which the axis can coast without crossing its soft limit, or its unhomed travel. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P4_soft_limit: \result <==> setpoint_allowed(config, axis, setpoint);
  @*/
static bool setpoint_is_within(const ilk_axis_config_t *config, const ilk_axis_t *axis, int32_t setpoint) {
  const int64_t coast = (int64_t)config->coast_counts;
  int64_t lowest = (int64_t)config->min_counts + coast;
  int64_t highest = (int64_t)config->max_counts - coast;
  if (axis->homed == 0u) {
    const int64_t pressed_at = (int64_t)axis->position_counts - (int64_t)axis->press_travel_counts;
    const int64_t reach = (int64_t)config->unhomed_travel_counts - coast;
    lowest = pressed_at - reach;
    highest = pressed_at + reach;
  }
  return ((int64_t)setpoint >= lowest) && ((int64_t)setpoint <= highest);
}

/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(request);
  @ requires slot: request->axis < ILK_SLOTS;
  @ assigns  \nothing;
  @ ensures  accepted: \result == ILK_VERDICT_ACCEPTED <==> move_allowed(config, state, request);
  @ ensures  lease: \result == ILK_VERDICT_LEASE <==> motion_allowed(state, &state->axis[request->axis])
  @   && !(0 < request->lease_ticks <= config->lease_max_ticks);
  @ ensures  P7_drive: \result == ILK_VERDICT_DRIVE <==> motion_allowed(state, &state->axis[request->axis])
  @   && 0 < request->lease_ticks <= config->lease_max_ticks
  @   && !drive_allowed(&config->axis[request->axis], &state->axis[request->axis], request);
  @ ensures  verdict: \result == ILK_VERDICT_ACCEPTED || \result == ILK_VERDICT_MODE
  @   || \result == ILK_VERDICT_FAULTED || \result == ILK_VERDICT_DISABLED || \result == ILK_VERDICT_BUSY
  @   || \result == ILK_VERDICT_LEASE || \result == ILK_VERDICT_DRIVE || \result == ILK_VERDICT_RANGE;
  @*/
static ilk_verdict_t check_move(const ilk_config_t *config, const ilk_state_t *state,
                                const ilk_request_t *request) {
  const ilk_axis_config_t *axis_config = &config->axis[request->axis];
  const ilk_axis_t *axis = &state->axis[request->axis];
  ilk_verdict_t verdict = check_may_move(state, axis);
  if (verdict != ILK_VERDICT_ACCEPTED) {
    /* The first check that fails is the verdict. */
  } else if ((request->lease_ticks == 0u) || (request->lease_ticks > config->lease_max_ticks)) {
    verdict = ILK_VERDICT_LEASE;
  } else if (!drive_is_within(axis_config, axis, request)) {
    verdict = ILK_VERDICT_DRIVE;
  } else if (!setpoint_is_within(axis_config, axis, request->target_counts)) {
    verdict = ILK_VERDICT_RANGE;
  } else {
    verdict = ILK_VERDICT_ACCEPTED;
  }
  return verdict;
}

/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  accepted: \result == ILK_VERDICT_ACCEPTED <==>
  @   motion_allowed(state, axis) && config->limit_side != ILK_LIMIT_NONE;
  @ ensures  no_switch: \result == ILK_VERDICT_NO_SWITCH <==>
  @   motion_allowed(state, axis) && config->limit_side == ILK_LIMIT_NONE;
  @ ensures  verdict: \result == ILK_VERDICT_ACCEPTED || \result == ILK_VERDICT_MODE
  @   || \result == ILK_VERDICT_FAULTED || \result == ILK_VERDICT_DISABLED || \result == ILK_VERDICT_BUSY
  @   || \result == ILK_VERDICT_NO_SWITCH;
  @*/
static ilk_verdict_t check_home(const ilk_axis_config_t *config, const ilk_state_t *state,
                                const ilk_axis_t *axis) {
  ilk_verdict_t verdict = check_may_move(state, axis);
  if ((verdict == ILK_VERDICT_ACCEPTED) && (config->limit_side == (uint32_t)ILK_LIMIT_NONE)) {
    verdict = ILK_VERDICT_NO_SWITCH;
  }
  return verdict;
}

/** SET_HOME and RESTORE declare where a resting axis stands: nowhere that its soft limits exclude. */
/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P4_soft_limit: \result == ILK_VERDICT_ACCEPTED <==> declare_allowed(config, state, axis, position);
  @ ensures  mode: \result == ILK_VERDICT_MODE <==> state->mode != ILK_MODE_READY;
  @ ensures  pedal: \result == ILK_VERDICT_PEDAL_DOWN <==>
  @   state->mode == ILK_MODE_READY && state->pedal != ILK_PEDAL_RELEASED;
  @ ensures  verdict: \result == ILK_VERDICT_ACCEPTED || \result == ILK_VERDICT_MODE
  @   || \result == ILK_VERDICT_PEDAL_DOWN || \result == ILK_VERDICT_FAULTED || \result == ILK_VERDICT_CARD
  @   || \result == ILK_VERDICT_BUSY || \result == ILK_VERDICT_RANGE;
  @*/
static ilk_verdict_t check_declare(const ilk_axis_config_t *config, const ilk_state_t *state,
                                   const ilk_axis_t *axis, int32_t position) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  if (!mode_is(state, ILK_MODE_READY)) {
    verdict = ILK_VERDICT_MODE;
  } else if (!pedal_is_up(state)) {
    verdict = ILK_VERDICT_PEDAL_DOWN;
  } else if (axis_is(axis, ILK_AXIS_FAULTED)) {
    verdict = ILK_VERDICT_FAULTED;
  } else if (axis->card_valid == 0u) {
    verdict = ILK_VERDICT_CARD;
  } else if (!is_at_rest(axis)) {
    verdict = ILK_VERDICT_BUSY;
  } else if ((position < config->min_counts) || (position > config->max_counts)) {
    verdict = ILK_VERDICT_RANGE;
  } else {
    verdict = ILK_VERDICT_ACCEPTED;
  }
  return verdict;
}

/** The row of the request table, from left to right; UNKNOWN without one, for which no axis was named. */
/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(request);
  @ requires slot: names_axis(request->kind) ==> request->axis < ILK_SLOTS;
  @ assigns  \nothing;
  @ ensures  row: \result == ILK_VERDICT_ACCEPTED <==> acceptable(config, state, request)
  @   && ILK_REQUEST_HEARTBEAT <= request->kind <= ILK_REQUEST_RESTORE;
  @ ensures  verdict: 0 <= \result < ILK_VERDICT_COUNT && \result != ILK_VERDICT_CHECKSUM
  @   && \result != ILK_VERDICT_SEQUENCE && \result != ILK_VERDICT_AXIS;
  @ ensures  unknown: \result == ILK_VERDICT_UNKNOWN <==>
  @   !(ILK_REQUEST_HEARTBEAT <= request->kind <= ILK_REQUEST_RESTORE);
  @*/
static ilk_verdict_t check_row(const ilk_config_t *config, const ilk_state_t *state,
                               const ilk_request_t *request) {
  const uint32_t slot = names_axis(request->kind) ? request->axis : 0u;
  const ilk_axis_config_t *axis_config = &config->axis[slot];
  const ilk_axis_t *axis = &state->axis[slot];
  ilk_verdict_t verdict = ILK_VERDICT_UNKNOWN;
  switch (request->kind) {
    case (uint32_t)ILK_REQUEST_HEARTBEAT:
    case (uint32_t)ILK_REQUEST_STOP:
      verdict = mode_is(state, ILK_MODE_INIT) ? ILK_VERDICT_MODE : ILK_VERDICT_ACCEPTED;
      break;
    case (uint32_t)ILK_REQUEST_RESET:
      verdict = check_reset(state);
      break;
    case (uint32_t)ILK_REQUEST_DISABLE:
      verdict = check_disable(state, axis);
      break;
    case (uint32_t)ILK_REQUEST_ENABLE:
      verdict = check_enable(state, axis);
      break;
    case (uint32_t)ILK_REQUEST_CLEAR_FAULT:
      verdict = check_clear_fault(state, axis);
      break;
    case (uint32_t)ILK_REQUEST_MOVE:
      verdict = check_move(config, state, request);
      break;
    case (uint32_t)ILK_REQUEST_HOME:
      verdict = check_home(axis_config, state, axis);
      break;
    case (uint32_t)ILK_REQUEST_SET_HOME:
      verdict = check_declare(axis_config, state, axis, 0);
      break;
    case (uint32_t)ILK_REQUEST_RESTORE:
      verdict = check_declare(axis_config, state, axis, request->target_counts);
      break;
    default:
      verdict = ILK_VERDICT_UNKNOWN;
      break;
  }
  return verdict;
}

ilk_verdict_t ilk_request_judge(const ilk_config_t *config, const ilk_state_t *state,
                                const ilk_request_t *request) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  if (request->crc != ilk_request_crc(request)) {
    verdict = ILK_VERDICT_CHECKSUM;
  } else if (!is_newer(request->sequence, state->last_sequence)) {
    verdict = ILK_VERDICT_SEQUENCE;
  } else if (names_axis(request->kind) &&
             ((request->axis >= (uint32_t)ILK_SLOTS) || !has_axis(&config->axis[request->axis]))) {
    verdict = ILK_VERDICT_AXIS;
  } else {
    verdict = check_row(config, state, request);
  }
  return verdict;
}
