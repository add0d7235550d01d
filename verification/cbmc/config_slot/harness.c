/**
 * @file
 * P13: when one slot of a configuration is valid, and what the step may rely on then. The slot is arbitrary
 * bits.
 *
 * Whether homing ends in time is replaced by an arbitrary answer: what its two products of 64 bits say is
 * left to the tests of its edges in P13_configuration.
 */
#include "config.c"
#include "proof.h"
#include "valid.h"

static bool in_time;

bool some_answer(const ilk_axis_config_t* axis, uint32_t period_us) {
  (void)axis;
  (void)period_us;
  return in_time;
}

static bool valid_homing_bounds(const ilk_axis_config_t* axis) {
  const int64_t range = range_counts(axis);
  return between(axis->home_drive, 1, axis->unhomed_max_drive) &&
         between(axis->home_travel_counts, range + axis->coast_counts, 2 * range) &&
         (axis->home_backoff_counts > 0u) && ((10 * (int64_t)axis->home_backoff_counts) <= range) &&
         between(axis->home_rest_ticks, 1, axis->home_timeout_ticks) && in_time;
}

/** A slot without a motor: nothing but its card and, for a sensor, whether it is required. */
static bool valid_bare(const ilk_axis_config_t* axis) {
  bool zero = true;
  for (uint32_t word = 2u; word < (sizeof(ilk_axis_config_t) / sizeof(uint32_t)); word++) {
    zero = zero && (((const uint32_t*)axis)[word] == 0u);
  }
  return zero && (axis->required <= ((axis->card == ILK_CARD_SENSOR) ? 1u : 0u));
}

static bool valid_slot(const ilk_axis_config_t* axis, uint32_t period_us) {
  const bool switched = axis->limit_side != ILK_LIMIT_NONE;
  return is_motor_card(axis->card)
             ? (valid_geometry(axis) && valid_bounds(axis) && valid_watch(axis, period_us) &&
                (switched ? valid_homing_bounds(axis) : without_homing(axis)))
             : (((axis->card == ILK_CARD_NONE) || (axis->card == ILK_CARD_SENSOR)) && valid_bare(axis));
}

/** What the other proofs and the step take from a valid axis. */
static void show_reliance(const ilk_axis_config_t* axis) {
  const int64_t coast = axis->coast_counts;
  const int64_t innocent = coast + axis->backlash_counts + axis->noise_counts;
  SHOW(((int64_t)axis->min_counts + coast) < ((int64_t)axis->max_counts - coast),
       "P4: there is room between the limits after coasting");
  SHOW((axis->max_drive <= ilk_card_max_drive(axis->card)) && (axis->unhomed_max_drive < axis->max_drive),
       "P7: the card's word carries the largest drive");
  SHOW(axis->home_drive <= axis->unhomed_max_drive, "P7: homing is no faster than an axis may be before it");
  SHOW(axis->unhomed_travel_counts > coast, "P7: unhomed travel leaves room for coasting");
  SHOW((axis->reverse_counts >= innocent) && (axis->drift_counts >= innocent),
       "P6: coast, backlash and noise alone are no runaway");
  SHOW(axis->stall_min_counts > axis->noise_counts, "P5: noise alone is no progress");
  SHOW((axis->limit_side == ILK_LIMIT_NONE) ||
           ((int64_t)axis->home_travel_counts >= (range_counts(axis) + coast)),
       "L2: homing covers the whole stroke");
}

void harness(void) {
  ilk_axis_config_t axis;
  uint32_t period_us;
  bool answer;
  GIVEN(between(period_us, 125, 2000));
  in_time = answer;
  const ilk_config_error_t error = slot_error(&axis, period_us);
  const bool valid = error == ILK_CONFIG_ERROR_NONE;
  SHOW(valid == valid_slot(&axis, period_us),
       "P13: a slot is accepted exactly when each field is in its range");
  if (valid && is_motor_card(axis.card)) {
    show_reliance(&axis);
  }
  GOAL(goal_valid_with_switch, valid && (axis.limit_side == ILK_LIMIT_UPPER));
  GOAL(goal_valid_without_switch, valid && is_motor_card(axis.card) && (axis.limit_side == ILK_LIMIT_NONE));
  GOAL(goal_valid_sensor, valid && (axis.card == ILK_CARD_SENSOR) && (axis.required == 1u));
  GOAL(goal_valid_empty, valid && (axis.card == ILK_CARD_NONE));
  GOAL(goal_card, error == ILK_CONFIG_ERROR_CARD);
  GOAL(goal_flag, error == ILK_CONFIG_ERROR_FLAG);
  GOAL(goal_empty_slot, error == ILK_CONFIG_ERROR_EMPTY_SLOT);
  GOAL(goal_limit_side, error == ILK_CONFIG_ERROR_LIMIT_SIDE);
  GOAL(goal_soft_limits, error == ILK_CONFIG_ERROR_SOFT_LIMITS);
  GOAL(goal_home_offset, error == ILK_CONFIG_ERROR_HOME_OFFSET);
  GOAL(goal_coast, error == ILK_CONFIG_ERROR_COAST);
  GOAL(goal_deadband, error == ILK_CONFIG_ERROR_DEADBAND);
  GOAL(goal_max_drive, error == ILK_CONFIG_ERROR_MAX_DRIVE);
  GOAL(goal_unhomed_drive, error == ILK_CONFIG_ERROR_UNHOMED_DRIVE);
  GOAL(goal_amplitude, error == ILK_CONFIG_ERROR_AMPLITUDE);
  GOAL(goal_unhomed_travel, error == ILK_CONFIG_ERROR_UNHOMED_TRAVEL);
  GOAL(goal_home_drive, error == ILK_CONFIG_ERROR_HOME_DRIVE);
  GOAL(goal_home_travel, error == ILK_CONFIG_ERROR_HOME_TRAVEL);
  GOAL(goal_home_backoff, error == ILK_CONFIG_ERROR_HOME_BACKOFF);
  GOAL(goal_home_rest, error == ILK_CONFIG_ERROR_HOME_REST);
  GOAL(goal_home_timeout, error == ILK_CONFIG_ERROR_HOME_TIMEOUT);
  GOAL(goal_stall, error == ILK_CONFIG_ERROR_STALL);
  GOAL(goal_reverse, error == ILK_CONFIG_ERROR_REVERSE);
  GOAL(goal_drift, error == ILK_CONFIG_ERROR_DRIFT);
  GOAL(goal_settle, error == ILK_CONFIG_ERROR_SETTLE);
  GOAL(goal_max_delta, error == ILK_CONFIG_ERROR_MAX_DELTA);
  GOAL(never_valid_unknown_card, valid && (axis.card >= ILK_CARD_COUNT));
}
