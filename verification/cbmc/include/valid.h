/**
 * @file
 * Which configurations are valid, from kernel.md ("Defaults and hard maxima") and the catalog's configuration
 * errors. Written apart from `ilk_config_validate`, with 64-bit arithmetic throughout.
 */
#ifndef ILK_PROOF_VALID_H
#define ILK_PROOF_VALID_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/types.h"

static bool between(int64_t value, int64_t lowest, int64_t highest) {
  return (value >= lowest) && (value <= highest);
}

static int64_t largest_drive_of(uint32_t card) {
  return ((card == ILK_CARD_PWM) || (card == ILK_CARD_ANALOG)) ? 0x7fffffff
         : (card == ILK_CARD_NON_PWM)                          ? 0x3fffffff
         : (card == ILK_CARD_HIGH_FREQUENCY)                   ? 397785
                                                               : 0;
}

static bool is_motor_card(uint32_t card) {
  return (card >= ILK_CARD_PWM) && (card <= ILK_CARD_HIGH_FREQUENCY);
}

static int64_t range_counts(const ilk_axis_config_t* axis) {
  return (int64_t)axis->max_counts - (int64_t)axis->min_counts;
}

static bool valid_geometry(const ilk_axis_config_t* axis) {
  const int64_t range = range_counts(axis);
  const int64_t farthest = (int64_t)1 << 30;
  return (axis->required <= 1u) && (axis->motor_direction <= 1u) && (axis->direction_correction <= 1u) &&
         (axis->limit_side < ILK_LIMIT_COUNT) && (range > 0) && (axis->min_counts >= -farthest) &&
         (axis->max_counts <= farthest) &&
         between(axis->home_offset_counts, axis->min_counts, axis->max_counts) && (axis->coast_counts > 0u) &&
         ((axis->min_counts + (int64_t)axis->coast_counts) <
          (axis->max_counts - (int64_t)axis->coast_counts)) &&
         (axis->deadband_counts > 0u) && ((2 * (int64_t)axis->deadband_counts) < range);
}

static bool valid_bounds(const ilk_axis_config_t* axis) {
  const bool waves = axis->card == ILK_CARD_HIGH_FREQUENCY;
  return between(axis->max_drive, 1, largest_drive_of(axis->card)) && (axis->unhomed_max_drive > 0u) &&
         ((10 * (int64_t)axis->unhomed_max_drive) <= axis->max_drive) &&
         between(axis->max_amplitude, waves ? 1 : 0, waves ? 255 : 0) &&
         (axis->home_amplitude <= axis->max_amplitude) &&
         (axis->unhomed_travel_counts > axis->coast_counts) &&
         ((10 * (int64_t)axis->unhomed_travel_counts) <= range_counts(axis));
}

/** At its slowest the axis backs off, crosses the travel and rests in time, and within ten minutes. */
static bool homing_ends_in_time(const ilk_axis_config_t* axis, uint32_t period_us) {
  const uint64_t timeout_us = (uint64_t)axis->home_timeout_ticks * period_us;
  const uint64_t rest_us = (uint64_t)axis->home_rest_ticks * period_us;
  const uint64_t distance = (uint64_t)axis->home_travel_counts + axis->home_backoff_counts;
  return (timeout_us <= 600000000u) &&
         (((timeout_us - rest_us) * axis->home_speed_counts_per_s) >= (distance * 1000000u));
}

static bool valid_homing(const ilk_axis_config_t* axis, uint32_t period_us) {
  const int64_t range = range_counts(axis);
  return between(axis->home_drive, 1, axis->unhomed_max_drive) &&
         between(axis->home_travel_counts, range + axis->coast_counts, 2 * range) &&
         (axis->home_backoff_counts > 0u) && ((10 * (int64_t)axis->home_backoff_counts) <= range) &&
         between(axis->home_rest_ticks, 1, axis->home_timeout_ticks) && homing_ends_in_time(axis, period_us);
}

static bool without_homing(const ilk_axis_config_t* axis) {
  return (axis->home_drive == 0u) && (axis->home_travel_counts == 0u) && (axis->home_backoff_counts == 0u) &&
         (axis->home_timeout_ticks == 0u) && (axis->home_rest_ticks == 0u) &&
         (axis->home_speed_counts_per_s == 0u);
}

static bool valid_watch(const ilk_axis_config_t* axis, uint32_t period_us) {
  const int64_t range = range_counts(axis);
  const int64_t innocent = (int64_t)axis->coast_counts + axis->backlash_counts + axis->noise_counts;
  return between((int64_t)axis->stall_ticks * period_us, 1, 500000) && (axis->stall_ticks > 0u) &&
         (axis->stall_min_counts > axis->noise_counts) && ((10 * (int64_t)axis->stall_min_counts) <= range) &&
         (axis->reverse_counts >= innocent) && ((10 * (int64_t)axis->reverse_counts) <= range) &&
         (axis->drift_counts >= innocent) && ((10 * (int64_t)axis->drift_counts) <= range) &&
         (axis->settle_ticks > 0u) && between((int64_t)axis->settle_ticks * period_us, 1, 1000000) &&
         (axis->max_delta_counts > 0u) && ((2 * (int64_t)axis->max_delta_counts) <= range);
}

/* A harness takes for granted only those of these rules that it needs: what is shown under fewer rules holds
 * under all. */

/** A slot with a motor, whose words are valid in a robot with this control period. */
static bool valid_axis(const ilk_axis_config_t* axis, uint32_t period_us) {
  return is_motor_card(axis->card) && valid_geometry(axis) && valid_bounds(axis) &&
         ((axis->limit_side == ILK_LIMIT_NONE) ? without_homing(axis) : valid_homing(axis, period_us)) &&
         valid_watch(axis, period_us);
}

/** The system's words, without version, size and CRC. */
static bool valid_system(const ilk_config_t* config) {
  const int64_t period_us = config->period_us;
  return between(period_us, 125, 2000) && between(config->pedal_channels, 1, 2) &&
         (config->app_timeout_ticks > 0u) && (((int64_t)config->app_timeout_ticks * period_us) <= 150000) &&
         (config->lease_max_ticks > 0u) && (((int64_t)config->lease_max_ticks * period_us) <= 150000) &&
         (config->pedal_debounce_ticks > 0u) &&
         (((int64_t)config->pedal_debounce_ticks * period_us) <= 50000) &&
         (config->pedal_disagree_ticks > 0u) &&
         (((int64_t)config->pedal_disagree_ticks * period_us) <= 50000) &&
         between(config->bad_frame_limit, 1, 5) && between(config->overrun_limit, 1, 10);
}

#endif
