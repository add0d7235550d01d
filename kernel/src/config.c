#include "config.h"

#include <stdbool.h>

#include "arith.h"
#include "interlock/kernel.h"

#define SOFT_LIMIT_MAX 1073741824 /* 2^30: any two limits differ by less than 2^32 */
#define AMPLITUDE_MAX 255u        /* eight bits of the frame's word */
#define SPEED_MAX 100000000u      /* counts per second: products of the checks below fit in 64 bits */
#define MICROSECONDS_PER_MS 1000u
#define MICROSECONDS_PER_S 1000000u
#define HOMING_MAX_MS 600000u /* ten minutes */

uint32_t ilk_card_max_drive(uint32_t card) {
  uint32_t largest = 0u;
  switch (card) {
    case (uint32_t)ILK_CARD_PWM:
    case (uint32_t)ILK_CARD_ANALOG:
      largest = 0x7fffffffu;
      break;
    case (uint32_t)ILK_CARD_NON_PWM:
      largest = 0x3fffffffu;
      break;
    case (uint32_t)ILK_CARD_HIGH_FREQUENCY:
      largest = 397785u;
      break;
    default:
      largest = 0u;
      break;
  }
  return largest;
}

/** The first rule that does not hold is the answer. */
static ilk_config_error_t then(ilk_config_error_t error, bool holds, ilk_config_error_t otherwise) {
  return ((error == ILK_CONFIG_ERROR_NONE) && !holds) ? otherwise : error;
}

static bool within(uint64_t value, uint64_t lowest, uint64_t highest) {
  return (value >= lowest) && (value <= highest);
}

static bool lasts_at_most(uint64_t ticks, uint32_t period_us, uint32_t limit_ms) {
  return (ticks * period_us) <= ((uint64_t)limit_ms * MICROSECONDS_PER_MS);
}

/** Counts travelled in `ticks` at a speed, rounded up. */
static uint64_t travel_in(uint32_t counts_per_s, uint64_t ticks, uint32_t period_us) {
  return ((ticks * period_us * counts_per_s) + (MICROSECONDS_PER_S - 1u)) / MICROSECONDS_PER_S;
}

/** Microseconds that a travel takes at a speed that is not zero, rounded up. */
static uint64_t time_for(uint64_t counts, uint32_t counts_per_s) {
  return ((counts * MICROSECONDS_PER_S) + counts_per_s - 1u) / counts_per_s;
}

static ilk_config_error_t common_error(const ilk_config_t *config) {
  const ilk_common_config_t *common = &config->common;
  const uint32_t period_us = common->period_us;
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  error = then(error, common->version == ILK_CONFIG_VERSION, ILK_CONFIG_ERROR_VERSION);
  error = then(error, common->size_bytes == (uint32_t)sizeof(ilk_config_t), ILK_CONFIG_ERROR_SIZE);
  error = then(error, config->crc == ilk_config_crc(config), ILK_CONFIG_ERROR_CRC);
  error = then(error, within(period_us, 125u, 2000u), ILK_CONFIG_ERROR_PERIOD);
  error = then(error, within(common->pedal_channels, 1u, 2u), ILK_CONFIG_ERROR_PEDAL_CHANNELS);
  error = then(error,
               (common->app_timeout_ticks > 1u) && lasts_at_most(common->app_timeout_ticks, period_us, 150u),
               ILK_CONFIG_ERROR_APP_TIMEOUT);
  error =
      then(error, (common->lease_max_ticks > 1u) && lasts_at_most(common->lease_max_ticks, period_us, 150u),
           ILK_CONFIG_ERROR_LEASE);
  error =
      then(error,
           (common->pedal_debounce_ticks > 0u) && lasts_at_most(common->pedal_debounce_ticks, period_us, 50u),
           ILK_CONFIG_ERROR_PEDAL_DEBOUNCE);
  error =
      then(error,
           (common->pedal_disagree_ticks > 0u) && lasts_at_most(common->pedal_disagree_ticks, period_us, 50u),
           ILK_CONFIG_ERROR_PEDAL_DISAGREE);
  error =
      then(error, (common->power_up_ticks > 0u) && lasts_at_most(common->power_up_ticks, period_us, 5000u),
           ILK_CONFIG_ERROR_POWER_UP);
  error = then(
      error,
      (common->switch_debounce_ticks > 1u) && lasts_at_most(common->switch_debounce_ticks, period_us, 20u),
      ILK_CONFIG_ERROR_SWITCH_DEBOUNCE);
  error = then(error, within(common->bad_frame_limit, 1u, 5u), ILK_CONFIG_ERROR_BAD_FRAMES);
  error = then(error, within(common->overrun_limit, 1u, 10u), ILK_CONFIG_ERROR_OVERRUNS);
  return error;
}

static bool is_flag(uint32_t value) { return value <= 1u; }

/** Distance between the soft limits; they are in order. */
static uint32_t range_of(const ilk_axis_config_t *axis) {
  return (uint32_t)axis->max_counts - (uint32_t)axis->min_counts;
}

static ilk_config_error_t geometry_error(const ilk_axis_config_t *axis) {
  const bool ordered = (axis->min_counts < axis->max_counts) && (axis->min_counts >= -SOFT_LIMIT_MAX) &&
                       (axis->max_counts <= SOFT_LIMIT_MAX);
  const uint32_t range = range_of(axis);
  const uint32_t tenth = range / 10u;
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  error = then(
      error, is_flag(axis->required) && is_flag(axis->motor_direction) && is_flag(axis->direction_correction),
      ILK_CONFIG_ERROR_FLAG);
  error = then(error, axis->limit_side < ILK_LIMIT_COUNT, ILK_CONFIG_ERROR_LIMIT_SIDE);
  error = then(error, ordered, ILK_CONFIG_ERROR_SOFT_LIMITS);
  error = then(
      error, (axis->home_offset_counts >= axis->min_counts) && (axis->home_offset_counts <= axis->max_counts),
      ILK_CONFIG_ERROR_HOME_OFFSET);
  error = then(error, (axis->coast_counts != 0u) && ((2u * (uint64_t)axis->coast_counts) < range),
               ILK_CONFIG_ERROR_COAST);
  error =
      then(error, (axis->noise_counts <= tenth) && (axis->backlash_counts <= tenth), ILK_CONFIG_ERROR_NOISE);
  error = then(error, (axis->deadband_counts != 0u) && ((2u * (uint64_t)axis->deadband_counts) < range),
               ILK_CONFIG_ERROR_DEADBAND);
  return error;
}

static bool amplitude_fits(const ilk_axis_config_t *axis) {
  return (axis->card == (uint32_t)ILK_CARD_HIGH_FREQUENCY) ? within(axis->max_amplitude, 1u, AMPLITUDE_MAX)
                                                           : (axis->max_amplitude == 0u);
}

static ilk_config_error_t drive_error(const ilk_axis_config_t *axis, uint32_t period_us) {
  const uint32_t full = axis->full_speed_counts_per_s;
  const uint64_t dead_zone = axis->dead_zone_drive;
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  error =
      then(error, within(axis->max_drive, 1u, ilk_card_max_drive(axis->card)), ILK_CONFIG_ERROR_MAX_DRIVE);
  error = then(error, within(axis->unhomed_max_drive, dead_zone + 1u, axis->max_drive / 10u),
               ILK_CONFIG_ERROR_UNHOMED_DRIVE);
  error = then(error, amplitude_fits(axis) && (axis->home_amplitude <= axis->max_amplitude),
               ILK_CONFIG_ERROR_AMPLITUDE);
  error = then(error, within(full, 1u, SPEED_MAX), ILK_CONFIG_ERROR_SPEED);
  error = then(error, (travel_in(full, 1u, period_us) + axis->noise_counts) <= axis->max_delta_counts,
               ILK_CONFIG_ERROR_MAX_DELTA);
  error = then(error, axis->max_delta_counts <= (range_of(axis) / 2u), ILK_CONFIG_ERROR_MAX_DELTA);
  error = then(error, axis->coast_counts >= travel_in(full, ILK_LATENCY_TICKS, period_us),
               ILK_CONFIG_ERROR_COAST);
  error = then(error,
               within(axis->unhomed_travel_counts, (uint64_t)axis->coast_counts + 1u, range_of(axis) / 10u),
               ILK_CONFIG_ERROR_UNHOMED_TRAVEL);
  return error;
}

/** An axis that is fast enough has both bounds; a slower one has none for effort, and says so. */
static bool effort_fits(const ilk_axis_config_t *axis, uint32_t period_us) {
  const uint64_t least =
      (5u * (uint64_t)axis->coast_counts) + axis->backlash_counts + axis->noise_counts + 1u;
  const uint64_t longest = ((uint64_t)200u * MICROSECONDS_PER_MS) / period_us;
  const uint64_t speed = axis->full_speed_counts_per_s;
  const uint64_t scaled = least * MICROSECONDS_PER_S;
  const bool can = (longest * period_us * speed) >= scaled;
  return (axis->stall_effort_ticks == 0u)
             ? !can
             : ((axis->stall_effort_ticks <= longest) &&
                (((uint64_t)axis->stall_effort_ticks * period_us * speed) >= scaled));
}

static ilk_config_error_t watch_error(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  const uint64_t tenth = range_of(axis) / 10u;
  const uint64_t lost = (uint64_t)axis->backlash_counts + axis->noise_counts;
  const uint64_t innocent = (uint64_t)axis->coast_counts + lost;
  const uint32_t period_us = common->period_us;
  const uint32_t slowest =
      has_switch(axis) ? axis->home_slow_speed_counts_per_s : axis->full_speed_counts_per_s;
  const bool progresses = ((uint64_t)axis->stall_ticks * period_us * slowest) >=
                          ((axis->stall_min_counts + lost) * MICROSECONDS_PER_S);
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  error = then(error, within(axis->stall_min_counts, (uint64_t)axis->noise_counts + 1u, tenth),
               ILK_CONFIG_ERROR_STALL);
  error = then(error,
               (axis->stall_ticks > ILK_LATENCY_TICKS) && lasts_at_most(axis->stall_ticks, period_us, 500u),
               ILK_CONFIG_ERROR_STALL);
  error = then(error, progresses, ILK_CONFIG_ERROR_STALL);
  error = then(error, effort_fits(axis, period_us), ILK_CONFIG_ERROR_STALL_EFFORT);
  error = then(error, within(axis->reverse_counts, innocent, tenth), ILK_CONFIG_ERROR_REVERSE);
  error = then(error, within(axis->drift_counts, innocent, tenth), ILK_CONFIG_ERROR_DRIFT);
  error =
      then(error,
           (axis->rest_ticks > ILK_LATENCY_TICKS) && (axis->rest_ticks >= common->switch_debounce_ticks) &&
               lasts_at_most(axis->rest_ticks, period_us, 1000u),
           ILK_CONFIG_ERROR_REST);
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

static uint64_t time_of_homing(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  const uint64_t waiting =
      (4u * (uint64_t)axis->rest_ticks) + (12u * (uint64_t)common->switch_debounce_ticks);
  return time_for(way_of_homing(axis), axis->home_speed_counts_per_s) +
         time_for(way_back_and_forth(axis), axis->home_slow_speed_counts_per_s) +
         (waiting * common->period_us);
}

static ilk_config_error_t homing_error(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  const uint32_t period_us = common->period_us;
  const uint64_t range = range_of(axis);
  const uint64_t tenth = range / 10u;
  const uint64_t coast = axis->coast_counts;
  const uint64_t noise = axis->noise_counts;
  const uint64_t margin = (uint64_t)axis->home_tolerance_counts + axis->switch_hysteresis_counts;
  const uint64_t debounced =
      travel_in(axis->home_speed_counts_per_s, (uint64_t)common->switch_debounce_ticks + 2u, period_us);
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  error = then(error,
               (axis->home_slow_speed_counts_per_s > 0u) &&
                   (axis->home_slow_speed_counts_per_s <= axis->home_speed_counts_per_s) &&
                   (axis->home_speed_counts_per_s <= axis->full_speed_counts_per_s),
               ILK_CONFIG_ERROR_SPEED);
  error = then(error, within(axis->home_drive, (uint64_t)axis->dead_zone_drive + 1u, axis->unhomed_max_drive),
               ILK_CONFIG_ERROR_HOME_DRIVE);
  error = then(error, within(axis->home_slow_drive, (uint64_t)axis->dead_zone_drive + 1u, axis->home_drive),
               ILK_CONFIG_ERROR_HOME_SLOW);
  error = then(error, axis->switch_hysteresis_counts <= tenth, ILK_CONFIG_ERROR_HYSTERESIS);
  error = then(error, within(axis->home_tolerance_counts, debounced + (2u * noise), tenth),
               ILK_CONFIG_ERROR_HOME_TOLERANCE);
  error = then(
      error,
      (axis->home_clear_counts > (margin + coast)) &&
          (axis->home_clear_counts > ((uint64_t)axis->stall_min_counts + axis->backlash_counts + noise)) &&
          (axis->home_clear_counts <= tenth),
      ILK_CONFIG_ERROR_HOME_CLEAR);
  error = then(error, within(axis->home_travel_counts, way_of_homing(axis) + coast + 1u, 4u * range),
               ILK_CONFIG_ERROR_HOME_TRAVEL);
  error = then(error, lasts_at_most(axis->home_timeout_ticks, period_us, HOMING_MAX_MS),
               ILK_CONFIG_ERROR_HOME_TIMEOUT);
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = then(error, ((uint64_t)axis->home_timeout_ticks * period_us) > time_of_homing(axis, common),
                 ILK_CONFIG_ERROR_HOME_TIMEOUT);
  }
  return error;
}

/** An axis without a switch is homed by SET_HOME; homing fields that mean nothing must be zero. */
static ilk_config_error_t switchless_error(const ilk_axis_config_t *axis) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  error = then(error, axis->home_drive == 0u, ILK_CONFIG_ERROR_HOME_DRIVE);
  error = then(error, axis->home_slow_drive == 0u, ILK_CONFIG_ERROR_HOME_SLOW);
  error = then(error, axis->home_amplitude == 0u, ILK_CONFIG_ERROR_AMPLITUDE);
  error = then(error, axis->home_travel_counts == 0u, ILK_CONFIG_ERROR_HOME_TRAVEL);
  error = then(error, axis->home_timeout_ticks == 0u, ILK_CONFIG_ERROR_HOME_TIMEOUT);
  error = then(error, axis->home_clear_counts == 0u, ILK_CONFIG_ERROR_HOME_CLEAR);
  error = then(error, axis->home_tolerance_counts == 0u, ILK_CONFIG_ERROR_HOME_TOLERANCE);
  error = then(error, axis->switch_hysteresis_counts == 0u, ILK_CONFIG_ERROR_HYSTERESIS);
  error = then(error, (axis->home_speed_counts_per_s == 0u) && (axis->home_slow_speed_counts_per_s == 0u),
               ILK_CONFIG_ERROR_SPEED);
  return error;
}

static ilk_config_error_t axis_error(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  ilk_config_error_t error = geometry_error(axis);
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = drive_error(axis, common->period_us);
  }
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = has_switch(axis) ? homing_error(axis, common) : switchless_error(axis);
  }
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = watch_error(axis, common);
  }
  return error;
}

/** A slot without a motor carries nothing but its card and, for a sensor, `required`. */
static bool is_bare(const ilk_axis_config_t *axis) {
  const unsigned char *bytes = (const unsigned char *)axis;
  uint32_t bits = 0u;
  for (uint32_t index = 2u * (uint32_t)sizeof(uint32_t); index < (uint32_t)sizeof(*axis); index++) {
    bits |= bytes[index];
  }
  return bits == 0u;
}

static ilk_config_error_t slot_error(const ilk_axis_config_t *axis, const ilk_common_config_t *common) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  error = then(error, axis->card < ILK_CARD_COUNT, ILK_CONFIG_ERROR_CARD);
  if (has_axis(axis)) {
    error = axis_error(axis, common);
  } else {
    error = then(error, is_flag(axis->required), ILK_CONFIG_ERROR_FLAG);
    error =
        then(error, is_bare(axis) && (has_card(axis) || (axis->required == 0u)), ILK_CONFIG_ERROR_EMPTY_SLOT);
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
  verdict.error = (uint32_t)then(error, any_axis, ILK_CONFIG_ERROR_NO_AXIS);
  return verdict;
}
