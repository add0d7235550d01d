/**
 * @file
 * R and M: what the judge remembers, and the kernel's own counters and marks. See tick.h.
 */
#include "monitors.c"
#include "tick.h"

bool ilk_state_is_sealed(const ilk_state_t* state); /* parts.h, whose names the monitors have, too */

static ilk_ghost_t ghost;
static ilk_view_t before;
static ilk_view_t after;
static ilk_tick_t tick;

ilk_ghost_t nondet_ghost(void);
bool nondet_truth(void);
uint32_t nondet_word(void);

#define RELATED(claim)                   \
  do {                                   \
    const bool related = (claim);        \
    if (shown) {                         \
      __CPROVER_assert(related, #claim); \
    } else {                             \
      __CPROVER_assume(related);         \
    }                                    \
  } while (false)

/* --- The configuration
 * -------------------------------------------------------------------------------------- */

/** What the proofs take from ilk_config_validate. The step `validity` shows that it follows. */
bool config_is_valid(void) {
  const ilk_common_config_t* c = &config.common;
  bool valid = c->pedal_channels >= 1u && c->pedal_channels <= 2u && c->pedal_debounce_ticks > 0u &&
               c->bad_frame_limit > 0u && c->overrun_limit > 0u && config.crc == ilk_config_crc(&config);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* a = &config.axis[slot];
    valid = valid && a->card < ILK_CARD_COUNT && a->required <= 1u && a->motor_direction <= 1u &&
            a->direction_correction <= 1u && a->limit_side < ILK_LIMIT_COUNT &&
            a->unhomed_max_drive <= a->max_drive &&
            HOLDS_IF(has_motor(a), a->noise_counts < (1u << 28) && a->drift_counts < (1u << 28) &&
                                       a->stall_min_counts > 0u && a->stall_min_counts < (1u << 31) &&
                                       a->deadband_counts < (1u << 30) && a->max_drive > 0u);
  }
  return valid;
}

/* --- The parts
 * ---------------------------------------------------------------------------------------------- */

static void relate_integrity(bool shown) {
  const ilk_system_t* s = &state.system;
  RELATED(ilk_state_is_sealed(&state));
  RELATED(s->config_sound == 1u && s->config_crc == config.crc && s->config_slice < ILK_SLOTS);
  RELATED(s->config_slice == 0u || s->config_partial_crc == ~config.crc);
  RELATED(s->pedal_channels == config.common.pedal_channels &&
          s->app_timeout_ticks == config.common.app_timeout_ticks);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* a = &config.axis[slot];
    RELATED(state.axis[slot].wiring == (a->card | (a->limit_side << 8) | (a->motor_direction << 16)));
  }
}

static void relate_frames(bool shown, bool middle) {
  RELATED(ghost.tick == state.system.tick && ghost.frames_sent == state.system.frames_sent);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost.slot[slot];
    const ilk_axis_t* s = &state.axis[slot];
    if (config.axis[slot].card != ILK_CARD_NONE) {
      RELATED(g->bad_run == s->bad_frames && g->lost == (g->bad_run >= config.common.bad_frame_limit));
      RELATED(s->card_valid == (g->valid ? 1u : 0u) && HOLDS_IF(g->valid, g->bad_run == 0u));
    }
    if (has_motor(&config.axis[slot])) {
      RELATED(s->card_seen == ((g->seen && !g->lost) ? 1u : 0u));
      RELATED(HOLDS_IF(g->valid, g->seen && g->periods == 0u) &&
              HOLDS_IF(!g->valid, g->periods == s->periods));
      RELATED(g->raw == s->raw && g->heartbeat == s->heartbeat && g->status == s->card_status);
      RELATED(g->edges.firsts <= ILK_JUDGE_EDGES && g->edges.seconds <= ILK_JUDGE_EDGES);
      if (middle && config.axis[slot].limit_side != ILK_LIMIT_NONE) {
        RELATED(s->switch_triggered == ((!g->valid || g->triggered) ? 1u : 0u));
      }
    }
  }
}

static void relate_system(bool shown, bool middle) {
  const ilk_system_t* s = &state.system;
  const uint32_t up = config.common.power_up_ticks;
  RELATED(ghost.app_age == s->app_age_ticks && ghost.holder == s->holder);
  RELATED(ghost.link_generation == s->link_generation && ghost.last_sequence == s->last_sequence);
  RELATED(ghost.bus_bad_ticks == s->bus_bad_ticks && ghost.disagree_ticks == s->pedal_disagree_ticks);
  RELATED(ghost.missed_in_row == s->overruns_in_row && ghost.missed_ticks <= s->overruns_in_row);
  RELATED(s->powered_ticks == (ghost.powered_ticks < up ? ghost.powered_ticks : up));
  if (middle) {
    RELATED(ghost.pedal == s->pedal && s->estop == (ghost.estop ? 1u : 0u));
    RELATED(s->app_alive == (ghost.app_alive ? 1u : 0u));
    RELATED(ghost.bus_lost == (s->bus_bad_ticks >= config.common.bad_frame_limit));
    RELATED(HOLDS_IF(ghost.app_alive, s->app_age_ticks < config.common.app_timeout_ticks));
  }
}

/** The kernel by itself. */
static void relate_mode(bool shown, bool middle) {
  const ilk_system_t* s = &state.system;
  const bool motion = s->mode == ILK_MODE_MOTION;
  RELATED(s->mode >= ILK_MODE_LOCKED && s->mode <= ILK_MODE_MOTION);
  RELATED(HOLDS_IF(s->mode == ILK_MODE_LOCKED, s->cause > ILK_CAUSE_NONE && s->cause < ILK_CAUSE_COUNT &&
                                                   s->cause != ILK_CAUSE_INTEGRITY));
  RELATED(HOLDS_IF(!motion, s->consent == 0u));
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_t* a = &state.axis[slot];
    RELATED(a->homed <= ILK_HOMED_BY_HAND && a->state <= ILK_AXIS_FAULTED && a->fault < ILK_FAULT_COUNT);
    RELATED(
        HOLDS_IF(!has_motor(&config.axis[slot]), a->state == ILK_AXIS_DISABLED && a->homed == ILK_HOMED_NOT));
    RELATED((a->fault != ILK_FAULT_NONE) == (a->state == ILK_AXIS_FAULTED) &&
            a->fault != ILK_FAULT_INTEGRITY);
    RELATED(HOLDS_IF(!motion, a->state != ILK_AXIS_MOVING && a->state != ILK_AXIS_HOMING));
    RELATED(
        HOLDS_IF(s->mode == ILK_MODE_LOCKED, a->state == ILK_AXIS_DISABLED || a->state == ILK_AXIS_FAULTED));
    RELATED(HOLDS_IF(s->mode != ILK_MODE_LOCKED, a->runaway == 0u) && a->runaway <= 1u);
    RELATED(HOLDS_IF(a->state == ILK_AXIS_HOMING,
                     a->homed == ILK_HOMED_NOT && config.axis[slot].limit_side != ILK_LIMIT_NONE));
  }
  if (middle) {
    RELATED(before.mode >= ILK_MODE_LOCKED && before.mode <= ILK_MODE_MOTION);
    RELATED(HOLDS_IF(before.mode != ILK_MODE_MOTION, before.consent == 0u));
    RELATED(HOLDS_IF(before.mode == ILK_MODE_LOCKED && s->mode == ILK_MODE_LOCKED, s->cause == before.cause));
    RELATED(HOLDS_IF(motion && before.mode == ILK_MODE_MOTION, s->consent == before.consent));
    RELATED(HOLDS_IF(motion, before.mode >= ILK_MODE_READY));
    RELATED(HOLDS_IF(s->estop != 0u || s->bus_bad_ticks >= config.common.bad_frame_limit,
                     s->mode == ILK_MODE_LOCKED));
    RELATED(HOLDS_IF(motion, s->app_alive != 0u && s->pedal == ILK_PEDAL_PRESSED));
    for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
      RELATED(HOLDS_IF(!has_motor(&config.axis[slot]), before.axis[slot].state == ILK_AXIS_DISABLED));
    }
  }
}

/** False when a press may have begun and ended within this tick, unseen. */
static bool mode_is_told(void) { return ghost.mode_sure || after.mode == ILK_MODE_MOTION; }

static void relate_orders(bool shown, bool middle) {
  const bool motion = state.system.mode == ILK_MODE_MOTION;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost.slot[slot];
    const ilk_axis_t* a = &state.axis[slot];
    const bool moving = a->state == ILK_AXIS_MOVING;
    if (!has_motor(&config.axis[slot])) {
      continue;
    }
    RELATED(HOLDS_IF(moving, a->lease_ticks > 0u && g->lease == a->lease_ticks));
    RELATED(
        HOLDS_IF(moving, a->drive > 0u && g->order_drive == a->drive && g->setpoint == a->setpoint_counts));
    RELATED(HOLDS_IF(moving || a->state == ILK_AXIS_HOMING, g->order_consent == state.system.consent));
    RELATED(HOLDS_IF(middle ? (motion && mode_is_told()) : true, moving || g->lease == 0u));
    if (middle) {
      RELATED(HOLDS_IF(before.axis[slot].state == ILK_AXIS_FAULTED && !g->cleared,
                       a->state == ILK_AXIS_FAULTED && a->fault == before.axis[slot].fault));
    }
  }
  if (middle) {
    RELATED(HOLDS_IF(before.mode == ILK_MODE_LOCKED && state.system.mode != ILK_MODE_LOCKED,
                     ghost.reset_accepted));
    RELATED(HOLDS_IF(motion && mode_is_told(), ghost.mode == ILK_MODE_MOTION));
    RELATED(HOLDS_IF(motion && mode_is_told() && before.mode != ILK_MODE_MOTION, ghost.entered));
    RELATED(HOLDS_IF(ghost.entered, before.mode == ILK_MODE_READY));
    RELATED(HOLDS_IF(!ghost.mode_sure, before.mode == ILK_MODE_READY));
    RELATED(!ghost.consent_error);
  }
}

static void relate_pedal(bool shown, bool middle) {
  const ilk_common_config_t* c = &config.common;
  const ilk_system_t* s = &state.system;
  const bool ready = s->mode == ILK_MODE_READY;
  RELATED(s->pedal_armed <= 1u && HOLDS_IF(!ready, s->pedal_armed == 0u && s->pedal_released_ticks == 0u));
  RELATED(HOLDS_IF(s->pedal_armed != 0u, ghost.armed && ghost.pressed_ticks == s->pedal_pressed_ticks));
  RELATED(HOLDS_IF(s->pedal_armed != 0u, s->pedal_pressed_ticks < c->pedal_debounce_ticks));
  RELATED(s->pedal_released_ticks <= ghost.armed_ticks);
  if (middle) {
    RELATED(HOLDS_IF(before.mode != ILK_MODE_READY, s->pedal_armed == 0u && s->pedal_released_ticks == 0u));
    if (s->mode == ILK_MODE_MOTION && before.mode != ILK_MODE_MOTION) {
      RELATED(ghost.pressed_ticks == c->pedal_debounce_ticks && ghost.app_alive && !ghost.required_lost);
      RELATED(ghost.powered_ticks >= c->power_up_ticks);
    }
  }
}

static void relate_path(bool shown, bool middle) {
  const bool told = state.system.mode == ILK_MODE_MOTION && (!middle || mode_is_told());
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* c = &config.axis[slot];
    const ilk_ghost_slot_t* g = &ghost.slot[slot];
    const ilk_axis_t* a = &state.axis[slot];
    if (!has_motor(c)) {
      continue;
    }
    const bool homing = a->state == ILK_AXIS_HOMING;
    RELATED(g->path_known || !g->seen || g->lost);
    RELATED(HOLDS_IF(told, a->path_raw == g->path));
    RELATED(HOLDS_IF(
        told, a->unhomed_travel_counts == g->move_travel && a->homing_travel_counts == g->homing_travel));
    RELATED(HOLDS_IF(told, a->path_is_homing == (g->path_homing ? 1u : 0u)));
    RELATED(HOLDS_IF(told, g->homing_ticks == a->homing_ticks + ((homing && !middle) ? 1u : 0u)));
    RELATED(a->homing_ticks <= c->home_timeout_ticks &&
            HOLDS_IF(homing, a->homing_ticks < c->home_timeout_ticks));
  }
}

/** A reading that the judge remembers, from the first of the kernel's. */
static int32_t from_first(const ilk_axis_config_t* c, const ilk_still_t* g, int32_t at,
                          const ilk_stillness_t* s) {
  const uint32_t raw = (c->direction_correction == 1u) ? g->origin - (uint32_t)at : g->origin + (uint32_t)at;
  return wrapped(raw, s->origin_raw);
}

static void relate_stillness(bool shown, const ilk_axis_config_t* c, const ilk_still_t* g,
                             const ilk_stillness_t* s, uint32_t span) {
  RELATED(s->ticks <= c->rest_ticks && g->apart_age >= s->ticks);
  RELATED(HOLDS_IF(s->ticks > 0u, s->below <= 0 && s->above >= 0 && (int64_t)s->above - s->below <= span));
  if (g->ticks > 0u) {
    const int32_t low = from_first(c, g, g->low, s);
    const int32_t high = from_first(c, g, g->high, s);
    RELATED(g->low <= 0 && g->high >= 0 && (int64_t)g->high - g->low <= span);
    RELATED(HOLDS_IF(g->low_age < s->ticks, low >= s->below && low <= s->above));
    RELATED(HOLDS_IF(g->high_age < s->ticks, high >= s->below && high <= s->above));
  }
}

/** The kernel knows rest only where the judge does not see motion. */
static void relate_rest(bool shown) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* c = &config.axis[slot];
    const ilk_ghost_slot_t* g = &ghost.slot[slot];
    const ilk_stillness_t* s = &state.axis[slot].rest;
    if (has_motor(c)) {
      const int32_t last = wrapped(g->raw, s->origin_raw);
      relate_stillness(shown, c, &g->rest, s, c->noise_counts);
      RELATED(g->quiet >= s->ticks);
      RELATED(HOLDS_IF(s->ticks > 0u, g->valid && last >= s->below && last <= s->above));
    }
  }
}

/** MOTION begins only when no axis that is DISABLED has moved. */
static void relate_calm(bool shown, bool middle) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (has_motor(&config.axis[slot])) {
      relate_stillness(shown, &config.axis[slot], &ghost.slot[slot].calm, &state.axis[slot].calm,
                       config.axis[slot].drift_counts);
    }
  }
  if (middle) {
    RELATED(HOLDS_IF(state.system.mode == ILK_MODE_MOTION && before.mode != ILK_MODE_MOTION,
                     !ghost.drift_of_disabled));
  }
}

static uint32_t nonce;      /**< of this start */
static uint32_t press_tick; /**< in which the last press began */

uint32_t __CPROVER_uninterpreted_number(uint32_t boot_nonce, uint32_t at);
uint32_t number_of(uint32_t boot_nonce, uint32_t at) {
  return __CPROVER_uninterpreted_number(boot_nonce, at);
}

bool is_number_of_another(uint32_t boot_nonce, uint32_t at, uint32_t number) {
  return press_tick != 0u && at != press_tick && number == number_of(boot_nonce, press_tick);
}

/** The nonce is that of this start, and the last press began less than 2^32 ticks ago. */
bool may_be_this_tick(void) { return in.boot_nonce == nonce && state.system.tick != press_tick; }

/** MOTION has a number that is not 0. */
static void relate_number(bool shown, bool middle) {
  const ilk_system_t* s = &state.system;
  RELATED(HOLDS_IF(s->mode == ILK_MODE_MOTION, s->consent != 0u));
  if (middle) {
    RELATED(HOLDS_IF(before.mode == ILK_MODE_MOTION, before.consent != 0u));
  }
}

/** The number of a press is not that of the press before. */
static void relate_press(bool shown, bool middle) {
  const ilk_system_t* s = &state.system;
  const bool motion = s->mode == ILK_MODE_MOTION;
  const bool was_known = ghost.last_consent != 0u;
  RELATED(HOLDS_IF(was_known, press_tick != 0u && ghost.last_consent == number_of(nonce, press_tick)));
  if (middle) {
    RELATED(HOLDS_IF(before.mode == ILK_MODE_MOTION, before.consent == ghost.last_consent));
    RELATED(HOLDS_IF(motion && before.mode != ILK_MODE_MOTION, s->tick != 0u &&
                                                                   s->consent == number_of(nonce, s->tick) &&
                                                                   s->consent != ghost.last_consent));
  } else {
    RELATED(HOLDS_IF(motion, s->consent == ghost.last_consent));
  }
}

/** A FAULTED axis that goes on moving locks, and is known to be the reason. */
static void relate_runaway(bool shown, bool middle) {
  bool known = false;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    known = known || state.axis[slot].runaway != 0u;
  }
  if (middle) {
    RELATED(HOLDS_IF(ghost.runaway, state.system.mode == ILK_MODE_LOCKED && known));
  }
}

static void relate_stall(bool shown, bool middle) {
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost.slot[slot];
    const ilk_axis_t* a = &state.axis[slot];
    const bool directed = a->stall_direction != ILK_DIRECTION_NONE;
    const bool was_well = before.axis[slot].state != ILK_AXIS_FAULTED;
    if (!has_motor(&config.axis[slot])) {
      continue;
    }
    RELATED(g->stall_direction == a->stall_direction && a->stall_direction <= ILK_DIRECTION_DECREASING);
    RELATED(HOLDS_IF(directed, g->stall_mark == a->stall_mark_raw && g->effort_mark == a->effort_mark_raw));
    RELATED(g->stall_ticks == a->stall_driven_ticks);
    RELATED(g->effort == (((uint64_t)a->effort_high << 32) | a->effort_low));
    if (middle) {
      RELATED(HOLDS_IF(was_well && a->state == ILK_AXIS_FAULTED, a->fault_tick == state.system.tick));
      RELATED(HOLDS_IF(!was_well && a->state == ILK_AXIS_FAULTED, a->fault == before.axis[slot].fault));
      RELATED(HOLDS_IF(g->stalled && was_well,
                       a->state == ILK_AXIS_FAULTED && a->fault_tick == state.system.tick));
      RELATED(HOLDS_IF(was_well && a->state == ILK_AXIS_FAULTED && a->fault == ILK_FAULT_STALL, g->stalled));
    }
  }
}

void relate(bool shown, bool middle, unsigned parts) {
  if ((parts & MODE) != 0u) {
    relate_integrity(shown);
    relate_mode(shown, middle);
  }
  if ((parts & FRAMES) != 0u) {
    relate_frames(shown, middle);
  }
  if ((parts & SYSTEM) != 0u) {
    relate_system(shown, middle);
  }
  if ((parts & ORDERS) != 0u) {
    relate_orders(shown, middle);
  }
  if ((parts & PEDAL) != 0u) {
    relate_pedal(shown, middle);
  }
  if ((parts & PATH) != 0u) {
    relate_path(shown, middle);
  }
  if ((parts & CALM) != 0u) {
    relate_calm(shown, middle);
  }
  if ((parts & NUMBER) != 0u) {
    relate_number(shown, middle);
  }
  if ((parts & PRESS) != 0u) {
    relate_press(shown, middle);
  }
  if ((parts & STALL) != 0u) {
    relate_stall(shown, middle);
  }
  if ((parts & REST) != 0u) {
    relate_rest(shown);
  }
  if ((parts & RUNAWAY) != 0u) {
    relate_runaway(shown, middle);
  }
}

/* --- What may follow by requests
 * ----------------------------------------------------------------------------- */

bool may_follow(const ilk_state_t* from, const ilk_state_t* to) {
  const ilk_system_t* s = &from->system;
  const ilk_system_t* t = &to->system;
  const bool locked = s->mode == ILK_MODE_LOCKED;
  bool clear = s->pedal == ILK_PEDAL_RELEASED && s->estop == 0u && s->bus_bad_ticks == 0u &&
               s->overruns_in_row == 0u && s->app_alive != 0u;
  bool may = t->tick == s->tick && t->pedal == s->pedal && t->estop == s->estop &&
             t->bus_bad_ticks == s->bus_bad_ticks && t->overruns_in_row == s->overruns_in_row &&
             t->app_alive == s->app_alive;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_t* a = &from->axis[slot];
    const ilk_axis_t* b = &to->axis[slot];
    clear = clear && a->runaway == 0u;
    may = may && b->fault_tick == ((b->state == ILK_AXIS_FAULTED) ? a->fault_tick : b->fault_tick) &&
          b->runaway == a->runaway &&
          HOLDS_IF(b->state == ILK_AXIS_FAULTED, a->state == ILK_AXIS_FAULTED && b->fault == a->fault) &&
          HOLDS_IF(a->state == ILK_AXIS_FAULTED && b->state != ILK_AXIS_FAULTED, a->fault_tick != s->tick) &&
          HOLDS_IF(b->homed == ILK_HOMED_BY_SWITCH,
                   a->homed == ILK_HOMED_BY_SWITCH && a->position_counts == b->position_counts);
  }
  return may && HOLDS_IF(t->mode == ILK_MODE_LOCKED, locked && t->cause == s->cause) &&
         HOLDS_IF(locked && t->mode != ILK_MODE_LOCKED, clear) &&
         HOLDS_IF(t->mode == ILK_MODE_MOTION, s->mode == ILK_MODE_MOTION && t->consent == s->consent) &&
         HOLDS_IF(t->mode == ILK_MODE_INIT, s->mode == ILK_MODE_INIT) &&
         HOLDS_IF(s->mode == ILK_MODE_INIT, t->mode == ILK_MODE_INIT) &&
         HOLDS_IF(t->mode != ILK_MODE_MOTION, t->consent == ((s->mode == ILK_MODE_MOTION) ? 0u : s->consent));
}

/** The same words, the seal and what a refusal may count apart. */
bool is_inert(const ilk_state_t* from, const ilk_state_t* to) {
  const uint32_t* a = (const uint32_t*)from;
  const uint32_t* b = (const uint32_t*)to;
  const uint32_t number = offsetof(ilk_state_t, system.last_sequence) / sizeof(uint32_t);
  const uint32_t refused = offsetof(ilk_state_t, system.requests_refused) / sizeof(uint32_t);
  uint32_t differ = 0u;
  for (uint32_t word = 0u; word < offsetof(ilk_state_t, seal) / sizeof(uint32_t); word++) {
    if (word != number && word != refused) {
      differ |= a[word] ^ b[word];
    }
  }
  return differ == 0u;
}

bool is_still(const uint32_t* frame) { return judge_is_zero_drive(frame); }

static bool checksums[ILK_SLOTS];

bool stand_in_checksum(const uint32_t* frame) {
  uint32_t slot = 0u;
  while (slot < ILK_SLOTS - 1u && frame != in.frame[slot]) {
    slot++;
  }
  return checksums[slot];
}

bool right_checksum(const uint32_t* frame) { return checksum_is_right(frame); }

/* --- The judge
 * ----------------------------------------------------------------------------------------------- */

void some_memory(void) {
  ghost = nondet_ghost();
  nonce = nondet_word();
  press_tick = nondet_word();
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    checksums[slot] = nondet_truth();
  }
}

void first_memory(void) {
  ghost_init(&ghost);
  nonce = nondet_word();
  press_tick = 0u;
}

void see_before(void) { judge_view(&state, &before); }

void see_after(const ilk_state_t* end) { judge_view(end, &after); }

bool after_is_seen(void) {
  ilk_view_t now;
  bool same;
  judge_view(&state, &now);
  same = now.mode == after.mode && now.cause == after.cause && now.consent == after.consent;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    same = same && now.axis[slot].state == after.axis[slot].state &&
           now.axis[slot].fault == after.axis[slot].fault && now.axis[slot].homed == after.axis[slot].homed &&
           now.axis[slot].position == after.axis[slot].position;
  }
  return same;
}

void begin_judging(void) {
  const ilk_tick_t now = {&config, true, &in, requests, 0u, &out, &before, &after};
  tick = now;
}

/** What must be possible, so that no claim holds for want of a case. */
#ifdef ILK_COVER
#define GOAL(condition) __CPROVER_cover(condition)
#else
#define GOAL(condition) ((void)0)
#endif

void judge_inputs(void) {
  ghost_observe(&ghost, &tick);
  before_requests(&ghost, &tick);
  GOAL(before.mode == ILK_MODE_READY && after.mode == ILK_MODE_MOTION);
  GOAL(before.mode == ILK_MODE_MOTION && after.mode == ILK_MODE_MOTION &&
       state.axis[0].state == ILK_AXIS_HOMING);
  GOAL(before.mode == ILK_MODE_MOTION && after.mode == ILK_MODE_READY && !ghost.app_alive);
  GOAL(before.axis[0].state == ILK_AXIS_MOVING && after.axis[0].state == ILK_AXIS_FAULTED);
  GOAL(before.mode == ILK_MODE_READY && after.mode == ILK_MODE_LOCKED && after.cause == ILK_CAUSE_BUS);
}

#define CLAIM(id)                                           \
  do {                                                      \
    const ilk_judgement_t told = judge_##id(&ghost, &tick); \
    __CPROVER_assert(told.clause == NULL, #id);             \
  } while (false)

void judge_request(void) {
  const bool accepted = out.verdict[0].verdict == ILK_VERDICT_ACCEPTED;
  (void)accepted;
  GOAL(accepted && requests[0].kind == ILK_REQUEST_RESET);
  GOAL(accepted && requests[0].kind == ILK_REQUEST_MOVE && after.axis[0].state == ILK_AXIS_MOVING);
  GOAL(accepted && requests[0].kind == ILK_REQUEST_HOME && after.axis[0].state == ILK_AXIS_HOMING);
  GOAL(accepted && requests[0].kind == ILK_REQUEST_CLEAR_FAULT);
  GOAL(accepted && requests[0].kind == ILK_REQUEST_STOP && before.mode == ILK_MODE_MOTION);
  GOAL(out.verdict[0].verdict == ILK_VERDICT_CONSENT);
  tick.count = 1u;
  ghost.order_error = 0u; /* P11 asks for the first request whose verdict is wrong: let it be this one */
  follow_request(&ghost, &tick, 0u);
  CLAIMS
}

void judge_drive(void) {
  const bool driven = is_driven(&tick, 0u);
  (void)driven;
  after_requests(&ghost, &tick);
  GOAL(driven && after.axis[0].state == ILK_AXIS_MOVING && after.axis[0].homed != ILK_HOMED_NOT);
  GOAL(driven && after.axis[0].state == ILK_AXIS_HOMING);
  GOAL(driven && after.axis[0].state == ILK_AXIS_MOVING && after.axis[0].homed == ILK_HOMED_NOT);
  GOAL(ghost.estop && before.mode == ILK_MODE_MOTION);
  GOAL(ghost.bus_lost && before.mode == ILK_MODE_MOTION);
  GOAL(!ghost.app_alive && before.mode == ILK_MODE_MOTION);
  GOAL(out.gate[0] == ILK_GATE_HARD_LIMIT);
  GOAL(out.gate[0] == ILK_GATE_SOFT_LIMIT);
  GOAL(out.gate[0] == ILK_GATE_UNHOMED_TRAVEL && after.axis[0].state == ILK_AXIS_MOVING);
  GOAL(out.gate[0] == ILK_GATE_UNHOMED_TRAVEL && after.axis[0].state == ILK_AXIS_HOMING);
  GOAL(before.mode == ILK_MODE_LOCKED && after.mode == ILK_MODE_READY);
  GOAL(before.mode == ILK_MODE_LOCKED && after.mode == ILK_MODE_LOCKED);
  GOAL(before.axis[0].state == ILK_AXIS_FAULTED && after.axis[0].state == ILK_AXIS_DISABLED);
  GOAL(before.mode == ILK_MODE_READY && after.mode == ILK_MODE_MOTION && driven);
  CLAIMS
  if (after.mode == ILK_MODE_MOTION && before.mode != ILK_MODE_MOTION) {
    press_tick = ghost.tick;
  }
  ghost_settle(&ghost, &tick);
}
