/**
 * @file
 * Valid configurations: what hostile.c and homing.c share.
 */
#ifndef JUDGE_RIG_H
#define JUDGE_RIG_H

#include <string.h>

#include "monitors.h"
#include "plant.h"

static inline uint32_t cap_ticks(uint32_t us, uint32_t period) { return us / period; }

/** A random axis; constants are as often small as large. Not always valid: the caller asks
 * `ilk_config_validate`. */
static inline void rig_random_axis(rng_t* r, const ilk_common_config_t* m, ilk_axis_config_t* a) {
  static const uint32_t largest[5] = {0u, 0x7FFFFFFFu, 0x3FFFFFFFu, 0x7FFFFFFFu, 397785u};
  const bool small = rng_one_in(r, 2u);
  const uint32_t period = m->period_us;
  uint32_t v, need, range, unhomed, home, home_q, slow_q, biggest;
  memset(a, 0, sizeof *a);
  a->card = rng_range(r, 1u, 4u);
  a->required = rng_below(r, 2u);
  a->motor_direction = rng_below(r, 2u);
  a->direction_correction = rng_below(r, 2u);
  a->limit_side = rng_one_in(r, 6u) ? 0u : rng_range(r, 1u, 2u);
  v = small ? rng_range(r, 2u, 14u) : rng_range(r, 10u, 200u); /* counts a tick at full drive */
  a->max_drive = small ? rng_range(r, 100u, 2000u) : rng_range(r, 1000u, largest[a->card]);
  if (a->max_drive > largest[a->card]) {
    a->max_drive = largest[a->card];
  }
  a->dead_zone_drive = rng_one_in(r, 2u) ? 0u : rng_below(r, a->max_drive / 5u + 1u);
  unhomed = (a->max_drive - a->dead_zone_drive) / (rng_one_in(r, 3u) ? rng_range(r, 10u, 20u) : 10u);
  if (unhomed < 4u) {
    unhomed = 4u;
  }
  a->unhomed_max_drive = a->dead_zone_drive + unhomed;
  if (a->card == ILK_CARD_HIGH_FREQUENCY) {
    a->max_amplitude = rng_range(r, 1u, 255u);
  }
  a->full_speed_counts_per_s = (uint32_t)((uint64_t)v * 1000000u / period);
  a->noise_counts = rng_one_in(r, 3u) ? 0u : rng_range(r, 1u, 2u);
  a->backlash_counts = rng_below(r, 3u);
  a->coast_counts =
      3u * v + a->noise_counts + 2u + (rng_one_in(r, 2u) ? rng_below(r, 4u) : rng_below(r, 2u * v));
  a->stall_min_counts = a->noise_counts + 1u + rng_below(r, small ? 3u : 20u);
  a->drift_counts = a->coast_counts + a->backlash_counts + a->noise_counts +
                    rng_below(r, rng_one_in(r, 4u) ? a->coast_counts : 5u);
  a->reverse_counts = a->coast_counts + a->backlash_counts + a->noise_counts + rng_below(r, 5u);
  a->rest_ticks = m->switch_debounce_ticks + 2u + rng_below(r, small ? 10u : 60u);
  a->max_delta_counts = v + a->noise_counts + 1u + rng_below(r, v + 2u);
  a->unhomed_travel_counts = a->coast_counts + 1u + rng_below(r, 3u * a->coast_counts);
  a->stall_effort_ticks = (5u * a->coast_counts + a->backlash_counts + a->noise_counts + 1u + v - 1u) / v +
                          1u + rng_below(r, 10u);
  if (a->stall_effort_ticks > cap_ticks(200000u, period)) {
    a->stall_effort_ticks = 0u;
  }
  biggest = a->drift_counts > a->reverse_counts ? a->drift_counts : a->reverse_counts;
  if (a->unhomed_travel_counts > biggest) {
    biggest = a->unhomed_travel_counts;
  }
  a->stall_ticks = rng_range(r, 20u, cap_ticks(500000u, period));
  if (a->limit_side != ILK_LIMIT_NONE) {
    home = rng_range(r, unhomed / 2u + 1u, unhomed);
    a->home_drive = a->dead_zone_drive + home;
    a->home_slow_drive = a->dead_zone_drive + rng_range(r, home / 2u, home);
    if (a->card == ILK_CARD_HIGH_FREQUENCY) {
      a->home_amplitude = rng_range(r, 1u, a->max_amplitude);
    }
    home_q = (uint32_t)((uint64_t)a->full_speed_counts_per_s * a->home_drive / a->max_drive);
    slow_q = (uint32_t)((uint64_t)a->full_speed_counts_per_s * a->home_slow_drive / a->max_drive);
    a->home_speed_counts_per_s = home_q ? home_q : 1u;
    a->home_slow_speed_counts_per_s = slow_q ? slow_q : 1u;
    a->switch_hysteresis_counts = rng_below(r, 5u);
    a->home_tolerance_counts = (uint32_t)((uint64_t)a->home_speed_counts_per_s * period *
                                          (m->switch_debounce_ticks + 2u) / 1000000u) +
                               1u + 2u * a->noise_counts + rng_below(r, 3u);
    need = a->home_tolerance_counts + a->switch_hysteresis_counts + a->coast_counts;
    if (a->stall_min_counts + a->backlash_counts + a->noise_counts > need) {
      need = a->stall_min_counts + a->backlash_counts + a->noise_counts;
    }
    a->home_clear_counts = need + 1u + rng_below(r, 4u);
    if (a->home_clear_counts > biggest) {
      biggest = a->home_clear_counts;
    }
    need =
        (uint32_t)(((uint64_t)(a->stall_min_counts + a->backlash_counts + a->noise_counts + 1u) * 1000000u) /
                   ((uint64_t)a->home_slow_speed_counts_per_s * period)) +
        8u;
    a->stall_ticks =
        rng_one_in(r, 2u) ? rng_range(r, need, cap_ticks(500000u, period)) : need + rng_below(r, 10u);
  }
  need =
      (5u * a->coast_counts + a->backlash_counts + a->noise_counts + a->stall_min_counts + v - 1u) / v + 1u;
  if (a->stall_ticks < need) {
    a->stall_ticks = need + rng_below(r, 10u);
  }
  range = 10u * biggest + rng_below(r, small ? 200u : 3000u);
  a->min_counts = (int32_t)rng_below(r, 2000u) - 1500;
  a->max_counts = a->min_counts + (int32_t)range;
  a->deadband_counts = rng_one_in(r, 2u) ? a->coast_counts : rng_range(r, 1u, a->coast_counts);
  if (a->limit_side == ILK_LIMIT_LOWER) {
    a->home_offset_counts = a->min_counts + (int32_t)rng_below(r, a->home_clear_counts);
  } else if (a->limit_side == ILK_LIMIT_UPPER) {
    a->home_offset_counts = a->max_counts - (int32_t)rng_below(r, a->home_clear_counts);
  } else {
    a->home_offset_counts = 0;
    if (a->min_counts > 0) {
      a->home_offset_counts = a->min_counts;
    }
    if (a->max_counts < 0) {
      a->home_offset_counts = a->max_counts;
    }
  }
  if (a->limit_side != ILK_LIMIT_NONE) {
    a->home_travel_counts =
        rng_one_in(r, 2u) ? 2u * range : rng_range(r, range + 6u * a->home_clear_counts, 3u * range);
    a->home_timeout_ticks = (uint32_t)((uint64_t)a->home_travel_counts * 1000000u * 3u /
                                       ((uint64_t)a->home_slow_speed_counts_per_s * period)) +
                            40u * a->rest_ticks;
  }
}

static inline void rig_random_config(rng_t* r, ilk_config_t* c) {
  ilk_common_config_t* m = &c->common;
  memset(c, 0, sizeof *c);
  m->version = ILK_CONFIG_VERSION;
  m->size_bytes = (uint32_t)sizeof *c;
  m->period_us = rng_one_in(r, 2u) ? 1000u : rng_range(r, 125u, 2000u);
  m->pedal_channels = rng_range(r, 1u, 2u);
  m->app_timeout_ticks =
      rng_one_in(r, 2u) ? rng_range(r, 2u, 10u) : rng_range(r, 2u, cap_ticks(150000u, m->period_us));
  m->lease_max_ticks =
      rng_one_in(r, 2u) ? rng_range(r, 1u, 10u) : rng_range(r, 1u, cap_ticks(150000u, m->period_us));
  m->pedal_debounce_ticks =
      rng_one_in(r, 2u) ? rng_range(r, 1u, 4u) : rng_range(r, 1u, cap_ticks(50000u, m->period_us));
  m->pedal_disagree_ticks =
      rng_one_in(r, 2u) ? rng_range(r, 1u, 4u) : rng_range(r, 1u, cap_ticks(50000u, m->period_us));
  m->power_up_ticks = rng_one_in(r, 2u) ? rng_range(r, 1u, 5u) : rng_range(r, 1u, 100u);
  m->switch_debounce_ticks =
      rng_range(r, 2u, cap_ticks(20000u, m->period_us) < 6u ? cap_ticks(20000u, m->period_us) : 6u);
  m->bad_frame_limit = rng_range(r, 1u, 5u);
  m->overrun_limit = rng_range(r, 1u, 10u);
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    const uint32_t kind = (i == 0u) ? 9u : rng_below(r, 10u);
    if (kind == 0u) {
      continue; /* empty */
    }
    if (kind == 1u) {
      c->axis[i].card = ILK_CARD_SENSOR;
      c->axis[i].required = rng_below(r, 2u);
      continue;
    }
    rig_random_axis(r, m, &c->axis[i]);
  }
  c->crc = ilk_config_crc(c);
}

#endif
