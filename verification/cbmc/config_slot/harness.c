/**
 * @file
 * P13: when one slot of a configuration is valid, and what the step may rely on then. The slot is arbitrary
 * bits, the system's words are valid (proof config).
 */
#include "config.c"
#include "proof.h"
#include "valid.h"

/** A slot without a motor: nothing but its card and, for a sensor, whether it is required. */
static bool valid_bare(const ilk_axis_config_t* axis) {
  bool zero = true;
  for (uint32_t word = 2u; word < (sizeof(ilk_axis_config_t) / sizeof(uint32_t)); word++) {
    zero = zero && (((const uint32_t*)axis)[word] == 0u);
  }
  return zero && (axis->required <= ((axis->card == ILK_CARD_SENSOR) ? 1u : 0u));
}

static bool valid_slot(const ilk_axis_config_t* axis, const ilk_common_config_t* common) {
  const bool with_switch = axis->limit_side != ILK_LIMIT_NONE;
  return is_motor_card(axis->card)
             ? (valid_geometry(axis) && valid_drives(axis, common->period_us) &&
                (with_switch ? (valid_homing(axis, common) && homing_ends_in_time(axis, common))
                             : without_homing(axis)) &&
                valid_watch(axis, common))
             : (((axis->card == ILK_CARD_NONE) || (axis->card == ILK_CARD_SENSOR)) && valid_bare(axis));
}

void harness(void) {
  ilk_axis_config_t axis;
  ilk_common_config_t common;
  GIVEN(valid_common(&common));
  const ilk_config_error_t error = slot_error(&axis, &common);
  const bool valid = error == ILK_CONFIG_ERROR_NONE;
  SHOW(error < ILK_CONFIG_ERROR_COUNT, "P13: a known error");
  SHOW(valid == valid_slot(&axis, &common),
       "P13: a slot is accepted exactly when it is in its stated bounds");
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
  GOAL(goal_noise, error == ILK_CONFIG_ERROR_NOISE);
  GOAL(goal_deadband, error == ILK_CONFIG_ERROR_DEADBAND);
  GOAL(goal_max_drive, error == ILK_CONFIG_ERROR_MAX_DRIVE);
  GOAL(goal_unhomed_drive, error == ILK_CONFIG_ERROR_UNHOMED_DRIVE);
  GOAL(goal_amplitude, error == ILK_CONFIG_ERROR_AMPLITUDE);
  GOAL(goal_speed, error == ILK_CONFIG_ERROR_SPEED);
  GOAL(goal_max_delta, error == ILK_CONFIG_ERROR_MAX_DELTA);
  GOAL(goal_unhomed_travel, error == ILK_CONFIG_ERROR_UNHOMED_TRAVEL);
  GOAL(goal_home_drive, error == ILK_CONFIG_ERROR_HOME_DRIVE);
  GOAL(goal_home_slow, error == ILK_CONFIG_ERROR_HOME_SLOW);
  GOAL(goal_hysteresis, error == ILK_CONFIG_ERROR_HYSTERESIS);
  GOAL(goal_home_tolerance, error == ILK_CONFIG_ERROR_HOME_TOLERANCE);
  GOAL(goal_home_clear, error == ILK_CONFIG_ERROR_HOME_CLEAR);
  GOAL(goal_home_travel, error == ILK_CONFIG_ERROR_HOME_TRAVEL);
  GOAL(goal_home_timeout, error == ILK_CONFIG_ERROR_HOME_TIMEOUT);
  GOAL(goal_stall, error == ILK_CONFIG_ERROR_STALL);
  GOAL(goal_stall_effort, error == ILK_CONFIG_ERROR_STALL_EFFORT);
  GOAL(goal_reverse, error == ILK_CONFIG_ERROR_REVERSE);
  GOAL(goal_drift, error == ILK_CONFIG_ERROR_DRIFT);
  GOAL(goal_rest, error == ILK_CONFIG_ERROR_REST);
  GOAL(never_valid_unknown_card, valid && (axis.card >= ILK_CARD_COUNT));
}
