/**
 * @file
 * Homing from many starts, and progress of a friendly plant (L1), with every monitor as a judge.
 *
 *   homing [STARTS [SEED]]     200 starts a configuration by default; exit 1 on a wrong home or a violation
 *
 * A home is right when the position after it is within one count, noise and the slow travel of one tick of
 * the truth.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"

static ilk_config_t config;
static ilk_state_t state;
static ilk_inputs_t in;
static ilk_outputs_t out;
static ilk_ghost_t ghost;
static ilk_view_t before, after;
static plant_t plant;
static rng_t r;
static uint32_t sequence;
static uint32_t tick_number;
static uint64_t violations;

/** Four valid configurations: a slow and a fast axis, switch at either end, with and without noise and
 * hysteresis. */
static bool make_config(uint32_t which) {
  ilk_common_config_t* m = &config.common;
  ilk_axis_config_t* a = &config.axis[0];
  memset(&config, 0, sizeof config);
  m->version = ILK_CONFIG_VERSION;
  m->size_bytes = (uint32_t)sizeof config;
  m->period_us = which == 3u ? 500u : 1000u;
  m->pedal_channels = 2u;
  m->app_timeout_ticks = 100u;
  m->lease_max_ticks = 100u;
  m->pedal_debounce_ticks = 10u;
  m->pedal_disagree_ticks = 50u;
  m->power_up_ticks = 20u;
  m->switch_debounce_ticks = 5u;
  m->bad_frame_limit = 3u;
  m->overrun_limit = 3u;
  a->card = which == 0u   ? ILK_CARD_PWM
            : which == 1u ? ILK_CARD_ANALOG
            : which == 2u ? ILK_CARD_NON_PWM
                          : ILK_CARD_HIGH_FREQUENCY;
  a->motor_direction = which & 1u;
  a->direction_correction = (which >> 1) & 1u;
  a->limit_side = (which == 0u || which == 3u) ? ILK_LIMIT_LOWER : ILK_LIMIT_UPPER;
  a->max_drive = which == 3u ? 100000u : 10000u;
  a->unhomed_max_drive = a->max_drive / 10u;
  a->home_drive = a->unhomed_max_drive;
  a->home_slow_drive = a->home_drive / 2u;
  a->dead_zone_drive = a->home_slow_drive / 4u;
  if (which == 3u) {
    a->max_amplitude = 200u;
    a->home_amplitude = 100u;
  }
  {
    const uint32_t v = which == 0u ? 8u : which == 1u ? 40u : which == 2u ? 12u : 20u; /* counts a tick */
    const uint32_t per_s = (uint32_t)(1000000u / m->period_us);
    a->full_speed_counts_per_s = v * per_s;
    a->home_speed_counts_per_s = v * per_s / 10u;
    a->home_slow_speed_counts_per_s = v * per_s / 20u;
    a->noise_counts = which == 2u ? 0u : 1u;
    a->backlash_counts = which == 1u ? 2u : 0u;
    a->coast_counts = 4u * v + a->noise_counts + 2u;
    a->deadband_counts = a->coast_counts / 2u + 1u;
    a->switch_hysteresis_counts = which == 0u ? 0u : 3u;
    a->stall_min_counts = 3u + a->noise_counts;
    a->home_tolerance_counts = v * 7u / 10u + 2u + 2u * a->noise_counts;
    a->home_clear_counts = a->home_tolerance_counts + a->switch_hysteresis_counts + a->coast_counts + 10u;
    a->drift_counts = a->coast_counts + a->backlash_counts + a->noise_counts + 4u;
    a->reverse_counts = a->drift_counts;
    a->stall_effort_ticks = (5u * a->coast_counts + a->backlash_counts + a->noise_counts + 1u) / v + 2u;
    a->stall_ticks = 200u;
    a->rest_ticks = 20u;
    a->max_delta_counts = 2u * v;
    a->unhomed_travel_counts = 2u * a->coast_counts;
    a->min_counts = -100;
    a->max_counts = a->min_counts + (int32_t)(30u * a->home_clear_counts);
    a->home_offset_counts = a->limit_side == ILK_LIMIT_LOWER ? a->min_counts + 10 : a->max_counts - 10;
    a->home_travel_counts = 80u * a->home_clear_counts;
    a->home_timeout_ticks = 40u * a->home_travel_counts / v + 2000u;
  }
  config.crc = ilk_config_crc(&config);
  return ilk_config_validate(&config).error == ILK_CONFIG_ERROR_NONE;
}

static ilk_request_t make(uint32_t kind) {
  ilk_request_t q;
  memset(&q, 0, sizeof q);
  q.sequence = ++sequence;
  q.kind = kind;
  q.holder = 1u;
  q.consent = before.consent;
  return q;
}

/** One tick with at most one request beside the heartbeat. */
static uint32_t run(bool pressed, const ilk_request_t* extra) {
  ilk_request_t list[2];
  ilk_tick_t t = {&config, true, &in, list, 0u, &out, &before, &after};
  list[0] = make(ILK_REQUEST_HEARTBEAT);
  list[0].crc = ilk_request_crc(&list[0]);
  t.count = 1u;
  if (extra != NULL) {
    list[1] = *extra;
    list[1].sequence = ++sequence;
    list[1].crc = ilk_request_crc(&list[1]);
    t.count = 2u;
  }
  in.boot_nonce = 5u;
  in.transaction_done = 1u;
  in.frames_received = 1u;
  in.estop_loop_closed = 1u;
  in.pedal_no_closed = pressed ? 1u : 0u;
  in.pedal_nc_closed = pressed ? 0u : 1u;
  plant_send(&plant, &config.axis[0], &r, in.frame[0]);
  if (tick_number > 0u) {
    plant.echo = out.frame[0][13];
  }
  plant_move(&plant, &config.axis[0], &out.command[0], out.power == 1u, &r);
  ilk_step(&config, &state, &in, list, t.count, &out);
  judge_view(&state, &after);
  ghost_observe(&ghost, &t);
  ghost_requests(&ghost, &t);
  for (uint32_t k = 0u; k < JUDGE_COUNT; k++) {
    const ilk_judgement_t j = ilk_judges[k](&ghost, &t);
    if (j.clause != NULL && violations++ < 20u) {
      printf("VIOLATION %s found %lld bound %lld tick %u\n", j.clause, (long long)j.found, (long long)j.bound,
             tick_number);
    }
  }
  ghost_settle(&ghost, &t);
  before = after;
  tick_number++;
  return extra != NULL ? out.verdict[1].verdict : 0u;
}

static void begin(int64_t start, uint32_t bounce, uint32_t noise_one_in, uint32_t glitch_one_in) {
  ilk_request_t q;
  memset(&in, 0, sizeof in);
  memset(&out, 0, sizeof out);
  sequence = 0u;
  tick_number = 0u;
  plant_init(&plant, &config.common, &config.axis[0], &r);
  plant.x = start;
  plant.closed = config.axis[0].limit_side == ILK_LIMIT_LOWER ? plant.x <= plant.edge : plant.x >= plant.edge;
  plant.bounce_ticks = bounce;
  plant.noise_one_in = config.axis[0].noise_counts > 0u ? noise_one_in : 0u;
  plant.glitch_one_in = glitch_one_in;
  (void)ilk_init(&config, &state);
  ghost_init(&ghost);
  judge_view(&state, &before);
  for (uint32_t i = 0u; i < 40u; i++) {
    (void)run(false, NULL);
  }
  q = make(ILK_REQUEST_RESET);
  (void)run(false, &q);
  for (uint32_t i = 0u; i < 60u; i++) {
    (void)run(false, NULL);
  }
  q = make(ILK_REQUEST_ENABLE);
  (void)run(false, &q);
  for (uint32_t i = 0u; i < 30u && before.mode != ILK_MODE_MOTION; i++) {
    (void)run(true, NULL);
  }
}

int main(int argc, char** argv) {
  const uint32_t starts = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 200u;
  uint64_t wrong = 0u, stuck = 0u;
  r.s = argc > 2 ? strtoull(argv[2], NULL, 10) : 1u;
  for (uint32_t which = 0u; which < 4u; which++) {
    const ilk_axis_config_t* a = &config.axis[0];
    uint64_t homed = 0u, faulted[ILK_FAULT_COUNT] = {0}, refused = 0u, reached = 0u, moves = 0u, stopped = 0u,
             late = 0u;
    int64_t worst = 0, longest = 0;
    if (!make_config(which)) {
      const ilk_config_verdict_t v = ilk_config_validate(&config);
      printf("configuration %u is refused: error %u slot %u\n", which, v.error, v.slot);
      return 2;
    }
    for (uint32_t i = 0u; i < starts; i++) {
      const int64_t low = ((int64_t)a->min_counts - 2) * Q;
      const int64_t high = ((int64_t)a->max_counts + 2) * Q;
      const int64_t edge = (int64_t)a->home_offset_counts * Q;
      const int64_t side = a->limit_side == ILK_LIMIT_LOWER ? 1 : -1;
      int64_t start = 0, off;
      bool done = false;
      ilk_request_t q;
      switch (i % 6u) {
        case 0:
          start = low;
          break;
        case 1:
          start = high;
          break;
        case 2: /* on the switch, at its edge */
          start = edge - side * (int64_t)rng_below(&r, 3u) * Q;
          break;
        case 3: /* just beyond it, within hysteresis and bounce */
          start = edge + side * (int64_t)(1u + rng_below(&r, a->switch_hysteresis_counts + 4u)) * Q;
          break;
        default:
          start = low + (int64_t)(rng_next(&r) % (uint64_t)(high - low));
          break;
      }
      begin(start, rng_below(&r, 4u), rng_one_in(&r, 4u) ? 0u : 10u, rng_one_in(&r, 2u) ? 0u : 300u);
      if (before.mode != ILK_MODE_MOTION) {
        refused++;
        continue;
      }
      q = make(ILK_REQUEST_HOME);
      if (run(true, &q) != ILK_VERDICT_ACCEPTED) {
        refused++;
        continue;
      }
      for (int64_t k = 0; k < (int64_t)a->home_timeout_ticks + 2000 && !done; k++) {
        (void)run(true, NULL);
        if (before.axis[0].homed == ILK_HOMED_BY_SWITCH) {
          done = true;
          homed++;
          longest = k > longest ? k : longest;
        } else if (before.axis[0].state == ILK_AXIS_FAULTED) {
          done = true;
          faulted[before.axis[0].fault < ILK_FAULT_COUNT ? before.axis[0].fault : 0u]++;
        }
      }
      if (!done) {
        stuck++;
        continue;
      }
      if (before.axis[0].homed != ILK_HOMED_BY_SWITCH) {
        continue;
      }
      off = (int64_t)before.axis[0].position - plant_counts(&plant);
      off = off < 0 ? -off : off;
      worst = off > worst ? off : worst;
      /* one count, noise, and what the slow approach travels in one tick and in the bounce */
      if (off > 1 + (int64_t)a->noise_counts + 1 +
                    (int64_t)(a->home_slow_speed_counts_per_s * config.common.period_us / 1000000u) * 4 +
                    (int64_t)(a->home_slow_speed_counts_per_s * config.common.period_us % 1000000u * 4u /
                              1000000u)) {
        wrong++;
        printf("WRONG HOME configuration %u start %u: %lld off\n", which, i, (long long)off);
      }
      /* L1: accepted setpoints are reached and stay reached */
      plant.glitch_one_in = 0u;
      for (uint32_t n = 0u; n < 3u; n++) {
        const int32_t room = (int32_t)a->coast_counts + (int32_t)a->home_clear_counts;
        const int32_t goal = a->min_counts + room +
                             (int32_t)rng_below(&r, (uint32_t)(a->max_counts - a->min_counts - 2 * room));
        const uint32_t drive = rng_range(&r, a->home_slow_drive, a->max_drive);
        int32_t in_band = 0, k = 0;
        moves++;
        for (k = 0; k < 20000 && in_band < 200 && before.mode == ILK_MODE_MOTION; k++) {
          uint32_t verdict;
          int64_t away;
          q = make(ILK_REQUEST_MOVE);
          q.target_counts = goal;
          q.drive = drive;
          q.amplitude = a->max_amplitude;
          q.lease_ticks = config.common.lease_max_ticks;
          verdict = run(true, &q);
          away = (int64_t)goal - before.axis[0].position;
          away = away < 0 ? -away : away;
          if (verdict != ILK_VERDICT_ACCEPTED) {
            break;
          }
          in_band = (away <= (int64_t)a->deadband_counts && out.command[0].drive == 0u) ? in_band + 1 : 0;
        }
        if (in_band >= 200) {
          reached++;
        } else if (before.mode != ILK_MODE_MOTION) {
          stopped++;
          break;
        } else {
          late++;
        }
      }
    }
    printf(
        "configuration %u: homed %llu of %u, worst %lld counts off, longest %lld ticks; refused %llu; "
        "faults:",
        which, (unsigned long long)homed, starts, (long long)worst, (long long)longest,
        (unsigned long long)refused);
    for (uint32_t f = 1u; f < ILK_FAULT_COUNT; f++) {
      if (faulted[f] != 0u) {
        printf(" %u: %llu", f, (unsigned long long)faulted[f]);
      }
    }
    printf("; L1: %llu moves, %llu reached and stayed, %llu ended by a fault, %llu not reached\n",
           (unsigned long long)moves, (unsigned long long)reached, (unsigned long long)stopped,
           (unsigned long long)late);
    wrong += late;
  }
  printf("wrong homes or moves %llu, homings without end %llu, violations %llu\n", (unsigned long long)wrong,
         (unsigned long long)stuck, (unsigned long long)violations);
  return (wrong == 0u && stuck == 0u && violations == 0u) ? 0 : 1;
}
