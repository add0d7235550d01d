#include "parts.h"

/** The first need that is not met is the verdict. */
static void must(ilk_verdict_t *verdict, bool met, ilk_verdict_t otherwise) {
  *verdict = ((*verdict == ILK_VERDICT_ACCEPTED) && !met) ? otherwise : *verdict;
}

static bool mode_is(const ilk_system_t *system, ilk_mode_t mode) { return system->mode == (uint32_t)mode; }

static bool axis_is(const ilk_axis_t *axis, ilk_axis_state_t state) { return axis->state == (uint32_t)state; }

static bool pedal_is_up(const ilk_system_t *system) { return system->pedal == (uint32_t)ILK_PEDAL_RELEASED; }

/** Of a homed axis by its soft limits, else by what is left of its travel; never behind a steady switch. */
static bool setpoint_is_within(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                               const ilk_axis_t *axis, int32_t setpoint) {
  const int64_t here = (int64_t)axis->position_counts;
  const int64_t left = (int64_t)ilk_unhomed_travel_left(config, axis);
  const ilk_reach_t unhomed = {.low = here - left, .high = here + left};
  const ilk_reach_t reach = (axis->homed != (uint32_t)ILK_HOMED_NOT) ? ilk_reach(config, axis) : unhomed;
  const bool towards = (((int64_t)setpoint > here) && (config->limit_side == (uint32_t)ILK_LIMIT_UPPER)) ||
                       (((int64_t)setpoint < here) && (config->limit_side == (uint32_t)ILK_LIMIT_LOWER));
  const bool behind = towards && ilk_switch_is_steady(common, axis, true);
  return ((int64_t)setpoint >= reach.low) && ((int64_t)setpoint <= reach.high) && !behind;
}

/** What MOVE and HOME need alike. */
static void need_enabled(ilk_verdict_t *verdict, const ilk_system_t *system, const ilk_axis_t *axis,
                         uint32_t consent) {
  must(verdict, mode_is(system, ILK_MODE_MOTION), ILK_VERDICT_MODE);
  must(verdict, consent == system->consent, ILK_VERDICT_CONSENT);
  must(verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
  must(verdict, !axis_is(axis, ILK_AXIS_DISABLED), ILK_VERDICT_DISABLED);
  must(verdict, !axis_is(axis, ILK_AXIS_HOMING), ILK_VERDICT_BUSY);
}

/** The rows of the table that name an axis. */
static ilk_verdict_t judge(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                           const ilk_system_t *system, const ilk_axis_t *axis, const ilk_request_t *request) {
  const bool at_rest = ilk_axis_is_at_rest(config, axis) && (axis->runaway == 0u); /* it may creep */
  const bool may_enable = (system->powered_ticks >= common->power_up_ticks) && at_rest;
  const bool sets_home = request->kind == (uint32_t)ILK_REQUEST_SET_HOME;
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  switch (request->kind) {
    case (uint32_t)ILK_REQUEST_DISABLE:
      must(&verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
      break;
    case (uint32_t)ILK_REQUEST_ENABLE:
      must(&verdict, ilk_power_is_on(system), ILK_VERDICT_MODE);
      must(&verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
      must(&verdict, axis->card_valid != 0u, ILK_VERDICT_CARD);
      must(&verdict, may_enable || !axis_is(axis, ILK_AXIS_DISABLED), ILK_VERDICT_BUSY);
      break;
    case (uint32_t)ILK_REQUEST_CLEAR_FAULT:
      must(&verdict, axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_NO_FAULT);
      must(&verdict, at_rest && (axis->fault_tick != system->tick), ILK_VERDICT_CAUSE_PRESENT);
      must(&verdict, pedal_is_up(system), ILK_VERDICT_PEDAL_DOWN);
      break;
    case (uint32_t)ILK_REQUEST_MOVE:
      need_enabled(&verdict, system, axis, request->consent);
      must(&verdict, count_of(request->lease_ticks, common->lease_max_ticks), ILK_VERDICT_LEASE);
      must(&verdict, count_of(request->drive, ilk_drive_bound(config, axis)), ILK_VERDICT_DRIVE);
      must(&verdict, request->amplitude <= config->max_amplitude, ILK_VERDICT_DRIVE);
      must(&verdict, setpoint_is_within(common, config, axis, request->target_counts), ILK_VERDICT_RANGE);
      break;
    case (uint32_t)ILK_REQUEST_HOME:
      need_enabled(&verdict, system, axis, request->consent);
      must(&verdict, has_switch(config), ILK_VERDICT_NO_SWITCH);
      must(&verdict, ilk_homing_has_budget(config, axis), ILK_VERDICT_BUDGET);
      break;
    default: /* SET_HOME and RESTORE: they say where a resting axis stands. */
      must(&verdict, mode_is(system, ILK_MODE_READY), ILK_VERDICT_MODE);
      must(&verdict, pedal_is_up(system), ILK_VERDICT_PEDAL_DOWN);
      must(&verdict, !axis_is(axis, ILK_AXIS_FAULTED), ILK_VERDICT_FAULTED);
      must(&verdict, axis->card_valid != 0u, ILK_VERDICT_CARD);
      must(&verdict, at_rest, ILK_VERDICT_BUSY);
      must(&verdict, sets_home || (request->target_counts >= config->min_counts), ILK_VERDICT_RANGE);
      must(&verdict, sets_home || (request->target_counts <= config->max_counts), ILK_VERDICT_RANGE);
      break;
  }
  return verdict;
}

static void carry_out(const ilk_request_t *request, ilk_axis_t *axis) {
  const bool sets_home = request->kind == (uint32_t)ILK_REQUEST_SET_HOME;
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
    default: /* SET_HOME, RESTORE */
      axis->position_counts = sets_home ? 0 : request->target_counts;
      axis->homed = (uint32_t)(sets_home ? ILK_HOMED_BY_HAND : ILK_HOMED_NOT);
      break;
  }
}

static ilk_verdict_t take_axis(const ilk_config_t *config, const ilk_request_t *request, ilk_state_t *state) {
  const uint32_t slot = request->axis;
  const ilk_verdict_t verdict =
      judge(&config->common, &config->axis[slot], &state->system, &state->axis[slot], request);
  if (verdict == ILK_VERDICT_ACCEPTED) {
    carry_out(request, &state->axis[slot]);
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
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  if (request->kind == (uint32_t)ILK_REQUEST_RESET) {
    must(&verdict, mode_is(system, ILK_MODE_LOCKED), ILK_VERDICT_MODE);
    must(&verdict, pedal_is_up(system), ILK_VERDICT_PEDAL_DOWN);
    must(&verdict, !ilk_cause_is_present(state), ILK_VERDICT_CAUSE_PRESENT);
    if (verdict == ILK_VERDICT_ACCEPTED) {
      ilk_mode_enter(ILK_MODE_READY, 0u, state);
    }
  } else if (request->kind == (uint32_t)ILK_REQUEST_STOP) {
    end_motion(state);
  } else { /* HEARTBEAT */
    system->app_age_ticks = 0u;
    if (system->holder != request->holder) {
      system->holder = request->holder;
      end_motion(state);
    }
  }
  return verdict;
}

/** A request that is intact and in order uses its number up, whatever the verdict. */
static ilk_verdict_t take(const ilk_config_t *config, const ilk_request_t *request, ilk_state_t *state) {
  const uint32_t ahead = request->sequence - state->system.last_sequence;
  const bool of_system = request->kind <= (uint32_t)ILK_REQUEST_RESET;
  const bool of_axis = (request->axis < (uint32_t)ILK_SLOTS) && has_axis(&config->axis[request->axis]);
  ilk_verdict_t verdict = ILK_VERDICT_ACCEPTED;
  must(&verdict, request->crc == ilk_request_crc(request), ILK_VERDICT_CHECKSUM);
  must(&verdict, count_of(ahead, (uint32_t)INT32_MAX), ILK_VERDICT_SEQUENCE);
  if (verdict == ILK_VERDICT_ACCEPTED) {
    state->system.last_sequence = request->sequence;
  }
  must(&verdict, count_of(request->kind, (uint32_t)ILK_REQUEST_RESTORE), ILK_VERDICT_UNKNOWN);
  must(&verdict, of_system || of_axis, ILK_VERDICT_AXIS);
  must(&verdict, !mode_is(&state->system, ILK_MODE_INIT), ILK_VERDICT_MODE);
  if (verdict == ILK_VERDICT_ACCEPTED) {
    verdict = of_system ? take_system(request, state) : take_axis(config, request, state);
  }
  return verdict;
}

ilk_verdict_record_t ilk_request_take(const ilk_config_t *config, const ilk_request_t *request,
                                      ilk_state_t *state) {
  ilk_system_t *system = &state->system;
  const uint32_t verdict = (uint32_t)take(config, request, state);
  const ilk_verdict_record_t record = {.tick = system->tick,
                                       .sequence = request->sequence,
                                       .kind = request->kind,
                                       .axis = request->axis,
                                       .verdict = verdict};
  uint32_t *counter =
      (verdict == (uint32_t)ILK_VERDICT_ACCEPTED) ? &system->requests_accepted : &system->requests_refused;
  *counter = count_up(*counter, UINT32_MAX);
  return record;
}
