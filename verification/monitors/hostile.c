/**
 * @file
 * A hostile environment for the compiled kernel, with every monitor as its judge.
 *
 *   hostile SECONDS SEED                run episodes for so much processor time; exit 1 when a monitor is
 * violated hostile replay EPISODE [FROM TO]    run one episode again (its seed as printed), with a trace of
 * those ticks
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "rig.h"

#define TICKS_PER_EPISODE 40000u
#define QUEUE 24u
#define CLAUSES 96u

static ilk_config_t config;
static ilk_state_t state;
static ilk_inputs_t in;
static ilk_outputs_t out;
static ilk_ghost_t ghost;
static ilk_ghost_t adopted; /* a second one, which begins in the middle */
static ilk_view_t before, after;
static plant_t plant[ILK_SLOTS];
static ilk_request_t queue[QUEUE];
static uint32_t queued;

static struct {
  uint64_t verdict[ILK_VERDICT_COUNT], fault[ILK_FAULT_COUNT], cause[ILK_CAUSE_COUNT], mode[4][4],
      gate[ILK_GATE_COUNT];
  uint64_t homings, homes_wrong, arrivals, moves_reached, driven, requests, flips, flips_met, twins, weak,
      ticks, episodes, shadow_ticks, shadow_homings, adoptions;
  uint64_t valid_configs, rejected_configs, boundaries;
  uint64_t choice[4];
  int64_t worst_home;
} total;

static struct {
  const char* clause;
  uint64_t count, episode;
  uint32_t tick, slot;
  int64_t found, bound;
} clauses[CLAUSES];
static uint32_t clause_count;

static bool note(ilk_judgement_t j, uint64_t episode, uint32_t tick) {
  uint32_t i = 0u;
  if (j.clause == NULL) {
    return false;
  }
  while (i < clause_count && strcmp(clauses[i].clause, j.clause) != 0) {
    i++;
  }
  if (i == CLAUSES) {
    return true;
  }
  if (i == clause_count) {
    clause_count++;
    clauses[i].clause = j.clause;
    clauses[i].episode = episode;
    clauses[i].tick = tick;
    clauses[i].slot = j.slot;
    clauses[i].found = j.found;
    clauses[i].bound = j.bound;
    printf("VIOLATION %s: slot %u found %lld bound %lld, episode %llu tick %u, after %llu ticks\n", j.clause,
           j.slot, (long long)j.found, (long long)j.bound, (unsigned long long)episode, tick,
           (unsigned long long)total.ticks);
    fflush(stdout);
  }
  clauses[i].count++;
  return true;
}

/* ------------------------------------------------------------------ the environment */

/** How unkind this episode is. */
typedef struct {
  uint32_t frames; /* one trouble of a frame in so many ticks and slots; 0: none */
  uint32_t plant;  /* one trouble of an axis in so many */
  uint32_t pedal;
  uint32_t system;   /* E-stop, missed deadlines, bus */
  uint32_t requests; /* one hostile burst in so many ticks */
  uint32_t app;      /* one silence in so many */
  bool contacts;     /* bounce and noise */
  bool frozen;       /* the encoders show the same for long, and moves aim just beyond the deadband */
  bool endless;      /* no stops, the switch never closes, the pedal is held: homing meets its budget */
  bool sluggish;     /* slower than the configuration says */
  bool wandering;    /* nobody homes; the budget of an unhomed axis is used up, DISABLE and ENABLE between */
  bool fumbling;     /* homing is begun again and again in one press, until no budget is left */
  bool homing;       /* axes home again and again, and nothing goes wrong */
  bool waiting;      /* the switch flaps, or the axis never rests, while homing: it meets its time */
} mood_t;

static struct {
  mood_t mood;
  rng_t r;
  uint32_t sequence;
  uint32_t holder;
  uint32_t silent_left;
  bool pressed;
  uint32_t press_left;
  uint32_t disagree_left;
  uint32_t estop_left;
  uint32_t bus_left;
  uint32_t late_left;
  uint32_t old_consent;
  int32_t goal[ILK_SLOTS];
  uint32_t goal_left[ILK_SLOTS];
  uint32_t goal_drive[ILK_SLOTS];
  uint32_t card_left[ILK_SLOTS]; /* the card is silent */
  uint32_t beat;
  bool left_alone[ILK_SLOTS]; /* nobody enables it */
  bool fumbled[ILK_SLOTS];    /* its homing is interrupted and begun again */
  bool slips;                 /* and its counter slips meanwhile */
} env;

static uint32_t shade(rng_t* r, uint32_t often) {
  const uint32_t k = rng_below(r, 4u);
  return (k == 0u) ? 0u : (k == 1u) ? often : (k == 2u) ? often * 10u : often * 100u;
}

static void choose_mood(void) {
  rng_t* r = &env.r;
  mood_t* m = &env.mood;
  m->frames = shade(r, 10u * (ILK_SLOTS + 1u));
  m->plant = shade(r, 100u * (ILK_SLOTS + 1u));
  m->pedal = shade(r, 100u);
  m->system = shade(r, 300u);
  m->requests = shade(r, 3u);
  m->app = shade(r, 300u);
  m->contacts = !rng_one_in(r, 4u);
  bool* const aims[6] = {&m->frozen, &m->endless, &m->wandering, &m->fumbling, &m->waiting, &m->homing};
  const uint32_t aim = rng_below(r, 12u);
  m->sluggish = rng_one_in(r, 8u);
  if (aim < 6u) {
    *aims[aim] = true;
    if (m->homing || !rng_one_in(r, 4u)) { /* and little else */
      m->requests = rng_one_in(r, 2u) ? 300u : 0u;
      m->pedal = 0u;
      m->system = 0u;
      m->app = 0u;
      m->plant = 0u;
      m->frames = m->homing || rng_one_in(r, 2u) ? 0u : m->frames * 10u;
    }
  } else if (rng_one_in(r, 3u)) { /* friendly, but for one kind of trouble */
    uint32_t* const kinds[6] = {&m->frames, &m->plant, &m->pedal, &m->system, &m->requests, &m->app};
    const uint32_t keep = rng_below(r, 6u);
    for (uint32_t k = 0u; k < 6u; k++) {
      *kinds[k] = (k == keep) ? *kinds[k] : 0u;
    }
    m->requests *= 10u;
  }
}

/** A foot that stays down for long. */
static bool is_patient(void) {
  const mood_t* m = &env.mood;
  return m->endless || m->wandering || m->fumbling || m->homing || m->waiting;
}

static bool motor(uint32_t i) { return config.axis[i].card >= 1u && config.axis[i].card <= 4u; }

static ilk_request_t* add(uint32_t kind, uint32_t axis) {
  ilk_request_t* q = &queue[queued < QUEUE ? queued : QUEUE - 1u];
  if (queued < QUEUE) {
    queued++;
  }
  memset(q, 0, sizeof *q);
  q->sequence = ++env.sequence;
  q->kind = kind;
  q->axis = axis;
  q->holder = env.holder;
  q->consent = before.consent;
  return q;
}

static int32_t place_near(uint32_t i) {
  const ilk_axis_config_t* a = &config.axis[i];
  const int32_t at = before.axis[i].position;
  rng_t* r = &env.r;
  if (env.mood.frozen && rng_one_in(r, 2u)) {
    const int32_t step = (int32_t)(a->deadband_counts - 1u + rng_below(r, 4u));
    return rng_one_in(r, 3u) ? at : (int32_t)((uint32_t)at + (uint32_t)(rng_one_in(r, 4u) ? -step : step));
  }
  switch (rng_below(r, 6u)) {
    case 0:
      return a->min_counts + (int32_t)rng_below(r, (uint32_t)(a->max_counts - a->min_counts) + 1u);
    case 1:
      return (int32_t)((uint32_t)at + rng_below(r, 2u * a->coast_counts + 1u) - a->coast_counts);
    case 2:
      return a->min_counts + (int32_t)a->coast_counts + (int32_t)rng_below(r, 3u) - 1;
    case 3:
      return a->max_counts - (int32_t)a->coast_counts + (int32_t)rng_below(r, 3u) - 1;
    case 4:
      return (int32_t)rng_next(r);
    default:
      return (int32_t)((uint32_t)at + rng_below(r, 2u * a->unhomed_travel_counts + 1u) -
                       a->unhomed_travel_counts);
  }
}

static void add_move(uint32_t i, bool wild) {
  const ilk_axis_config_t* a = &config.axis[i];
  rng_t* r = &env.r;
  ilk_request_t* q = add(ILK_REQUEST_MOVE, i);
  const uint32_t top = before.axis[i].homed != ILK_HOMED_NOT ? a->max_drive : a->unhomed_max_drive;
  q->target_counts = wild ? place_near(i) : env.goal[i];
  q->drive = wild && rng_one_in(r, 8u) ? (uint32_t)rng_next(r)
             : wild                    ? rng_range(r, 1u, rng_one_in(r, 4u) ? a->max_drive : top)
             : env.goal_drive[i] < top ? env.goal_drive[i]
                                       : top;
  q->amplitude = a->max_amplitude ? rng_range(r, 1u, a->max_amplitude) : 0u;
  if (wild && rng_one_in(r, 12u)) {
    q->amplitude = rng_below(r, 300u);
  }
  q->lease_ticks = wild ? rng_below(r, config.common.lease_max_ticks + 2u) : config.common.lease_max_ticks;
  if (wild && rng_one_in(r, 8u)) {
    q->consent = rng_one_in(r, 2u) ? env.old_consent : (uint32_t)rng_next(r);
  }
}

static void add_any(uint32_t kind, uint32_t axis) {
  ilk_request_t* q;
  if (kind == ILK_REQUEST_MOVE && axis < ILK_SLOTS && motor(axis)) {
    add_move(axis, true);
    return;
  }
  q = add(kind, axis);
  if (kind == ILK_REQUEST_HOME && rng_one_in(&env.r, 8u)) {
    q->consent = rng_one_in(&env.r, 2u) ? env.old_consent : (uint32_t)rng_next(&env.r);
  }
  if (kind == ILK_REQUEST_RESTORE) {
    q->target_counts = (axis < ILK_SLOTS && motor(axis)) ? place_near(axis) : (int32_t)rng_next(&env.r);
  }
  if (kind == ILK_REQUEST_HEARTBEAT && rng_one_in(&env.r, 20u)) {
    q->holder = rng_below(&env.r, 3u);
    env.holder = q->holder;
  }
}

static void hostile_burst(void) {
  static const uint32_t tune[][6] = {
      {5, 4, 5, 8, 0, 0},  {4, 5, 7, 0, 0, 0}, {8, 4, 5, 7, 0, 0}, {8, 4, 5, 8, 0, 0}, {7, 8, 4, 5, 7, 0},
      {2, 3, 5, 7, 0, 0},  {6, 5, 7, 0, 0, 0}, {6, 4, 5, 8, 7, 0}, {3, 2, 5, 0, 0, 0}, {9, 10, 5, 7, 0, 0},
      {2, 9, 10, 0, 0, 0}, {7, 7, 4, 7, 5, 7}, {1, 3, 5, 8, 0, 0}, {8, 2, 8, 0, 0, 0}, {2, 2, 2, 1, 0, 0}};
  rng_t* r = &env.r;
  const uint32_t axis = rng_below(r, ILK_SLOTS);
  if (rng_one_in(r, 2u)) {
    const uint32_t k = rng_below(r, (uint32_t)(sizeof tune / sizeof tune[0]));
    for (uint32_t i = 0u; i < 6u && tune[k][i] != 0u; i++) {
      add_any(tune[k][i], axis);
    }
  } else {
    const uint32_t n = rng_one_in(r, 10u) ? rng_range(r, 5u, 20u) : rng_range(r, 1u, 4u);
    for (uint32_t i = 0u; i < n; i++) {
      uint32_t kind = rng_range(r, 1u, 10u);
      if (kind == 2u && !rng_one_in(r, 4u)) {
        kind = 7u;
      }
      if (rng_one_in(r, 60u)) {
        kind = (uint32_t)rng_next(r);
      }
      add_any(kind, rng_one_in(r, 40u) ? (uint32_t)rng_next(r) : rng_below(r, ILK_SLOTS));
    }
  }
}

/** DISABLE in the middle: while an axis uses its budgets, most of all when less than a coast of one is left.
 */
static bool interrupts(uint32_t i) {
  const ilk_axis_config_t* a = &config.axis[i];
  const ilk_ghost_slot_t* g = &ghost.slot[i];
  const uint32_t state = before.axis[i].state;
  if (env.fumbled[i] && state == ILK_AXIS_HOMING) {
    const uint64_t nearly = (uint64_t)g->homing_travel + 2u * (uint64_t)a->coast_counts + a->noise_counts;
    return rng_one_in(&env.r, nearly >= a->home_travel_counts ? 4u : 400u);
  }
  return env.mood.wandering && state == ILK_AXIS_MOVING && rng_one_in(&env.r, 60u);
}

/** The drive of the last tick met a bound of stall. */
static bool meets_stall(uint32_t i) {
  const ilk_ghost_slot_t* g = &ghost.slot[i];
  const uint64_t most = (uint64_t)config.axis[i].stall_effort_ticks * config.axis[i].max_drive;
  return g->stall_ticks >= config.axis[i].stall_ticks || (most != 0u && g->effort >= most);
}

/** A fault comes in this tick, perhaps at rest. */
static bool fault_is_due(uint32_t i) {
  const ilk_ghost_slot_t* g = &ghost.slot[i];
  return before.axis[i].state != ILK_AXIS_FAULTED &&
         (meets_stall(i) || g->implausible > 0u ||
          (before.axis[i].state == ILK_AXIS_HOMING &&
           g->homing_ticks + 1u >= config.axis[i].home_timeout_ticks));
}

/** It moves, and its switch will close in a few ticks. */
static bool nears_switch(uint32_t i) {
  const plant_t* p = &plant[i];
  const int64_t way = p->edge - p->x;
  return !p->closed && ((p->v > 0 && way > 0 && way < 3 * p->v) || (p->v < 0 && way < 0 && way > 3 * p->v));
}

/** What a reasonable app asks for. */
static void cooperate(void) {
  rng_t* r = &env.r;
  if (before.mode == ILK_MODE_LOCKED && !env.pressed && rng_one_in(r, 4u)) {
    (void)add(ILK_REQUEST_RESET, 0u);
  }
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    const ilk_axis_config_t* a = &config.axis[i];
    const ilk_axis_view_t* v = &before.axis[i];
    if (!motor(i)) {
      continue;
    }
    if ((v->state == ILK_AXIS_FAULTED && !env.pressed && rng_one_in(r, 5u)) ||
        (fault_is_due(i) && rng_one_in(r, 2u))) {
      (void)add(ILK_REQUEST_CLEAR_FAULT, i);
    }
    if (v->state == ILK_AXIS_DISABLED && before.mode >= ILK_MODE_READY && !env.left_alone[i] &&
        rng_one_in(r, 5u)) {
      (void)add(ILK_REQUEST_ENABLE, i);
    }
    if (before.mode == ILK_MODE_READY && v->homed == ILK_HOMED_NOT && a->limit_side == ILK_LIMIT_NONE &&
        !env.mood.wandering && rng_one_in(r, 10u)) {
      (void)add(ILK_REQUEST_SET_HOME, i);
    }
    if (before.mode == ILK_MODE_MOTION && interrupts(i)) {
      (void)add(ILK_REQUEST_DISABLE, i);
    }
    if (before.mode != ILK_MODE_MOTION || v->state == ILK_AXIS_HOMING || v->state == ILK_AXIS_DISABLED ||
        v->state == ILK_AXIS_FAULTED) {
      continue;
    }
    if (a->limit_side != ILK_LIMIT_NONE && nears_switch(i) && rng_one_in(r, 3u)) {
      (void)add(ILK_REQUEST_HOME, i);
      continue;
    }
    if (a->limit_side != ILK_LIMIT_NONE && !env.mood.wandering &&
        (v->homed == ILK_HOMED_NOT || ((env.fumbled[i] || env.mood.homing) && rng_one_in(r, 100u))) &&
        !rng_one_in(r, 10u)) {
      if (rng_one_in(r, 3u)) {
        (void)add(ILK_REQUEST_HOME, i);
      }
      continue;
    }
    if (v->homed == ILK_HOMED_NOT && (env.mood.wandering || rng_one_in(r, 4u))) { /* as far as is left */
      const int64_t left = (int64_t)a->unhomed_travel_counts - ghost.slot[i].move_travel -
                           (int64_t)(a->coast_counts + a->noise_counts);
      if (ghost.slot[i].lease == 0u && left >= 0 && rng_one_in(r, 4u)) {
        env.goal_left[i] = rng_range(r, 2u, 200u);
        env.goal[i] = (int32_t)(v->position + (rng_one_in(r, 2u) ? -left : left));
        env.goal_drive[i] = a->unhomed_max_drive;
      }
    }
    if (env.goal_left[i] == 0u) {
      env.goal_left[i] = rng_range(r, 50u, 1500u);
      env.goal[i] = (v->homed != ILK_HOMED_NOT && !rng_one_in(r, 4u))
                        ? a->min_counts + (int32_t)a->coast_counts + (int32_t)a->home_clear_counts +
                              (int32_t)rng_below(r, (uint32_t)(a->max_counts - a->min_counts) -
                                                        2u * (a->coast_counts + a->home_clear_counts))
                        : place_near(i);
      env.goal_drive[i] = rng_one_in(r, 2u) ? a->max_drive : rng_range(r, 1u, a->max_drive);
    }
    env.goal_left[i]--;
    add_move(i, false);
  }
}

static void choose_requests(void) {
  rng_t* r = &env.r;
  const uint32_t every = config.common.app_timeout_ticks / 2u;
  /* requests that were not taken are offered again */
  if (queued > ILK_REQUESTS_PER_TICK) {
    memmove(queue, &queue[ILK_REQUESTS_PER_TICK], (queued - ILK_REQUESTS_PER_TICK) * sizeof queue[0]);
    queued -= ILK_REQUESTS_PER_TICK;
  } else {
    queued = 0u;
  }
  if (env.mood.app != 0u && env.silent_left == 0u && rng_one_in(r, env.mood.app)) {
    env.silent_left = rng_range(r, 1u, 3u * config.common.app_timeout_ticks);
  }
  if (env.silent_left > 0u) {
    env.silent_left--;
  } else if (env.beat == 0u) {
    (void)add(ILK_REQUEST_HEARTBEAT, 0u);
    env.beat = every > 1u ? every - 1u : 0u;
  } else {
    env.beat--;
  }
  if (env.mood.requests != 0u && rng_one_in(r, env.mood.requests)) {
    hostile_burst();
    if (rng_one_in(r, 2u)) {
      cooperate();
    }
  } else {
    cooperate();
    if (env.mood.requests != 0u && rng_one_in(r, env.mood.requests * 4u)) {
      hostile_burst();
    }
  }
  for (uint32_t i = 0u; i < queued; i++) {
    if (env.mood.requests != 0u && rng_one_in(r, 100u)) {
      queue[i].sequence = rng_one_in(r, 2u) ? queue[i].sequence - rng_below(r, 5u) : (uint32_t)rng_next(r);
      if (queue[i].sequence - env.sequence < 0x7FFFFFFFu) {
        env.sequence = queue[i].sequence; /* keeps later ones ahead, mostly */
      }
    }
    queue[i].crc = ilk_request_crc(&queue[i]);
    if (env.mood.requests != 0u && rng_one_in(r, 100u)) {
      queue[i].crc ^= 1u << rng_below(r, 32u);
    }
  }
}

static void choose_contacts(void) {
  rng_t* r = &env.r;
  if (env.press_left == 0u) {
    const uint32_t settle = config.common.power_up_ticks + config.common.pedal_debounce_ticks + 80u;
    if (env.pressed) {
      env.pressed = false;
      env.press_left = rng_one_in(r, 4u) ? rng_range(r, 1u, settle) : rng_range(r, settle, 2u * settle);
    } else {
      env.pressed = true;
      env.press_left = rng_one_in(r, is_patient() ? 10u : 3u)
                           ? rng_range(r, 1u, 200u)
                           : rng_range(r, 1000u, is_patient() ? 60000u : 12000u);
    }
  } else {
    env.press_left--;
  }
  if (before.mode == ILK_MODE_LOCKED && env.pressed && rng_one_in(r, 20u)) {
    env.press_left = 0u;
  }
  if (ghost.reset_accepted && rng_one_in(r, 2u)) {
    env.press_left = rng_below(r, config.common.pedal_debounce_ticks);
  }
  if (before.mode == ILK_MODE_READY && env.pressed && rng_one_in(r, 60u)) {
    env.press_left = 0u;
  }
  in.pedal_no_closed = env.pressed ? 1u : 0u;
  in.pedal_nc_closed = env.pressed ? 0u : 1u;
  if (env.mood.pedal != 0u && rng_one_in(r, env.mood.pedal)) {
    switch (rng_below(r, 4u)) {
      case 0:
        env.disagree_left = rng_range(r, 1u, config.common.pedal_disagree_ticks + 2u);
        break;
      case 1:
        in.pedal_no_closed = (uint32_t)rng_next(r);
        break;
      case 2:
        env.press_left = 0u;
        break;
      default: /* one tick the other way */
        in.pedal_no_closed ^= 1u;
        in.pedal_nc_closed ^= 1u;
        break;
    }
  }
  if (env.disagree_left > 0u) {
    env.disagree_left--;
    in.pedal_nc_closed = in.pedal_no_closed;
  }
  in.estop_loop_closed = 1u;
  in.deadlines_missed = 0u;
  in.transaction_done = 1u;
  if (env.mood.system != 0u && rng_one_in(r, env.mood.system)) {
    switch (rng_below(r, 6u)) {
      case 0:
        env.estop_left = rng_range(r, 1u, 20u);
        break;
      case 1:
        env.bus_left = rng_range(r, 1u, config.common.bad_frame_limit + 1u);
        break;
      case 2:
        env.late_left = rng_range(r, 1u, config.common.overrun_limit + 1u);
        break;
      case 3:
        in.deadlines_missed = rng_one_in(r, 10u) ? (uint32_t)rng_next(r) : rng_range(r, 1u, 3u);
        break;
      case 4:
        in.link_generation++;
        env.sequence = rng_one_in(r, 2u) ? 0u : env.sequence;
        break;
      default:
        in.transaction_done = (uint32_t)rng_next(r);
        break;
    }
  }
  if (env.estop_left > 0u) {
    env.estop_left--;
    in.estop_loop_closed = rng_one_in(r, 4u) ? (uint32_t)rng_next(r) & ~1u : 0u;
  }
  if (env.bus_left > 0u) {
    env.bus_left--;
    in.transaction_done = 0u;
  }
  if (env.late_left > 0u) {
    env.late_left--;
    in.deadlines_missed = rng_one_in(r, 3u) ? 2u : 1u;
  }
}

static void trouble_axis(uint32_t i) {
  rng_t* r = &env.r;
  plant_t* p = &plant[i];
  switch (rng_below(r, 11u)) {
    case 0:
      p->stuck_left = rng_range(r, 1u, 2u * config.axis[i].stall_ticks);
      break;
    case 1:
      p->jam_left = rng_range(r, 1u, 2u * config.axis[i].stall_ticks);
      break;
    case 2: /* the wrong way */
      if (out.command[i].drive != 0u) {
        p->runaway = (int64_t)rng_below(r, (uint32_t)p->full + 1u);
        p->runaway = out.command[i].direction == ILK_DIRECTION_INCREASING ? -p->runaway : p->runaway;
        p->runaway_left = rng_range(r, 1u, 80u);
        p->runaway_needs_power = false;
      }
      break;
    case 3:
      p->runaway = (int64_t)(rng_below(r, 2u) ? 1 : -1) * (int64_t)rng_below(r, (uint32_t)p->full + 1u);
      p->runaway_left = rng_range(r, 1u, 80u);
      p->runaway_needs_power = rng_one_in(r, 2u);
      break;
    case 4: /* slowly by hand */
      p->runaway = (int64_t)rng_below(r, Q) - Q / 2;
      p->runaway_left = rng_range(r, 1u, 400u);
      p->runaway_needs_power = false;
      break;
    case 5: /* the card restarts */
      p->raw_zero = (uint32_t)rng_below(r, 20u) - 10u -
                    (config.axis[i].direction_correction == 1u ? 0u - (uint32_t)plant_counts(p)
                                                               : (uint32_t)plant_counts(p));
      if (rng_one_in(r, 4u)) {
        p->raw_zero += (uint32_t)rng_below(r, 5u);
      }
      p->heartbeat = rng_one_in(r, 4u) ? p->heartbeat : 0u;
      if (!rng_one_in(r, 3u) || p->heartbeat != 0u) {
        p->status |= 8u;
      }
      break;
    case 6: /* the counter slips */
      p->raw_zero +=
          rng_below(r, 2u * config.axis[i].max_delta_counts + 2u) - config.axis[i].max_delta_counts;
      break;
    case 7: /* the heartbeat stays, or leaps */
      p->heartbeat += rng_one_in(r, 2u) ? 0xFFFFFFFFu : rng_range(r, 1u, 3u);
      break;
    case 8:
      p->status &= ~8u;
      break;
    case 9:
      p->contact_left = rng_range(r, 1u, 4u * config.common.switch_debounce_ticks);
      p->contact_stuck = rng_one_in(r, 2u);
      break;
    default:
      env.card_left[i] = rng_range(r, 1u, config.common.bad_frame_limit + 2u);
      break;
  }
}

/** Before it rests at the edge its counter slips as far inward as drift is tolerated. */
static void slip_inward(uint32_t i) {
  const ilk_axis_config_t* a = &config.axis[i];
  const ilk_ghost_slot_t* g = &ghost.slot[i];
  const bool lower = a->limit_side == ILK_LIMIT_LOWER;
  const int32_t drifted = judge_counts(a, g->raw, g->drift_mark);
  const int64_t left = (int64_t)a->drift_counts - (lower ? -(int64_t)drifted : drifted);
  const uint32_t counts = left < a->max_delta_counts ? (uint32_t)left : a->max_delta_counts;
  if (!g->driven && left > 0 && plant[i].v == 0) {
    plant[i].raw_zero += lower == (a->direction_correction == 1u) ? counts : 0u - counts;
  }
}

static void exchange(void) {
  rng_t* r = &env.r;
  const uint32_t rounds = 1u + (in.deadlines_missed < 5u ? in.deadlines_missed : 5u);
  in.frames_received = 0u;
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    plant_t* p = &plant[i];
    uint32_t* frame = in.frame[i];
    bool heard = true;
    if (config.axis[i].card == ILK_CARD_NONE) {
      continue;
    }
    for (uint32_t k = 1u; k < rounds; k++) { /* the periods that were missed: the last command holds */
      plant_move(p, &config.axis[i], &out.command[i], out.power == 1u, r);
    }
    if (env.mood.plant != 0u && motor(i) && rng_one_in(r, env.mood.plant)) {
      trouble_axis(i);
    }
    if (env.left_alone[i] && ghost.armed && before.mode == ILK_MODE_READY &&
        rng_one_in(r, 2u * config.common.power_up_ticks + 20u)) {
      p->runaway = rng_one_in(r, 2u) ? p->full : -p->full;
      p->runaway_left = rng_range(r, 1u, 2u * config.axis[i].rest_ticks);
      p->runaway_needs_power = false;
    }
    if (env.slips && env.fumbled[i] && ghost.slot[i].seeks && ghost.slot[i].edges.firsts == 1u &&
        rng_one_in(r, 200u)) {
      p->raw_zero +=
          rng_below(r, 2u * config.axis[i].max_delta_counts + 1u) - config.axis[i].max_delta_counts;
    }
    if (env.slips && env.fumbled[i] && ghost.slot[i].seeks && ghost.slot[i].edges.seconds > 0u) {
      slip_inward(i);
    }
    if (env.mood.frozen) { /* frozen, but for a while now and then */
      p->stuck_left = (ghost.tick / 2048u) % 3u == 0u ? p->stuck_left : 2u;
    }
    if (in.transaction_done == 1u && env.card_left[i] == 0u) {
      plant_send(p, &config.axis[i], r, frame);
      in.frames_received |= 1u << i;
      if (env.mood.waiting && before.axis[i].state == ILK_AXIS_HOMING && i % 3u != 2u) {
        if (i % 3u == 0u) {
          frame[2] = (in.boot_nonce + ghost.tick) % 2u == 0u ? 0u : 0x00080000u;
        } else if (out.command[i].drive == 0u) {
          frame[3] += (ghost.tick % 2u) * (config.axis[i].noise_counts + 1u);
        }
        plant_seal(frame);
      }
      if (env.mood.frozen && meets_stall(i) && rng_one_in(r, 3u)) {
        in.frames_received &= ~(1u << i);
      }
      if (env.mood.frames != 0u && rng_one_in(r, env.mood.frames)) {
        switch (rng_below(r, 7u)) {
          case 0:
            in.frames_received &= ~(1u << i);
            break;
          case 1:
            frame[rng_below(r, ILK_FRAME_WORDS)] ^= 1u << rng_below(r, 32u);
            break;
          case 2:
            frame[11] -= rng_range(r, 1u, 2u);
            plant_seal(frame);
            break;
          case 3: /* repeated */
            if (p->has_last) {
              memcpy(frame, p->last_frame, sizeof p->last_frame);
            }
            break;
          case 4:
            heard = false;
            break;
          case 5: /* contact glitch */
            frame[2] ^= 0x00080000u;
            plant_seal(frame);
            break;
          default: /* counter glitch of one frame */
            frame[3] += rng_one_in(r, 3u) ? (uint32_t)rng_next(r)
                                          : rng_below(r, 2u * config.axis[i].coast_counts + 1u) -
                                                config.axis[i].coast_counts;
            plant_seal(frame);
            break;
        }
      }
      memcpy(p->last_frame, frame, sizeof p->last_frame);
      p->has_last = true;
      if (heard && ghost.frames_sent > 0u) {
        p->echo = out.frame[i][13];
      }
    } else if (env.card_left[i] > 0u) {
      env.card_left[i]--;
    }
    plant_move(p, &config.axis[i], &out.command[i], out.power == 1u, r);
  }
}

/* ------------------------------------------------------------------ a tick */

static void trace(uint32_t tick) {
  printf(
      "t %u mode %u->%u cause %u consent %08x pedal %u/%u estop %u late %u done %u power %u age %u armed "
      "%d/%d",
      tick, before.mode, after.mode, after.cause, after.consent, in.pedal_no_closed, in.pedal_nc_closed,
      in.estop_loop_closed, in.deadlines_missed, in.transaction_done, out.power, ghost.app_age, ghost.armed,
      ghost.armed_weakly);
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    const ilk_ghost_slot_t* g = &ghost.slot[i];
    if (motor(i)) {
      printf(
          "\n    [%u] st %u fault %u homed %u pos %d true %d raw %08x %s%s%s%s hb %u trig %d x%u cmd %u:%u "
          "gate %u lease %u sp %d rest %u stall %u/%llu trav %u/%u edges %u",
          i, after.axis[i].state, after.axis[i].fault, after.axis[i].homed, after.axis[i].position,
          plant_counts(&plant[i]), g->raw, g->valid ? "V" : "-", g->jump ? "J" : "", g->reset ? "R" : "",
          g->lost ? "L" : "", g->heartbeat, g->triggered, g->run, out.command[i].direction,
          out.command[i].drive, out.gate[i], g->lease, g->setpoint, g->rest.ticks, g->stall_ticks,
          (unsigned long long)g->effort, g->move_travel, g->homing_travel, g->edges.seconds);
    }
  }
  for (uint32_t i = 0u; i < out.verdict_count && i < 16u; i++) {
    printf("\n    req kind %u axis %u target %d drive %u lease %u consent %08x holder %u -> %u",
           queue[i].kind, queue[i].axis, queue[i].target_counts, queue[i].drive, queue[i].lease_ticks,
           queue[i].consent, queue[i].holder, out.verdict[i].verdict);
  }
  printf("\n");
}

/** P11: the accepted requests alone give the same outputs and the same published state. */
static ilk_judgement_t twin_without_refused(const ilk_state_t* start) {
  static ilk_state_t other;
  static ilk_outputs_t result;
  static ilk_request_t kept[ILK_REQUESTS_PER_TICK];
  ilk_judgement_t j = {NULL, 0u, 0, 0};
  ilk_view_t view;
  uint32_t n = 0u;
  for (uint32_t i = 0u; i < out.verdict_count && i < ILK_REQUESTS_PER_TICK; i++) {
    if (out.verdict[i].verdict == ILK_VERDICT_ACCEPTED) {
      kept[n++] = queue[i];
    }
  }
  if (n == out.verdict_count) {
    return j;
  }
  total.twins++;
  other = *start;
  memset(&result, 0x5A, sizeof result);
  ilk_step(&config, &other, &in, kept, n, &result);
  judge_view(&other, &view);
  for (uint32_t i = 0u; i < n; i++) {
    if (result.verdict[i].verdict == ILK_VERDICT_SEQUENCE) {
      return j; /* a refused request had used up numbers: one of the counters */
    }
  }
  if (memcmp(&view, &after, sizeof view) != 0) {
    j.clause = "P11: a refused request changed the published state";
  } else if (memcmp(result.command, out.command, sizeof out.command) != 0 ||
             memcmp(result.frame, out.frame, sizeof out.frame) != 0 ||
             memcmp(result.gate, out.gate, sizeof out.gate) != 0 ||
             memcmp(result.lamp, out.lamp, sizeof out.lamp) != 0 || result.power != out.power) {
    j.clause = "P11: a refused request changed an output";
  }
  for (uint32_t i = 0u; i < n && j.clause == NULL; i++) {
    if (result.verdict[i].verdict != ILK_VERDICT_ACCEPTED &&
        result.verdict[i].verdict != ILK_VERDICT_SEQUENCE) {
      j.clause = "P11: a refused request changed a later verdict";
    }
  }
  return j;
}

/** P14 in part: one flipped bit of the state gives zero drive and LOCKED, or the same outputs. */
static ilk_judgement_t twin_with_flip(const ilk_state_t* start) {
  static ilk_state_t other;
  static ilk_outputs_t result;
  ilk_judgement_t j = {NULL, 0u, 0, 0};
  const uint32_t word = rng_below(&env.r, (uint32_t)(sizeof other / 4u));
  bool driven = false;
  other = *start;
  ((uint32_t*)(void*)&other)[word] ^= 1u << rng_below(&env.r, 32u);
  memset(&result, 0x5A, sizeof result);
  ilk_step(&config, &other, &in, queue, queued, &result);
  total.flips++;
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    driven = driven || result.command[i].drive != 0u ||
             (result.frame[i][2] | result.frame[i][3] | result.frame[i][4] | result.frame[i][5] |
              result.frame[i][6] | result.frame[i][14]) != 0u;
  }
  if (other.system.mode == ILK_MODE_LOCKED && other.system.cause == ILK_CAUSE_INTEGRITY && !driven &&
      result.power == 0u) {
    total.flips_met++;
  } else if (memcmp(&result, &out, sizeof out) != 0) {
    j.clause = "P14: a flipped bit of the state changed an output and was not met";
    j.slot = word;
  }
  return j;
}

/** A second run beside the first, with the same requests. Either one reading of an axis that homes is wrong
   (P17), or the inputs of another axis differ (P18). */
static struct {
  uint32_t left; /* ticks */
  uint32_t slot;
  bool homes;
  bool met;   /* the wrong reading was given */
  bool slips; /* it stays wrong */
  uint32_t what;
  uint32_t edges;  /* of the contact, until it comes */
  uint32_t wait;   /* ticks after them */
  uint32_t other;  /* P18: the slot that differs */
  uint32_t offset; /* P18: by so many counts */
  ilk_state_t state;
  ilk_inputs_t in;
  ilk_outputs_t out;
  plant_t plant;
  rng_t r;
} shadow;

/** Nothing is wrong with the readings of the axis. */
static bool is_calm(uint32_t i) {
  const mood_t* m = &env.mood;
  return m->frames == 0u && m->plant == 0u && !m->frozen && !m->waiting && !(env.slips && env.fumbled[i]);
}

static void begin_shadow(void) {
  rng_t* r = &env.r;
  const uint32_t slot = rng_below(r, ILK_SLOTS);
  if (!motor(slot)) {
    return;
  }
  if (is_calm(slot) && after.axis[slot].state == ILK_AXIS_HOMING && plant[slot].glitch_one_in == 0u) {
    shadow.homes = true;
    shadow.left = config.axis[slot].home_timeout_ticks;
    shadow.edges = rng_below(r, 6u);
    shadow.wait =
        rng_one_in(r, 2u) ? rng_below(r, config.common.switch_debounce_ticks + 3u) : rng_below(r, 400u);
    shadow.what = rng_below(r, 4u);
  } else if (ILK_SLOTS > 1u && rng_one_in(r, 2000u)) {
    shadow.homes = false;
    shadow.left = 300u;
    shadow.other = (slot + 1u + rng_below(r, ILK_SLOTS - 1u)) % ILK_SLOTS;
    shadow.offset = rng_below(r, 5u) - 2u;
    if (!motor(shadow.other)) {
      shadow.left = 0u;
    }
  }
  shadow.slot = slot;
  shadow.met = false;
  shadow.slips = false;
  shadow.state = state;
  shadow.out = out;
  shadow.plant = plant[slot];
  shadow.r.s = rng_next(r);
}

/** One reading of the axis that homes is wrong. */
static void spoil_reading(uint32_t* frame) {
  const ilk_axis_config_t* a = &config.axis[shadow.slot];
  const uint32_t step = rng_one_in(&shadow.r, 2u) ? a->max_delta_counts : a->home_tolerance_counts;
  const uint32_t counts = rng_below(&shadow.r, 2u * step + 1u) - step;
  shadow.met = true;
  switch (shadow.what) {
    case 0:
      frame[2] ^= 0x00080000u;
      plant_seal(frame);
      break;
    case 1:
      frame[3] += counts;
      plant_seal(frame);
      break;
    case 2:
      frame[rng_below(&shadow.r, ILK_FRAME_WORDS)] ^= 1u << rng_below(&shadow.r, 32u);
      break;
    default:
      shadow.slips = true;
      shadow.plant.raw_zero += counts;
      frame[3] += counts;
      plant_seal(frame);
      break;
  }
}

/** The frame of the axis that homes, from a plant of its own. */
static void shadow_exchange(void) {
  const uint32_t slot = shadow.slot;
  const ilk_command_t* command = &shadow.out.command[slot];
  const bool power = shadow.out.power == 1u;
  const bool closed = shadow.plant.closed;
  const uint32_t missed = in.deadlines_missed < 5u ? in.deadlines_missed : 5u;
  for (uint32_t k = 0u; k < missed; k++) {
    plant_move(&shadow.plant, &config.axis[slot], command, power, &shadow.r);
  }
  if (in.transaction_done == 1u) {
    plant_send(&shadow.plant, &config.axis[slot], &shadow.r, shadow.in.frame[slot]);
    if (!shadow.met && shadow.edges == 0u && shadow.wait-- == 0u) {
      spoil_reading(shadow.in.frame[slot]);
    }
    shadow.plant.echo = shadow.out.frame[slot][13];
  }
  plant_move(&shadow.plant, &config.axis[slot], command, power, &shadow.r);
  if (closed != shadow.plant.closed && shadow.edges > 0u) {
    shadow.edges--;
  }
}

static void differ(void) {
  uint32_t* frame = shadow.in.frame[shadow.other];
  frame[3] += shadow.offset;
  if (rng_one_in(&shadow.r, 20u)) {
    frame[2] ^= 0x00080000u;
  }
  plant_seal(frame);
  if (rng_one_in(&shadow.r, 50u)) {
    frame[0] ^= 1u;
  }
}

static ilk_judgement_t run_shadow(void) {
  const uint32_t slot = shadow.slot;
  const ilk_axis_config_t* a = &config.axis[slot];
  ilk_judgement_t j = {NULL, slot, 0, 0};
  ilk_view_t view;
  shadow.left--;
  shadow.in = in;
  if (shadow.homes) {
    shadow_exchange();
  } else if (in.transaction_done == 1u) {
    differ();
  }
  ilk_step(&config, &shadow.state, &shadow.in, queue, queued, &shadow.out);
  judge_view(&shadow.state, &view);
  total.shadow_ticks++;
  if (shadow.homes && view.axis[slot].homed == ILK_HOMED_BY_SWITCH) {
    const int64_t off = (int64_t)view.axis[slot].position - plant_counts(&shadow.plant);
    const int64_t slack = (int64_t)a->home_tolerance_counts + a->noise_counts + 1 +
                          (shadow.slips ? (int64_t)a->coast_counts : 0);
    total.shadow_homings += shadow.met ? 1u : 0u;
    if (off > slack || -off > slack) {
      j.clause = "P17: one wrong reading moved home, silently";
      j.found = off;
      j.bound = slack;
    }
  }
  if (view.mode != after.mode || memcmp(shadow.out.verdict, out.verdict, sizeof out.verdict) != 0 ||
      (shadow.homes && view.axis[slot].state != ILK_AXIS_HOMING)) {
    shadow.left = 0u;
  } else if (!shadow.homes &&
             (memcmp(&view.axis[slot], &after.axis[slot], sizeof view.axis[slot]) != 0 ||
              memcmp(&shadow.out.command[slot], &out.command[slot], sizeof out.command[slot]) != 0 ||
              memcmp(shadow.out.frame[slot], out.frame[slot], sizeof out.frame[slot]) != 0 ||
              shadow.out.gate[slot] != out.gate[slot])) {
    j.clause = "P18: an axis does something else because another axis' inputs differ";
  }
  return j;
}

/** When the second ghost is adopted from the state anew: after few ticks or many, or for the rest of an
 * episode. In three of four episodes there is none, for speed. */
static struct {
  rng_t r;
  uint32_t left; /* ticks */
  bool on;
} adoption;

static void adopt_now_and_then(void) {
  if (adoption.left == 0u) {
    const uint32_t least =
        rng_one_in(&adoption.r, 16u) ? TICKS_PER_EPISODE : 1u << rng_below(&adoption.r, 13u);
    adoption.left = least + rng_below(&adoption.r, least);
    ghost_adopt(&adopted, &config, &state);
    total.adoptions++;
  }
  adoption.left--;
}

/** What the second ghost says where the first is content. */
static bool judge_adopted(const ilk_tick_t* t, bool bad, uint64_t episode, uint32_t tick) {
  static char clause[JUDGE_COUNT][128]; /* of each judge the first */
  bool worse = false;
  ghost_observe(&adopted, t);
  ghost_requests(&adopted, t);
  for (uint32_t k = 0u; k < JUDGE_COUNT && !bad; k++) {
    ilk_judgement_t j = ilk_judges[k](&adopted, t);
    if (j.clause != NULL) {
      (void)snprintf(clause[k], sizeof clause[k], "adopted ghost: %s", j.clause);
      j.clause = clause[k];
    }
    worse = note(j, episode, tick) || worse;
  }
  ghost_settle(&adopted, t);
  return worse;
}

static bool run_tick(uint64_t episode, uint32_t tick, bool show) {
  static ilk_state_t start;
  ilk_tick_t t = {&config, true, &in, queue, 0u, &out, &before, &after};
  bool bad = false;
  const bool twins = (tick & 15u) == 3u;
  static bool was_driven[ILK_SLOTS];
  in.boot_nonce = 77u;
  choose_contacts();
  exchange();
  choose_requests();
  t.count = queued;
  if (twins) {
    start = state;
  }
  memset(&out, 0xA5, sizeof out);
  if (adoption.on) {
    adopt_now_and_then();
  }
  ilk_step(&config, &state, &in, queue, queued, &out);
  judge_view(&state, &after);
  ghost_observe(&ghost, &t);
  ghost_requests(&ghost, &t);
  for (uint32_t k = 0u; k < JUDGE_COUNT; k++) {
    bad = note(ilk_judges[k](&ghost, &t), episode, tick) || bad;
  }
  if (adoption.on) {
    bad = judge_adopted(&t, bad, episode, tick) || bad;
  }
  if (twins) {
    bad = note(twin_without_refused(&start), episode, tick) || bad;
    bad = note(twin_with_flip(&start), episode, tick) || bad;
  }
  if (shadow.left > 0u) {
    bad = note(run_shadow(), episode, tick) || bad;
  } else {
    begin_shadow();
  }
  /* counts */
  total.ticks++;
  total.mode[before.mode & 3u][after.mode & 3u]++;
  if (after.mode == ILK_MODE_LOCKED && before.mode != ILK_MODE_LOCKED && after.cause < ILK_CAUSE_COUNT) {
    total.cause[after.cause]++;
  }
  for (uint32_t i = 0u; i < out.verdict_count && i < ILK_REQUESTS_PER_TICK; i++) {
    total.requests++;
    total.verdict[out.verdict[i].verdict < ILK_VERDICT_COUNT ? out.verdict[i].verdict : 0u]++;
  }
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    const ilk_ghost_slot_t* g = &ghost.slot[i];
    if (!motor(i)) {
      continue;
    }
    if (before.axis[i].state != ILK_AXIS_FAULTED && after.axis[i].state == ILK_AXIS_FAULTED &&
        after.axis[i].fault < ILK_FAULT_COUNT) {
      total.fault[after.axis[i].fault]++;
    }
    total.gate[out.gate[i] < ILK_GATE_COUNT ? out.gate[i] : 0u]++;
    if (out.command[i].drive != 0u) {
      total.driven++;
      was_driven[i] = true;
    } else if (g->lease > 0u && after.mode == ILK_MODE_MOTION && after.axis[i].state != ILK_AXIS_HOMING &&
               was_driven[i]) {
      const int64_t off = (int64_t)g->setpoint - after.axis[i].position;
      if (off <= (int64_t)config.axis[i].deadband_counts && -off <= (int64_t)config.axis[i].deadband_counts) {
        total.arrivals++;
        was_driven[i] = false;
      }
    }
    if (g->just_homed) {
      const int64_t off = (int64_t)after.axis[i].position - plant_counts(&plant[i]);
      const int64_t size = off < 0 ? -off : off;
      total.homings++;
      total.worst_home = size > total.worst_home ? size : total.worst_home;
      if (size > (int64_t)config.axis[i].home_tolerance_counts + config.axis[i].noise_counts + 1) {
        total.homes_wrong++;
        if (is_calm(i) && env.mood.system == 0u) {
          const ilk_judgement_t j = {"P17: home is not where the switch closes", i, off,
                                     config.axis[i].home_tolerance_counts};
          bad = note(j, episode, tick) || bad;
        }
      }
    }
  }
  if (show) {
    trace(tick);
  }
  ghost_settle(&ghost, &t);
  if (after.consent != before.consent && before.consent != 0u) {
    env.old_consent = before.consent;
  }
  before = after;
  return bad;
}

/** The smallest homing budgets that validation accepts, by halving. */
static void shrink_budget(uint32_t i) {
  uint32_t* const field[2] = {&config.axis[i].home_travel_counts, &config.axis[i].home_timeout_ticks};
  if (!motor(i) || config.axis[i].limit_side == ILK_LIMIT_NONE) {
    return;
  }
  for (uint32_t k = 0u; k < 2u; k++) {
    uint32_t low = 0u;
    uint32_t high = *field[k];
    while (high - low > 1u) {
      const uint32_t middle = low + (high - low) / 2u;
      *field[k] = middle;
      config.crc = ilk_config_crc(&config);
      if (ilk_config_validate(&config).error == ILK_CONFIG_ERROR_NONE) {
        high = middle;
      } else {
        low = middle;
      }
    }
    *field[k] = high;
    config.crc = ilk_config_crc(&config);
  }
}

/** One number as far to one side as validation lets it: what is accepted there must still satisfy the text.
 */
static void judge_boundary(uint64_t episode) {
  static ilk_config_t edge;
  const uint32_t of_common = (uint32_t)(sizeof edge.common / 4u);
  const uint32_t of_axis = (uint32_t)(sizeof edge.axis[0] / 4u);
  const bool common = rng_one_in(&env.r, 4u);
  const uint32_t slot = rng_below(&env.r, ILK_SLOTS);
  edge = config;
  uint32_t* word = common ? (uint32_t*)(void*)&edge.common + 2u + rng_below(&env.r, of_common - 2u)
                          : (uint32_t*)(void*)&edge.axis[slot] + rng_below(&env.r, of_axis);
  const bool is_signed = word >= (uint32_t*)(void*)&edge.axis[slot].min_counts &&
                         word <= (uint32_t*)(void*)&edge.axis[slot].home_offset_counts;
  int64_t good = is_signed ? (int64_t)(int32_t)*word : (int64_t)*word;
  int64_t bad =
      rng_one_in(&env.r, 2u) ? (is_signed ? INT32_MIN : 0) : (is_signed ? INT32_MAX : (int64_t)UINT32_MAX);
  if (!common && !motor(slot)) {
    return;
  }
  for (uint32_t k = 0u; k < 33u; k++) {
    const int64_t middle = (k == 0u) ? bad : good + (bad - good) / 2;
    *word = (uint32_t)middle;
    edge.crc = ilk_config_crc(&edge);
    if (ilk_config_validate(&edge).error == ILK_CONFIG_ERROR_NONE) {
      good = middle;
      total.boundaries++;
      (void)note(judge_config(&edge), episode, 0u);
    } else {
      bad = middle;
    }
  }
}

static void start_episode(uint64_t episode) {
  ilk_config_verdict_t v;
  memset(&env, 0, sizeof env);
  env.r.s = episode;
  do {
    rig_random_config(&env.r, &config);
    v = ilk_config_validate(&config);
    if (v.error != ILK_CONFIG_ERROR_NONE) {
      total.rejected_configs++;
    }
  } while (v.error != ILK_CONFIG_ERROR_NONE);
  total.valid_configs++;
  (void)note(judge_config(&config), episode, 0u);
  for (uint32_t k = 0u; k < 40u; k++) {
    judge_boundary(episode);
  }
  choose_mood();
  if (env.mood.waiting ||
      (is_patient() && !env.mood.homing &&
       rng_one_in(&env.r, 2u))) { /* budgets as small as validation allows are met sooner */
    for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
      shrink_budget(i);
    }
  }
  memset(&in, 0, sizeof in);
  memset(&out, 0, sizeof out);
  queued = 0u;
  shadow.left = 0u;
  env.slips = rng_one_in(&env.r, 2u);
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    env.left_alone[i] = rng_one_in(&env.r, 8u);
    env.fumbled[i] = env.mood.fumbling && rng_one_in(&env.r, (ILK_SLOTS + 2u) / 3u);
  }
  env.holder = 1u;
  env.press_left = config.common.power_up_ticks + 100u;
  in.link_generation = rng_below(&env.r, 2u);
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    memset(&plant[i], 0, sizeof plant[i]);
    if (config.axis[i].card != ILK_CARD_NONE) {
      plant_init(&plant[i], &config.common, &config.axis[i], &env.r);
      if (env.mood.endless) {
        plant[i].stop_low -= (int64_t)1000000 * Q;
        plant[i].stop_high += (int64_t)1000000 * Q;
        plant[i].edge =
            config.axis[i].limit_side == ILK_LIMIT_LOWER ? plant[i].stop_low * 2 : plant[i].stop_high * 2;
        plant[i].closed = false;
      }
      if (env.mood.sluggish) {
        plant[i].full = plant[i].full / (int64_t)rng_range(&env.r, 2u, 6u) + 1;
      }
      plant[i].wobble = env.mood.wandering && rng_one_in(&env.r, 2u) ? config.axis[i].noise_counts + 1u : 0u;
      plant[i].raw_zero =
          rng_one_in(&env.r, 3u) ? (uint32_t)rng_below(&env.r, 2000u) - 1000u : plant[i].raw_zero;
      if (env.mood.contacts) {
        plant[i].bounce_ticks = 3u;
        plant[i].noise_one_in = 10u;
        plant[i].glitch_one_in = !env.mood.homing && rng_one_in(&env.r, 2u) ? 200u : 0u;
      }
    }
  }
  (void)ilk_init(&config, &state);
  ghost_init(&ghost);
  adoption.r.s = ~episode;
  adoption.left = 0u;
  adoption.on = episode % 4u == 0u;
  judge_view(&state, &before);
}

static void print_totals(double seconds) {
  static const char* const verdicts[] = {"ACCEPTED", "CHECKSUM",   "SEQUENCE",      "UNKNOWN", "AXIS",
                                         "MODE",     "PEDAL_DOWN", "CAUSE_PRESENT", "FAULTED", "CARD",
                                         "NO_FAULT", "DISABLED",   "BUSY",          "LEASE",   "DRIVE",
                                         "RANGE",    "NO_SWITCH",  "CONSENT",       "BUDGET"};
  static const char* const faults[] = {"NONE",       "STALL",  "REVERSE",       "DRIFT",
                                       "JUMP",       "CARD",   "HOMING_TRAVEL", "HOMING_TIMEOUT",
                                       "CARD_RESET", "SWITCH", "INTEGRITY"};
  static const char* const causes[] = {"NONE",  "BOOT",      "ESTOP",   "BUS",
                                       "PEDAL", "INTEGRITY", "OVERRUN", "RUNAWAY"};
  static const char* const modes[] = {"INIT", "LOCKED", "READY", "MOTION"};
  static const char* const gates[] = {"OPEN",           "MODE",  "PEDAL",    "ESTOP",      "CARD",
                                      "ENABLE",         "LEASE", "SETPOINT", "HARD_LIMIT", "SOFT_LIMIT",
                                      "UNHOMED_TRAVEL", "DRIVE", "STALL"};
  printf(
      "slots %u, %llu ticks in %.1f s: %.0f ticks/s, %llu episodes, configurations refused by validation "
      "%llu\n",
      (unsigned)ILK_SLOTS, (unsigned long long)total.ticks, seconds, (double)total.ticks / seconds,
      (unsigned long long)total.episodes, (unsigned long long)total.rejected_configs);
  printf(
      "second runs %llu ticks, %llu homings with a wrong reading; %llu changed configurations accepted\n"
      "homings %llu (farther off than tolerance + noise: %llu, worst %lld), arrivals %llu, driven axis ticks "
      "%llu, adoptions %llu, twins %llu, bit flips %llu (met %llu)\n",
      (unsigned long long)total.shadow_ticks, (unsigned long long)total.shadow_homings,
      (unsigned long long)total.boundaries, (unsigned long long)total.homings,
      (unsigned long long)total.homes_wrong, (long long)total.worst_home, (unsigned long long)total.arrivals,
      (unsigned long long)total.driven, (unsigned long long)total.adoptions, (unsigned long long)total.twins,
      (unsigned long long)total.flips, (unsigned long long)total.flips_met);
  printf(
      "entries to MOTION armed by a release that began before READY: %llu; overrun_limit reached by periods, "
      "not ticks: locked %llu, not %llu; "
      "disagreement of just the limit: locked %llu, not %llu\nverdicts:",
      (unsigned long long)total.weak, (unsigned long long)total.choice[0],
      (unsigned long long)total.choice[1], (unsigned long long)total.choice[2],
      (unsigned long long)total.choice[3]);
  for (uint32_t i = 0u; i < ILK_VERDICT_COUNT; i++) {
    printf(" %s %llu", verdicts[i], (unsigned long long)total.verdict[i]);
  }
  printf("\nfaults:");
  for (uint32_t i = 1u; i < ILK_FAULT_COUNT; i++) {
    printf(" %s %llu", faults[i], (unsigned long long)total.fault[i]);
  }
  printf("\ncauses:");
  for (uint32_t i = 1u; i < ILK_CAUSE_COUNT; i++) {
    printf(" %s %llu", causes[i], (unsigned long long)total.cause[i]);
  }
  printf("\nmodes:");
  for (uint32_t i = 0u; i < 4u; i++) {
    for (uint32_t k = 0u; k < 4u; k++) {
      if (total.mode[i][k] != 0u) {
        printf(" %s>%s %llu", modes[i], modes[k], (unsigned long long)total.mode[i][k]);
      }
    }
  }
  printf("\ngates:");
  for (uint32_t i = 0u; i < ILK_GATE_COUNT; i++) {
    printf(" %s %llu", gates[i], (unsigned long long)total.gate[i]);
  }
  printf("\n");
  for (uint32_t i = 0u; i < clause_count; i++) {
    printf("VIOLATED %llu times: %s; first: slot %u found %lld bound %lld, episode %llu tick %u\n",
           (unsigned long long)clauses[i].count, clauses[i].clause, clauses[i].slot,
           (long long)clauses[i].found, (long long)clauses[i].bound, (unsigned long long)clauses[i].episode,
           clauses[i].tick);
  }
}

/** Whether a clause with this text was violated. */
static bool was_violated(const char* text) {
  bool violated = false;
  for (uint32_t i = 0u; i < clause_count; i++) {
    violated = violated || strstr(clauses[i].clause, text) != NULL;
  }
  return violated;
}

/** Seconds of processor time. */
static double now(void) { return (double)clock() / CLOCKS_PER_SEC; }

int main(int argc, char** argv) {
  if (argc >= 3 && strcmp(argv[1], "replay") == 0) {
    const uint64_t episode = strtoull(argv[2], NULL, 10);
    const uint32_t from = argc > 4 ? (uint32_t)strtoul(argv[3], NULL, 10) : 1u;
    const uint32_t to = argc > 4 ? (uint32_t)strtoul(argv[4], NULL, 10) : 0u;
    start_episode(episode);
    printf(
        "common: period %u channels %u timeout %u lease %u debounce %u disagree %u power %u switch %u bad %u "
        "overrun %u\n",
        config.common.period_us, config.common.pedal_channels, config.common.app_timeout_ticks,
        config.common.lease_max_ticks, config.common.pedal_debounce_ticks, config.common.pedal_disagree_ticks,
        config.common.power_up_ticks, config.common.switch_debounce_ticks, config.common.bad_frame_limit,
        config.common.overrun_limit);
    for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
      const uint32_t* w = (const uint32_t*)(const void*)&config.axis[i];
      static const char* const names[] = {"card",
                                          "required",
                                          "motor_direction",
                                          "direction_correction",
                                          "limit_side",
                                          "min",
                                          "max",
                                          "home_offset",
                                          "coast",
                                          "backlash",
                                          "noise",
                                          "deadband",
                                          "dead_zone",
                                          "max_drive",
                                          "unhomed_max_drive",
                                          "max_amplitude",
                                          "unhomed_travel",
                                          "home_drive",
                                          "home_slow_drive",
                                          "home_amplitude",
                                          "home_travel",
                                          "home_timeout",
                                          "clear",
                                          "tolerance",
                                          "hysteresis",
                                          "full_speed",
                                          "home_speed",
                                          "slow_speed",
                                          "stall_ticks",
                                          "stall_effort",
                                          "stall_min",
                                          "reverse",
                                          "drift",
                                          "rest",
                                          "max_delta"};
      printf("axis %u:", i);
      for (uint32_t k = 0u; k < sizeof config.axis[i] / 4u; k++) {
        printf(" %s %d", names[k], (int32_t)w[k]);
      }
      printf("\n");
    }
    for (uint32_t tick = 0u; tick < TICKS_PER_EPISODE; tick++) {
      if (run_tick(episode, tick, tick >= from && tick <= to)) {
        return 1;
      }
    }
    return 0;
  }
  if (argc < 3) {
    fprintf(stderr, "hostile SECONDS SEED [CLAUSE] | hostile replay EPISODE [FROM TO]\n");
    return 2;
  }
  {
    const double end = now() + strtod(argv[1], NULL);
    const double begin = now();
    rng_t seeds = {strtoull(argv[2], NULL, 10)};
    while (now() < end && !(argc > 3 && was_violated(argv[3]))) {
      const uint64_t episode = rng_next(&seeds) >> 16;
      start_episode(episode);
      total.episodes++;
      for (uint32_t tick = 0u; tick < TICKS_PER_EPISODE; tick++) {
        if (run_tick(episode, tick, false)) {
          break;
        }
      }
      total.weak += ghost.weak_entries;
      for (uint32_t k = 0u; k < 4u; k++) {
        total.choice[k] += ghost.choice[k];
      }
    }
    print_totals(now() - begin);
  }
  return clause_count == 0u ? 0 : 1;
}
