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

static bool drive_is_within(const ilk_axis_config_t *config, const ilk_axis_t *axis,
                            const ilk_request_t *request) {
  return (request->drive != 0u) && (request->drive <= ilk_drive_bound(config, axis)) &&
         (request->amplitude <= config->max_amplitude);
}

/** Of an axis that is homed by its soft limits, else by what is left of its travel; never behind a steady
 * switch. */
static bool setpoint_is_within(const ilk_config_t *config, const ilk_axis_config_t *axis_config,
                               const ilk_axis_t *axis, int32_t setpoint) {
  const int64_t distance = (int64_t)setpoint - (int64_t)axis->position_counts;
  const int64_t left = (int64_t)ilk_unhomed_travel_left(axis_config, axis);
  const ilk_reach_t reach = ilk_reach(axis_config, axis);
  const bool towards = ((distance > 0) && (axis_config->limit_side == (uint32_t)ILK_LIMIT_UPPER)) ||
                       ((distance < 0) && (axis_config->limit_side == (uint32_t)ILK_LIMIT_LOWER));
  const bool reachable = (axis->homed != (uint32_t)ILK_HOMED_NOT)
                             ? (((int64_t)setpoint >= reach.low) && ((int64_t)setpoint <= reach.high))
                             : ((distance >= -left) && (distance <= left));
  const bool behind = towards && ilk_switch_is_steady(&config->common, axis, true);
  return reachable && !behind;
}

/** What MOVE and HOME ask alike. */
static ilk_verdict_t check_may_move(const ilk_system_t *system, const ilk_axis_t *axis, uint32_t consent) {
  ilk_verdict_t verdict = then(ILK_VERDICT_ACCEPTED, mode_is(system, ILK_MODE_MOTION), ILK_VERDICT_MODE);
  verdict = then(verdict, consent == system->consent, ILK_VERDICT_CONSENT);
  verdict = then(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
  verdict = then(verdict, !axis_is(axis, ILK_AXIS_DISABLED), ILK_VERDICT_DISABLED);
  return then(verdict, !axis_is(axis, ILK_AXIS_HOMING), ILK_VERDICT_BUSY);
}

/** What SET_HOME and RESTORE ask alike: they say where a resting axis stands. */
static ilk_verdict_t check_may_declare(const ilk_system_t *system, const ilk_axis_t *axis, bool at_rest) {
  ilk_verdict_t verdict = then(ILK_VERDICT_ACCEPTED, mode_is(system, ILK_MODE_READY), ILK_VERDICT_MODE);
  verdict = then(verdict, pedal_is_up(system), ILK_VERDICT_PEDAL_DOWN);
  verdict = then(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
  verdict = then(verdict, axis->card_valid != 0u, ILK_VERDICT_CARD);
  return then(verdict, at_rest, ILK_VERDICT_BUSY);
}

/** The rows of the table that name an axis, INIT apart. */
static ilk_verdict_t check_axis(const ilk_config_t *config, const ilk_axis_config_t *axis_config,
                                const ilk_system_t *system, const ilk_axis_t *axis,
                                const ilk_request_t *request) {
  const bool at_rest = ilk_axis_is_at_rest(axis_config, axis);
  const bool powered = system->powered_ticks >= config->common.power_up_ticks;
  const bool card = axis->card_valid != 0u;
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  switch (request->kind) {
    case (uint32_t)ILK_REQUEST_DISABLE:
      verdict = then(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
      break;
    case (uint32_t)ILK_REQUEST_ENABLE:
      verdict = then(verdict, ilk_power_is_on(system), ILK_VERDICT_MODE);
      verdict = then(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
      verdict = then(verdict, card, ILK_VERDICT_CARD);
      verdict = then(verdict, (powered && at_rest) || !axis_is(axis, ILK_AXIS_DISABLED), ILK_VERDICT_BUSY);
      break;
    case (uint32_t)ILK_REQUEST_CLEAR_FAULT:
      verdict = then(verdict, axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_NO_FAULT);
      verdict = then(verdict, at_rest && (axis->fault_tick != system->tick), ILK_VERDICT_CAUSE_PRESENT);
      verdict = then(verdict, pedal_is_up(system), ILK_VERDICT_PEDAL_DOWN);
      break;
    case (uint32_t)ILK_REQUEST_MOVE:
      verdict = check_may_move(system, axis, request->consent);
      verdict =
          then(verdict, count_of(request->lease_ticks, config->common.lease_max_ticks), ILK_VERDICT_LEASE);
      verdict = then(verdict, drive_is_within(axis_config, axis, request), ILK_VERDICT_DRIVE);
      verdict = then(verdict, setpoint_is_within(config, axis_config, axis, request->target_counts),
                     ILK_VERDICT_RANGE);
      break;
    case (uint32_t)ILK_REQUEST_HOME:
      verdict = check_may_move(system, axis, request->consent);
      verdict = then(verdict, has_switch(axis_config), ILK_VERDICT_NO_SWITCH);
      verdict = then(verdict, ilk_homing_has_budget(axis_config, axis), ILK_VERDICT_BUDGET);
      break;
    case (uint32_t)ILK_REQUEST_RESTORE:
      verdict = check_may_declare(system, axis, at_rest);
      verdict = then(verdict, request->target_counts >= axis_config->min_counts, ILK_VERDICT_RANGE);
      verdict = then(verdict, request->target_counts <= axis_config->max_counts, ILK_VERDICT_RANGE);
      break;
    default: /* SET_HOME */
      verdict = check_may_declare(system, axis, at_rest);
      break;
  }
  return verdict;
}

static void carry_out(const ilk_request_t *request, ilk_axis_t *axis) {
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
      axis->position_counts = request->target_counts;
      axis->homed = (uint32_t)ILK_HOMED_NOT;
      break;
    default: /* SET_HOME */
      axis->position_counts = 0;
      axis->homed = (uint32_t)ILK_HOMED_BY_HAND;
      break;
  }
}

static ilk_verdict_t take_axis(const ilk_config_t *config, const ilk_request_t *request, ilk_state_t *state) {
  ilk_verdict_t verdict = ILK_VERDICT_AXIS;
  if ((request->axis < (uint32_t)ILK_SLOTS) && has_axis(&config->axis[request->axis])) {
    ilk_axis_t *axis = &state->axis[request->axis];
    verdict = then(ILK_VERDICT_ACCEPTED, !mode_is(&state->system, ILK_MODE_INIT), ILK_VERDICT_MODE);
    if (verdict == ILK_VERDICT_ACCEPTED) {
      verdict = check_axis(config, &config->axis[request->axis], &state->system, axis, request);
    }
    if (verdict == ILK_VERDICT_ACCEPTED) {
      carry_out(request, axis);
    }
  }
  return verdict;
}

static void end_motion(ilk_state_t *state) {
  if (mode_is(&state->system, ILK_MODE_MOTION)) {
    ilk_mode_enter(ILK_MODE_READY, 0u, state);
  }
  ilk_pedal_disarm(&state->system);
}

/** Requests to the robot as a whole. A new holder finds no consent and no motion. */
static ilk_verdict_t take_system(const ilk_request_t *request, ilk_state_t *state) {
  ilk_system_t *system = &state->system;
  ilk_verdict_t verdict = then(ILK_VERDICT_ACCEPTED, !mode_is(system, ILK_MODE_INIT), ILK_VERDICT_MODE);
  if (request->kind == (uint32_t)ILK_REQUEST_RESET) {
    verdict = then(verdict, mode_is(system, ILK_MODE_LOCKED), ILK_VERDICT_MODE);
    verdict = then(verdict, pedal_is_up(system), ILK_VERDICT_PEDAL_DOWN);
    verdict = then(verdict, !ilk_cause_is_present(state), ILK_VERDICT_CAUSE_PRESENT);
  }
  if (verdict == ILK_VERDICT_ACCEPTED) {
    if (request->kind == (uint32_t)ILK_REQUEST_RESET) {
      ilk_mode_unlock(state);
    } else if (request->kind == (uint32_t)ILK_REQUEST_STOP) {
      end_motion(state);
    } else { /* HEARTBEAT */
      system->app_age_ticks = 0u;
      if (system->holder != request->holder) {
        system->holder = request->holder;
        end_motion(state);
      }
    }
  }
  return verdict;
}

/** Newer by less than half of the number space; gaps are allowed, repeats and returns are not. */
static bool is_newer(uint32_t sequence, uint32_t last) {
  return count_of(sequence - last, (uint32_t)INT32_MAX);
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
    if ((request->kind >= (uint32_t)ILK_REQUEST_HEARTBEAT) &&
        (request->kind <= (uint32_t)ILK_REQUEST_RESET)) {
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

ilk_verdict_record_t ilk_request_take(const ilk_config_t *config, const ilk_request_t *request,
                                      ilk_state_t *state) {
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
