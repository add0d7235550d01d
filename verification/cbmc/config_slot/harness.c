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

static bool lasts(uint32_t ticks, uint32_t period_us, int64_t longest_us) {
  return (ticks > 0u) && (((int64_t)ticks * (int64_t)period_us) <= longest_us);
}

static bool a_tenth(int64_t counts, int64_t lowest, int64_t range) {
  return (counts >= lowest) && ((10 * counts) <= range);
}

/** The first rule that geometry and drive of an axis break. */
static uint32_t first_broken_bound(const ilk_axis_config_t* axis) {
  const int64_t range = range_counts(axis);
  const int64_t farthest = (int64_t)1 << 30;
  const bool waves = axis->card == ILK_CARD_HIGH_FREQUENCY;
  const bool flags =
      (axis->required <= 1u) && (axis->motor_direction <= 1u) && (axis->direction_correction <= 1u);
  const bool limits = (range > 0) && (axis->min_counts >= -farthest) && (axis->max_counts <= farthest);
  const bool amplitudes = between(axis->max_amplitude, waves ? 1 : 0, waves ? 255 : 0) &&
                          (axis->home_amplitude <= axis->max_amplitude);
  return !flags                                  ? ILK_CONFIG_ERROR_FLAG
         : (axis->limit_side >= ILK_LIMIT_COUNT) ? ILK_CONFIG_ERROR_LIMIT_SIDE
         : !limits                               ? ILK_CONFIG_ERROR_SOFT_LIMITS
         : !between(axis->home_offset_counts, axis->min_counts, axis->max_counts)
             ? ILK_CONFIG_ERROR_HOME_OFFSET
         : !((axis->coast_counts > 0u) && ((2 * (int64_t)axis->coast_counts) < range))
             ? ILK_CONFIG_ERROR_COAST
         : !((axis->deadband_counts > 0u) && ((2 * (int64_t)axis->deadband_counts) < range))
             ? ILK_CONFIG_ERROR_DEADBAND
         : !between(axis->max_drive, 1, largest_drive_of(axis->card)) ? ILK_CONFIG_ERROR_MAX_DRIVE
         : !a_tenth(axis->unhomed_max_drive, 1, axis->max_drive)      ? ILK_CONFIG_ERROR_UNHOMED_DRIVE
         : !amplitudes                                                ? ILK_CONFIG_ERROR_AMPLITUDE
         : !a_tenth(axis->unhomed_travel_counts, (int64_t)axis->coast_counts + 1, range)
             ? ILK_CONFIG_ERROR_UNHOMED_TRAVEL
             : ILK_CONFIG_ERROR_NONE;
}

/** The first rule of homing that is broken: of its bounds at a switch, of its absence without one. */
static uint32_t first_broken_homing(const ilk_axis_config_t* axis) {
  const int64_t range = range_counts(axis);
  const bool switched = axis->limit_side != ILK_LIMIT_NONE;
  const bool drive =
      switched ? between(axis->home_drive, 1, axis->unhomed_max_drive) : (axis->home_drive == 0u);
  const bool travel = switched ? between(axis->home_travel_counts, range + axis->coast_counts, 2 * range)
                               : (axis->home_travel_counts == 0u);
  const bool backoff =
      switched ? a_tenth(axis->home_backoff_counts, 1, range) : (axis->home_backoff_counts == 0u);
  const bool rest =
      switched ? between(axis->home_rest_ticks, 1, axis->home_timeout_ticks) : (axis->home_rest_ticks == 0u);
  const bool timeout =
      switched ? in_time : ((axis->home_timeout_ticks == 0u) && (axis->home_speed_counts_per_s == 0u));
  return !drive     ? ILK_CONFIG_ERROR_HOME_DRIVE
         : !travel  ? ILK_CONFIG_ERROR_HOME_TRAVEL
         : !backoff ? ILK_CONFIG_ERROR_HOME_BACKOFF
         : !rest    ? ILK_CONFIG_ERROR_HOME_REST
         : !timeout ? ILK_CONFIG_ERROR_HOME_TIMEOUT
                    : ILK_CONFIG_ERROR_NONE;
}

/** The first rule of watching an axis that is broken. */
static uint32_t first_broken_watch(const ilk_axis_config_t* axis, uint32_t period_us) {
  const int64_t range = range_counts(axis);
  const int64_t innocent = (int64_t)axis->coast_counts + axis->backlash_counts + axis->noise_counts;
  const bool stall = lasts(axis->stall_ticks, period_us, 500000) &&
                     a_tenth(axis->stall_min_counts, (int64_t)axis->noise_counts + 1, range);
  return !stall                                            ? ILK_CONFIG_ERROR_STALL
         : !a_tenth(axis->reverse_counts, innocent, range) ? ILK_CONFIG_ERROR_REVERSE
         : !a_tenth(axis->drift_counts, innocent, range)   ? ILK_CONFIG_ERROR_DRIFT
         : !lasts(axis->settle_ticks, period_us, 1000000)  ? ILK_CONFIG_ERROR_SETTLE
         : !((axis->max_delta_counts > 0u) && ((2 * (int64_t)axis->max_delta_counts) <= range))
             ? ILK_CONFIG_ERROR_MAX_DELTA
             : ILK_CONFIG_ERROR_NONE;
}

/** The first rule of an axis that is broken, in the order of the catalog; NONE when all are kept. */
static uint32_t first_broken_rule(const ilk_axis_config_t* axis, uint32_t period_us) {
  const uint32_t bound = first_broken_bound(axis);
  const uint32_t homing = first_broken_homing(axis);
  return (bound != ILK_CONFIG_ERROR_NONE)    ? bound
         : (homing != ILK_CONFIG_ERROR_NONE) ? homing
                                             : first_broken_watch(axis, period_us);
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
  SHOW(IMPLIES(is_motor_card(axis.card), error == first_broken_rule(&axis, period_us)),
       "P13: of an axis the first broken rule is told");
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
