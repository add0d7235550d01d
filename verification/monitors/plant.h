/**
 * @file
 * A small plant for one axis with its card, and random numbers. Integer: distances in 1/1024 count.
 */
#ifndef JUDGE_PLANT_H
#define JUDGE_PLANT_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/kernel.h"

typedef struct {
  uint64_t s;
} rng_t;

static inline uint64_t rng_next(rng_t* r) { /* splitmix64 */
  uint64_t z = (r->s += 0x9E3779B97F4A7C15u);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}
/** 0 to n - 1 */
static inline uint32_t rng_below(rng_t* r, uint32_t n) { return (uint32_t)(((rng_next(r) >> 32) * n) >> 32); }
static inline uint32_t rng_range(rng_t* r, uint32_t low, uint32_t high) {
  return high <= low ? low : low + rng_below(r, high - low + 1u);
}
/** true once in n */
static inline bool rng_one_in(rng_t* r, uint32_t n) { return n != 0u && rng_below(r, n) == 0u; }

#define Q 1024

typedef struct {
  /* the axis */
  int64_t x;     /* true place in the sense of the position, homed truth: the switch closes at home_offset */
  int64_t v;     /* a tick */
  int64_t accel; /* change of v a tick */
  int64_t full;  /* speed at max_drive */
  int64_t backlash;
  int64_t slack; /* motor travel not yet passed on */
  int64_t stop_low, stop_high;
  int64_t edge; /* closes here */
  int64_t hysteresis;
  bool closed; /* contact without bounce */
  uint32_t bounce_left, bounce_ticks;
  uint32_t noise_one_in; /* a reading of n is off by one */
  uint32_t glitch_one_in;
  uint32_t wobble; /* counts by which a reading in motion may be off */
  /* trouble */
  uint32_t stuck_left;   /* the encoder shows the same */
  uint32_t contact_left; /* the contact shows `contact_stuck` */
  bool contact_stuck;
  uint32_t jam_left; /* the axis does not move */
  int64_t runaway;   /* speed it takes by itself */
  uint32_t runaway_left;
  bool runaway_needs_power;
  /* the card */
  uint32_t raw_zero; /* counter at x = 0 */
  uint32_t heartbeat;
  uint32_t status;
  uint32_t echo;
  int32_t shown; /* last reading, while stuck */
  uint32_t last_frame[ILK_FRAME_WORDS];
  bool has_last;
} plant_t;

static inline int32_t plant_counts(const plant_t* p) {
  return (int32_t)(p->x >= 0 ? p->x / Q : -((-p->x + Q - 1) / Q));
}

static inline void plant_seal(uint32_t* frame) {
  uint32_t sum = 0u;
  for (uint32_t i = 0u; i < ILK_FRAME_WORDS - 1u; i++) {
    sum += frame[i];
  }
  frame[ILK_FRAME_WORDS - 1u] = 0xFFFFFFFFu - sum;
}

/** What the card latched, as it sends it in this transaction. */
static inline void plant_send(plant_t* p, const ilk_axis_config_t* c, rng_t* r, uint32_t* frame) {
  int32_t at = plant_counts(p);
  bool contact = p->closed;
  if (p->noise_one_in != 0u && rng_one_in(r, p->noise_one_in)) {
    at += 1;
  }
  if (p->wobble != 0u && p->v != 0 && rng_one_in(r, 3u)) {
    at += (int32_t)p->wobble;
  }
  if (p->stuck_left > 0u) {
    at = p->shown;
  }
  p->shown = at;
  if (p->bounce_left > 0u) {
    p->bounce_left--;
    contact = rng_one_in(r, 2u) ? contact : !contact;
  } else if (p->glitch_one_in != 0u && rng_one_in(r, p->glitch_one_in)) {
    contact = !contact;
  }
  if (p->contact_left > 0u) {
    p->contact_left--;
    contact = p->contact_stuck;
  }
  for (uint32_t i = 0u; i < ILK_FRAME_WORDS; i++) {
    frame[i] = 0u;
  }
  frame[0] = 0xFEFEFE01u;
  frame[2] = contact ? 0u : 0x00080000u;
  frame[3] = p->raw_zero + (c->direction_correction == 1u ? 0u - (uint32_t)at : (uint32_t)at);
  p->heartbeat++;
  frame[9] = p->heartbeat;
  frame[11] = p->echo;
  frame[12] = p->status;
  plant_seal(frame);
}

/** Direction and drive by the words on the wire; drive of a high-frequency card comes from the command. */
static inline void plant_move(plant_t* p, const ilk_axis_config_t* c, const ilk_command_t* command,
                              bool power, rng_t* r) {
  int64_t wanted = 0;
  int64_t step;
  bool closed;
  if (command->drive > c->dead_zone_drive && power) {
    wanted = (int64_t)((uint64_t)p->full * command->drive / (c->max_drive ? c->max_drive : 1u));
    if (command->direction == ILK_DIRECTION_DECREASING) {
      wanted = -wanted;
    }
  }
  if (p->runaway_left > 0u) {
    p->runaway_left--;
    if (power || !p->runaway_needs_power) {
      wanted = p->runaway;
      p->v = wanted;
    }
  }
  if (p->v < wanted) {
    p->v = (p->v + p->accel > wanted) ? wanted : p->v + p->accel;
  } else if (p->v > wanted) {
    p->v = (p->v - p->accel < wanted) ? wanted : p->v - p->accel;
  }
  if (p->jam_left > 0u) {
    p->jam_left--;
    p->v = 0;
  }
  if (p->stuck_left > 0u) {
    p->stuck_left--;
  }
  step = p->v;
  if (p->backlash > 0 && step != 0) { /* slack runs from 0 (pushing up) to backlash (pushing down) */
    int64_t s = p->slack - step;
    if (s < 0) {
      step = -s;
      s = 0;
    } else if (s > p->backlash) {
      step = -(s - p->backlash);
      s = p->backlash;
    } else {
      step = 0;
    }
    p->slack = s;
  }
  p->x += step;
  if (p->x < p->stop_low) {
    p->x = p->stop_low;
    p->v = 0;
  }
  if (p->x > p->stop_high) {
    p->x = p->stop_high;
    p->v = 0;
  }
  closed = p->closed;
  if (c->limit_side == ILK_LIMIT_LOWER) {
    if (p->x <= p->edge) {
      closed = true;
    } else if (p->x > p->edge + p->hysteresis) {
      closed = false;
    }
  } else if (c->limit_side == ILK_LIMIT_UPPER) {
    if (p->x >= p->edge) {
      closed = true;
    } else if (p->x < p->edge - p->hysteresis) {
      closed = false;
    }
  } else {
    closed = false;
  }
  if (closed != p->closed) {
    p->bounce_left = p->bounce_ticks;
    p->closed = closed;
  }
  (void)r;
}

/** A plant that keeps what the configuration promises. `accel` brings it to rest within the coast. */
static inline void plant_init(plant_t* p, const ilk_common_config_t* common, const ilk_axis_config_t* c,
                              rng_t* r) {
  const plant_t zero = {0};
  int64_t margin;
  *p = zero;
  p->full = (int64_t)((uint64_t)c->full_speed_counts_per_s * common->period_us * Q / 1000000u);
  /* two ticks of latency, then v*v/(2a) until rest: a >= v*v / (2 * room) */
  margin = ((int64_t)c->coast_counts - (int64_t)c->noise_counts - 1) * Q - 3 * p->full;
  if (margin < Q / 4) {
    p->accel = p->full + 1;
  } else {
    p->accel = p->full * p->full / (2 * margin) + 1;
  }
  p->backlash = (int64_t)c->backlash_counts * Q / 2;
  p->edge = (int64_t)c->home_offset_counts * Q + (c->limit_side == ILK_LIMIT_LOWER ? Q - 1 : 0);
  p->hysteresis = (int64_t)rng_range(r, 0u, c->switch_hysteresis_counts) * Q;
  p->stop_low = ((int64_t)c->min_counts - 2) * Q;
  p->stop_high = ((int64_t)c->max_counts + 2) * Q;
  p->raw_zero = (uint32_t)rng_next(r);
  p->heartbeat = (uint32_t)rng_next(r);
  p->x = p->stop_low + (int64_t)(rng_next(r) % (uint64_t)(p->stop_high - p->stop_low + 1));
  p->closed = (c->limit_side == ILK_LIMIT_LOWER && p->x <= p->edge) ||
              (c->limit_side == ILK_LIMIT_UPPER && p->x >= p->edge);
}

#endif
