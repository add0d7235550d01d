#include "parts.h"

#define SOFT_LIMIT_MAX 1073741824 /* 2^30: any two limits differ by less than 2^32 */
#define SPEED_MAX 100000000u      /* counts per second: products of the checks below fit in 64 bits */
#define US_PER_MS 1000u
#define US_PER_S 1000000u
#define HOMING_MAX_MS 600000u /* ten minutes */

uint32_t ilk_card_max_drive(uint32_t card) {
  static const uint32_t largest[ILK_CARD_COUNT] = {
      [ILK_CARD_PWM] = 0x7fffffffu,
      [ILK_CARD_NON_PWM] = 0x3fffffffu,
      [ILK_CARD_ANALOG] = 0x7fffffffu,
      [ILK_CARD_HIGH_FREQUENCY] = 397785u,
  };
  return (card < ILK_CARD_COUNT) ? largest[card] : 0u;
}

/** The first need that is not met is the answer. */
static void need(ilk_config_error_t *error, bool met, ilk_config_error_t otherwise) {
  *error = ((*error == ILK_CONFIG_ERROR_NONE) && !met) ? otherwise : *error;
}

static bool within(uint64_t value, uint64_t lowest, uint64_t highest) {
  return (value >= lowest) && (value <= highest);
}

/** From `lowest` ticks to `highest_ms`. */
static bool lasts(uint32_t ticks, uint32_t period_us, uint32_t lowest, uint32_t highest_ms) {
  return (ticks >= lowest) && (((uint64_t)ticks * period_us) <= ((uint64_t)highest_ms * US_PER_MS));
}

/** Counts travelled in `ticks` at a speed, rounded up. */
static uint64_t travel_in(uint32_t counts_per_s, uint64_t ticks, uint32_t period_us) {
  return ((ticks * period_us * counts_per_s) + (US_PER_S - 1u)) / US_PER_S;
}

/** Microseconds that a travel takes at a speed that is not zero, rounded up. */
static uint64_t time_for(uint64_t counts, uint32_t counts_per_s) {
  return ((counts * US_PER_S) + counts_per_s - 1u) / counts_per_s;
}

static ilk_config_error_t common_error(const ilk_config_t *config) {
  const ilk_common_config_t *common = &config->common;
  const uint32_t us = common->period_us;
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  need(&error, common->version == ILK_CONFIG_VERSION, ILK_CONFIG_ERROR_VERSION);
  need(&error, common->size_bytes == (uint32_t)sizeof(ilk_config_t), ILK_CONFIG_ERROR_SIZE);
  need(&error, config->crc == ilk_config_crc(config), ILK_CONFIG_ERROR_CRC);
  need(&error, within(us, 125u, 2000u), ILK_CONFIG_ERROR_PERIOD);
  need(&error, within(common->pedal_channels, 1u, 2u), ILK_CONFIG_ERROR_PEDAL_CHANNELS);
  need(&error, lasts(common->app_timeout_ticks, us, 2u, 150u), ILK_CONFIG_ERROR_APP_TIMEOUT);
  need(&error, lasts(common->lease_max_ticks, us, 2u, 150u), ILK_CONFIG_ERROR_LEASE);
  need(&error, lasts(common->pedal_debounce_ticks, us, 1u, 50u), ILK_CONFIG_ERROR_PEDAL_DEBOUNCE);
  need(&error, lasts(common->pedal_disagree_ticks, us, 1u, 50u), ILK_CONFIG_ERROR_PEDAL_DISAGREE);
  need(&error, lasts(common->power_up_ticks, us, 1u, 5000u), ILK_CONFIG_ERROR_POWER_UP);
  need(&error, lasts(common->switch_debounce_ticks, us, 2u, 20u), ILK_CONFIG_ERROR_SWITCH_DEBOUNCE);
  need(&error, within(common->bad_frame_limit, 1u, 5u), ILK_CONFIG_ERROR_BAD_FRAMES);
  need(&error, within(common->overrun_limit, 1u, 10u), ILK_CONFIG_ERROR_OVERRUNS);
  return error;
}

/** Distance between the soft limits; zero when they are not in order. */
static uint32_t range_of(const ilk_axis_config_t *axis) {
  const int64_t range = (int64_t)axis->max_counts - axis->min_counts;
  return (range > 0) ? (uint32_t)range : 0u;
}

static ilk_config_error_t geometry_error(const ilk_axis_config_t *axis) {
  const bool ordered = (axis->min_counts < axis->max_counts) && (axis->min_counts >= -SOFT_LIMIT_MAX) &&
                       (axis->max_counts <= SOFT_LIMIT_MAX);
  const uint32_t range = range_of(axis);
  const uint64_t twice_coast = 2u * (uint64_t)axis->coast_counts;
  const uint64_t twice_deadband = 2u * (uint64_t)axis->deadband_counts;
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  need(&error, axis->motor_direction <= 1u, ILK_CONFIG_ERROR_FLAG);
  need(&error, axis->direction_correction <= 1u, ILK_CONFIG_ERROR_FLAG);
  need(&error, axis->limit_side < ILK_LIMIT_COUNT, ILK_CONFIG_ERROR_LIMIT_SIDE);
  need(&error, ordered, ILK_CONFIG_ERROR_SOFT_LIMITS);
  need(&error, axis->home_offset_counts >= axis->min_counts, ILK_CONFIG_ERROR_HOME_OFFSET);
  need(&error, axis->home_offset_counts <= axis->max_counts, ILK_CONFIG_ERROR_HOME_OFFSET);
  need(&error, (twice_coast != 0u) && (twice_coast < range), ILK_CONFIG_ERROR_COAST);
  need(&error, axis->noise_counts <= (range / 10u), ILK_CONFIG_ERROR_NOISE);
  need(&error, axis->backlash_counts <= (range / 10u), ILK_CONFIG_ERROR_NOISE);
  need(&error, (twice_deadband != 0u) && (twice_deadband < range), ILK_CONFIG_ERROR_DEADBAND);
  return error;
}

static ilk_config_error_t drive_error(const ilk_axis_config_t *axis, uint32_t us) {
  const bool waves = axis->card == (uint32_t)ILK_CARD_HIGH_FREQUENCY;
  const uint64_t dead = axis->dead_zone_drive;
  const uint64_t unhomed = axis->unhomed_max_drive;
  const uint64_t coast = axis->coast_counts;
  const uint32_t full = axis->full_speed_counts_per_s;
  const uint64_t fastest = travel_in(full, 1u, us) + axis->noise_counts;
  const uint32_t range = range_of(axis);
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  need(&error, within(axis->max_drive, 1u, ilk_card_max_drive(axis->card)), ILK_CONFIG_ERROR_MAX_DRIVE);
  need(&error, (5u * dead) <= axis->max_drive, ILK_CONFIG_ERROR_UNHOMED_DRIVE);
  need(&error, unhomed > dead, ILK_CONFIG_ERROR_UNHOMED_DRIVE);
  need(&error, (10u * unhomed) <= ((9u * dead) + axis->max_drive), ILK_CONFIG_ERROR_UNHOMED_DRIVE);
  need(&error, within(axis->max_amplitude, flag_of(waves), waves ? ILK_AMPLITUDE_MAX : 0u),
       ILK_CONFIG_ERROR_AMPLITUDE);
  need(&error, axis->home_amplitude <= axis->max_amplitude, ILK_CONFIG_ERROR_AMPLITUDE);
  need(&error, within(full, 1u, SPEED_MAX), ILK_CONFIG_ERROR_SPEED);
  need(&error, within(axis->max_delta_counts, fastest, range / 2u), ILK_CONFIG_ERROR_MAX_DELTA);
  need(&error, coast >= travel_in(full, ILK_LATENCY_TICKS, us), ILK_CONFIG_ERROR_COAST);
  need(&error, within(axis->unhomed_travel_counts, coast + axis->noise_counts + 1u, range / 10u),
       ILK_CONFIG_ERROR_UNHOMED_TRAVEL);
  return error;
}

/** Longest way of driven ticks until a reversal at full speed makes `way` of progress, in micro-counts. */
static uint64_t way_of_reversal(const ilk_axis_config_t *axis, uint32_t way) {
  return ((5u * (uint64_t)axis->coast_counts) + axis->backlash_counts + axis->noise_counts + way) * US_PER_S;
}

/** An axis that is fast enough has both bounds; a slower one has none for effort, and says so. */
static bool effort_fits(const ilk_axis_config_t *axis, uint32_t us) {
  const uint64_t speed = (uint64_t)us * axis->full_speed_counts_per_s;
  const uint64_t longest = ((uint64_t)200u * US_PER_MS) / us;
  const uint64_t ticks = axis->stall_effort_ticks;
  const uint64_t judged = (ticks == 0u) ? longest : ticks;
  return (ticks <= longest) && (((judged * speed) < way_of_reversal(axis, 1u)) == (ticks == 0u));
}

static ilk_config_error_t watch_error(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  const uint64_t tenth = range_of(axis) / 10u;
  const uint64_t noise = axis->noise_counts;
  const uint64_t lost = axis->backlash_counts + noise;
  const uint64_t innocent = axis->coast_counts + lost;
  const uint32_t us = common->period_us;
  const uint32_t unseen = ILK_LATENCY_TICKS + 1u; /* ticks until a reading shows what drive does */
  const uint32_t stall_min = axis->stall_min_counts;
  const uint64_t full = (uint64_t)us * axis->full_speed_counts_per_s;
  const uint64_t slowest = has_switch(axis) ? ((uint64_t)us * axis->home_slow_speed_counts_per_s) : full;
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  need(&error, within(stall_min, noise + 1u, tenth), ILK_CONFIG_ERROR_STALL);
  need(&error,
       lasts(axis->stall_ticks, us, unseen + 1u, 500u) &&
           ((left_of(axis->stall_ticks, unseen) * slowest) >= ((stall_min + lost) * US_PER_S)) &&
           ((axis->stall_ticks * full) >= way_of_reversal(axis, stall_min)),
       ILK_CONFIG_ERROR_STALL);
  need(&error, effort_fits(axis, us), ILK_CONFIG_ERROR_STALL_EFFORT);
  need(&error, within(axis->reverse_counts, innocent, tenth), ILK_CONFIG_ERROR_REVERSE);
  need(&error, within(axis->drift_counts, innocent, tenth), ILK_CONFIG_ERROR_DRIFT);
  need(&error, lasts(axis->rest_ticks, us, ILK_LATENCY_TICKS + 1u, 1000u), ILK_CONFIG_ERROR_REST);
  need(&error, axis->rest_ticks >= common->switch_debounce_ticks, ILK_CONFIG_ERROR_REST);
  return error;
}

/** Longest way of a back-off and of the approach after it, both ends coasting. */
static uint64_t way_back_and_forth(const ilk_axis_config_t *axis) {
  return 2u * ((uint64_t)axis->home_clear_counts + axis->switch_hysteresis_counts +
               (2u * (uint64_t)axis->coast_counts) + axis->noise_counts);
}

/** From either stop, which lies at most a coast beyond the soft limit, to rest at the second edge. */
static uint64_t way_of_homing(const ilk_axis_config_t *axis) {
  return (uint64_t)range_of(axis) + (2u * (uint64_t)axis->coast_counts) + (2u * way_back_and_forth(axis));
}

/** Microseconds of that way and of all waiting on it; the speeds are not zero. */
static uint64_t time_of_homing(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  const uint64_t waiting =
      (4u * (uint64_t)axis->rest_ticks) + (12u * (uint64_t)common->switch_debounce_ticks);
  return time_for(way_of_homing(axis), axis->home_speed_counts_per_s) +
         time_for(way_back_and_forth(axis), axis->home_slow_speed_counts_per_s) +
         (waiting * common->period_us);
}

static ilk_config_error_t homing_error(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  const uint32_t us = common->period_us;
  const uint32_t range = range_of(axis);
  const uint64_t coast = axis->coast_counts;
  const uint64_t noise = axis->noise_counts;
  const uint64_t awake = (uint64_t)axis->dead_zone_drive + 1u;
  const uint64_t clear = axis->home_clear_counts;
  const uint64_t edges = (uint64_t)axis->home_tolerance_counts + axis->switch_hysteresis_counts + coast;
  const bool lower = axis->limit_side == (uint32_t)ILK_LIMIT_LOWER;
  const int64_t home = axis->home_offset_counts;
  const int64_t open_side = lower ? (axis->max_counts - home) : (home - axis->min_counts);
  const uint64_t room = edges + axis->deadband_counts;
  const uint32_t home_speed = axis->home_speed_counts_per_s;
  const uint64_t gap = travel_in(home_speed, (uint64_t)common->switch_debounce_ticks + 2u, us) + (2u * noise);
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  need(&error, within(axis->home_slow_speed_counts_per_s, 1u, home_speed), ILK_CONFIG_ERROR_SPEED);
  need(&error, home_speed <= axis->full_speed_counts_per_s, ILK_CONFIG_ERROR_SPEED);
  need(&error, within(axis->home_drive, awake, axis->unhomed_max_drive), ILK_CONFIG_ERROR_HOME_DRIVE);
  need(&error, within(axis->home_slow_drive, awake, axis->home_drive), ILK_CONFIG_ERROR_HOME_SLOW);
  need(&error, axis->switch_hysteresis_counts <= (range / 10u), ILK_CONFIG_ERROR_HYSTERESIS);
  need(&error, within(axis->home_tolerance_counts, gap, range / 10u), ILK_CONFIG_ERROR_HOME_TOLERANCE);
  need(&error, open_side > (int64_t)room, ILK_CONFIG_ERROR_HOME_OFFSET);
  need(&error, within(clear, edges + 1u, range / 10u), ILK_CONFIG_ERROR_HOME_CLEAR);
  need(&error, clear > (noise + axis->stall_min_counts + axis->backlash_counts), ILK_CONFIG_ERROR_HOME_CLEAR);
  need(&error,
       within(axis->home_travel_counts, way_of_homing(axis) + coast + noise + 1u, 4u * (uint64_t)range),
       ILK_CONFIG_ERROR_HOME_TRAVEL);
  need(&error, lasts(axis->home_timeout_ticks, us, 1u, HOMING_MAX_MS), ILK_CONFIG_ERROR_HOME_TIMEOUT);
  if (error == ILK_CONFIG_ERROR_NONE) {
    need(&error, ((uint64_t)axis->home_timeout_ticks * us) > time_of_homing(axis, common),
         ILK_CONFIG_ERROR_HOME_TIMEOUT);
  }
  return error;
}

/** An axis without a switch is homed by SET_HOME; homing fields that mean nothing must be zero. */
static ilk_config_error_t switchless_error(const ilk_axis_config_t *axis) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  need(&error, axis->home_drive == 0u, ILK_CONFIG_ERROR_HOME_DRIVE);
  need(&error, axis->home_slow_drive == 0u, ILK_CONFIG_ERROR_HOME_SLOW);
  need(&error, axis->home_amplitude == 0u, ILK_CONFIG_ERROR_AMPLITUDE);
  need(&error, axis->home_travel_counts == 0u, ILK_CONFIG_ERROR_HOME_TRAVEL);
  need(&error, axis->home_timeout_ticks == 0u, ILK_CONFIG_ERROR_HOME_TIMEOUT);
  need(&error, axis->home_clear_counts == 0u, ILK_CONFIG_ERROR_HOME_CLEAR);
  need(&error, axis->home_tolerance_counts == 0u, ILK_CONFIG_ERROR_HOME_TOLERANCE);
  need(&error, axis->switch_hysteresis_counts == 0u, ILK_CONFIG_ERROR_HYSTERESIS);
  need(&error, axis->home_speed_counts_per_s == 0u, ILK_CONFIG_ERROR_SPEED);
  need(&error, axis->home_slow_speed_counts_per_s == 0u, ILK_CONFIG_ERROR_SPEED);
  return error;
}

/** Each step rests on those before it. */
static ilk_config_error_t axis_error(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  ilk_config_error_t error = geometry_error(axis);
  error = (error == ILK_CONFIG_ERROR_NONE) ? drive_error(axis, common->period_us) : error;
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = has_switch(axis) ? homing_error(axis, common) : switchless_error(axis);
  }
  return (error == ILK_CONFIG_ERROR_NONE) ? watch_error(axis, common) : error;
}

/** A slot without a motor carries nothing but its card and, for a sensor, `required`. */
static bool is_bare(const ilk_axis_config_t *axis) {
  const uint8_t *bytes = (const uint8_t *)axis;
  uint32_t bits = has_card(axis) ? 0u : axis->required;
  for (uint32_t index = 2u * (uint32_t)sizeof(uint32_t); index < (uint32_t)sizeof(*axis); index++) {
    bits |= bytes[index];
  }
  return bits == 0u;
}

static ilk_config_error_t slot_error(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  need(&error, axis->card < ILK_CARD_COUNT, ILK_CONFIG_ERROR_CARD);
  need(&error, axis->required <= 1u, ILK_CONFIG_ERROR_FLAG);
  need(&error, has_axis(axis) || is_bare(axis), ILK_CONFIG_ERROR_EMPTY_SLOT);
  if ((error == ILK_CONFIG_ERROR_NONE) && has_axis(axis)) {
    error = axis_error(axis, common);
  }
  return error;
}

ilk_config_verdict_t ilk_config_validate(const ilk_config_t *config) {
  ilk_config_error_t error = common_error(config);
  ilk_config_verdict_t verdict = {.error = (uint32_t)error, .slot = (uint32_t)ILK_SLOTS};
  bool any_axis = false;
  for (uint32_t slot = 0u; (slot < (uint32_t)ILK_SLOTS) && (error == ILK_CONFIG_ERROR_NONE); slot++) {
    any_axis = any_axis || has_axis(&config->axis[slot]);
    error = slot_error(&config->axis[slot], &config->common);
    verdict.slot = (error == ILK_CONFIG_ERROR_NONE) ? (uint32_t)ILK_SLOTS : slot;
  }
  need(&error, any_axis, ILK_CONFIG_ERROR_NO_AXIS);
  verdict.error = (uint32_t)error;
  return verdict;
}
