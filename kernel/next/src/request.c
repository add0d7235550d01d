#include "request.h"

#include <stdbool.h>

#include "arith.h"
#include "axis.h"
#include "gate.h"
#include "homing.h"
#include "interlock/kernel.h"
#include "mode.h"

/** The first check that fails is the verdict. */
static ilk_verdict_t then(ilk_verdict_t verdict, bool holds, ilk_verdict_t otherwise) {
  return ((verdict == ILK_VERDICT_ACCEPTED) && !holds) ? otherwise : verdict;
}

static bool mode_is(const ilk_system_t *system, ilk_mode_t mode) { return system->mode == (uint32_t)mode; }

static bool axis_is(const ilk_axis_t *axis, ilk_axis_state_t state) { return axis->state == (uint32_t)state; }

static bool pedal_is_up(const ilk_system_t *system) { return system->pedal == (uint32_t)ILK_PEDAL_RELEASED; }

static ilk_verdict_t check_reset(const ilk_state_t *state) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  verdict = then(verdict, mode_is(&state->system, ILK_MODE_LOCKED), ILK_VERDICT_MODE);
  verdict = then(verdict, pedal_is_up(&state->system), ILK_VERDICT_PEDAL_DOWN);
  verdict = then(verdict, !ilk_cause_is_present(state), ILK_VERDICT_CAUSE_PRESENT);
  return verdict;
}

static ilk_verdict_t check_enable(const ilk_config_t *config, const ilk_axis_config_t *axis_config,
                                  const ilk_system_t *system, const ilk_axis_t *axis) {
  const bool ready = (system->powered_ticks >= config->common.power_up_ticks) &&
                     ilk_axis_is_at_rest(axis_config, axis);
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  verdict = then(verdict, ilk_power_is_on(system), ILK_VERDICT_MODE);
  verdict = then(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
  verdict = then(verdict, axis->card_valid != 0u, ILK_VERDICT_CARD);
  verdict = then(verdict, ready || !axis_is(axis, ILK_AXIS_DISABLED), ILK_VERDICT_BUSY);
  return verdict;
}

static ilk_verdict_t check_clear_fault(const ilk_axis_config_t *axis_config, const ilk_system_t *system,
                                       const ilk_axis_t *axis) {
  const bool gone = (axis->card_valid != 0u) && (axis->fault_tick != system->tick) &&
                    ilk_axis_is_at_rest(axis_config, axis);
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  verdict = then(verdict, axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_NO_FAULT);
  verdict = then(verdict, gone, ILK_VERDICT_CAUSE_PRESENT);
  verdict = then(verdict, pedal_is_up(system), ILK_VERDICT_PEDAL_DOWN);
  return verdict;
}

/** What MOVE and HOME ask of mode and axis alike. */
static ilk_verdict_t check_may_move(const ilk_system_t *system, const ilk_axis_t *axis,
                                    const ilk_request_t *request) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  verdict = then(verdict, mode_is(system, ILK_MODE_MOTION), ILK_VERDICT_MODE);
  verdict = then(verdict, request->consent == system->consent, ILK_VERDICT_CONSENT);
  verdict = then(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
  verdict = then(verdict, !axis_is(axis, ILK_AXIS_DISABLED), ILK_VERDICT_DISABLED);
  verdict = then(verdict, !axis_is(axis, ILK_AXIS_HOMING), ILK_VERDICT_BUSY);
  return verdict;
}

static bool drive_is_within(const ilk_axis_config_t *config, const ilk_axis_t *axis, const ilk_request_t *request) {
  const uint32_t bound =
      (axis->homed != (uint32_t)ILK_HOMED_NOT) ? config->max_drive : config->unhomed_max_drive;
  return (request->drive != 0u) && (request->drive <= bound) && (request->amplitude <= config->max_amplitude);
}

/** Towards a switch that is steadily triggered: it could not be reached. */
static bool lies_behind_switch(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                               const ilk_axis_t *axis, int64_t distance) {
  const bool towards = (distance > 0) ? (config->limit_side == (uint32_t)ILK_LIMIT_UPPER)
                                      : ((distance < 0) && (config->limit_side == (uint32_t)ILK_LIMIT_LOWER));
  return towards && ilk_switch_is_steady(common, axis, true);
}

static bool setpoint_is_within(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                               const ilk_axis_t *axis, int32_t setpoint) {
  const int64_t distance = (int64_t)setpoint - (int64_t)axis->position_counts;
  const int64_t left = (int64_t)ilk_unhomed_travel_left(config, axis);
  const ilk_reach_t reach = ilk_reach(config, axis);
  bool within = (distance >= -left) && (distance <= left);
  if (axis->homed != (uint32_t)ILK_HOMED_NOT) {
    within = ((int64_t)setpoint >= reach.low) && ((int64_t)setpoint <= reach.high);
  }
  return within && !lies_behind_switch(common, config, axis, distance);
}

static ilk_verdict_t check_move(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                                const ilk_system_t *system, const ilk_axis_t *axis, const ilk_request_t *request) {
  ilk_verdict_t verdict = check_may_move(system, axis, request);
  verdict = then(verdict, (request->lease_ticks != 0u) && (request->lease_ticks <= common->lease_max_ticks),
                 ILK_VERDICT_LEASE);
  verdict = then(verdict, drive_is_within(config, axis, request), ILK_VERDICT_DRIVE);
  verdict = then(verdict, setpoint_is_within(common, config, axis, request->target_counts), ILK_VERDICT_RANGE);
  return verdict;
}

static ilk_verdict_t check_home(const ilk_axis_config_t *config, const ilk_system_t *system,
                                const ilk_axis_t *axis, const ilk_request_t *request) {
  const bool budget_left =
      (ilk_homing_travel_left(config, axis) != 0u) && (axis->homing_ticks < config->home_timeout_ticks);
  ilk_verdict_t verdict = check_may_move(system, axis, request);
  verdict = then(verdict, has_switch(config), ILK_VERDICT_NO_SWITCH);
  verdict = then(verdict, budget_left, ILK_VERDICT_BUDGET);
  return verdict;
}

/** SET_HOME and RESTORE declare where a resting axis stands. */
static ilk_verdict_t check_declare(const ilk_axis_config_t *config, const ilk_system_t *system,
                                   const ilk_axis_t *axis) {
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  verdict = then(verdict, mode_is(system, ILK_MODE_READY), ILK_VERDICT_MODE);
  verdict = then(verdict, pedal_is_up(system), ILK_VERDICT_PEDAL_DOWN);
  verdict = then(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
  verdict = then(verdict, axis->card_valid != 0u, ILK_VERDICT_CARD);
  verdict = then(verdict, ilk_axis_is_at_rest(config, axis), ILK_VERDICT_BUSY);
  return verdict;
}

/** The rows of the table that name an axis. */
static ilk_verdict_t judge_axis(const ilk_config_t *config, const ilk_axis_config_t *axis_config,
                                const ilk_system_t *system, const ilk_axis_t *axis, const ilk_request_t *request) {
  ilk_verdict_t verdict = mode_is(system, ILK_MODE_INIT) ? ILK_VERDICT_MODE : ILK_VERDICT_ACCEPTED;
  if (verdict == ILK_VERDICT_ACCEPTED) {
    switch (request->kind) {
      case (uint32_t)ILK_REQUEST_DISABLE:
        verdict = then(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
        break;
      case (uint32_t)ILK_REQUEST_ENABLE:
        verdict = check_enable(config, axis_config, system, axis);
        break;
      case (uint32_t)ILK_REQUEST_CLEAR_FAULT:
        verdict = check_clear_fault(axis_config, system, axis);
        break;
      case (uint32_t)ILK_REQUEST_MOVE:
        verdict = check_move(&config->common, axis_config, system, axis, request);
        break;
      case (uint32_t)ILK_REQUEST_HOME:
        verdict = check_home(axis_config, system, axis, request);
        break;
      case (uint32_t)ILK_REQUEST_RESTORE:
        verdict = check_declare(axis_config, system, axis);
        verdict = then(verdict,
                       (request->target_counts >= axis_config->min_counts) &&
                           (request->target_counts <= axis_config->max_counts),
                       ILK_VERDICT_RANGE);
        break;
      default: /* SET_HOME */
        verdict = check_declare(axis_config, system, axis);
        break;
    }
  }
  return verdict;
}

static void declare_position(ilk_axis_t *axis, int32_t position_counts, ilk_homed_t homed) {
  axis->position_counts = position_counts;
  axis->homed = (uint32_t)homed;
}

static void carry_out_axis(const ilk_request_t *request, ilk_axis_t *axis) {
  switch (request->kind) {
    case (uint32_t)ILK_REQUEST_DISABLE:
      ilk_axis_disable(axis);
      break;
    case (uint32_t)ILK_REQUEST_ENABLE:
      ilk_axis_enable(axis);
      break;
    case (uint32_t)ILK_REQUEST_CLEAR_FAULT:
      ilk_axis_clear_fault(axis);
      break;
    case (uint32_t)ILK_REQUEST_MOVE:
      axis->state = (uint32_t)ILK_AXIS_MOVING;
      axis->setpoint_counts = request->target_counts;
      axis->drive = request->drive;
      axis->amplitude = request->amplitude;
      axis->lease_ticks = request->lease_ticks;
      break;
    case (uint32_t)ILK_REQUEST_HOME:
      ilk_homing_begin(axis);
      break;
    case (uint32_t)ILK_REQUEST_RESTORE:
      declare_position(axis, request->target_counts, ILK_HOMED_NOT);
      break;
    default: /* SET_HOME */
      declare_position(axis, 0, ILK_HOMED_BY_HAND);
      break;
  }
}

/** A new holder finds no consent and no motion. */
static void follow_heartbeat(uint32_t holder, ilk_state_t *state) {
  state->system.app_age_ticks = 0u;
  if (state->system.holder != holder) {
    state->system.holder = holder;
    ilk_pedal_disarm(&state->system);
    if (mode_is(&state->system, ILK_MODE_MOTION)) {
      ilk_mode_enter(ILK_MODE_READY, 0u, state);
    }
  }
}

static void carry_out_stop(ilk_state_t *state) {
  if (mode_is(&state->system, ILK_MODE_MOTION)) {
    ilk_mode_enter(ILK_MODE_READY, 0u, state);
  }
  ilk_pedal_disarm(&state->system);
}

static void carry_out_reset(ilk_state_t *state) {
  state->system.cause = (uint32_t)ILK_CAUSE_NONE;
  state->system.cause_tick = 0u;
  state->system.cause_value = 0u;
  state->system.causes_seen = 0u;
  ilk_mode_enter(ILK_MODE_READY, 0u, state);
}

/** Requests of the app as a whole. */
static ilk_verdict_t take_system(const ilk_request_t *request, ilk_state_t *state) {
  ilk_verdict_t verdict = mode_is(&state->system, ILK_MODE_INIT) ? ILK_VERDICT_MODE : ILK_VERDICT_ACCEPTED;
  if (request->kind == (uint32_t)ILK_REQUEST_RESET) {
    verdict = check_reset(state);
  }
  if (verdict != ILK_VERDICT_ACCEPTED) {
    /* Refused: nothing changes. */
  } else if (request->kind == (uint32_t)ILK_REQUEST_HEARTBEAT) {
    follow_heartbeat(request->holder, state);
  } else if (request->kind == (uint32_t)ILK_REQUEST_STOP) {
    carry_out_stop(state);
  } else {
    carry_out_reset(state);
  }
  return verdict;
}

static ilk_verdict_t take_axis(const ilk_config_t *config, const ilk_request_t *request, ilk_state_t *state) {
  ilk_verdict_t verdict = ILK_VERDICT_AXIS;
  if ((request->axis < (uint32_t)ILK_SLOTS) && has_axis(&config->axis[request->axis])) {
    ilk_axis_t *axis = &state->axis[request->axis];
    verdict = judge_axis(config, &config->axis[request->axis], &state->system, axis, request);
    if (verdict == ILK_VERDICT_ACCEPTED) {
      carry_out_axis(request, axis);
    }
  }
  return verdict;
}

/** Newer by less than half of the number space; gaps are allowed, repeats and returns are not. */
static bool is_newer(uint32_t sequence, uint32_t last) {
  const uint32_t ahead = sequence - last;
  return (ahead != 0u) && (ahead <= (uint32_t)INT32_MAX);
}

/** A request that is intact and in order uses its number up, whatever the verdict. */
static ilk_verdict_t take(const ilk_config_t *config, const ilk_request_t *request, ilk_state_t *state) {
  ilk_verdict_t verdict = ILK_VERDICT_UNKNOWN;
  if (request->crc != ilk_request_crc(request)) {
    verdict = ILK_VERDICT_CHECKSUM;
  } else if (!is_newer(request->sequence, state->system.last_sequence)) {
    verdict = ILK_VERDICT_SEQUENCE;
  } else {
    state->system.last_sequence = request->sequence;
    if ((request->kind >= (uint32_t)ILK_REQUEST_HEARTBEAT) && (request->kind <= (uint32_t)ILK_REQUEST_RESET)) {
      verdict = take_system(request, state);
    } else if ((request->kind >= (uint32_t)ILK_REQUEST_DISABLE) &&
               (request->kind <= (uint32_t)ILK_REQUEST_RESTORE)) {
      verdict = take_axis(config, request, state);
    } else {
      verdict = ILK_VERDICT_UNKNOWN;
    }
  }
  return verdict;
}

ilk_verdict_record_t ilk_request_take(const ilk_config_t *config, const ilk_request_t *request, ilk_state_t *state) {
  const ilk_verdict_record_t record = {.tick = state->system.tick,
                                       .sequence = request->sequence,
                                       .kind = request->kind,
                                       .axis = request->axis,
                                       .verdict = (uint32_t)take(config, request, state)};
  if (record.verdict == (uint32_t)ILK_VERDICT_ACCEPTED) {
    state->system.requests_accepted = count_up(state->system.requests_accepted, UINT32_MAX);
  } else {
    state->system.requests_refused = count_up(state->system.requests_refused, UINT32_MAX);
  }
  return record;
}
