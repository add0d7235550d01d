/**
 * @file
 * Which configurations are valid, from kernel.md ("Defaults and hard maxima") and the catalog's configuration
 * errors. Written apart from `ilk_config_validate`.
 */
#ifndef ILK_PROOF_VALID_H
#define ILK_PROOF_VALID_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/types.h"

#define SECOND_US 1000000u

static bool between(int64_t value, int64_t lowest, int64_t highest) {
  return (value >= lowest) && (value <= highest);
}

static bool at_most_a_tenth(int64_t counts, uint32_t whole) { return counts <= (int64_t)(whole / 10u); }

static bool at_most_ms(uint32_t ticks, uint32_t period_us, uint32_t longest_ms) {
  return ((uint64_t)ticks * period_us) <= ((uint64_t)longest_ms * 1000u);
}

/** Counts that a speed comes to in some ticks, rounded up. */
static uint64_t way_in(uint64_t ticks, uint32_t period_us, uint32_t counts_per_s) {
  return ((ticks * period_us * counts_per_s) + (SECOND_US - 1u)) / SECOND_US;
}

/** Microseconds that a way takes, rounded up. */
static uint64_t us_for(uint64_t counts, uint32_t counts_per_s) {
  return ((counts * SECOND_US) + counts_per_s - 1u) / counts_per_s;
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

/** From one soft limit to the other; zero, too, of limits that are not in order. */
static uint32_t range_counts(const ilk_axis_config_t* axis) {
  const int64_t range = (int64_t)axis->max_counts - axis->min_counts;
  return (range > 0) ? (uint32_t)range : 0u;
}

/** The system's words, without version, size and CRC. */
static bool valid_common(const ilk_common_config_t* common) {
  const uint32_t us = common->period_us;
  return between(us, 125, 2000) && between(common->pedal_channels, 1, 2) &&
         (common->app_timeout_ticks >= 2u) && at_most_ms(common->app_timeout_ticks, us, 150u) &&
         (common->lease_max_ticks >= 2u) && at_most_ms(common->lease_max_ticks, us, 150u) &&
         (common->pedal_debounce_ticks >= 1u) && at_most_ms(common->pedal_debounce_ticks, us, 50u) &&
         (common->pedal_disagree_ticks >= 1u) && at_most_ms(common->pedal_disagree_ticks, us, 50u) &&
         (common->power_up_ticks >= 1u) && at_most_ms(common->power_up_ticks, us, 5000u) &&
         (common->switch_debounce_ticks >= 2u) && at_most_ms(common->switch_debounce_ticks, us, 20u) &&
         between(common->bad_frame_limit, 1, 5) && between(common->overrun_limit, 1, 10);
}

static bool valid_geometry(const ilk_axis_config_t* axis) {
  const uint32_t range = range_counts(axis);
  const int64_t farthest = (int64_t)1 << 30;
  return (axis->required <= 1u) && (axis->motor_direction <= 1u) && (axis->direction_correction <= 1u) &&
         (axis->limit_side < ILK_LIMIT_COUNT) && (axis->min_counts < axis->max_counts) &&
         (axis->min_counts >= -farthest) && (axis->max_counts <= farthest) &&
         between(axis->home_offset_counts, axis->min_counts, axis->max_counts) && (axis->coast_counts > 0u) &&
         ((2 * (int64_t)axis->coast_counts) < range) && at_most_a_tenth(axis->noise_counts, range) &&
         at_most_a_tenth(axis->backlash_counts, range) && (axis->deadband_counts > 0u) &&
         ((2 * (int64_t)axis->deadband_counts) < range);
}

/** Drives that the card can carry and that move the axis; a motor no faster than its counter can be followed.
 */
static bool valid_drives(const ilk_axis_config_t* axis, uint32_t us) {
  const bool waves = axis->card == ILK_CARD_HIGH_FREQUENCY;
  const uint32_t full = axis->full_speed_counts_per_s;
  return between(axis->max_drive, 1, largest_drive_of(axis->card)) &&
         (axis->unhomed_max_drive > axis->dead_zone_drive) &&
         ((5u * (uint64_t)axis->dead_zone_drive) <= axis->max_drive) &&
         ((10u * (uint64_t)axis->unhomed_max_drive) <=
          ((9u * (uint64_t)axis->dead_zone_drive) + axis->max_drive)) &&
         between(axis->max_amplitude, waves ? 1 : 0, waves ? 255 : 0) &&
         (axis->home_amplitude <= axis->max_amplitude) && between(full, 1, 100000000) &&
         ((way_in(1u, us, full) + axis->noise_counts) <= axis->max_delta_counts) &&
         ((2 * (int64_t)axis->max_delta_counts) <= range_counts(axis)) &&
         (axis->coast_counts >= way_in(ILK_LATENCY_TICKS, us, full)) &&
         (axis->unhomed_travel_counts > ((int64_t)axis->coast_counts + axis->noise_counts)) &&
         at_most_a_tenth(axis->unhomed_travel_counts, range_counts(axis));
}

/** Away from an edge, and back to it, coasting at both ends. */
static uint64_t way_back_and_to(const ilk_axis_config_t* axis) {
  return 2u * ((uint64_t)axis->home_clear_counts + axis->switch_hysteresis_counts +
               (2u * (uint64_t)axis->coast_counts) + axis->noise_counts);
}

static uint64_t way_home(const ilk_axis_config_t* axis) {
  return (uint64_t)range_counts(axis) + (2u * (uint64_t)axis->coast_counts) + (2u * way_back_and_to(axis));
}

/** From either stop to rest at the second edge, within the times that it takes at the slowest. */
static bool homing_ends_in_time(const ilk_axis_config_t* axis, const ilk_common_config_t* common) {
  const uint64_t waits = (4u * (uint64_t)axis->rest_ticks) + (12u * (uint64_t)common->switch_debounce_ticks);
  return ((uint64_t)axis->home_timeout_ticks * common->period_us) >
         (us_for(way_home(axis), axis->home_speed_counts_per_s) +
          us_for(way_back_and_to(axis), axis->home_slow_speed_counts_per_s) + (waits * common->period_us));
}

/** Of an axis with a switch, time apart. */
static bool valid_homing(const ilk_axis_config_t* axis, const ilk_common_config_t* common) {
  const uint32_t range = range_counts(axis);
  const int64_t coast = axis->coast_counts;
  const int64_t clear = axis->home_clear_counts;
  const int64_t margin = (int64_t)axis->home_tolerance_counts + axis->switch_hysteresis_counts;
  const int64_t opens = (axis->limit_side == ILK_LIMIT_LOWER)
                            ? ((int64_t)axis->max_counts - axis->home_offset_counts)
                            : ((int64_t)axis->home_offset_counts - axis->min_counts);
  return (axis->home_slow_speed_counts_per_s > 0u) &&
         (axis->home_slow_speed_counts_per_s <= axis->home_speed_counts_per_s) &&
         (axis->home_speed_counts_per_s <= axis->full_speed_counts_per_s) &&
         between(axis->home_drive, (int64_t)axis->dead_zone_drive + 1, axis->unhomed_max_drive) &&
         between(axis->home_slow_drive, (int64_t)axis->dead_zone_drive + 1, axis->home_drive) &&
         at_most_a_tenth(axis->switch_hysteresis_counts, range) &&
         ((way_in((uint64_t)common->switch_debounce_ticks + 2u, common->period_us,
                  axis->home_speed_counts_per_s) +
           (2u * (uint64_t)axis->noise_counts)) <= axis->home_tolerance_counts) &&
         at_most_a_tenth(axis->home_tolerance_counts, range) &&
         (opens > (margin + coast + axis->deadband_counts)) && (clear > (margin + coast)) &&
         (clear > ((int64_t)axis->stall_min_counts + axis->backlash_counts + axis->noise_counts)) &&
         at_most_a_tenth(clear, range) &&
         (axis->home_travel_counts >=
          (way_home(axis) + (uint64_t)axis->coast_counts + axis->noise_counts + 1u)) &&
         (axis->home_travel_counts <= (4u * (uint64_t)range)) && (axis->home_timeout_ticks > 0u) &&
         at_most_ms(axis->home_timeout_ticks, common->period_us, 600000u);
}

static bool without_homing(const ilk_axis_config_t* axis) {
  return (axis->home_drive == 0u) && (axis->home_slow_drive == 0u) && (axis->home_amplitude == 0u) &&
         (axis->home_travel_counts == 0u) && (axis->home_timeout_ticks == 0u) &&
         (axis->home_clear_counts == 0u) && (axis->home_tolerance_counts == 0u) &&
         (axis->switch_hysteresis_counts == 0u) && (axis->home_speed_counts_per_s == 0u) &&
         (axis->home_slow_speed_counts_per_s == 0u);
}

/** Counts that full speed must come to before a reversal shows `counts` of progress: five coasts, backlash
   and noise. */
static bool reversal_shows(const ilk_axis_config_t* axis, uint64_t ticks, uint32_t us, uint32_t counts) {
  const uint64_t least =
      (5u * (uint64_t)axis->coast_counts) + axis->backlash_counts + axis->noise_counts + counts;
  return (ticks * ((uint64_t)us * axis->full_speed_counts_per_s)) >= (least * SECOND_US);
}

/** A bound of at most 200 ms; none on an axis for which 200 ms are not enough. */
static bool valid_effort(const ilk_axis_config_t* axis, uint32_t us) {
  const uint64_t longest = (uint64_t)200000u / us;
  const bool none = axis->stall_effort_ticks == 0u;
  const uint64_t ticks = none ? longest : axis->stall_effort_ticks;
  return (axis->stall_effort_ticks <= longest) && (none != reversal_shows(axis, ticks, us, 1u));
}

/** Ticks in which a reading shows drive: the loop's latency, and one more, pass before the first. */
static uint32_t shown_of(uint32_t ticks) {
  return (ticks <= (ILK_LATENCY_TICKS + 1u)) ? 0u : (ticks - (ILK_LATENCY_TICKS + 1u));
}

/** In the time of a stall, from the first reading that shows drive, an axis at its slowest makes progress. */
static bool stall_suffices(const ilk_axis_config_t* axis, uint32_t us) {
  const uint64_t slowest = (axis->limit_side == ILK_LIMIT_NONE)
                               ? ((uint64_t)us * axis->full_speed_counts_per_s)
                               : ((uint64_t)us * axis->home_slow_speed_counts_per_s);
  const uint64_t progress = axis->stall_min_counts + (axis->backlash_counts + (uint64_t)axis->noise_counts);
  return ((shown_of(axis->stall_ticks) * slowest) >= (progress * SECOND_US)) &&
         reversal_shows(axis, axis->stall_ticks, us, axis->stall_min_counts);
}

static bool valid_watch(const ilk_axis_config_t* axis, const ilk_common_config_t* common) {
  const uint32_t range = range_counts(axis);
  const uint32_t us = common->period_us;
  const int64_t innocent = (int64_t)axis->coast_counts + axis->backlash_counts + axis->noise_counts;
  return (axis->stall_min_counts > axis->noise_counts) && at_most_a_tenth(axis->stall_min_counts, range) &&
         (axis->stall_ticks > (ILK_LATENCY_TICKS + 1u)) && at_most_ms(axis->stall_ticks, us, 500u) &&
         stall_suffices(axis, us) && valid_effort(axis, us) && (axis->reverse_counts >= innocent) &&
         at_most_a_tenth(axis->reverse_counts, range) && (axis->drift_counts >= innocent) &&
         at_most_a_tenth(axis->drift_counts, range) && (axis->rest_ticks > ILK_LATENCY_TICKS) &&
         at_most_ms(axis->rest_ticks, us, 1000u) && (axis->rest_ticks >= common->switch_debounce_ticks);
}

#endif
