/**
 * @file
 * The monitors and their ghost. See monitors.h.
 */
#include "monitors.h"

#include <stddef.h>

/* ------------------------------------------------------------------ small arithmetic */

#define START_WORD 0xFEFEFE01u
#define SWITCH_OPEN_BIT 0x00080000u
#define STATUS_RESET 8u

static uint32_t plus(uint32_t a, uint32_t b) { return (a > UINT32_MAX - b) ? UINT32_MAX : a + b; }

static uint64_t plus64(uint64_t a, uint64_t b) { return (a > UINT64_MAX - b) ? UINT64_MAX : a + b; }

/** `to - from` modulo 2^32 as a signed number. */
static int32_t wrapped(uint32_t to, uint32_t from) {
  const uint32_t d = to - from;
  return (d <= 0x7FFFFFFFu) ? (int32_t)d : -(int32_t)(~d) - 1;
}

static uint32_t size_of(int32_t v) { return (v < 0) ? 0u - (uint32_t)v : (uint32_t)v; }

static int32_t saturate(int64_t v) {
  if (v > INT32_MAX) {
    return INT32_MAX;
  }
  return (v < INT32_MIN) ? INT32_MIN : (int32_t)v;
}

int32_t judge_counts(const ilk_axis_config_t* config, uint32_t to, uint32_t from) {
  return (config->direction_correction == 1u) ? wrapped(from, to) : wrapped(to, from);
}

static bool has_motor(const ilk_axis_config_t* config) { return config->card >= 1u && config->card <= 4u; }

static uint32_t towards_switch(const ilk_axis_config_t* config) {
  if (config->limit_side == ILK_LIMIT_LOWER) {
    return ILK_DIRECTION_DECREASING;
  }
  return (config->limit_side == ILK_LIMIT_UPPER) ? ILK_DIRECTION_INCREASING : ILK_DIRECTION_NONE;
}

/** `counts` as progress in `direction`. */
static int64_t along(uint32_t direction, int32_t counts) {
  if (direction == ILK_DIRECTION_INCREASING) {
    return counts;
  }
  return (direction == ILK_DIRECTION_DECREASING) ? -(int64_t)counts : 0;
}

/** A tick passes. */
static void still_age(ilk_still_t* still) {
  still->steady = plus(still->steady, 1u);
  still->ticks = plus(still->ticks, (still->ticks > 0u) ? 1u : 0u);
  still->low_age = plus(still->low_age, 1u);
  still->high_age = plus(still->high_age, 1u);
  still->apart_age = plus(still->apart_age, 1u);
}

/** The run ends: nothing is known. */
static void still_end(ilk_still_t* still) {
  still->ticks = 0u;
  still->steady = 0u;
  still->apart_age = UINT32_MAX;
}

/** A reading of this tick. `ticks` is then a length of time for which no two readings were farther apart than
   `bound`; `apart_age` the age of the older of two readings that were. */
static void still_add(ilk_still_t* still, const ilk_axis_config_t* config, uint32_t raw, uint32_t bound) {
  const int32_t at = judge_counts(config, raw, still->origin);
  if (still->ticks > 1u && (int64_t)at - still->low > (int64_t)bound) {
    still->apart_age = (still->low_age < still->apart_age) ? still->low_age : still->apart_age;
    still->ticks = 0u;
  } else if (still->ticks > 1u && (int64_t)still->high - at > (int64_t)bound) {
    still->apart_age = (still->high_age < still->apart_age) ? still->high_age : still->apart_age;
    still->ticks = 0u;
  }
  if (still->ticks <= 1u) {
    still->origin = raw;
    still->low = 0;
    still->high = 0;
    still->low_age = 0u;
    still->high_age = 0u;
    still->ticks = 1u;
    still->steady = 0u;
  } else if (at <= still->low) {
    still->steady = (at < still->low) ? 0u : still->steady;
    still->low = at;
    still->low_age = 0u;
    if (at >= still->high) {
      still->high_age = 0u;
    }
  } else if (at >= still->high) {
    still->steady = (at > still->high) ? 0u : still->steady;
    still->high = at;
    still->high_age = 0u;
  }
}

static const ilk_judgement_t HOLDS = {NULL, 0u, 0, 0};

static ilk_judgement_t broken(const char* clause, uint32_t slot, int64_t found, int64_t bound) {
  const ilk_judgement_t j = {clause, slot, found, bound};
  return j;
}

bool judge_is_zero_drive(const uint32_t* frame) {
  return (frame[2] | frame[3] | frame[4] | frame[5] | frame[6] | frame[14]) == 0u;
}

static bool is_driven(const ilk_tick_t* tick, uint32_t slot) {
  return !judge_is_zero_drive(tick->out->frame[slot]) || tick->out->command[slot].drive != 0u ||
         tick->out->command[slot].direction != ILK_DIRECTION_NONE;
}

void judge_view(const ilk_state_t* s, ilk_view_t* v) {
  v->mode = s->system.mode;
  v->cause = s->system.cause;
  v->consent = s->system.consent;
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    v->axis[i].state = s->axis[i].state;
    v->axis[i].fault = s->axis[i].fault;
    v->axis[i].homed = s->axis[i].homed;
    v->axis[i].position = s->axis[i].position_counts;
  }
}

/* ------------------------------------------------------------------ what the inputs say */

void ghost_init(ilk_ghost_t* ghost) {
  const ilk_ghost_t zero = {0};
  *ghost = zero;
  ghost->app_age = UINT32_MAX;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    still_end(&ghost->slot[slot].rest);
    still_end(&ghost->slot[slot].calm);
    ghost->slot[slot].since_disable = UINT32_MAX;
  }
  ghost->mode = ILK_MODE_LOCKED;
}

static bool checksum_is_right(const uint32_t* frame) {
  uint32_t sum = 0u;
  for (uint32_t i = 0u; i < ILK_FRAME_WORDS - 1u; i++) {
    sum += frame[i];
  }
  return frame[ILK_FRAME_WORDS - 1u] == 0xFFFFFFFFu - sum;
}

static bool frame_is_valid(const ilk_ghost_t* ghost, const ilk_inputs_t* in, uint32_t slot) {
  const uint32_t* frame = in->frame[slot];
  if (in->transaction_done != 1u || ((in->frames_received >> slot) & 1u) == 0u) {
    return false;
  }
  if (frame[0] != START_WORD || !checksum_is_right(frame)) {
    return false;
  }
  return ghost->frames_sent < 2u || frame[11] == ghost->tick - 2u;
}

static void observe_frame(ilk_ghost_t* ghost, ilk_ghost_slot_t* g, const ilk_tick_t* tick, uint32_t slot) {
  const ilk_axis_config_t* config = &tick->config->axis[slot];
  const uint32_t* frame = tick->in->frame[slot];
  const uint32_t raw = frame[3];

  g->periods = plus(plus(g->periods, 1u), tick->in->deadlines_missed);
  g->valid = frame_is_valid(ghost, tick->in, slot);
  g->first = false;
  g->jump = false;
  g->reset = false;
  if (!g->valid) {
    g->bad_run = plus(g->bad_run, 1u);
    g->lost = g->bad_run >= tick->config->common.bad_frame_limit;
    return;
  }
  g->first = !g->seen || g->lost;
  if (!g->first) {
    const uint32_t ahead = frame[9] - g->heartbeat;
    const bool flag = (frame[12] & STATUS_RESET) != 0u && (g->status & STATUS_RESET) == 0u;
    g->reset = flag || ahead == 0u || ahead > plus(1u, g->periods);
    g->jump = (uint64_t)size_of(wrapped(raw, g->raw)) > (uint64_t)config->max_delta_counts * g->periods;
  }
  g->bad_run = 0u;
  g->lost = false;
}

/** After everything that compares with the last reading. */
static void keep_frame(ilk_ghost_slot_t* g, const ilk_axis_config_t* config, const uint32_t* frame) {
  const bool triggered = (frame[2] & SWITCH_OPEN_BIT) == 0u;
  if (!g->valid) {
    return;
  }
  if (g->run > 0u && triggered == g->triggered) {
    g->run = plus(g->run, 1u);
  } else {
    g->run = 1u;
    g->run_raw = frame[3];
  }
  g->triggered = triggered;
  g->delta = g->first ? 0 : judge_counts(config, frame[3], g->raw);
  g->seen = true;
  g->heartbeat = frame[9];
  g->status = frame[12];
  g->raw = frame[3];
  g->periods = 0u;
}

static void observe_rest(ilk_ghost_slot_t* g, const ilk_axis_config_t* config, uint32_t raw) {
  still_age(&g->rest);
  still_age(&g->calm);
  g->quiet = plus(g->quiet, 1u);
  if (g->driven || !g->valid) {
    still_end(&g->rest);
    g->quiet = g->valid ? 1u : 0u;
  }
  if (g->jump || g->reset ||
      g->first) { /* earlier readings may mean another place: undecided for rest_ticks */
    g->rest.ticks = 0u;
    g->rest.steady = 0u;
    g->calm.ticks = 0u;
  }
  if (g->valid) {
    still_add(&g->rest, config, raw, config->noise_counts);
    still_add(&g->calm, config, raw, config->drift_counts);
  }
  g->since_disable = plus(g->since_disable, 1u);
}

/** Not at rest for sure: driven, an invalid frame, or two readings too far apart in the last rest_ticks. */
static bool moves(const ilk_ghost_slot_t* g, const ilk_axis_config_t* config) {
  return g->quiet < config->rest_ticks || g->rest.apart_age < config->rest_ticks;
}

/** At rest for sure. A kernel that counts runs of readings decides rest later than the text, but not once all
   of the last rest_ticks readings lie where others of the run lay before: its run, which may have begun
   earlier, would have ended at one of those. */
static bool rests(const ilk_ghost_slot_t* g, const ilk_axis_config_t* config) {
  return g->rest.steady > config->rest_ticks && g->quiet > config->rest_ticks;
}

/** Whether rest may be counted from before this tick is undecided (DISABLE, LOCKED, SET_HOME, RESTORE): count
 * anew. */
static void rest_anew(ilk_ghost_slot_t* g) {
  g->rest.origin = g->raw;
  g->rest.low = 0;
  g->rest.high = 0;
  g->rest.low_age = 0u;
  g->rest.high_age = 0u;
  g->rest.ticks = (g->rest.ticks > 0u) ? 1u : 0u;
  g->rest.steady = 0u;
}

/** The mark of a FAULTED axis is here. */
static void mark_fault(ilk_ghost_slot_t* g, uint32_t raw) {
  g->fault_mark = raw;
  g->mark_low = 0;
  g->mark_high = 0;
}

/** Reverse, drift and the mark of a FAULTED axis. */
static void observe_motion(ilk_ghost_slot_t* g, const ilk_axis_config_t* config, const ilk_tick_t* tick,
                           uint32_t slot, uint32_t raw) {
  const uint32_t state = tick->before->axis[slot].state;
  g->drifted = false;
  g->reversed = false;
  g->maybe_reversed = false;
  g->runaway = false;
  g->maybe_runaway = false;
  g->distance = 0;
  if (!g->valid) {
    g->ran = g->ran && !g->lost;
    g->maybe_ran = g->maybe_ran && !g->lost;
    return;
  }
  if (!g->first && !g->jump && !g->reset) {
    const int64_t forward = along(g->reverse_direction, judge_counts(config, raw, g->reverse_mark));
    if (forward > 0) {
      g->reverse_mark = raw;
    } else if (-forward > (int64_t)config->reverse_counts) {
      g->reversed = g->driven;
      g->maybe_reversed = true;
      g->distance = saturate(-forward);
    }
  }
  if (state == ILK_AXIS_FAULTED) {
    const bool anew = g->first || g->jump || g->reset;
    const int32_t delta = judge_counts(config, raw, g->raw);
    const bool went_on = anew && !g->first && ((delta > 0 && g->delta > 0) || (delta < 0 && g->delta < 0));
    if (anew) {
      mark_fault(g, raw);
    }
    if (g->ran && !g->resting && !moves(g, config)) {
      mark_fault(g, raw);
      g->resting = true;
    }
    const int32_t at = judge_counts(config, raw, g->fault_mark);
    if (g->maybe_ran && !moves(g, config)) { /* at rest, perhaps: its mark is perhaps here */
      g->mark_low = (at < g->mark_low) ? at : g->mark_low;
      g->mark_high = (at > g->mark_high) ? at : g->mark_high;
    }
    g->distance = saturate((at > g->mark_high)  ? (int64_t)at - g->mark_high
                           : (at < g->mark_low) ? (int64_t)at - g->mark_low
                                                : 0);
    g->runaway = size_of(g->distance) > config->drift_counts || went_on;
    g->maybe_runaway = g->runaway || (int64_t)at - g->mark_low > (int64_t)config->drift_counts ||
                       (int64_t)g->mark_high - at > (int64_t)config->drift_counts;
    g->ran = (g->ran && !rests(g, config)) || g->runaway;
    g->maybe_ran = (g->maybe_ran && !rests(g, config)) || g->maybe_runaway;
    g->resting = g->resting && g->ran && !g->runaway;
    g->drift_known = false;
  } else if (state == ILK_AXIS_DISABLED && tick->before->mode != ILK_MODE_MOTION) {
    g->drift_mark = raw;
    g->drift_known = true;
  } else if (!g->drift_known || g->first || g->jump || g->reset) {
    g->drift_mark = raw;
    g->drift_known = true;
  } else if (!g->driven && size_of(judge_counts(config, raw, g->drift_mark)) > config->drift_counts) {
    g->drifted = true;
    g->distance = judge_counts(config, raw, g->drift_mark);
  }
}

static void observe_progress(ilk_ghost_slot_t* g, const ilk_axis_config_t* config, uint32_t raw) {
  if (g->valid && g->stall_direction != ILK_DIRECTION_NONE) {
    if (g->jump || g->reset || g->first) {
      g->stall_mark = raw;
      g->effort_mark = raw;
    } else if (along(g->stall_direction, judge_counts(config, raw, g->stall_mark)) >=
               (int64_t)config->stall_min_counts) {
      g->stall_mark = raw;
      g->effort_mark = raw;
      g->stall_ticks = 0u;
      g->effort = 0u;
    } else if (along(g->stall_direction, judge_counts(config, raw, g->effort_mark)) >
               (int64_t)config->noise_counts) {
      g->effort_mark = raw;
      g->effort = 0u;
    }
  }
  g->stalled = g->stall_ticks >= config->stall_ticks ||
               (config->stall_effort_ticks > 0u &&
                g->effort >= (uint64_t)config->stall_effort_ticks * config->max_drive);
}

static void observe_path(ilk_ghost_slot_t* g, const ilk_axis_config_t* config, const ilk_tick_t* tick,
                         uint32_t slot, uint32_t raw) {
  const bool counted =
      tick->before->mode == ILK_MODE_MOTION && tick->before->axis[slot].homed == ILK_HOMED_NOT;
  uint32_t way;
  if (!g->valid) {
    return;
  }
  if (!counted || !g->path_known || g->first || g->jump || g->reset) {
    g->path = raw;
    g->path_known = true;
    return;
  }
  way = size_of(judge_counts(config, raw, g->path));
  if (way > config->noise_counts) {
    g->path = raw;
    if (g->path_homing) {
      g->homing_travel = plus(g->homing_travel, way);
    } else {
      g->move_travel = plus(g->move_travel, way);
    }
  }
}

/** An edge: with each e1 that it follows as the text lists it, it may be e2; and it may be e1. */
static void add_edge(ilk_edges_t* edges, const ilk_axis_config_t* config, uint32_t raw) {
  bool is_second = false;
  for (uint32_t i = 0u; i < edges->firsts; i++) {
    is_second = is_second || (edges->slow[i] && size_of(judge_counts(config, raw, edges->first[i])) <=
                                                    config->home_tolerance_counts);
  }
  for (uint32_t i = ILK_JUDGE_EDGES - 1u; i > 0u; i--) {
    edges->first[i] = edges->first[i - 1u];
    edges->slow[i] = edges->slow[i - 1u];
    edges->second[i] = is_second ? edges->second[i - 1u] : edges->second[i];
  }
  edges->first[0] = raw;
  edges->slow[0] = false;
  edges->firsts = (edges->firsts < ILK_JUDGE_EDGES) ? edges->firsts + 1u : ILK_JUDGE_EDGES;
  if (is_second) {
    edges->second[0] = raw;
    edges->seconds = (edges->seconds < ILK_JUDGE_EDGES) ? edges->seconds + 1u : ILK_JUDGE_EDGES;
  }
}

/** P17: what the inputs since HOME show. */
static void observe_homing(ilk_ghost_slot_t* g, const ilk_axis_config_t* config, uint32_t debounce,
                           const uint32_t* frame) {
  const bool triggered = (frame[2] & SWITCH_OPEN_BIT) == 0u;
  const uint32_t raw = frame[3];
  if (!g->valid || !g->seeks) {
    return;
  }
  if (g->home_run > 0u && triggered == g->triggered) {
    g->home_run = plus(g->home_run, 1u);
  } else {
    g->home_run = 1u;
    g->home_run_raw = raw;
  }
  if (g->home_run < debounce) {
    return;
  }
  if (triggered && g->home_open) {
    g->home_open = false;
    add_edge(&g->edges, config, g->home_run_raw);
  } else if (!triggered) {
    g->home_open = true;
    for (uint32_t i = 0u; i < g->edges.firsts; i++) {
      const int64_t away = -along(towards_switch(config), judge_counts(config, raw, g->edges.first[i]));
      g->edges.slow[i] = g->edges.slow[i] || away >= (int64_t)config->home_clear_counts;
    }
  }
}

static void observe_plausibility(ilk_ghost_slot_t* g, const ilk_axis_config_t* config, const ilk_tick_t* tick,
                                 uint32_t slot, const uint32_t* frame) {
  const bool triggered = (frame[2] & SWITCH_OPEN_BIT) == 0u;
  const int64_t slack = (int64_t)config->home_tolerance_counts + config->coast_counts;
  int64_t open_side;
  if (!g->valid) {
    return;
  }
  if (tick->before->axis[slot].homed != ILK_HOMED_BY_SWITCH || g->jump || g->reset || g->first) {
    g->implausible = 0u;
    return;
  }
  open_side = -along(towards_switch(config), judge_counts(config, frame[3], g->reference));
  if ((triggered && open_side > slack + config->switch_hysteresis_counts) ||
      (!triggered && -open_side > slack)) {
    g->implausible = plus(g->implausible, 1u);
  } else {
    g->implausible = 0u;
  }
}

static void observe_system(ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  const ilk_common_config_t* c = &tick->config->common;
  const ilk_inputs_t* in = tick->in;
  const bool two = c->pedal_channels == 2u;
  if (in->pedal_no_closed == 1u && (!two || in->pedal_nc_closed == 0u)) {
    ghost->pedal = ILK_PEDAL_PRESSED;
  } else if (in->pedal_no_closed == 0u && (!two || in->pedal_nc_closed == 1u)) {
    ghost->pedal = ILK_PEDAL_RELEASED;
  } else {
    ghost->pedal = ILK_PEDAL_DISAGREE;
  }
  ghost->pressed_ticks = (ghost->pedal == ILK_PEDAL_PRESSED) ? plus(ghost->pressed_ticks, 1u) : 0u;
  ghost->released_ticks = (ghost->pedal == ILK_PEDAL_RELEASED) ? plus(ghost->released_ticks, 1u) : 0u;
  ghost->disagree_ticks = (ghost->pedal == ILK_PEDAL_DISAGREE) ? plus(ghost->disagree_ticks, 1u) : 0u;
  ghost->estop = in->estop_loop_closed != 1u;
  ghost->app_age = plus(ghost->app_age, 1u);
  ghost->app_alive = ghost->app_age < c->app_timeout_ticks;
  ghost->missed_in_row = (in->deadlines_missed > 0u) ? plus(ghost->missed_in_row, in->deadlines_missed) : 0u;
  ghost->missed_ticks = (in->deadlines_missed > 0u) ? plus(ghost->missed_ticks, 1u) : 0u;
  if (in->link_generation != ghost->link_generation) {
    ghost->link_generation = in->link_generation;
    ghost->last_sequence = 0u;
    ghost->app_age = UINT32_MAX; /* another app: silent until its first HEARTBEAT */
    ghost->app_alive = false;
  }
  if (!ghost->app_alive || tick->before->mode != ILK_MODE_READY) {
    ghost->armed = false;
    ghost->armed_weakly = false;
    ghost->armed_ticks = 0u;
  } else {
    ghost->armed_ticks = (ghost->pedal == ILK_PEDAL_RELEASED) ? plus(ghost->armed_ticks, 1u) : 0u;
    ghost->armed = ghost->armed || ghost->armed_ticks >= c->pedal_debounce_ticks;
    ghost->armed_weakly = ghost->armed_weakly || ghost->released_ticks >= c->pedal_debounce_ticks;
  }
}

void ghost_observe(ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  ghost->bus_ok_now = false;
  ghost->required_lost = false;
  ghost->runaway = false;
  ghost->new_fault = false;
  ghost->drift_of_disabled = false;
  ghost->calm_unsure = false;
  ghost->runaway_unsure = false;
  observe_system(ghost, tick);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* config = &tick->config->axis[slot];
    ilk_ghost_slot_t* g = &ghost->slot[slot];
    const uint32_t* frame = tick->in->frame[slot];
    const ilk_axis_view_t* before = &tick->before->axis[slot];
    const ilk_axis_view_t* after = &tick->after->axis[slot];
    if (config->card == ILK_CARD_NONE) {
      continue;
    }
    observe_frame(ghost, g, tick, slot);
    ghost->bus_ok_now = ghost->bus_ok_now || g->valid;
    ghost->required_lost = ghost->required_lost || (config->required == 1u && g->lost);
    if (has_motor(config)) {
      observe_rest(g, config, frame[3]);
      observe_motion(g, config, tick, slot, frame[3]);
      observe_progress(g, config, frame[3]);
      observe_path(g, config, tick, slot, frame[3]);
      observe_plausibility(g, config, tick, slot, frame);
      observe_homing(g, config, tick->config->common.switch_debounce_ticks, frame);
      if (g->valid && g->position_known && !g->first && !g->jump && !g->reset) {
        g->position = saturate((int64_t)g->position + judge_counts(config, frame[3], g->raw));
      } else if (g->valid) {
        g->position_known = false;
      }
      g->lease = (g->lease > 0u) ? g->lease - 1u : 0u;
      g->cleared = false;
      g->set_home = false;
      g->restored = false;
      g->just_homed = before->state == ILK_AXIS_HOMING && after->homed == ILK_HOMED_BY_SWITCH;
      ghost->runaway = ghost->runaway || g->runaway;
      ghost->new_fault =
          ghost->new_fault || (before->state != ILK_AXIS_FAULTED && after->state == ILK_AXIS_FAULTED);
      ghost->drift_of_disabled = ghost->drift_of_disabled ||
                                 (before->state == ILK_AXIS_DISABLED && after->state != ILK_AXIS_FAULTED &&
                                  g->calm.apart_age < config->rest_ticks);
      ghost->calm_unsure =
          ghost->calm_unsure || (before->state == ILK_AXIS_DISABLED &&
                                 (g->calm.ticks <= config->rest_ticks || g->quiet <= config->rest_ticks));
      ghost->runaway_unsure = ghost->runaway_unsure || g->maybe_runaway;
    }
    keep_frame(g, config, frame);
  }
  ghost->bus_bad_ticks = ghost->bus_ok_now ? 0u : plus(ghost->bus_bad_ticks, 1u);
  ghost->bus_lost = ghost->bus_bad_ticks >= tick->config->common.bad_frame_limit;
}

/* ------------------------------------------------------------------ what the requests change */

static void drop_orders(ilk_ghost_t* ghost) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    ilk_ghost_slot_t* g = &ghost->slot[slot];
    g->lease = 0u;
    g->order_consent = 0u;
    g->seeks = g->seeks && g->just_homed;
    if (g->state == ILK_AXIS_MOVING || g->state == ILK_AXIS_HOMING) {
      g->state = ILK_AXIS_ENABLED;
    }
  }
}

static void disarm(ilk_ghost_t* ghost) {
  ghost->armed = false;
  ghost->armed_weakly = false;
  ghost->armed_ticks = 0u;
}

static void leave_motion(ilk_ghost_t* ghost) {
  if (ghost->mode == ILK_MODE_MOTION) {
    ghost->mode = ILK_MODE_READY;
    drop_orders(ghost);
  }
  disarm(ghost);
}

/** Phases 4 and 5: states by what was published, the mode by the table. */
static void decide_mode(ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  const ilk_common_config_t* c = &tick->config->common;
  const uint32_t mode = tick->before->mode;
  const bool armed = ghost->armed;
  if (mode != ILK_MODE_LOCKED && mode != ILK_MODE_INIT && !ghost->estop && !ghost->bus_lost &&
      !ghost->runaway && !ghost->runaway_unsure) {
    const bool locked = tick->after->mode == ILK_MODE_LOCKED;
    if (ghost->missed_in_row >= c->overrun_limit && ghost->missed_ticks < c->overrun_limit) {
      ghost->choice[locked ? 0 : 1] = plus(ghost->choice[locked ? 0 : 1], 1u);
    } else if (ghost->disagree_ticks == c->pedal_disagree_ticks && ghost->missed_ticks == 0u) {
      ghost->choice[locked ? 2 : 3] = plus(ghost->choice[locked ? 2 : 3], 1u);
    }
  }
  ghost->entered = false;
  ghost->mode_sure = true;
  ghost->mode = mode;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    ilk_ghost_slot_t* g = &ghost->slot[slot];
    const ilk_axis_view_t* before = &tick->before->axis[slot];
    const ilk_axis_view_t* after = &tick->after->axis[slot];
    g->state = before->state;
    g->homed = g->just_homed ? (uint32_t)ILK_HOMED_BY_SWITCH : before->homed;
    if (before->state != ILK_AXIS_FAULTED && after->state == ILK_AXIS_FAULTED) {
      g->state = ILK_AXIS_FAULTED;
      g->lease = 0u;
      g->order_consent = 0u;
      g->seeks = g->seeks && g->just_homed;
      g->ran = false;
      g->maybe_ran = false;
      mark_fault(g, g->raw);
    } else if (g->just_homed) {
      g->state = ILK_AXIS_ENABLED;
    }
    if (after->homed == ILK_HOMED_NOT && (g->state == ILK_AXIS_FAULTED || g->jump || g->reset || g->lost)) {
      g->homed = ILK_HOMED_NOT; /* dropped in phase 4 */
    }
  }
  if (mode == ILK_MODE_INIT) {
    return;
  }
  if (ghost->estop || ghost->bus_lost || ghost->disagree_ticks > c->pedal_disagree_ticks ||
      ghost->missed_ticks >= c->overrun_limit) {
    ghost->mode = ILK_MODE_LOCKED;
  } else if (tick->after->mode == ILK_MODE_LOCKED && mode != ILK_MODE_LOCKED &&
             (ghost->missed_in_row >= c->overrun_limit || ghost->disagree_ticks == c->pedal_disagree_ticks ||
              ghost->runaway_unsure)) {
    ghost->mode = ILK_MODE_LOCKED; /* near a bound that the text leaves open */
  } else if (mode == ILK_MODE_MOTION) {
    if (ghost->pedal != ILK_PEDAL_PRESSED || !ghost->app_alive || ghost->new_fault || ghost->required_lost) {
      leave_motion(ghost);
    }
  } else if (mode == ILK_MODE_READY && ghost->pressed_ticks == c->pedal_debounce_ticks) {
    const bool good = ghost->tick != 0u && ghost->app_alive && !ghost->required_lost &&
                      ghost->powered_ticks >= c->power_up_ticks;
    if (ghost->armed && good &&
        (ghost->calm_unsure || ghost->drift_of_disabled)) { /* judge_mode judges the latter */
      ghost->mode_sure = false;
    } else if (ghost->armed && good) {
      ghost->mode = ILK_MODE_MOTION;
      ghost->entered = true;
    }
    disarm(ghost);
  }
  if (!ghost->mode_sure && tick->after->mode == ILK_MODE_MOTION) {
    ghost->mode = ILK_MODE_MOTION;
    ghost->entered = true;
    ghost->weak_entries = plus(ghost->weak_entries, armed ? 0u : 1u);
  }
  if (ghost->entered) {
    for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
      ilk_ghost_slot_t* g = &ghost->slot[slot];
      g->move_travel = 0u;
      g->homing_travel = 0u;
      g->homing_ticks = 0u;
      g->path = g->raw;
      g->path_homing = false;
      if (tick->before->axis[slot].state == ILK_AXIS_DISABLED) { /* moved by hand until now, read or not */
        g->drift_mark = g->raw;
        g->drift_known = true;
      }
    }
  }
  if (ghost->mode == ILK_MODE_LOCKED && mode != ILK_MODE_LOCKED) {
    drop_orders(ghost);
    disarm(ghost);
    for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
      if (ghost->slot[slot].state != ILK_AXIS_FAULTED) {
        ghost->slot[slot].state = ILK_AXIS_DISABLED;
      }
      rest_anew(&ghost->slot[slot]);
    }
  }
}

/** A verdict that the text demands, and another one that it allows as well. */
typedef struct {
  uint32_t verdict;
  uint32_t other;
} ilk_demand_t;

#define ANY ILK_VERDICT_COUNT /* the judge cannot tell */

static ilk_demand_t demand(uint32_t verdict) {
  const ilk_demand_t d = {verdict, verdict};
  return d;
}

static ilk_demand_t either(uint32_t verdict, uint32_t other) {
  const ilk_demand_t d = {verdict, other};
  return d;
}

/** RANGE of a MOVE. */
static bool in_range(const ilk_ghost_slot_t* g, const ilk_axis_config_t* config, const ilk_axis_view_t* after,
                     int32_t target) {
  const int64_t coast = config->coast_counts;
  const int64_t kept_back = coast + config->noise_counts;
  const int64_t to_switch = along(towards_switch(config), saturate((int64_t)target - after->position));
  if (config->limit_side != ILK_LIMIT_NONE && g->triggered && to_switch > 0) {
    return false;
  }
  if (g->homed == ILK_HOMED_NOT) {
    const int64_t way =
        (target > after->position) ? (int64_t)target - after->position : (int64_t)after->position - target;
    return way == 0 || way <= (int64_t)config->unhomed_travel_counts - g->move_travel - kept_back;
  }
  {
    const int64_t margin = (int64_t)config->switch_hysteresis_counts + config->home_tolerance_counts;
    int64_t low = (int64_t)config->min_counts + coast;
    int64_t high = (int64_t)config->max_counts - coast;
    if (g->homed == ILK_HOMED_BY_SWITCH && config->limit_side == ILK_LIMIT_LOWER &&
        low < config->home_offset_counts + margin) {
      low = config->home_offset_counts + margin;
    }
    if (g->homed == ILK_HOMED_BY_SWITCH && config->limit_side == ILK_LIMIT_UPPER &&
        high > config->home_offset_counts - margin) {
      high = config->home_offset_counts - margin;
    }
    return target >= low && target <= high;
  }
}

static ilk_demand_t demand_of_motion(const ilk_ghost_t* ghost, const ilk_tick_t* tick,
                                     const ilk_request_t* r) {
  const ilk_axis_config_t* config = &tick->config->axis[r->axis];
  const ilk_ghost_slot_t* g = &ghost->slot[r->axis];
  const uint32_t consent = ghost->entered ? tick->after->consent : tick->before->consent;
  if (ghost->mode != ILK_MODE_MOTION) {
    return demand(ILK_VERDICT_MODE);
  }
  if (r->consent != consent ||
      consent == 0u) { /* 0: the press began and ended in this tick; nobody saw its number */
    return demand(ILK_VERDICT_CONSENT);
  }
  if (g->state == ILK_AXIS_FAULTED) {
    return demand(ILK_VERDICT_FAULTED);
  }
  if (g->state == ILK_AXIS_DISABLED) {
    return demand(ILK_VERDICT_DISABLED);
  }
  if (g->state == ILK_AXIS_HOMING) { /* unless it homed in this very tick, which a second HOME hides */
    return (g->edges.seconds > 0u && r->kind == ILK_REQUEST_HOME)
               ? either(ILK_VERDICT_BUSY, ILK_VERDICT_ACCEPTED)
               : demand(ILK_VERDICT_BUSY);
  }
  if (r->kind == ILK_REQUEST_HOME) {
    if (config->limit_side == ILK_LIMIT_NONE) {
      return demand(ILK_VERDICT_NO_SWITCH);
    }
    const uint64_t used = (uint64_t)g->homing_travel + config->coast_counts + config->noise_counts;
    return demand((used >= config->home_travel_counts || g->homing_ticks >= config->home_timeout_ticks)
                      ? ILK_VERDICT_BUDGET
                      : ILK_VERDICT_ACCEPTED);
  }
  if (r->lease_ticks == 0u || r->lease_ticks > tick->config->common.lease_max_ticks) {
    return demand(ILK_VERDICT_LEASE);
  }
  if (r->drive == 0u || r->drive > config->max_drive || r->amplitude > config->max_amplitude ||
      (g->homed == ILK_HOMED_NOT && r->drive > config->unhomed_max_drive)) {
    return demand(ILK_VERDICT_DRIVE);
  }
  if (in_range(g, config, &tick->after->axis[r->axis], r->target_counts)) {
    return demand(ILK_VERDICT_ACCEPTED);
  }
  if (g->triggered && (size_of(saturate((int64_t)r->target_counts - tick->after->axis[r->axis].position)) <=
                           config->deadband_counts ||
                       g->run < tick->config->common.switch_debounce_ticks)) {
    return either(ILK_VERDICT_RANGE,
                  ILK_VERDICT_ACCEPTED); /* towards a triggered switch, but no drive follows */
  }
  return demand(ILK_VERDICT_RANGE);
}

static ilk_demand_t demand_of_place(const ilk_ghost_t* ghost, const ilk_tick_t* tick,
                                    const ilk_request_t* r) {
  const ilk_axis_config_t* config = &tick->config->axis[r->axis];
  const ilk_ghost_slot_t* g = &ghost->slot[r->axis];
  if (ghost->mode != ILK_MODE_READY) {
    return demand(ILK_VERDICT_MODE);
  }
  if (ghost->pedal != ILK_PEDAL_RELEASED) {
    return demand(ILK_VERDICT_PEDAL_DOWN);
  }
  if (g->state == ILK_AXIS_FAULTED) {
    return demand(ILK_VERDICT_FAULTED);
  }
  if (!g->valid) {
    return demand(ILK_VERDICT_CARD);
  }
  if (moves(g, config)) {
    return demand(ILK_VERDICT_BUSY);
  }
  if (!rests(g, config)) {
    return demand(ANY);
  }
  if (r->kind == ILK_REQUEST_RESTORE &&
      (r->target_counts < config->min_counts || r->target_counts > config->max_counts)) {
    return demand(ILK_VERDICT_RANGE);
  }
  return demand(ILK_VERDICT_ACCEPTED);
}

/** A FAULTED axis that is known to lie at rest where its mark is is no cause. */
static bool runaway_present(const ilk_ghost_t* ghost, bool* unsure) {
  bool present = false;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    present = present || g->runaway;
    *unsure = *unsure || (g->state == ILK_AXIS_FAULTED && g->maybe_ran);
  }
  return present;
}

static ilk_demand_t demand_of_row(const ilk_ghost_t* ghost, const ilk_tick_t* tick, const ilk_request_t* r) {
  const ilk_ghost_slot_t* g = &ghost->slot[(r->axis < ILK_SLOTS) ? r->axis : 0u];
  const ilk_axis_config_t* config = &tick->config->axis[(r->axis < ILK_SLOTS) ? r->axis : 0u];
  bool unsure = false;
  if (ghost->mode == ILK_MODE_INIT) {
    return demand(ILK_VERDICT_MODE);
  }
  switch (r->kind) {
    case ILK_REQUEST_RESET:
      if (ghost->mode != ILK_MODE_LOCKED) {
        return demand(ILK_VERDICT_MODE);
      }
      if (ghost->pedal != ILK_PEDAL_RELEASED) {
        return demand(ILK_VERDICT_PEDAL_DOWN);
      }
      if (ghost->estop || ghost->bus_lost || !ghost->app_alive || runaway_present(ghost, &unsure) ||
          ghost->missed_ticks >= tick->config->common.overrun_limit) {
        return demand(ILK_VERDICT_CAUSE_PRESENT);
      }
      /* after damage the configuration is trusted again when a whole pass over it agreed */
      unsure =
          unsure || tick->before->cause == ILK_CAUSE_INTEGRITY || tick->after->cause == ILK_CAUSE_INTEGRITY;
      return (unsure || !ghost->bus_ok_now || ghost->missed_in_row > 0u)
                 ? either(ILK_VERDICT_ACCEPTED, ILK_VERDICT_CAUSE_PRESENT)
                 : demand(ILK_VERDICT_ACCEPTED);
    case ILK_REQUEST_DISABLE:
      return demand((g->state == ILK_AXIS_FAULTED) ? ILK_VERDICT_FAULTED : ILK_VERDICT_ACCEPTED);
    case ILK_REQUEST_ENABLE:
      if (ghost->mode == ILK_MODE_LOCKED) {
        return demand(ILK_VERDICT_MODE);
      }
      if (g->state == ILK_AXIS_FAULTED) {
        return demand(ILK_VERDICT_FAULTED);
      }
      if (g->state != ILK_AXIS_DISABLED) {
        return g->valid ? demand(ILK_VERDICT_ACCEPTED) : either(ILK_VERDICT_ACCEPTED, ILK_VERDICT_CARD);
      }
      if (!g->valid) {
        return demand(ILK_VERDICT_CARD);
      }
      if (moves(g, config) || ghost->powered_ticks < tick->config->common.power_up_ticks ||
          g->since_disable < config->rest_ticks) {
        return demand(ILK_VERDICT_BUSY);
      }
      return rests(g, config) ? demand(ILK_VERDICT_ACCEPTED) : either(ILK_VERDICT_ACCEPTED, ILK_VERDICT_BUSY);
    case ILK_REQUEST_CLEAR_FAULT:
      if (g->state != ILK_AXIS_FAULTED) {
        return demand(ILK_VERDICT_NO_FAULT);
      }
      if (!g->valid || tick->before->axis[r->axis].state != ILK_AXIS_FAULTED || moves(g, config) ||
          g->runaway) {
        return demand(ILK_VERDICT_CAUSE_PRESENT);
      }
      if (!rests(g, config) || g->maybe_runaway) {
        return demand(ANY);
      }
      return demand((ghost->pedal != ILK_PEDAL_RELEASED) ? ILK_VERDICT_PEDAL_DOWN : ILK_VERDICT_ACCEPTED);
    case ILK_REQUEST_MOVE:
    case ILK_REQUEST_HOME:
      return demand_of_motion(ghost, tick, r);
    case ILK_REQUEST_SET_HOME:
    case ILK_REQUEST_RESTORE:
      return demand_of_place(ghost, tick, r);
    default:
      return demand(ILK_VERDICT_ACCEPTED); /* HEARTBEAT, STOP */
  }
}

/** CHECKSUM, SEQUENCE, UNKNOWN, AXIS, in this order; ACCEPTED when the row decides. */
static uint32_t verdict_before_row(ilk_ghost_t* ghost, const ilk_tick_t* tick, const ilk_request_t* r) {
  const uint32_t ahead = r->sequence - ghost->last_sequence;
  if (ilk_request_crc(r) != r->crc) {
    return ILK_VERDICT_CHECKSUM;
  }
  if (ahead == 0u || ahead > 0x7FFFFFFFu) {
    return ILK_VERDICT_SEQUENCE;
  }
  ghost->last_sequence = r->sequence;
  if (r->kind < ILK_REQUEST_HEARTBEAT || r->kind > ILK_REQUEST_RESTORE) {
    return ILK_VERDICT_UNKNOWN;
  }
  if (r->kind >= ILK_REQUEST_DISABLE && (r->axis >= ILK_SLOTS || !has_motor(&tick->config->axis[r->axis]))) {
    return ILK_VERDICT_AXIS;
  }
  return ILK_VERDICT_ACCEPTED;
}

/** A press that began in this tick and was ended by a later request of it: its number was never published. */
static bool press_is_unseen(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  return (ghost->entered || !ghost->mode_sure) && tick->after->mode != ILK_MODE_MOTION;
}

static void accept(ilk_ghost_t* ghost, const ilk_tick_t* tick, const ilk_request_t* r) {
  ilk_ghost_slot_t* g = &ghost->slot[(r->axis < ILK_SLOTS) ? r->axis : 0u];
  const uint32_t consent = ghost->entered ? tick->after->consent : tick->before->consent;
  switch (r->kind) {
    case ILK_REQUEST_HEARTBEAT:
      ghost->app_age = 0u;
      if (r->holder != ghost->holder) {
        ghost->holder = r->holder;
        ghost->holder_changed = true;
        leave_motion(ghost);
      }
      break;
    case ILK_REQUEST_STOP:
      ghost->stop_accepted = true;
      leave_motion(ghost);
      break;
    case ILK_REQUEST_RESET:
      ghost->reset_accepted = true;
      ghost->mode = ILK_MODE_READY;
      disarm(ghost);
      break;
    case ILK_REQUEST_DISABLE:
      if (g->state != ILK_AXIS_FAULTED) {
        g->state = ILK_AXIS_DISABLED;
      }
      g->since_disable = 0u;
      rest_anew(g);
      g->lease = 0u;
      g->order_consent = 0u;
      g->seeks = g->seeks && g->just_homed;
      if (ghost->mode != ILK_MODE_MOTION) {
        g->drift_mark = g->raw;
      }
      break;
    case ILK_REQUEST_ENABLE:
      if (g->state == ILK_AXIS_DISABLED) {
        g->state = ILK_AXIS_ENABLED;
        g->drift_mark = g->raw;
        g->drift_known = true;
        g->reverse_direction = ILK_DIRECTION_NONE;
        g->stall_direction = ILK_DIRECTION_NONE;
      }
      break;
    case ILK_REQUEST_CLEAR_FAULT:
      g->cleared = true;
      g->state = ILK_AXIS_DISABLED;
      g->drift_mark = g->raw;
      g->drift_known = true;
      g->since_disable = UINT32_MAX;
      if (tick->before->axis[r->axis].fault == ILK_FAULT_STALL) {
        g->stall_ticks = 0u;
        g->effort = 0u;
        g->stall_mark = g->raw;
        g->effort_mark = g->raw;
      }
      break;
    case ILK_REQUEST_MOVE:
      ghost->consent_error =
          ghost->consent_error || (!press_is_unseen(ghost, tick) && (r->consent != consent || consent == 0u));
      g->lease = r->lease_ticks;
      g->setpoint = r->target_counts;
      g->order_drive = r->drive;
      g->order_consent = r->consent;
      g->state = ILK_AXIS_MOVING;
      break;
    case ILK_REQUEST_HOME:
      ghost->consent_error =
          ghost->consent_error || (!press_is_unseen(ghost, tick) && (r->consent != consent || consent == 0u));
      g->lease = 0u;
      g->order_consent = r->consent;
      g->position_known = g->position_known && g->state != ILK_AXIS_HOMING;
      g->state = ILK_AXIS_HOMING;
      g->homed = ILK_HOMED_NOT;
      g->path_homing = true;
      g->seeks = true;
      g->home_open = false;
      g->edges.firsts = 0u;
      g->edges.seconds = 0u;
      g->home_run = 0u;
      break;
    case ILK_REQUEST_SET_HOME:
      g->set_home = true;
      rest_anew(g);
      g->homed = ILK_HOMED_BY_HAND;
      g->position = 0;
      g->position_known = true;
      break;
    case ILK_REQUEST_RESTORE:
      g->restored = true;
      rest_anew(g);
      g->homed = ILK_HOMED_NOT;
      g->position = r->target_counts;
      g->position_known = true;
      break;
    default:
      break;
  }
}

static void before_requests(ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  ghost->reset_accepted = false;
  ghost->stop_accepted = false;
  ghost->holder_changed = false;
  ghost->order_error = 0u;
  ghost->consent_error = false;
  decide_mode(ghost, tick);
}

static void follow_request(ilk_ghost_t* ghost, const ilk_tick_t* tick, uint32_t i) {
  const ilk_request_t* r = &tick->requests[i];
  const uint32_t given = tick->out->verdict[i].verdict;
  ilk_demand_t d = demand(verdict_before_row(ghost, tick, r));
  if (d.verdict == ILK_VERDICT_ACCEPTED) {
    d = demand_of_row(ghost, tick, r);
  }
  /* a press that may have begun and ended in this tick: nobody can tell in which mode the requests were
   * judged */
  const bool told = ghost->mode_sure || tick->after->mode == ILK_MODE_MOTION;
  if (told && d.verdict != ANY && given != d.verdict && given != d.other && ghost->order_error == 0u) {
    ghost->order_error = i + 1u;
    ghost->expected = d.verdict;
  }
  if (given == ILK_VERDICT_ACCEPTED && r->kind <= ILK_REQUEST_RESTORE &&
      (r->axis < ILK_SLOTS || r->kind < ILK_REQUEST_DISABLE)) {
    accept(ghost, tick, r);
  }
}

static void after_requests(ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  if (tick->after->mode == ILK_MODE_READY && tick->before->mode != ILK_MODE_READY) {
    disarm(ghost);
  }
  if (tick->after->mode != ILK_MODE_MOTION) {
    drop_orders(ghost);
  }
}

void ghost_requests(ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  const uint32_t taken = (tick->count < ILK_REQUESTS_PER_TICK) ? tick->count : ILK_REQUESTS_PER_TICK;
  before_requests(ghost, tick);
  for (uint32_t i = 0u; i < taken && i < tick->out->verdict_count; i++) {
    follow_request(ghost, tick, i);
  }
  after_requests(ghost, tick);
}

/* ------------------------------------------------------------------ what the drive of this tick means */

/** The edge that the published position implies; false when none does. */
static bool reference_of(const ilk_ghost_slot_t* g, const ilk_axis_config_t* config, int32_t position,
                         uint32_t* reference) {
  bool found = false;
  for (uint32_t i = 0u; i < g->edges.seconds && !found; i++) {
    const int64_t beyond = judge_counts(config, g->raw, g->edges.second[i]);
    found = saturate(beyond + config->home_offset_counts) == position;
    *reference = g->edges.second[i];
  }
  return found;
}

static void settle_slot(ilk_ghost_t* ghost, ilk_ghost_slot_t* g, const ilk_axis_config_t* config,
                        const ilk_tick_t* tick, uint32_t slot) {
  const ilk_command_t* command = &tick->out->command[slot];
  const ilk_axis_view_t* after = &tick->after->axis[slot];
  g->driven = is_driven(tick, slot);
  if (g->driven) {
    g->direction = command->direction;
    still_end(&g->rest);
    g->quiet = 0u;
    g->drift_mark = g->raw;
    g->drift_known = true;
    if (command->direction != g->reverse_direction) {
      g->reverse_direction = command->direction;
      g->reverse_mark = g->raw;
    }
    if (command->direction != g->stall_direction) {
      g->stall_direction = command->direction;
      g->stall_mark = g->raw;
      g->effort_mark = g->raw;
    }
    g->stall_ticks = plus(g->stall_ticks, 1u);
    g->effort = plus64(g->effort, command->drive);
    for (uint32_t i = 0u; i < g->edges.firsts; i++) {
      g->edges.slow[i] = g->edges.slow[i] && command->drive <= config->home_slow_drive;
    }
    if (after->state != ILK_AXIS_HOMING) {
      g->path_homing = false;
    }
  } else if (g->valid && ghost->mode == ILK_MODE_MOTION && g->lease > 0u &&
             size_of(saturate((int64_t)g->setpoint - after->position)) <= config->deadband_counts &&
             along(g->stall_direction, judge_counts(config, g->raw, g->stall_mark)) >
                 (int64_t)config->noise_counts) {
    g->stall_ticks = 0u;
    g->effort = 0u;
    g->stall_mark = g->raw;
    if (along(g->stall_direction, judge_counts(config, g->raw, g->effort_mark)) > 0) {
      g->effort_mark = g->raw;
    }
  }
  if (after->state == ILK_AXIS_HOMING) {
    g->homing_ticks = plus(g->homing_ticks, 1u);
  }
  if (g->just_homed) {
    (void)reference_of(g, config, after->position, &g->reference); /* P17 has judged it */
    g->seeks = false;
    g->position_known = false;
  }
  if (!g->position_known && g->seen) {
    g->position = after->position;
    g->position_known = true;
  }
}

void ghost_settle(ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (has_motor(&tick->config->axis[slot])) {
      settle_slot(ghost, &ghost->slot[slot], &tick->config->axis[slot], tick, slot);
    }
  }
  ghost->powered_ticks = (tick->out->power == 1u) ? plus(ghost->powered_ticks, 1u) : 0u;
  if (tick->after->mode == ILK_MODE_MOTION) {
    ghost->last_consent = tick->after->consent;
  }
  ghost->tick++;
  ghost->frames_sent = (ghost->frames_sent < 2u) ? ghost->frames_sent + 1u : 2u;
}

/* ------------------------------------------------------------------ the monitors */

/** P1: non-zero drive, on the wire or as a command, implies every condition now. */
ilk_judgement_t judge_P1(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    const uint32_t state = tick->after->axis[slot].state;
    if (!is_driven(tick, slot)) {
      continue;
    }
    if (!has_motor(&tick->config->axis[slot])) {
      return broken("P1: drive in a slot without an axis", slot, tick->out->command[slot].drive, 0);
    }
    if (tick->after->mode != ILK_MODE_MOTION) {
      return broken("P1: drive outside of MOTION", slot, tick->after->mode, ILK_MODE_MOTION);
    }
    if (tick->out->power != 1u) {
      return broken("P1: drive without power", slot, tick->out->power, 1);
    }
    if (ghost->pedal != ILK_PEDAL_PRESSED) {
      return broken("P1: drive without the pedal", slot, ghost->pedal, ILK_PEDAL_PRESSED);
    }
    if (ghost->estop) {
      return broken("P1: drive at E-stop", slot, 1, 0);
    }
    if (!g->valid) {
      return broken("P1: drive without a valid frame", slot, 0, 1);
    }
    if (state != ILK_AXIS_ENABLED && state != ILK_AXIS_MOVING && state != ILK_AXIS_HOMING) {
      return broken("P1: drive of an axis that is not enabled", slot, state, ILK_AXIS_MOVING);
    }
    if (g->lease == 0u && state != ILK_AXIS_HOMING) {
      return broken("P1: drive without a live lease or homing", slot, g->lease, 1);
    }
    if (state != ILK_AXIS_HOMING && tick->out->command[slot].drive > g->order_drive) {
      return broken("P1: more drive than the MOVE asked for", slot, tick->out->command[slot].drive,
                    g->order_drive);
    }
    if (state == ILK_AXIS_MOVING) {
      const int64_t way = (int64_t)g->setpoint - tick->after->axis[slot].position;
      const bool up = tick->out->command[slot].direction == ILK_DIRECTION_INCREASING;
      if ((up ? way : -way) <= (int64_t)tick->config->axis[slot].deadband_counts) {
        return broken("P1: drive within the deadband or away from the setpoint", slot, way,
                      tick->config->axis[slot].deadband_counts);
      }
    }
  }
  return HOLDS;
}

/** P2: zero drive on every card in each of the listed situations; power only in READY and MOTION. */
ilk_judgement_t judge_P2(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  const bool must = ghost->pedal != ILK_PEDAL_PRESSED || ghost->estop ||
                    tick->after->mode != ILK_MODE_MOTION || ghost->bus_lost || !ghost->app_alive;
  const bool power = tick->after->mode == ILK_MODE_READY || tick->after->mode == ILK_MODE_MOTION;
  if (tick->out->power != (power ? 1u : 0u)) {
    return broken("P2: power is on in READY and MOTION only", ILK_SLOTS, tick->out->power, power);
  }
  if (ghost->estop && tick->config_valid && tick->after->mode != ILK_MODE_LOCKED) {
    return broken("P2: E-stop locks now", ILK_SLOTS, tick->after->mode, ILK_MODE_LOCKED);
  }
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (must && is_driven(tick, slot)) {
      return broken("P2: drive although all must be zero", slot, tick->out->command[slot].drive, 0);
    }
  }
  return HOLDS;
}

/** P3: no drive towards a switch that reads triggered, or that was not read validly. */
ilk_judgement_t judge_P3(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* config = &tick->config->axis[slot];
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    if (has_motor(config) && config->limit_side != ILK_LIMIT_NONE && is_driven(tick, slot) &&
        (!g->valid || g->triggered) && tick->out->command[slot].direction == towards_switch(config)) {
      return broken("P3: drive towards a triggered switch", slot, tick->out->command[slot].drive, 0);
    }
  }
  return HOLDS;
}

/** P4, first half. Less than the sentence: the bound is judged by the published position, drive exactly on it
 * is allowed. */
ilk_judgement_t judge_P4(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  (void)ghost;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* config = &tick->config->axis[slot];
    const ilk_axis_view_t* axis = &tick->after->axis[slot];
    const int64_t margin = (int64_t)config->home_offset_counts;
    const int64_t opens = (int64_t)config->switch_hysteresis_counts + config->home_tolerance_counts;
    int64_t low = (int64_t)config->min_counts + config->coast_counts;
    int64_t high = (int64_t)config->max_counts - config->coast_counts;
    if (!has_motor(config) || axis->homed == ILK_HOMED_NOT || !is_driven(tick, slot)) {
      continue;
    }
    if (axis->homed == ILK_HOMED_BY_SWITCH && config->limit_side == ILK_LIMIT_LOWER && margin + opens > low) {
      low = margin + opens;
    }
    if (axis->homed == ILK_HOMED_BY_SWITCH && config->limit_side == ILK_LIMIT_UPPER &&
        margin - opens < high) {
      high = margin - opens;
    }
    if (tick->out->command[slot].direction == ILK_DIRECTION_DECREASING && axis->position < low) {
      return broken("P4: drive outward below the lower limit and coast", slot, axis->position, low);
    }
    if (tick->out->command[slot].direction == ILK_DIRECTION_INCREASING && axis->position > high) {
      return broken("P4: drive outward above the upper limit less coast", slot, axis->position, high);
    }
  }
  return HOLDS;
}

/** P5. Drive is counted with the drive of this tick, which ghost_settle adds afterwards. */
ilk_judgement_t judge_P5(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* config = &tick->config->axis[slot];
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    const ilk_axis_view_t* before = &tick->before->axis[slot];
    const ilk_axis_view_t* after = &tick->after->axis[slot];
    const uint64_t bound = (uint64_t)config->stall_effort_ticks * config->max_drive;
    if (!has_motor(config)) {
      continue;
    }
    if (is_driven(tick, slot)) {
      if (g->stall_ticks >= config->stall_ticks) {
        return broken("P5: driven for more than stall_ticks without progress", slot,
                      (int64_t)g->stall_ticks + 1, config->stall_ticks);
      }
      if (config->stall_effort_ticks > 0u &&
          plus64(g->effort, tick->out->command[slot].drive) >= bound + config->max_drive) {
        return broken("P5: driven with stall_effort_ticks + 1 of full drive without progress", slot,
                      (int64_t)g->effort, (int64_t)bound);
      }
    }
    if (g->stalled && before->state != ILK_AXIS_FAULTED && after->state != ILK_AXIS_FAULTED) {
      return broken("P5: a bound is reached and the axis is not faulted", slot, g->stall_ticks,
                    (int64_t)g->effort);
    }
    if (!g->stalled && before->state != ILK_AXIS_FAULTED && after->state == ILK_AXIS_FAULTED &&
        after->fault == ILK_FAULT_STALL) {
      return broken("P5: STALL before a bound was reached", slot, g->stall_ticks, (int64_t)g->effort);
    }
  }
  return HOLDS;
}

/** P6. Less than the sentence: reverse motion is demanded in the tick after a driven one only; the first
   frame after start or after a lost card is compared with nothing. */
static ilk_judgement_t judge_P6_faults(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    const ilk_axis_view_t* before = &tick->before->axis[slot];
    const ilk_axis_view_t* after = &tick->after->axis[slot];
    const bool judged = before->state != ILK_AXIS_DISABLED || tick->before->mode == ILK_MODE_MOTION;
    if (!has_motor(&tick->config->axis[slot])) {
      continue;
    }
    if (before->state != ILK_AXIS_FAULTED && judged && (g->jump || g->reversed || g->drifted)) {
      const uint32_t first = g->jump ? ILK_FAULT_JUMP : (g->reversed ? ILK_FAULT_REVERSE : ILK_FAULT_DRIFT);
      const bool other = g->reset || (!g->jump && g->maybe_reversed && after->fault == ILK_FAULT_REVERSE);
      if (after->state != ILK_AXIS_FAULTED) {
        return broken("P6: moved beyond its limit and is not faulted", slot, g->distance, first);
      }
      if (after->fault != first && !other) {
        return broken("P6: the code is not the first of those that apply", slot, after->fault, first);
      }
    }
    if (before->state != ILK_AXIS_FAULTED && after->state == ILK_AXIS_FAULTED &&
        ((after->fault == ILK_FAULT_DRIFT && !g->drifted) || (after->fault == ILK_FAULT_JUMP && !g->jump) ||
         (after->fault == ILK_FAULT_REVERSE && !g->maybe_reversed))) {
      return broken("P6: REVERSE, DRIFT or JUMP without such motion", slot, after->fault, g->distance);
    }
  }
  return HOLDS;
}

ilk_judgement_t judge_P6(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    if (has_motor(&tick->config->axis[slot]) && g->runaway &&
        (tick->after->mode != ILK_MODE_LOCKED || tick->out->power != 0u)) {
      return broken("P6: a faulted axis goes on moving and power is not taken away", slot, g->distance,
                    tick->config->axis[slot].drift_counts);
    }
  }
  return judge_P6_faults(ghost, tick);
}

/** P7. The second half is judged where it is decided: no drive once the path travelled and coast exceed the
 * budget. */
ilk_judgement_t judge_P7(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* config = &tick->config->axis[slot];
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    const ilk_command_t* command = &tick->out->command[slot];
    const ilk_axis_view_t* after = &tick->after->axis[slot];
    if (!has_motor(config)) {
      continue;
    }
    const uint64_t kept_back =
        (uint64_t)config->coast_counts + config->noise_counts; /* the path may lag by the noise */
    if (command->drive > config->max_drive) {
      return broken("P7: drive above max_drive", slot, command->drive, config->max_drive);
    }
    if (command->amplitude > config->max_amplitude) {
      return broken("P7: amplitude above max_amplitude", slot, command->amplitude, config->max_amplitude);
    }
    if (is_driven(tick, slot) && after->homed == ILK_HOMED_NOT) {
      if (command->drive > config->unhomed_max_drive) {
        return broken("P7: drive above unhomed_max_drive", slot, command->drive, config->unhomed_max_drive);
      }
      if (after->state != ILK_AXIS_HOMING && g->move_travel + kept_back > config->unhomed_travel_counts) {
        return broken("P7: MOVE drives beyond the unhomed travel of this press", slot, g->move_travel,
                      (int64_t)config->unhomed_travel_counts - (int64_t)kept_back);
      }
      if (after->state == ILK_AXIS_HOMING && g->homing_travel + kept_back > config->home_travel_counts) {
        return broken("P7: homing drives beyond its travel of this press", slot, g->homing_travel,
                      (int64_t)config->home_travel_counts - (int64_t)kept_back);
      }
    }
    if (after->state == ILK_AXIS_HOMING && g->homing_ticks > config->home_timeout_ticks) {
      return broken("P7: homing lasts longer than its time of this press", slot, g->homing_ticks,
                    config->home_timeout_ticks);
    }
  }
  return HOLDS;
}

/** P8. */
ilk_judgement_t judge_P8(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  const ilk_view_t* before = tick->before;
  const ilk_view_t* after = tick->after;
  if (after->cause == ILK_CAUSE_INTEGRITY) {
    return HOLDS;
  }
  if (before->mode == ILK_MODE_LOCKED && after->mode != ILK_MODE_LOCKED && !ghost->reset_accepted) {
    return broken("P8: LOCKED was left without RESET", ILK_SLOTS, after->mode, ILK_MODE_LOCKED);
  }
  if (before->mode == ILK_MODE_LOCKED && after->mode == ILK_MODE_LOCKED && after->cause != before->cause) {
    return broken("P8: the first cause was overwritten", ILK_SLOTS, after->cause, before->cause);
  }
  if (after->mode == ILK_MODE_LOCKED && after->cause == ILK_CAUSE_NONE) {
    return broken("P8: LOCKED without a cause", ILK_SLOTS, 0, 1);
  }
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (before->axis[slot].state == ILK_AXIS_FAULTED && !ghost->slot[slot].cleared) {
      if (after->axis[slot].state != ILK_AXIS_FAULTED) {
        return broken("P8: a fault ended without CLEAR_FAULT", slot, after->axis[slot].state,
                      ILK_AXIS_FAULTED);
      }
      if (after->axis[slot].fault != before->axis[slot].fault) {
        return broken("P8: the first fault was overwritten", slot, after->axis[slot].fault,
                      before->axis[slot].fault);
      }
    }
  }
  return HOLDS;
}

/** P9. The release that arms counts from the last event that disarms: all of its debounce time lies in READY
   with the app alive. */
ilk_judgement_t judge_P9(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  const ilk_common_config_t* c = &tick->config->common;
  const uint32_t consent = tick->after->consent;
  if (tick->after->mode != ILK_MODE_MOTION) {
    return (consent == 0u) ? HOLDS : broken("P9: consent outside of MOTION", ILK_SLOTS, consent, 0);
  }
  if (consent == 0u) {
    return broken("P9: MOTION without a consent number", ILK_SLOTS, 0, 1);
  }
  if (tick->before->mode == ILK_MODE_MOTION) {
    return (consent == tick->before->consent) ? HOLDS
                                              : broken("P9: the consent number changed within a press",
                                                       ILK_SLOTS, consent, tick->before->consent);
  }
  if (tick->before->mode != ILK_MODE_READY) {
    return broken("P9: MOTION not entered from READY", ILK_SLOTS, tick->before->mode, ILK_MODE_READY);
  }
  if (consent == ghost->last_consent) {
    return broken("P9: the consent number of an earlier press", ILK_SLOTS, consent, ghost->last_consent);
  }
  if (ghost->pressed_ticks != c->pedal_debounce_ticks) {
    return broken("P9: MOTION not in the tick in which the press completes", ILK_SLOTS, ghost->pressed_ticks,
                  c->pedal_debounce_ticks);
  }
  if (!ghost->entered) {
    return broken("P9: MOTION without an armed pedal, the app, a required card, power or rest", ILK_SLOTS,
                  ghost->powered_ticks, c->power_up_ticks);
  }
  if (!ghost->app_alive || ghost->required_lost || ghost->powered_ticks < c->power_up_ticks) {
    return broken("P9: MOTION although app, card or power forbids it", ILK_SLOTS,
                  (ghost->app_alive ? 0 : 1) + (ghost->required_lost ? 2 : 0), ghost->powered_ticks);
  }
  return HOLDS;
}

/** P10. */
ilk_judgement_t judge_P10(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  if (ghost->app_alive) {
    return HOLDS;
  }
  if (tick->after->mode == ILK_MODE_MOTION) {
    return broken("P10: MOTION although the app is silent", ILK_SLOTS, tick->after->mode, ILK_MODE_READY);
  }
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (is_driven(tick, slot)) {
      return broken("P10: drive although the app is silent", slot, tick->out->command[slot].drive, 0);
    }
  }
  return HOLDS;
}

/** P11: one verdict a taken request, in order, with its tick, sequence, kind and axis. That a refused request
   changes nothing takes two runs: the driver compares them. */
ilk_judgement_t judge_P11(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  const uint32_t taken = (tick->count < ILK_REQUESTS_PER_TICK) ? tick->count : ILK_REQUESTS_PER_TICK;
  if (tick->out->verdict_count != taken) {
    return broken("P11: not one verdict for each request taken", ILK_SLOTS, tick->out->verdict_count, taken);
  }
  for (uint32_t i = 0u; i < taken; i++) {
    const ilk_verdict_record_t* v = &tick->out->verdict[i];
    const ilk_request_t* r = &tick->requests[i];
    if (v->sequence != r->sequence || v->kind != r->kind || v->axis != r->axis || v->tick != ghost->tick) {
      return broken("P11: the verdict names another request", i, v->sequence, r->sequence);
    }
    if (v->verdict >= ILK_VERDICT_COUNT) {
      return broken("P11: not a verdict", i, v->verdict, ILK_VERDICT_COUNT);
    }
    if (ghost->order_error == i + 1u &&
        (ghost->expected <= ILK_VERDICT_AXIS || v->verdict <= ILK_VERDICT_AXIS) &&
        (ghost->expected != ILK_VERDICT_ACCEPTED || v->verdict != ILK_VERDICT_ACCEPTED) &&
        ((ghost->expected >= ILK_VERDICT_CHECKSUM && ghost->expected <= ILK_VERDICT_AXIS) ||
         (v->verdict >= ILK_VERDICT_CHECKSUM && v->verdict <= ILK_VERDICT_AXIS))) {
      return broken("P11: CHECKSUM, SEQUENCE, UNKNOWN, AXIS in this order", i, v->verdict, ghost->expected);
    }
  }
  return HOLDS;
}

/** P12. */
ilk_judgement_t judge_P12(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  if (ghost->consent_error) {
    return broken("P12: a MOVE or HOME of another press was accepted", ILK_SLOTS, tick->before->consent,
                  tick->after->consent);
  }
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    if (is_driven(tick, slot) && (g->order_consent == 0u || g->order_consent != tick->after->consent)) {
      return broken("P12: drive without a MOVE or HOME of this press", slot, g->order_consent,
                    tick->after->consent);
    }
  }
  return HOLDS;
}

/** P13. That the configuration does not change is the driver's to keep: it is const. */
ilk_judgement_t judge_P13(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  (void)ghost;
  if (!tick->config_valid && tick->after->mode != ILK_MODE_INIT) {
    return broken("P13: INIT was left with an invalid configuration", ILK_SLOTS, tick->after->mode,
                  ILK_MODE_INIT);
  }
  if (tick->config_valid && tick->after->mode == ILK_MODE_INIT) {
    return broken("P13: INIT with a valid configuration", ILK_SLOTS, tick->after->mode, ILK_MODE_LOCKED);
  }
  return HOLDS;
}

/** P17, but its last sentence for single wrong readings, which takes two runs. */
ilk_judgement_t judge_P17(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* config = &tick->config->axis[slot];
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    const ilk_axis_view_t* before = &tick->before->axis[slot];
    const ilk_axis_view_t* after = &tick->after->axis[slot];
    if (!has_motor(config)) {
      continue;
    }
    if (after->homed == ILK_HOMED_BY_HAND && before->homed != ILK_HOMED_BY_HAND && !g->set_home) {
      return broken("P17: homed by hand without SET_HOME", slot, after->homed, before->homed);
    }
    if (g->reset && after->homed != ILK_HOMED_NOT && !g->set_home) {
      return broken("P17: a reset card stays homed", slot, after->homed, 0);
    }
    if (g->jump && after->homed != ILK_HOMED_NOT && !g->set_home) {
      return broken("P17: homed after a jump", slot, after->homed, 0);
    }
    if (g->lost && after->homed != ILK_HOMED_NOT) {
      return broken("P17: homed although its card is lost", slot, after->homed, 0);
    }
    if (after->homed == ILK_HOMED_BY_SWITCH && before->homed != ILK_HOMED_BY_SWITCH) {
      uint32_t reference = g->raw;
      if (!g->just_homed || !g->seeks || g->edges.seconds == 0u) {
        return broken("P17: homed without the sequence of edges", slot, g->edges.firsts, g->edges.seconds);
      }
      if (!g->valid || !g->triggered || g->home_run < tick->config->common.switch_debounce_ticks) {
        return broken("P17: homed and the switch is not triggered for the debounce time", slot, g->home_run,
                      tick->config->common.switch_debounce_ticks);
      }
      if (moves(g, config)) {
        return broken("P17: homed and not at rest", slot, g->rest.ticks, config->rest_ticks);
      }
      if (!reference_of(g, config, after->position, &reference)) {
        return broken("P17: position is not raw - e2 + home offset", slot, after->position,
                      (int64_t)judge_counts(config, g->raw, reference) + config->home_offset_counts);
      }
      if (size_of(judge_counts(config, g->raw, reference)) >
          plus(config->coast_counts, config->home_tolerance_counts)) {
        return broken("P17: homed farther from the edge than coast and tolerance", slot,
                      judge_counts(config, g->raw, reference), config->coast_counts);
      }
    } else if (g->position_known && g->seen && after->position != g->position) {
      return broken("P17: the position does not follow the counter", slot, after->position, g->position);
    }
  }
  return HOLDS;
}

/* ------------------------------------------------------------------ beyond the properties */

static uint32_t frequency_word(uint32_t drive) {
  static const uint32_t speed[24] = {0,     54,    189,    331,    614,    1095,   2020,   3222,
                                     3773,  6383,  11445,  15308,  20955,  27358,  36039,  45548,
                                     58997, 78710, 105850, 141386, 188106, 247388, 317394, 397785};
  uint32_t i = 0u;
  if (drive >= speed[23]) {
    return 1196612456u - 4063228u * 23u;
  }
  while (i < 22u && drive >= speed[i + 1u]) {
    i++;
  }
  {
    const uint64_t span = (uint64_t)speed[i + 1u] - speed[i];
    const uint64_t lower =
        4063228u * ((uint64_t)drive - speed[i]) / span; /* rounded down: the word is rounded up */
    return 1196612456u - 4063228u * i - (uint32_t)lower;
  }
}

/** P16, one half: the frames say what the commands say. */
ilk_judgement_t judge_wire(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* config = &tick->config->axis[slot];
    const ilk_command_t* command = &tick->out->command[slot];
    const uint32_t* frame = tick->out->frame[slot];
    uint32_t want[ILK_FRAME_WORDS] = {0};
    uint32_t sum = 0u;
    if (config->card == ILK_CARD_NONE || !tick->config_valid) {
      continue;
    }
    want[0] = START_WORD;
    want[13] = ghost->tick;
    if (command->drive > 0u) {
      const bool set = command->direction == ILK_DIRECTION_DECREASING;
      const bool actual = (config->motor_direction == 1u) ? set : !set;
      want[14] = 1u;
      switch (config->card) {
        case ILK_CARD_PWM:
          want[3] = (actual ? 0u : 0x80000000u) + command->drive;
          break;
        case ILK_CARD_NON_PWM:
          want[3] = (actual ? 0x40000000u : 0xC0000000u) + command->drive;
          break;
        case ILK_CARD_ANALOG:
          want[6] = (actual ? 0u : 0x80000000u) + command->drive;
          break;
        case ILK_CARD_HIGH_FREQUENCY:
          want[2] = (actual ? 0u : 0x01000000u) | command->amplitude;
          want[4] = (actual ? 0x01000000u : 0u) | command->amplitude;
          want[3] = frequency_word(command->drive);
          want[5] = want[3];
          break;
        default:
          return broken("wire: drive of a card without a motor", slot, command->drive, 0);
      }
    } else if (command->direction != ILK_DIRECTION_NONE || command->amplitude != 0u) {
      return broken("wire: zero drive is NONE, 0, 0", slot, command->direction, command->amplitude);
    }
    for (uint32_t i = 0u; i < ILK_FRAME_WORDS - 1u; i++) {
      sum += want[i];
      if (frame[i] != want[i]) {
        return broken("wire: a word differs from the published packing", slot, frame[i], want[i]);
      }
    }
    if (frame[ILK_FRAME_WORDS - 1u] != 0xFFFFFFFFu - sum) {
      return broken("wire: checksum", slot, frame[ILK_FRAME_WORDS - 1u], 0xFFFFFFFFu - sum);
    }
  }
  return HOLDS;
}

/** The table of modes. Less than its text: whether a DISABLED axis moved is not judged in the first
   rest_ticks after a new or reset card or an invalid frame, nor when it took more than two of its readings to
   move that far. */
ilk_judgement_t judge_mode(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  const ilk_common_config_t* c = &tick->config->common;
  const uint32_t cause = tick->after->cause;
  if (ghost->mode != tick->after->mode) {
    return broken("mode: not the mode of the table", tick->before->mode, tick->after->mode, ghost->mode);
  }
  if (tick->after->mode == ILK_MODE_MOTION && tick->before->mode != ILK_MODE_MOTION &&
      ghost->drift_of_disabled) {
    return broken("mode: MOTION although a DISABLED axis moved", ILK_SLOTS, 1, 0);
  }
  if (tick->after->mode == ILK_MODE_LOCKED && tick->before->mode != ILK_MODE_LOCKED) {
    const bool there = (cause == ILK_CAUSE_ESTOP && ghost->estop) ||
                       (cause == ILK_CAUSE_BUS && ghost->bus_lost) ||
                       (cause == ILK_CAUSE_PEDAL && ghost->disagree_ticks >= c->pedal_disagree_ticks) ||
                       (cause == ILK_CAUSE_OVERRUN && ghost->missed_in_row >= c->overrun_limit) ||
                       (cause == ILK_CAUSE_RUNAWAY && (ghost->runaway || ghost->runaway_unsure));
    if (!there) {
      return broken("mode: LOCKED by a cause that is not there", ILK_SLOTS, cause, 0);
    }
  }
  if (tick->after->mode == ILK_MODE_LOCKED) {
    for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
      const uint32_t state = tick->after->axis[slot].state;
      if (state != ILK_AXIS_FAULTED && state != ILK_AXIS_DISABLED) {
        return broken("mode: an axis is enabled in LOCKED", slot, state, ILK_AXIS_DISABLED);
      }
    }
  }
  return HOLDS;
}

/** The table of requests: the verdict is the first check that fails. */
ilk_judgement_t judge_rows(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  if (ghost->order_error != 0u) {
    const ilk_request_t* r = &tick->requests[ghost->order_error - 1u];
    static const char* const names[] = {"rows: ?",           "rows: HEARTBEAT", "rows: STOP",
                                        "rows: RESET",       "rows: DISABLE",   "rows: ENABLE",
                                        "rows: CLEAR_FAULT", "rows: MOVE",      "rows: HOME",
                                        "rows: SET_HOME",    "rows: RESTORE"};
    return broken(names[r->kind <= ILK_REQUEST_RESTORE ? r->kind : 0u], r->axis,
                  tick->out->verdict[ghost->order_error - 1u].verdict, ghost->expected);
  }
  return HOLDS;
}

static uint32_t class_of(uint32_t state) {
  return (state == ILK_AXIS_MOVING) ? (uint32_t)ILK_AXIS_ENABLED : state;
}

/** States, what drops `homed`, lost and reset cards, switch plausibility. */
ilk_judgement_t judge_states(const ilk_ghost_t* ghost, const ilk_tick_t* tick) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* config = &tick->config->axis[slot];
    const ilk_ghost_slot_t* g = &ghost->slot[slot];
    const ilk_axis_view_t* before = &tick->before->axis[slot];
    const ilk_axis_view_t* after = &tick->after->axis[slot];
    const bool new_fault = before->state != ILK_AXIS_FAULTED && after->state == ILK_AXIS_FAULTED;
    if (!has_motor(config)) {
      continue;
    }
    if (class_of(after->state) != class_of(g->state)) {
      return broken("states: not the state that faults, mode and requests give", slot, after->state,
                    g->state);
    }
    if (after->state == ILK_AXIS_FAULTED &&
        (after->fault == ILK_FAULT_NONE || after->fault >= ILK_FAULT_COUNT)) {
      return broken("states: FAULTED without a code", slot, after->fault, 0);
    }
    if (new_fault && after->fault != ILK_FAULT_DRIFT && after->homed != ILK_HOMED_NOT) {
      return broken("states: the fault does not drop homed", slot, after->fault, after->homed);
    }
    if (before->homed != ILK_HOMED_NOT && after->homed == ILK_HOMED_NOT && !g->jump && !g->reset &&
        !g->lost && !(after->state == ILK_AXIS_FAULTED && after->fault != ILK_FAULT_DRIFT && new_fault) &&
        !g->stalled && g->implausible == 0u && !ghost->consent_error && !g->restored) {
      bool home = false; /* a HOME in this tick that STOP or DISABLE ended again */
      for (uint32_t i = 0u; i < tick->out->verdict_count && i < tick->count && i < ILK_REQUESTS_PER_TICK;
           i++) {
        home = home || (tick->requests[i].kind == ILK_REQUEST_HOME && tick->requests[i].axis == slot &&
                        tick->out->verdict[i].verdict == ILK_VERDICT_ACCEPTED);
      }
      if (!home) {
        return broken("states: homed was dropped without a reason", slot, after->fault, before->homed);
      }
    }
    if (before->state != ILK_AXIS_FAULTED && g->lost && (!new_fault || after->fault != ILK_FAULT_CARD)) {
      return broken("states: a lost card and no fault CARD", slot, after->state, after->fault);
    }
    if (before->state != ILK_AXIS_FAULTED && g->reset &&
        (!new_fault || after->fault != ILK_FAULT_CARD_RESET)) {
      return broken("states: a reset card and no fault CARD_RESET", slot, after->state, after->fault);
    }
    if (new_fault && ((after->fault == ILK_FAULT_CARD && !g->lost) ||
                      (after->fault == ILK_FAULT_CARD_RESET && !g->reset))) {
      return broken("states: CARD or CARD_RESET without its reason", slot, after->fault, g->bad_run);
    }
    if (new_fault && before->state != ILK_AXIS_HOMING &&
        (after->fault == ILK_FAULT_HOMING_TRAVEL || after->fault == ILK_FAULT_HOMING_TIMEOUT ||
         (after->fault == ILK_FAULT_SWITCH && g->implausible < tick->config->common.switch_debounce_ticks))) {
      return broken("states: SWITCH or HOMING fault without its reason", slot, after->fault, g->implausible);
    }
    if (g->implausible >= tick->config->common.switch_debounce_ticks && after->homed == ILK_HOMED_BY_SWITCH) {
      return broken("states: the switch contradicts the position and the axis is homed", slot,
                    after->position, g->implausible);
    }
    if (after->state == ILK_AXIS_HOMING && before->state != ILK_AXIS_HOMING &&
        after->homed != ILK_HOMED_NOT) {
      return broken("states: homed while HOMING", slot, after->homed, 0);
    }
  }
  return HOLDS;
}

/** Rules of the text in numbers, as far as it gives them; speed is rounded up where it must not be exceeded.
 */
ilk_judgement_t judge_config(const ilk_config_t* config) {
  const ilk_common_config_t* c = &config->common;
  const uint64_t ms = c->period_us;
  bool motor = false;
  if (c->app_timeout_ticks < 2u || c->app_timeout_ticks * ms > 150000u) {
    return broken("config: app_timeout_ticks", ILK_SLOTS, c->app_timeout_ticks, 0);
  }
  if (c->lease_max_ticks < 1u || c->lease_max_ticks * ms > 150000u) {
    return broken("config: lease_max_ticks", ILK_SLOTS, c->lease_max_ticks, 0);
  }
  if (ms < 125u || ms > 2000u || c->pedal_channels < 1u || c->pedal_channels > 2u) {
    return broken("config: period or pedal channels", ILK_SLOTS, (int64_t)ms, c->pedal_channels);
  }
  if (c->pedal_debounce_ticks < 1u || c->pedal_debounce_ticks * ms > 50000u || c->pedal_disagree_ticks < 1u ||
      c->pedal_disagree_ticks * ms > 50000u) {
    return broken("config: pedal times", ILK_SLOTS, c->pedal_debounce_ticks, c->pedal_disagree_ticks);
  }
  if (c->bad_frame_limit < 1u || c->bad_frame_limit > 5u || c->overrun_limit < 1u || c->overrun_limit > 10u) {
    return broken("config: bad frames or overruns", ILK_SLOTS, c->bad_frame_limit, c->overrun_limit);
  }
  if (c->switch_debounce_ticks < 2u || c->switch_debounce_ticks * ms > 20000u) { /* one reading is no edge */
    return broken("config: switch debounce", ILK_SLOTS, c->switch_debounce_ticks, 0);
  }
  for (uint32_t i = 0u; i < ILK_SLOTS; i++) {
    const ilk_axis_config_t* a = &config->axis[i];
    const uint64_t noise = a->noise_counts;
    const uint64_t coast = a->coast_counts;
    const uint64_t range = (uint64_t)((int64_t)a->max_counts - a->min_counts);
    /* millionths of a count a tick */
    const uint64_t full = (uint64_t)a->full_speed_counts_per_s * ms;
    const uint64_t home = (uint64_t)a->home_speed_counts_per_s * ms;
    const uint64_t slow = (uint64_t)a->home_slow_speed_counts_per_s * ms;
    const uint64_t dead = a->dead_zone_drive;
    const uint64_t one = 1000000u;
    if (!has_motor(a)) {
      continue;
    }
    motor = true;
    if (a->min_counts >= a->max_counts || 2u * coast >= range || a->home_offset_counts < a->min_counts ||
        a->home_offset_counts > a->max_counts) {
      return broken("config: soft limits, coast or home offset", i, a->min_counts, a->max_counts);
    }
    if (5u * dead > a->max_drive || a->unhomed_max_drive <= dead ||
        10u * (a->unhomed_max_drive - dead) > a->max_drive - dead ||
        a->max_amplitude > ((a->card == ILK_CARD_HIGH_FREQUENCY) ? 255u : 0u)) {
      return broken("config: drives or amplitude", i, a->unhomed_max_drive, a->dead_zone_drive);
    }
    if (a->unhomed_travel_counts <= coast + noise) {
      return broken("config: unhomed travel that allows none", i, a->unhomed_travel_counts, (int64_t)coast);
    }
    if (a->stall_ticks <= ILK_LATENCY_TICKS || a->stall_ticks * ms > 500000u ||
        a->stall_effort_ticks * ms > 200000u) {
      return broken("config: stall times", i, a->stall_ticks, a->stall_effort_ticks);
    }
    if (full > (uint64_t)a->max_delta_counts * one) {
      return broken("config: full speed beyond max_delta_counts", i, (int64_t)full, a->max_delta_counts);
    }
    if ((uint64_t)a->coast_counts * one < full * ILK_LATENCY_TICKS) {
      return broken("config: coast shorter than the latency at full speed", i, a->coast_counts,
                    (int64_t)full);
    }
    if (a->stall_effort_ticks > 0u &&
        a->stall_effort_ticks * full <
            one * (5u * (uint64_t)a->coast_counts + a->backlash_counts + noise + 1u)) {
      return broken("config: stall effort too short", i, a->stall_effort_ticks, (int64_t)full);
    }
    if (a->stall_effort_ticks == 0u &&
        (200000u / ms) * full >= one * (5u * (uint64_t)a->coast_counts + a->backlash_counts + noise + 1u)) {
      return broken("config: no effort bound on an axis fast enough", i, 0, (int64_t)full);
    }
    if ((uint64_t)a->drift_counts < (uint64_t)a->coast_counts + a->backlash_counts + noise ||
        (uint64_t)a->reverse_counts < (uint64_t)a->coast_counts + a->backlash_counts + noise) {
      return broken("config: drift or reverse", i, a->drift_counts, a->reverse_counts);
    }
    if (a->limit_side != ILK_LIMIT_NONE) {
      const uint64_t clear = a->home_clear_counts;
      const bool lower = a->limit_side == ILK_LIMIT_LOWER;
      const uint64_t inside = (uint64_t)(lower ? (int64_t)a->max_counts - a->home_offset_counts
                                               : (int64_t)a->home_offset_counts - a->min_counts);
      /* from the far stop to the second edge; from the near one, off the switch first */
      const uint64_t far_way = inside + 2u * clear;
      const uint64_t near_way = range - inside + a->switch_hysteresis_counts + 4u * clear;
      const uint64_t way = far_way > near_way ? far_way : near_way;
      if (clear <= (uint64_t)a->home_tolerance_counts + a->switch_hysteresis_counts + a->coast_counts ||
          clear <= (uint64_t)a->stall_min_counts + a->backlash_counts + noise) {
        return broken("config: home_clear_counts", i, (int64_t)clear, 0);
      }
      if ((uint64_t)a->home_tolerance_counts * one <
          home * (c->switch_debounce_ticks + 2u) + 2u * noise * one) {
        return broken("config: home_tolerance_counts", i, a->home_tolerance_counts, (int64_t)home);
      }
      if (a->stall_ticks * slow < one * ((uint64_t)a->stall_min_counts + a->backlash_counts + noise)) {
        return broken("config: stall_ticks at the slow speed", i, a->stall_ticks, (int64_t)slow);
      }
      if (inside <=
          (uint64_t)a->home_tolerance_counts + a->switch_hysteresis_counts + coast + a->deadband_counts) {
        return broken("config: no room on the open side of the switch", i, (int64_t)inside,
                      a->home_offset_counts);
      }
      if (a->home_slow_drive <= a->dead_zone_drive || a->home_drive > a->unhomed_max_drive ||
          a->home_slow_drive > a->home_drive || slow == 0u || slow > home || home > full ||
          a->home_amplitude > a->max_amplitude) {
        return broken("config: homing drives", i, a->home_slow_drive, a->home_drive);
      }
      if (a->home_travel_counts <= way + coast + noise) {
        return broken("config: home_travel_counts below the way of homing", i, a->home_travel_counts,
                      (int64_t)way);
      }
      if (a->home_timeout_ticks * home < one * (way - clear)) {
        return broken("config: home_timeout_ticks below the time of homing", i, a->home_timeout_ticks,
                      (int64_t)way);
      }
    }
  }
  return motor ? HOLDS : broken("config: no motor", ILK_SLOTS, 0, 1);
}

const ilk_judge_t ilk_judges[JUDGE_COUNT] = {
    judge_P1,  judge_P2,  judge_P3,  judge_P4,  judge_P5,  judge_P6,   judge_P7,   judge_P8,   judge_P9,
    judge_P10, judge_P11, judge_P12, judge_P13, judge_P17, judge_wire, judge_mode, judge_rows, judge_states};
const char* const ilk_judge_names[JUDGE_COUNT] = {"P1",  "P2",  "P3",   "P4",   "P5",   "P6",
                                                  "P7",  "P8",  "P9",   "P10",  "P11",  "P12",
                                                  "P13", "P17", "wire", "mode", "rows", "states"};
