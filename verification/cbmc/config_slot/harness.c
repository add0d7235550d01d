/**
 * @file
 * P13: when one slot of a configuration is valid. The slot is arbitrary bits. That each rule is judged, of
 * what those before it let through, is shown here; what each accepts in the variants, where the system's
 * words are valid (proof config).
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

#if defined(DRIVES) || defined(HOMING) || defined(WATCH)

/** One rule after the other, each as far as those before it are kept. */
void harness(void) {
  ilk_axis_config_t axis;
  ilk_common_config_t common;
  ilk_config_error_t error;
  bool valid;
  GIVEN(valid_common(&common));
  GIVEN(is_motor_card(axis.card) && (axis.required <= 1u));
#ifdef DRIVES
  error = geometry_error(&axis);
  valid = valid_geometry(&axis);
  SHOW((error == ILK_CONFIG_ERROR_NONE) == valid,
       "P13: the geometry is accepted exactly when it is in its bounds");
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = drive_error(&axis, common.period_us);
    valid = valid_drives(&axis, common.period_us);
  }
  SHOW((error == ILK_CONFIG_ERROR_NONE) == valid,
       "P13: drives are accepted exactly when they are in their bounds");
  GOAL(goal_flag, error == ILK_CONFIG_ERROR_FLAG);
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
  GOAL(never_valid_without_drive, valid && (axis.max_drive == 0u));
#elif defined(HOMING)
  GIVEN(valid_geometry(&axis) && between(axis.full_speed_counts_per_s, 1, 100000000));
  const bool with_switch = axis.limit_side != ILK_LIMIT_NONE;
  error = with_switch ? homing_error(&axis, &common) : switchless_error(&axis);
  valid = with_switch ? (valid_homing(&axis, &common) && homing_ends_in_time(&axis, &common))
                      : without_homing(&axis);
  SHOW((error == ILK_CONFIG_ERROR_NONE) == valid, "P13: homing is accepted exactly when it is in its bounds");
  GOAL(goal_home_drive, error == ILK_CONFIG_ERROR_HOME_DRIVE);
  GOAL(goal_home_slow, error == ILK_CONFIG_ERROR_HOME_SLOW);
  GOAL(goal_hysteresis, error == ILK_CONFIG_ERROR_HYSTERESIS);
  GOAL(goal_home_tolerance, error == ILK_CONFIG_ERROR_HOME_TOLERANCE);
  GOAL(goal_home_clear, error == ILK_CONFIG_ERROR_HOME_CLEAR);
  GOAL(goal_home_travel, error == ILK_CONFIG_ERROR_HOME_TRAVEL);
  GOAL(goal_home_timeout, error == ILK_CONFIG_ERROR_HOME_TIMEOUT);
  GOAL(never_valid_without_speed, valid && with_switch && (axis.home_speed_counts_per_s == 0u));
#else
  GIVEN(valid_geometry(&axis) && between(axis.full_speed_counts_per_s, 1, 100000000));
  GIVEN(axis.home_slow_speed_counts_per_s <= axis.full_speed_counts_per_s);
  error = watch_error(&axis, &common);
  valid = valid_watch(&axis, &common);
  SHOW((error == ILK_CONFIG_ERROR_NONE) == valid,
       "P13: the watch is accepted exactly when it is in its bounds");
  GOAL(goal_stall, error == ILK_CONFIG_ERROR_STALL);
  GOAL(goal_stall_effort, error == ILK_CONFIG_ERROR_STALL_EFFORT);
  GOAL(goal_reverse, error == ILK_CONFIG_ERROR_REVERSE);
  GOAL(goal_drift, error == ILK_CONFIG_ERROR_DRIFT);
  GOAL(goal_rest, error == ILK_CONFIG_ERROR_REST);
  GOAL(never_valid_without_stall, valid && (axis.stall_ticks == 0u));
#endif
  GOAL(goal_valid_with_switch, valid && (axis.limit_side == ILK_LIMIT_UPPER));
  GOAL(goal_valid_without_switch, valid && (axis.limit_side == ILK_LIMIT_NONE));
}

#else

static ilk_axis_config_t axis;
static ilk_config_error_t geometry;
static ilk_config_error_t drives;
static ilk_config_error_t homing;
static ilk_config_error_t watch;

ilk_config_error_t some_geometry(const ilk_axis_config_t* own) {
  SHOW((own == &axis) && is_motor_card(axis.card) && (axis.required <= 1u),
       "P13: the geometry of a motor is judged");
  return geometry;
}

ilk_config_error_t some_drives(const ilk_axis_config_t* own, uint32_t us) {
  (void)us;
  SHOW((own == &axis) && (geometry == ILK_CONFIG_ERROR_NONE), "P13: drives are judged of a valid geometry");
  return drives;
}

ilk_config_error_t some_homing(const ilk_axis_config_t* own, const ilk_common_config_t* common) {
  (void)common;
  SHOW((own == &axis) && (axis.limit_side != ILK_LIMIT_NONE) && (drives == ILK_CONFIG_ERROR_NONE),
       "P13: homing with a switch is judged of valid drives");
  return homing;
}

ilk_config_error_t some_homing_without(const ilk_axis_config_t* own) {
  SHOW((own == &axis) && (axis.limit_side == ILK_LIMIT_NONE) && (drives == ILK_CONFIG_ERROR_NONE),
       "P13: homing without a switch is judged of valid drives");
  return homing;
}

ilk_config_error_t some_watch(const ilk_axis_config_t* own, const ilk_common_config_t* common) {
  (void)common;
  SHOW((own == &axis) && (homing == ILK_CONFIG_ERROR_NONE), "P13: the watch is judged of valid homing");
  return watch;
}

static ilk_config_error_t any_error(void) {
  uint32_t error;
  GIVEN(error < ILK_CONFIG_ERROR_COUNT);
  return (ilk_config_error_t)error;
}

static bool valid_slot(void) {
  const bool kept = (geometry == ILK_CONFIG_ERROR_NONE) && (drives == ILK_CONFIG_ERROR_NONE) &&
                    (homing == ILK_CONFIG_ERROR_NONE) && (watch == ILK_CONFIG_ERROR_NONE);
  return is_motor_card(axis.card)
             ? ((axis.required <= 1u) && kept)
             : (((axis.card == ILK_CARD_NONE) || (axis.card == ILK_CARD_SENSOR)) && valid_bare(&axis));
}

void harness(void) {
  ilk_common_config_t common;
  __CPROVER_havoc_object(&axis);
  geometry = any_error();
  drives = any_error();
  homing = any_error();
  watch = any_error();
  const ilk_config_error_t error = slot_error(&axis, &common);
  const bool valid = error == ILK_CONFIG_ERROR_NONE;
  SHOW(error < ILK_CONFIG_ERROR_COUNT, "P13: a known error");
  SHOW(valid == valid_slot(), "P13: a slot is accepted exactly when each of its rules is kept");
  GOAL(goal_valid_motor, valid && is_motor_card(axis.card));
  GOAL(goal_valid_sensor, valid && (axis.card == ILK_CARD_SENSOR) && (axis.required == 1u));
  GOAL(goal_valid_empty, valid && (axis.card == ILK_CARD_NONE));
  GOAL(goal_card, error == ILK_CONFIG_ERROR_CARD);
  GOAL(goal_empty_slot, error == ILK_CONFIG_ERROR_EMPTY_SLOT);
  GOAL(never_valid_unknown_card, valid && (axis.card >= ILK_CARD_COUNT));
}

#endif
