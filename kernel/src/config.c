#include "config.h"

#include <stdbool.h>
#include <stddef.h>

#include "arith.h"
#include "crc32.h"
#include "interlock/kernel.h"

#define SOFT_LIMIT_MAX 1073741824 /* 2^30: any two limits differ by less than 2^32 */
#define AMPLITUDE_MAX 255u        /* eight bits of the frame's word */
#define MICROSECONDS_PER_MS 1000u
#define MICROSECONDS_PER_S 1000000u
#define HOMING_MAX_US 600000000u /* ten minutes */

uint32_t ilk_crc_axis_config(uint32_t crc, const ilk_axis_config_t *axis) {
  uint32_t next = crc;
  next = ilk_crc32_word(next, axis->card);
  next = ilk_crc32_word(next, axis->required);
  next = ilk_crc32_word(next, axis->motor_direction);
  next = ilk_crc32_word(next, axis->direction_correction);
  next = ilk_crc32_word(next, axis->limit_side);
  next = ilk_crc32_word(next, (uint32_t)axis->min_counts);
  next = ilk_crc32_word(next, (uint32_t)axis->max_counts);
  next = ilk_crc32_word(next, (uint32_t)axis->home_offset_counts);
  next = ilk_crc32_word(next, axis->coast_counts);
  next = ilk_crc32_word(next, axis->backlash_counts);
  next = ilk_crc32_word(next, axis->noise_counts);
  next = ilk_crc32_word(next, axis->deadband_counts);
  next = ilk_crc32_word(next, axis->max_drive);
  next = ilk_crc32_word(next, axis->unhomed_max_drive);
  next = ilk_crc32_word(next, axis->max_amplitude);
  next = ilk_crc32_word(next, axis->unhomed_travel_counts);
  next = ilk_crc32_word(next, axis->home_drive);
  next = ilk_crc32_word(next, axis->home_amplitude);
  next = ilk_crc32_word(next, axis->home_travel_counts);
  next = ilk_crc32_word(next, axis->home_backoff_counts);
  next = ilk_crc32_word(next, axis->home_timeout_ticks);
  next = ilk_crc32_word(next, axis->home_rest_ticks);
  next = ilk_crc32_word(next, axis->home_speed_counts_per_s);
  next = ilk_crc32_word(next, axis->stall_ticks);
  next = ilk_crc32_word(next, axis->stall_min_counts);
  next = ilk_crc32_word(next, axis->reverse_counts);
  next = ilk_crc32_word(next, axis->drift_counts);
  next = ilk_crc32_word(next, axis->settle_ticks);
  next = ilk_crc32_word(next, axis->max_delta_counts);
  return next;
}
_Static_assert(sizeof(ilk_axis_config_t) == (29u * sizeof(uint32_t)), "every word is in the CRC");

uint32_t ilk_crc_system_config(uint32_t crc, const ilk_config_t *config) {
  uint32_t next = crc;
  next = ilk_crc32_word(next, config->version);
  next = ilk_crc32_word(next, config->size_bytes);
  next = ilk_crc32_word(next, config->period_us);
  next = ilk_crc32_word(next, config->pedal_channels);
  next = ilk_crc32_word(next, config->app_timeout_ticks);
  next = ilk_crc32_word(next, config->lease_max_ticks);
  next = ilk_crc32_word(next, config->pedal_debounce_ticks);
  next = ilk_crc32_word(next, config->pedal_disagree_ticks);
  next = ilk_crc32_word(next, config->bad_frame_limit);
  next = ilk_crc32_word(next, config->overrun_limit);
  return next;
}
_Static_assert(sizeof(ilk_config_t) ==
                   (((size_t)ILK_SLOTS * sizeof(ilk_axis_config_t)) + (11u * sizeof(uint32_t))),
               "every word is in the CRC");

/*@ ensures P14_crc: \result == config_crc(config);
  @*/
uint32_t ilk_config_crc(const ilk_config_t *config) {
  uint32_t crc = ilk_crc_system_config(ILK_CRC32_START, config);
  /*@ loop invariant bounds: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P14_crc: crc == crc_of_axes(config, slot);
    @ loop assigns slot, crc;
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    crc = ilk_crc_axis_config(crc, &config->axis[slot]);
  }
  return ilk_crc32_finish(crc);
}

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

/*@ assigns \nothing;
  @ ensures exact: \result <==> lowest <= value <= highest;
  @*/
static bool within(uint64_t value, uint64_t lowest, uint64_t highest) {
  return (value >= lowest) && (value <= highest);
}

/** True when `ticks` is at least one and lasts no longer than `limit_ms`. */
/*@ assigns \nothing;
  @ ensures exact: \result <==> lasts(ticks, period_us, limit_ms);
  @*/
static bool lasts_at_most(uint32_t ticks, uint32_t period_us, uint32_t limit_ms) {
  return (ticks > 0u) && (((uint64_t)ticks * period_us) <= ((uint64_t)limit_ms * MICROSECONDS_PER_MS));
}

/*@ assigns \nothing;
  @ ensures exact: \result <==> value <= 1;
  @*/
static bool is_flag(uint32_t value) { return value <= 1u; }

/*@ requires readable: \valid_read(config);
  @ assigns  \nothing;
  @ ensures  P13_exact: \result == common_rule(config, crc);
  @ ensures  known: \result < ILK_CONFIG_ERROR_COUNT;
  @*/
static ilk_config_error_t system_error(const ilk_config_t *config, uint32_t crc) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  if (config->version != ILK_CONFIG_VERSION) {
    error = ILK_CONFIG_ERROR_VERSION;
  } else if (config->size_bytes != (uint32_t)sizeof(ilk_config_t)) {
    error = ILK_CONFIG_ERROR_SIZE;
  } else if (config->crc != crc) {
    error = ILK_CONFIG_ERROR_CRC;
  } else if (!within(config->period_us, 125u, 2000u)) {
    error = ILK_CONFIG_ERROR_PERIOD;
  } else if (!within(config->pedal_channels, 1u, 2u)) {
    error = ILK_CONFIG_ERROR_PEDAL_CHANNELS;
  } else if (!lasts_at_most(config->app_timeout_ticks, config->period_us, 150u)) {
    error = ILK_CONFIG_ERROR_APP_TIMEOUT;
  } else if (!lasts_at_most(config->lease_max_ticks, config->period_us, 150u)) {
    error = ILK_CONFIG_ERROR_LEASE;
  } else if (!lasts_at_most(config->pedal_debounce_ticks, config->period_us, 50u)) {
    error = ILK_CONFIG_ERROR_PEDAL_DEBOUNCE;
  } else if (!lasts_at_most(config->pedal_disagree_ticks, config->period_us, 50u)) {
    error = ILK_CONFIG_ERROR_PEDAL_DISAGREE;
  } else if (!within(config->bad_frame_limit, 1u, 5u)) {
    error = ILK_CONFIG_ERROR_BAD_FRAMES;
  } else if (!within(config->overrun_limit, 1u, 10u)) {
    error = ILK_CONFIG_ERROR_OVERRUNS;
  } else {
    error = ILK_CONFIG_ERROR_NONE;
  }
  return error;
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> ordered_limits(axis);
  @*/
static bool soft_limits_are_ordered(const ilk_axis_config_t *axis) {
  return (axis->min_counts < axis->max_counts) && (axis->min_counts >= -SOFT_LIMIT_MAX) &&
         (axis->max_counts <= SOFT_LIMIT_MAX);
}

/*@ requires readable: \valid_read(axis);
  @ requires ordered: ordered_limits(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result == range(axis);
  @*/
static uint32_t range_of(const ilk_axis_config_t *axis) {
  return (uint32_t)axis->max_counts - (uint32_t)axis->min_counts;
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P13_exact: \result == geometry_rule(axis);
  @ ensures  known: \result < ILK_CONFIG_ERROR_COUNT;
  @*/
static ilk_config_error_t geometry_error(const ilk_axis_config_t *axis) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  if (!is_flag(axis->required) || !is_flag(axis->motor_direction) || !is_flag(axis->direction_correction)) {
    error = ILK_CONFIG_ERROR_FLAG;
  } else if (axis->limit_side >= ILK_LIMIT_COUNT) {
    error = ILK_CONFIG_ERROR_LIMIT_SIDE;
  } else if (!soft_limits_are_ordered(axis)) {
    error = ILK_CONFIG_ERROR_SOFT_LIMITS;
  } else if ((axis->home_offset_counts < axis->min_counts) || (axis->home_offset_counts > axis->max_counts)) {
    error = ILK_CONFIG_ERROR_HOME_OFFSET;
  } else if ((axis->coast_counts == 0u) || ((2u * (uint64_t)axis->coast_counts) >= range_of(axis))) {
    error = ILK_CONFIG_ERROR_COAST;
  } else if ((axis->deadband_counts == 0u) || ((2u * (uint64_t)axis->deadband_counts) >= range_of(axis))) {
    error = ILK_CONFIG_ERROR_DEADBAND;
  } else {
    error = ILK_CONFIG_ERROR_NONE;
  }
  return error;
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> amplitude_allowed(axis);
  @*/
static bool amplitude_fits(const ilk_axis_config_t *axis) {
  const bool has_amplitude = axis->card == (uint32_t)ILK_CARD_HIGH_FREQUENCY;
  return has_amplitude ? within(axis->max_amplitude, 1u, AMPLITUDE_MAX) : (axis->max_amplitude == 0u);
}

/*@ requires readable: \valid_read(axis);
  @ requires geometry: geometry_rule(axis) == ILK_CONFIG_ERROR_NONE;
  @ assigns  \nothing;
  @ ensures  P13_exact: \result == drive_rule(axis);
  @ ensures  known: \result < ILK_CONFIG_ERROR_COUNT;
  @*/
static ilk_config_error_t drive_error(const ilk_axis_config_t *axis) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  if (!within(axis->max_drive, 1u, ilk_card_max_drive(axis->card))) {
    error = ILK_CONFIG_ERROR_MAX_DRIVE;
  } else if (!within(axis->unhomed_max_drive, 1u, axis->max_drive / 10u)) {
    error = ILK_CONFIG_ERROR_UNHOMED_DRIVE;
  } else if (!amplitude_fits(axis) || (axis->home_amplitude > axis->max_amplitude)) {
    error = ILK_CONFIG_ERROR_AMPLITUDE;
  } else if (!within(axis->unhomed_travel_counts, (uint64_t)axis->coast_counts + 1u, range_of(axis) / 10u)) {
    error = ILK_CONFIG_ERROR_UNHOMED_TRAVEL;
  } else {
    error = ILK_CONFIG_ERROR_NONE;
  }
  return error;
}

/** At its slowest the axis backs off, crosses the whole travel and rests before homing times out (L2). */
/*@ requires readable: \valid_read(axis);
  @ requires rest: axis->home_rest_ticks <= axis->home_timeout_ticks;
  @ assigns  \nothing;
  @ ensures  L2_homing_ends: \result <==> homing_suffices(axis, period_us);
  @*/
static bool homing_time_suffices(const ilk_axis_config_t *axis, uint32_t period_us) {
  const uint64_t moving_us = (uint64_t)(axis->home_timeout_ticks - axis->home_rest_ticks) * period_us;
  const uint64_t distance = (uint64_t)axis->home_travel_counts + axis->home_backoff_counts;
  const bool short_enough = ((uint64_t)axis->home_timeout_ticks * period_us) <= HOMING_MAX_US;
  return short_enough && ((moving_us * axis->home_speed_counts_per_s) >= (distance * MICROSECONDS_PER_S));
}

/*@ requires readable: \valid_read(axis);
  @ requires geometry: geometry_rule(axis) == ILK_CONFIG_ERROR_NONE;
  @ assigns  \nothing;
  @ ensures  P13_exact: \result == homing_rule(axis, period_us);
  @ ensures  known: \result < ILK_CONFIG_ERROR_COUNT;
  @*/
static ilk_config_error_t homing_error(const ilk_axis_config_t *axis, uint32_t period_us) {
  const uint64_t range = range_of(axis);
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  if (!within(axis->home_drive, 1u, axis->unhomed_max_drive)) {
    error = ILK_CONFIG_ERROR_HOME_DRIVE;
  } else if (!within(axis->home_travel_counts, range + axis->coast_counts, 2u * range)) {
    error = ILK_CONFIG_ERROR_HOME_TRAVEL;
  } else if (!within(axis->home_backoff_counts, 1u, range / 10u)) {
    error = ILK_CONFIG_ERROR_HOME_BACKOFF;
  } else if (!within(axis->home_rest_ticks, 1u, axis->home_timeout_ticks)) {
    error = ILK_CONFIG_ERROR_HOME_REST;
  } else if (!homing_time_suffices(axis, period_us)) {
    error = ILK_CONFIG_ERROR_HOME_TIMEOUT;
  } else {
    error = ILK_CONFIG_ERROR_NONE;
  }
  return error;
}

/** An axis without a switch is homed by SET_HOME; homing fields that mean nothing must be zero. */
/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P13_exact: \result == switchless_rule(axis);
  @ ensures  known: \result < ILK_CONFIG_ERROR_COUNT;
  @*/
static ilk_config_error_t switchless_error(const ilk_axis_config_t *axis) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  if (axis->home_drive != 0u) {
    error = ILK_CONFIG_ERROR_HOME_DRIVE;
  } else if (axis->home_travel_counts != 0u) {
    error = ILK_CONFIG_ERROR_HOME_TRAVEL;
  } else if (axis->home_backoff_counts != 0u) {
    error = ILK_CONFIG_ERROR_HOME_BACKOFF;
  } else if (axis->home_rest_ticks != 0u) {
    error = ILK_CONFIG_ERROR_HOME_REST;
  } else if ((axis->home_timeout_ticks != 0u) || (axis->home_speed_counts_per_s != 0u)) {
    error = ILK_CONFIG_ERROR_HOME_TIMEOUT;
  } else {
    error = ILK_CONFIG_ERROR_NONE;
  }
  return error;
}

/*@ requires readable: \valid_read(axis);
  @ requires geometry: geometry_rule(axis) == ILK_CONFIG_ERROR_NONE;
  @ assigns  \nothing;
  @ ensures  P13_exact: \result == watch_rule(axis, period_us);
  @ ensures  known: \result < ILK_CONFIG_ERROR_COUNT;
  @*/
static ilk_config_error_t watch_error(const ilk_axis_config_t *axis, uint32_t period_us) {
  const uint64_t range = range_of(axis);
  const uint64_t innocent = (uint64_t)axis->coast_counts + axis->backlash_counts + axis->noise_counts;
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  if (!lasts_at_most(axis->stall_ticks, period_us, 500u) || (axis->stall_min_counts <= axis->noise_counts) ||
      (axis->stall_min_counts > (range / 10u))) {
    error = ILK_CONFIG_ERROR_STALL;
  } else if (!within(axis->reverse_counts, innocent, range / 10u)) {
    error = ILK_CONFIG_ERROR_REVERSE;
  } else if (!within(axis->drift_counts, innocent, range / 10u)) {
    error = ILK_CONFIG_ERROR_DRIFT;
  } else if (!lasts_at_most(axis->settle_ticks, period_us, 1000u)) {
    error = ILK_CONFIG_ERROR_SETTLE;
  } else if (!within(axis->max_delta_counts, 1u, range / 2u)) {
    error = ILK_CONFIG_ERROR_MAX_DELTA;
  } else {
    error = ILK_CONFIG_ERROR_NONE;
  }
  return error;
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P13_exact: \result == axis_rule(axis, period_us);
  @ ensures  known: \result < ILK_CONFIG_ERROR_COUNT;
  @*/
static ilk_config_error_t axis_error(const ilk_axis_config_t *axis, uint32_t period_us) {
  ilk_config_error_t error = geometry_error(axis);
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = drive_error(axis);
  }
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = (axis->limit_side == (uint32_t)ILK_LIMIT_NONE) ? switchless_error(axis)
                                                           : homing_error(axis, period_us);
  }
  if (error == ILK_CONFIG_ERROR_NONE) {
    error = watch_error(axis, period_us);
  }
  return error;
}

/** A slot without a motor carries nothing but its card and, for a sensor, `required`. */
/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P13_bare: \result <==> bare(axis);
  @*/
static bool is_bare(const ilk_axis_config_t *axis) {
  const uint32_t bits =
      axis->motor_direction | axis->direction_correction | axis->limit_side | (uint32_t)axis->min_counts |
      (uint32_t)axis->max_counts | (uint32_t)axis->home_offset_counts | axis->coast_counts |
      axis->backlash_counts | axis->noise_counts | axis->deadband_counts | axis->max_drive |
      axis->unhomed_max_drive | axis->max_amplitude | axis->unhomed_travel_counts | axis->home_drive |
      axis->home_amplitude | axis->home_travel_counts | axis->home_backoff_counts | axis->home_timeout_ticks |
      axis->home_rest_ticks | axis->home_speed_counts_per_s | axis->stall_ticks | axis->stall_min_counts |
      axis->reverse_counts | axis->drift_counts | axis->settle_ticks | axis->max_delta_counts;
  return bits == 0u;
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P13_exact: \result == slot_rule(axis, period_us);
  @ ensures  known: \result < ILK_CONFIG_ERROR_COUNT;
  @*/
static ilk_config_error_t slot_error(const ilk_axis_config_t *axis, uint32_t period_us) {
  ilk_config_error_t error = ILK_CONFIG_ERROR_NONE;
  if (axis->card >= ILK_CARD_COUNT) {
    error = ILK_CONFIG_ERROR_CARD;
  } else if (has_axis(axis)) {
    error = axis_error(axis, period_us);
  } else if (!is_flag(axis->required)) {
    error = ILK_CONFIG_ERROR_FLAG;
  } else if (!is_bare(axis) || (!has_card(axis) && (axis->required != 0u))) {
    error = ILK_CONFIG_ERROR_EMPTY_SLOT;
  } else {
    error = ILK_CONFIG_ERROR_NONE;
  }
  return error;
}

/*@ requires readable: \valid_read(config);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> some_axis(config, ILK_SLOTS);
  @*/
static bool any_axis(const ilk_config_t *config) {
  bool found = false;
  /*@ loop invariant bounds: 0 <= slot <= ILK_SLOTS;
    @ loop invariant found: found <==> some_axis(config, slot);
    @ loop assigns slot, found;
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    found = found || has_axis(&config->axis[slot]);
  }
  return found;
}

/** The first broken rule and where; `crc` is that of the words that are there. */
/*@ requires readable: \valid_read(config);
  @ assigns  \nothing;
  @ ensures  P13_valid: \result.error == ILK_CONFIG_ERROR_NONE ==> valid_config(config);
  @ ensures  known: \result.error < ILK_CONFIG_ERROR_COUNT && \result.slot <= ILK_SLOTS;
  @ ensures  P13_first: \result.slot < ILK_SLOTS ==> valid_slots(config, \result.slot)
  @   && \result.error == slot_rule(&config->axis[\result.slot], config->period_us)
  @   && \result.error != ILK_CONFIG_ERROR_NONE;
  @ ensures  P13_exact: \result.error == ILK_CONFIG_ERROR_NONE <==>
  @   valid_config(config) && config->crc == crc;
  @ ensures  P13_system: common_rule(config, crc) != ILK_CONFIG_ERROR_NONE ==>
  @   \result.error == common_rule(config, crc) && \result.slot == ILK_SLOTS;
  @ ensures  P13_slots: common_rule(config, crc) == ILK_CONFIG_ERROR_NONE
  @   && !valid_slots(config, ILK_SLOTS) ==> \result.slot < ILK_SLOTS;
  @ ensures  P13_no_axis: common_rule(config, crc) == ILK_CONFIG_ERROR_NONE
  @   && valid_slots(config, ILK_SLOTS) && !some_axis(config, ILK_SLOTS) ==>
  @     \result.error == ILK_CONFIG_ERROR_NO_AXIS && \result.slot == ILK_SLOTS;
  @ ensures  P13_none_named: \result.error == ILK_CONFIG_ERROR_NONE ==> \result.slot == ILK_SLOTS;
  @*/
static ilk_config_verdict_t first_error(const ilk_config_t *config, uint32_t crc) {
  ilk_config_verdict_t verdict = {.error = (uint32_t)system_error(config, crc), .slot = (uint32_t)ILK_SLOTS};
  /*@ loop invariant bounds: 0 <= slot <= ILK_SLOTS;
    @ loop invariant known: verdict.error < ILK_CONFIG_ERROR_COUNT && verdict.slot <= ILK_SLOTS;
    @ loop invariant system: common_rule(config, crc) != ILK_CONFIG_ERROR_NONE ==>
    @   verdict.error == common_rule(config, crc) && verdict.slot == ILK_SLOTS;
    @ loop invariant slots: common_rule(config, crc) == ILK_CONFIG_ERROR_NONE && verdict.slot == ILK_SLOTS ==>
    @   verdict.error == ILK_CONFIG_ERROR_NONE;
    @ loop invariant valid: verdict.error == ILK_CONFIG_ERROR_NONE ==> valid_slots(config, slot);
    @ loop invariant none_named: verdict.error == ILK_CONFIG_ERROR_NONE ==> verdict.slot == ILK_SLOTS;
    @ loop invariant first: verdict.slot < ILK_SLOTS ==> valid_slots(config, verdict.slot)
    @   && verdict.error == slot_rule(&config->axis[verdict.slot], config->period_us)
    @   && verdict.error != ILK_CONFIG_ERROR_NONE;
    @ loop assigns slot, verdict;
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; (slot < (uint32_t)ILK_SLOTS) && (verdict.error == (uint32_t)ILK_CONFIG_ERROR_NONE);
       slot++) {
    verdict.error = (uint32_t)slot_error(&config->axis[slot], config->period_us);
    verdict.slot = (verdict.error == (uint32_t)ILK_CONFIG_ERROR_NONE) ? (uint32_t)ILK_SLOTS : slot;
  }
  if ((verdict.error == (uint32_t)ILK_CONFIG_ERROR_NONE) && !any_axis(config)) {
    verdict.error = (uint32_t)ILK_CONFIG_ERROR_NO_AXIS;
  }
  return verdict;
}

/*@ ensures P13_exact: \result.error == ILK_CONFIG_ERROR_NONE <==>
  @   valid_config(config) && config->crc == config_crc(config);
  @ ensures P13_system: common_rule(config, config_crc(config)) != ILK_CONFIG_ERROR_NONE ==>
  @   \result.error == common_rule(config, config_crc(config)) && \result.slot == ILK_SLOTS;
  @ ensures P13_slots: common_rule(config, config_crc(config)) == ILK_CONFIG_ERROR_NONE
  @   && !valid_slots(config, ILK_SLOTS) ==> \result.slot < ILK_SLOTS;
  @ ensures P13_no_axis: common_rule(config, config_crc(config)) == ILK_CONFIG_ERROR_NONE
  @   && valid_slots(config, ILK_SLOTS) && !some_axis(config, ILK_SLOTS) ==>
  @     \result.error == ILK_CONFIG_ERROR_NO_AXIS && \result.slot == ILK_SLOTS;
  @ ensures P13_none_named: \result.error == ILK_CONFIG_ERROR_NONE ==> \result.slot == ILK_SLOTS;
  @*/
ilk_config_verdict_t ilk_config_validate(const ilk_config_t *config) {
  return first_error(config, ilk_config_crc(config));
}
