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
               c->bad_frame_limit > 0u && c->overrun_limit > 0u && c->switch_debounce_ticks > 0u &&
               config.crc == ilk_config_crc(&config);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t* a = &config.axis[slot];
    valid = valid && a->card < ILK_CARD_COUNT && a->required <= 1u && a->motor_direction <= 1u &&
            a->direction_correction <= 1u && a->limit_side < ILK_LIMIT_COUNT &&
            a->unhomed_max_drive <= a->max_drive &&
            HOLDS_IF(has_motor(a), a->noise_counts < (1u << 28) && a->drift_counts < (1u << 28) &&
                                       a->stall_min_counts > 0u && a->stall_min_counts < (1u << 31) &&
                                       a->deadband_counts < (1u << 30) && a->max_drive > 0u &&
                                       a->rest_ticks > 1u);
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

/** Any two valid readings since the start: whatever is shown of them is shown of each two. */
static struct {
  uint32_t raw;
  uint32_t age; /**< in ticks */
} pair[2];

static void remember_readings(void) {
  for (uint32_t n = 0u; n < 2u; n++) {
    pair[n].age = plus(pair[n].age, 1u);
    if (ghost.slot[0].valid && nondet_truth()) {
      pair[n].raw = ghost.slot[0].raw;
      pair[n].age = 0u;
    }
  }
}

/** The kernel's run of readings is undriven and valid throughout, and lies within noise. */
static void relate_rest(bool shown, bool middle) {
  const ilk_axis_config_t* c = &config.axis[0];
  const ilk_ghost_slot_t* g = &ghost.slot[0];
  const ilk_axis_t* a = &state.axis[0];
  const ilk_stillness_t* s = &a->rest;
  if (!has_motor(c)) {
    return;
  }
  RELATED(s->ticks <= c->rest_ticks && g->quiet >= s->ticks);
  RELATED(HOLDS_IF(s->ticks > 0u, s->below <= 0 && s->above >= 0 &&
                                      (int64_t)s->above - (int64_t)s->below <= (int64_t)c->noise_counts));
  for (uint32_t n = 0u; n < 2u; n++) {
    const int32_t from_first = wrapped(pair[n].raw, s->origin_raw);
    RELATED(HOLDS_IF(pair[n].age < s->ticks, from_first >= s->below && from_first <= s->above));
  }
  RELATED(HOLDS_IF(!middle && g->driven, s->ticks == 0u));
}

/** P17: an axis that is homed now was undriven and read validly for the time of rest, and no two readings of
 * it are farther apart than noise: this way round, and so the other. */
static void claim_rest(void) {
  const ilk_axis_config_t* c = &config.axis[0];
  const bool homes =
      state.axis[0].homed == ILK_HOMED_BY_SWITCH && before.axis[0].homed != ILK_HOMED_BY_SWITCH;
  const bool of_rest = pair[0].age < c->rest_ticks && pair[1].age < c->rest_ticks;
  if (homes) {
    __CPROVER_assert(ghost.slot[0].quiet >= c->rest_ticks, "P17: homed after the time of rest");
    __CPROVER_assert(!of_rest || (int64_t)wrapped(pair[0].raw, pair[1].raw) <= (int64_t)c->noise_counts,
                     "P17: homed at rest");
  }
}

/** Since its fault, or since its card was lost, this FAULTED axis may have moved beyond `drift_counts`: now,
 * and before this tick. */
static bool has_run;
static bool had_run;

/** Within a tick the judge knows of requests that an axis is disabled, or its fault cleared. */
static void relate_state(bool shown, uint32_t slot) {
  const uint32_t judged = ghost.slot[slot].state;
  RELATED((state.axis[slot].state == ILK_AXIS_DISABLED) == (judged == ILK_AXIS_DISABLED));
  RELATED((state.axis[slot].state == ILK_AXIS_FAULTED) == (judged == ILK_AXIS_FAULTED));
}

/** What an axis is compared with when it moves, and what came of it. */
static void relate_marks(bool shown, bool middle) {
  const bool told = state.system.mode == ILK_MODE_MOTION && (!middle || mode_is_told());
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_ghost_slot_t* g = &ghost.slot[slot];
    const ilk_axis_t* a = &state.axis[slot];
    const bool awaits_valid_frame = a->driven_direction != ILK_DIRECTION_NONE;
    const bool directed = a->reverse_direction != ILK_DIRECTION_NONE;
    const bool rides = a->state != ILK_AXIS_DISABLED && a->state != ILK_AXIS_FAULTED;
    const bool drift_is_judged = rides || (a->state == ILK_AXIS_DISABLED && told);
    if (!has_motor(&config.axis[slot])) {
      continue;
    }
    RELATED(g->delta == a->delta_counts && a->reverse_direction <= ILK_DIRECTION_DECREASING);
    RELATED(HOLDS_IF(rides, g->reverse_direction == a->reverse_direction));
    RELATED(HOLDS_IF(directed,
                     g->reverse_direction == a->reverse_direction && g->reverse_mark == a->reverse_mark_raw));
    RELATED(HOLDS_IF(drift_is_judged, g->drift_known && g->drift_mark == a->drift_mark_raw));
    RELATED(HOLDS_IF(awaits_valid_frame && !g->valid, g->periods > 0u));
    RELATED(HOLDS_IF(a->runaway != 0u, a->state == ILK_AXIS_FAULTED && has_run));
    if (a->state == ILK_AXIS_FAULTED && !has_run) {
      RELATED(!g->ran && !g->maybe_ran);
      RELATED(HOLDS_IF(a->card_seen != 0u,
                       g->fault_mark == a->drift_mark_raw && g->mark_low == 0 && g->mark_high == 0));
    }
    if (middle) {
      const bool was_well = before.axis[slot].state != ILK_AXIS_FAULTED;
      const bool judged = before.axis[slot].state != ILK_AXIS_DISABLED || before.mode == ILK_MODE_MOTION;
      const bool faulted = was_well && a->state == ILK_AXIS_FAULTED;
      const uint32_t first = g->jump ? ILK_FAULT_JUMP : (g->reversed ? ILK_FAULT_REVERSE : ILK_FAULT_DRIFT);
      const bool other = g->reset || (!g->jump && g->maybe_reversed && a->fault == ILK_FAULT_REVERSE);
      relate_state(shown, slot);
      RELATED(HOLDS_IF(g->valid, !awaits_valid_frame));
      RELATED(HOLDS_IF(was_well && judged && (g->jump || g->reversed || g->drifted),
                       faulted && a->fault_tick == state.system.tick && (a->fault == first || other)));
      RELATED(HOLDS_IF(faulted && a->fault == ILK_FAULT_DRIFT, g->drifted));
      RELATED(HOLDS_IF(faulted && a->fault == ILK_FAULT_JUMP, g->jump));
      RELATED(HOLDS_IF(faulted && a->fault == ILK_FAULT_REVERSE, g->maybe_reversed));
      RELATED(HOLDS_IF(g->runaway && !had_run, a->runaway != 0u));
    } else {
      RELATED(g->driven == (g->valid && awaits_valid_frame));
      RELATED(HOLDS_IF(g->driven, rides));
    }
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
      relate_state(shown, slot);
      RELATED(HOLDS_IF(was_well && a->state == ILK_AXIS_FAULTED, a->fault_tick == state.system.tick));
      RELATED(HOLDS_IF(!was_well && a->state == ILK_AXIS_FAULTED, a->fault == before.axis[slot].fault));
      RELATED(HOLDS_IF(g->stalled && was_well,
                       a->state == ILK_AXIS_FAULTED && a->fault_tick == state.system.tick));
      RELATED(HOLDS_IF(was_well && a->state == ILK_AXIS_FAULTED && a->fault == ILK_FAULT_STALL, g->stalled));
    }
  }
}

/* Any two readings, fixed for a whole run. What is shown of them is shown of those that the kernel homes by,
 * too: that the edges of which P17 speaks exist. */
static uint32_t first_reading;
static uint32_t second_reading;
/** What the inputs since HOME show of these two, by the judge's runs of readings. */
static struct {
  bool first;  /**< an edge at the one */
  bool slow;   /**< clear of it, and not driven above `home_slow_drive` since */
  bool second; /**< then an edge at the other, within the tolerance */
} edges;

static void follow_edges(bool sought, bool was_open) {
  const ilk_axis_config_t* c = &config.axis[0];
  const ilk_ghost_slot_t* g = &ghost.slot[0];
  const bool steady = sought && g->valid && g->home_run >= config.common.switch_debounce_ticks;
  const uint32_t apart = size_of(judge_counts(c, second_reading, first_reading));
  const int64_t away = -along(towards_switch(c), judge_counts(c, g->raw, first_reading));
  if (steady && g->triggered && was_open) {
    edges.second = edges.second ||
                   (edges.slow && g->home_run_raw == second_reading && apart <= c->home_tolerance_counts);
    edges.first = edges.first || g->home_run_raw == first_reading;
  }
  if (steady && !g->triggered) {
    edges.slow = edges.slow || (edges.first && away >= (int64_t)c->home_clear_counts);
  }
}

/** Each phase of homing is entered by what the inputs have shown. */
static void relate_edges(bool shown, bool middle) {
  const ilk_axis_config_t* c = &config.axis[0];
  const ilk_ghost_slot_t* g = &ghost.slot[0];
  const ilk_axis_t* a = &state.axis[0];
  const uint32_t debounce = config.common.switch_debounce_ticks;
  const uint32_t phase = a->homing_phase;
  const bool ends = phase == ILK_HOMING_APPROACH || phase == ILK_HOMING_REST;
  if (has_motor(c)) {
    RELATED(HOLDS_IF(g->lost, a->homed == ILK_HOMED_NOT));
    if (middle) {
      RELATED(HOLDS_IF(g->just_homed, after.axis[0].homed == ILK_HOMED_BY_SWITCH));
      RELATED(HOLDS_IF((g->jump || g->reset) && !g->set_home, a->homed == ILK_HOMED_NOT));
      RELATED(
          HOLDS_IF(a->homed == ILK_HOMED_BY_HAND && before.axis[0].homed != ILK_HOMED_BY_HAND, g->set_home));
    }
  }
  RELATED(HOLDS_IF(has_motor(c) && a->state != ILK_AXIS_DISABLED && a->state != ILK_AXIS_FAULTED,
                   a->card_seen != 0u));
  if (a->state == ILK_AXIS_HOMING) {
    RELATED(g->seeks && a->switch_run_ticks == (g->home_run < debounce ? g->home_run : debounce));
    RELATED(HOLDS_IF(g->home_run > 0u,
                     a->switch_reading == (g->triggered ? 1u : 0u) && a->switch_run_raw == g->home_run_raw));
    RELATED(HOLDS_IF(phase == ILK_HOMING_SEEK || phase == ILK_HOMING_APPROACH, g->home_open));
    RELATED(HOLDS_IF(phase == ILK_HOMING_BACK_OFF, a->first_edge_raw == a->homing_mark_raw));
    RELATED(
        HOLDS_IF((ends || phase == ILK_HOMING_BACK_OFF) && a->first_edge_raw == first_reading, edges.first));
    RELATED(HOLDS_IF(ends && a->first_edge_raw == first_reading, edges.slow));
    RELATED(HOLDS_IF(phase == ILK_HOMING_REST && a->first_edge_raw == first_reading &&
                         a->homing_mark_raw == second_reading &&
                         size_of(judge_counts(c, second_reading, first_reading)) <= c->home_tolerance_counts,
                     edges.second));
  }
}

/** P17, of the two edges by which the kernel says that the axis is homed now. */
static void claim_edges(void) {
  const bool was_homed = before.axis[0].homed == ILK_HOMED_BY_SWITCH;
  const ilk_axis_config_t* c = &config.axis[0];
  const ilk_ghost_slot_t* g = &ghost.slot[0];
  const ilk_axis_t* a = &state.axis[0];
  const bool by_these = a->first_edge_raw == first_reading && a->home_raw == second_reading;
  if (a->homed == ILK_HOMED_BY_SWITCH && !was_homed && by_these) {
    const int32_t beyond = judge_counts(c, g->raw, second_reading);
#if (SHOWN & EDGES) != 0u /* goals are counted where they stand, called or not */
    GOAL(true);
#endif
    __CPROVER_assert(edges.second, "P17: homed after the listed sequence of edges");
    __CPROVER_assert(g->valid && g->triggered && g->home_run >= config.common.switch_debounce_ticks,
                     "P17: homed with the switch triggered for the debounce time");
    __CPROVER_assert(a->position_counts == saturate((int64_t)beyond + c->home_offset_counts),
                     "P17: the position is raw - e2 + home offset");
    __CPROVER_assert(size_of(beyond) <= plus(c->coast_counts, c->home_tolerance_counts),
                     "P17: homed no farther from the edge than coast and tolerance");
  }
}

void claim_home(void) {
  if ((SHOWN & REST) != 0u) {
    claim_rest();
  }
  if ((SHOWN & EDGES) != 0u) {
    claim_edges();
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
    relate_rest(shown, middle);
  }
  if ((parts & EDGES) != 0u) {
    relate_edges(shown, middle);
  }
  if ((parts & MARKS) != 0u) {
    relate_marks(shown, middle);
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
  while (slot < ILK_SLOTS - 1u && frame != in.frame[slot] && frame != twin_in.frame[slot]) {
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
  first_reading = nondet_word();
  second_reading = nondet_word();
  for (uint32_t n = 0u; n < 2u; n++) {
    pair[n].raw = nondet_word();
    pair[n].age = nondet_word();
  }
  edges.first = nondet_truth();
  edges.slow = nondet_truth();
  edges.second = nondet_truth();
  has_run = nondet_truth();
  had_run = nondet_truth();
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    ghost.slot[slot].triggered = nondet_word() != 0u; /* it is compared, and truth has one form in C */
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

void judge_inputs(void) {
  const bool sought = ghost.slot[0].seeks;
  const bool was_open = ghost.slot[0].home_open;
  ghost_observe(&ghost, &tick);
  had_run = has_run;
  has_run = before.axis[0].state == ILK_AXIS_FAULTED && !ghost.slot[0].lost &&
            (has_run || ghost.slot[0].maybe_runaway);
  remember_readings();
  follow_edges(sought, was_open);
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
  GOAL(accepted && requests[0].kind == ILK_REQUEST_RESET);
  GOAL(accepted && requests[0].kind == ILK_REQUEST_MOVE && after.axis[0].state == ILK_AXIS_MOVING);
  GOAL(accepted && requests[0].kind == ILK_REQUEST_HOME && after.axis[0].state == ILK_AXIS_HOMING);
  GOAL(accepted && requests[0].kind == ILK_REQUEST_CLEAR_FAULT);
  GOAL(accepted && requests[0].kind == ILK_REQUEST_STOP && before.mode == ILK_MODE_MOTION);
  GOAL(out.verdict[0].verdict == ILK_VERDICT_CONSENT);
  tick.count = 1u;
  ghost.order_error = 0u; /* P11 asks for the first request whose verdict is wrong: let it be this one */
  follow_request(&ghost, &tick, 0u);
  if (accepted && requests[0].kind == ILK_REQUEST_HOME && requests[0].axis == 0u) {
    edges.first = edges.slow = edges.second = false;
  }
  CLAIMS
}

/** P17, without edges: who else says that an axis is homed, and what takes it back. */
static void claim_place(void) {
  const ilk_ghost_slot_t* g = &ghost.slot[0];
  const uint32_t was = before.axis[0].homed;
  const uint32_t is = after.axis[0].homed;
  if (has_motor(&config.axis[0])) {
    __CPROVER_assert(HOLDS_IF(is == ILK_HOMED_BY_HAND && was != is, g->set_home), "P17: by hand by SET_HOME");
    __CPROVER_assert(HOLDS_IF((g->jump || g->reset) && is != ILK_HOMED_NOT, g->set_home),
                     "P17: neither a jump nor a reset card stays homed");
    __CPROVER_assert(HOLDS_IF(g->lost, is == ILK_HOMED_NOT), "P17: a lost card is not homed");
  }
}

/** P6, the last clause, of the first time since the fault that the axis goes on moving. */
static void claim_runaway(void) {
  const bool goes_on = has_motor(&config.axis[0]) && ghost.slot[0].runaway && !had_run;
  __CPROVER_assert(!goes_on || (after.mode == ILK_MODE_LOCKED && out.power == 0u),
                   "P6: a faulted axis that goes on moving locks and takes power away");
}

void judge_drive(void) {
  const bool driven = is_driven(&tick, 0u);
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
#if (SHOWN & MARKS) != 0u
  GOAL(ghost.slot[0].runaway && !had_run && before.mode == ILK_MODE_MOTION);
#endif
  CLAIMS
  if ((SHOWN & EDGES) != 0u) {
    claim_place();
  }
  if ((SHOWN & MARKS) != 0u) {
    claim_runaway();
  }
  if (after.mode == ILK_MODE_MOTION && before.mode != ILK_MODE_MOTION) {
    press_tick = ghost.tick;
  }
  ghost_settle(&ghost, &tick);
  edges.slow = edges.slow && (!driven || out.command[0].drive <= config.axis[0].home_slow_drive);
}
