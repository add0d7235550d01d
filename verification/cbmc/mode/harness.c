/**
 * @file
 * Phases 3 and 5: pedal, E-stop, app and overruns, then the mode, as exact relations; and consent over time,
 * by induction over ghost counters that watch the contacts alone.
 */
#include "axis_effects.h"
#include "counts.h"
#include "mode.h"
#include "proof.h"
#include "sound.h"

/** The mode that was entered last, and how often one was. */
static uint32_t entered_mode;
static uint32_t entries;

/** Stands for `ilk_mode_enter`: what it does to the system's words; the axes are shown in `mode_enter`. */
void some_entry(ilk_state_t* state, ilk_mode_t mode) {
  state->mode = (uint32_t)mode;
  state->pedal_armed = 0u;
  state->pedal_pressed_ticks = 0u;
  state->pedal_released_ticks = 0u;
  entered_mode = (uint32_t)mode;
  entries++;
}

static uint32_t pedal_says(const ilk_config_t* config, const ilk_inputs_t* in) {
  const bool two = config->pedal_channels != 1u;
  const bool pressed = (in->pedal_no_closed == 1u) && (!two || (in->pedal_nc_closed == 0u));
  const bool released = (in->pedal_no_closed == 0u) && (!two || (in->pedal_nc_closed == 1u));
  return pressed ? ILK_PEDAL_PRESSED : released ? ILK_PEDAL_RELEASED : ILK_PEDAL_DISAGREE;
}

/** Phase 3. */
static void expect_observed(const ilk_config_t* config, ilk_state_t* state, const ilk_inputs_t* in) {
  const uint32_t debounce = config->pedal_debounce_ticks;
  if (in->link_generation != state->link_generation) {
    state->link_generation = in->link_generation;
    state->last_sequence = 0u;
    state->app_age_ticks = UINT32_MAX;
  }
  state->app_age_ticks = (uint32_t)one_more(state->app_age_ticks, UINT32_MAX);
  state->app_alive = (state->app_age_ticks < config->app_timeout_ticks) ? 1u : 0u;
  state->pedal = pedal_says(config, in);
  state->pedal_disagree_ticks =
      (state->pedal == ILK_PEDAL_DISAGREE) ? (uint32_t)one_more(state->pedal_disagree_ticks, UINT32_MAX) : 0u;
  state->pedal_released_ticks =
      ((state->pedal == ILK_PEDAL_RELEASED) && (state->mode == ILK_MODE_READY) && (state->app_alive != 0u))
          ? (uint32_t)one_more(state->pedal_released_ticks, debounce)
          : 0u;
  state->pedal_pressed_ticks = ((state->pedal == ILK_PEDAL_PRESSED) && (state->pedal_armed != 0u))
                                   ? (uint32_t)one_more(state->pedal_pressed_ticks, debounce)
                                   : 0u;
  state->overruns_in_row =
      (in->deadline_missed != 0u) ? (uint32_t)one_more(state->overruns_in_row, UINT32_MAX) : 0u;
  state->overruns =
      (in->deadline_missed != 0u) ? (uint32_t)one_more(state->overruns, UINT32_MAX) : state->overruns;
  state->estop = (in->estop_loop_closed != 1u) ? 1u : 0u;
}

/** Notes a cause; the first one, when not LOCKED yet, with its value. */
static void note_cause(ilk_state_t* state, bool present, uint32_t cause, uint32_t value) {
  if (present && (state->mode != ILK_MODE_LOCKED)) {
    state->mode = ILK_MODE_LOCKED;
    state->cause = cause;
    state->cause_value = value;
    state->cause_tick = state->tick;
  }
  state->causes_seen = state->causes_seen | (present ? (1u << cause) : 0u);
}

static void withdraw_consent(ilk_state_t* state) {
  state->pedal_armed = 0u;
  state->pedal_pressed_ticks = 0u;
  state->pedal_released_ticks = 0u;
}

/** Phase 5. */
static void expect_mode(const ilk_config_t* config, ilk_state_t* state, const ilk_alarms_t* alarms,
                        const ilk_inputs_t* in) {
  const uint32_t before = state->mode;
  const uint32_t contacts = ((in->pedal_no_closed != 0u) ? 1u : 0u) | ((in->pedal_nc_closed != 0u) ? 2u : 0u);
  note_cause(state, alarms->configuration_damaged, ILK_CAUSE_INTEGRITY, alarms->configuration_crc);
  note_cause(state, state->estop != 0u, ILK_CAUSE_ESTOP, in->estop_loop_closed);
  note_cause(state, state->bus_bad_ticks >= config->bad_frame_limit, ILK_CAUSE_BUS, state->bus_bad_ticks);
  note_cause(state, state->pedal_disagree_ticks > config->pedal_disagree_ticks, ILK_CAUSE_PEDAL, contacts);
  note_cause(state, state->overruns_in_row >= config->overrun_limit, ILK_CAUSE_OVERRUN,
             state->overruns_in_row);
  if ((state->mode == ILK_MODE_MOTION) && ((state->pedal != ILK_PEDAL_PRESSED) || (state->app_alive == 0u) ||
                                           alarms->new_fault || alarms->required_card_lost)) {
    state->mode = ILK_MODE_READY;
  } else if ((state->mode == ILK_MODE_READY) && (state->app_alive == 0u)) {
    withdraw_consent(state);
  } else if (state->mode == ILK_MODE_READY) {
    state->pedal_armed =
        (state->pedal_released_ticks >= config->pedal_debounce_ticks) ? 1u : state->pedal_armed;
    if ((state->pedal_armed != 0u) && (state->pedal == ILK_PEDAL_PRESSED) &&
        (state->pedal_pressed_ticks >= config->pedal_debounce_ticks) && !alarms->required_card_lost) {
      state->mode = ILK_MODE_MOTION;
    }
  }
  if (state->mode != before) {
    withdraw_consent(state);
  }
}

/** What the contacts alone have shown: ticks in a row, and whether a whole release was among them. */
typedef struct {
  uint64_t released;
  uint64_t pressed;
  bool consent;
} watch_t;

static bool agrees(const ilk_config_t* config, const watch_t* watch, const ilk_state_t* state) {
  return (state->pedal_released_ticks <= watch->released) && (state->pedal_pressed_ticks <= watch->pressed) &&
         ((state->pedal_armed == 0u) || (watch->consent && (state->mode == ILK_MODE_READY))) &&
         (config->pedal_debounce_ticks > 0u);
}

/** Watches one tick: the contacts, in READY and with the app alive. */
static void look(watch_t* watch, const ilk_config_t* config, const ilk_state_t* observed, uint32_t pedal) {
  const bool counts = (observed->mode == ILK_MODE_READY) && (observed->app_alive != 0u);
  watch->released = (counts && (pedal == ILK_PEDAL_RELEASED)) ? (watch->released + 1u) : 0u;
  watch->pressed = (pedal == ILK_PEDAL_PRESSED) ? (watch->pressed + 1u) : 0u;
  watch->consent = counts && (watch->consent || (watch->released >= (uint64_t)config->pedal_debounce_ticks));
}

/** P14: references are lost with the configuration, and only so; the rest is told in `mode_enter`. */
static void show_axis(const ilk_axis_t* before, const ilk_axis_t* after, const ilk_alarms_t* alarms) {
  ilk_axis_t expected = *before;
  expected.homed = alarms->configuration_damaged ? 0u : before->homed;
  show_same_axis(after, &expected);
}

void harness(void) {
  ilk_config_t config;
  ilk_state_t state;
  ilk_inputs_t in;
  ilk_alarms_t alarms;
  uint32_t bits;
  watch_t watch;
  alarms.new_fault = (bits & 1u) != 0u;
  alarms.required_card_lost = (bits & 2u) != 0u;
  alarms.configuration_damaged = (bits & 4u) != 0u;
  watch.consent = (bits & 8u) != 0u;
  GIVEN(sound_system(&state));
  GIVEN(state.mode != ILK_MODE_INIT); /* in INIT the step calls neither phase: proof `step` */
  GIVEN((watch.released < UINT32_MAX) && (watch.pressed < UINT32_MAX) && agrees(&config, &watch, &state));

  const ilk_state_t before = state;
  ilk_state_t expected = before;
  expect_observed(&config, &expected, &in);
  ilk_observe_system(&config, &state, &in);
  show_same_system(&state, &expected);
  look(&watch, &config, &state, pedal_says(&config, &in));
  const ilk_state_t observed = state;
  expected = observed;
  expect_mode(&config, &expected, &alarms, &in);
  ilk_change_mode(&config, &state, &alarms, &in);
  show_same_system(&state, &expected);
  SHOW(entries == ((state.mode != observed.mode) ? 1u : 0u), "P12: a mode is entered once, when it changes");
  SHOW((entries == 0u) || (entered_mode == state.mode), "P12: and no other");
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    show_axis(&before.axis[slot], &state.axis[slot], &alarms);
  }

  const bool enters = (state.mode == ILK_MODE_MOTION) && (before.mode != ILK_MODE_MOTION);
  SHOW(sound_system(&state), "P15: the invariant is kept");
  SHOW((state.mode != ILK_MODE_MOTION) || (pedal_says(&config, &in) == ILK_PEDAL_PRESSED),
       "P2: no MOTION unless every channel of the pedal says pressed");
  SHOW((state.mode != ILK_MODE_MOTION) || (in.estop_loop_closed == 1u),
       "P2: no MOTION with the E-stop active");
  SHOW((state.mode != ILK_MODE_MOTION) || (state.app_age_ticks < config.app_timeout_ticks),
       "P10: no MOTION once the app was silent for app_timeout_ticks");
  SHOW((before.mode != ILK_MODE_LOCKED) ||
           ((state.mode == ILK_MODE_LOCKED) && (state.cause == before.cause) &&
            (state.cause_tick == before.cause_tick) && (state.cause_value == before.cause_value)),
       "P8: LOCKED stays, with its first cause");
  SHOW(!enters || (before.mode == ILK_MODE_READY), "P9: MOTION is entered from READY alone");
  SHOW(!enters || (watch.consent && (watch.pressed >= (uint64_t)config.pedal_debounce_ticks)),
       "P9: MOTION follows a whole release seen in READY and a fresh debounced press");
  if (state.mode != observed.mode) {
    watch.consent = false;
  }
  SHOW(agrees(&config, &watch, &state), "P9: consent is never more than the contacts have shown");

  GOAL(goal_enters_motion, enters);
  GOAL(goal_pedal_ends_motion, (before.mode == ILK_MODE_MOTION) && (state.mode == ILK_MODE_READY) &&
                                   (state.app_alive != 0u) && !alarms.new_fault);
  GOAL(goal_silence_ends_motion, (before.mode == ILK_MODE_MOTION) && (state.mode == ILK_MODE_READY) &&
                                     (state.pedal == ILK_PEDAL_PRESSED));
  GOAL(goal_fault_ends_motion,
       (before.mode == ILK_MODE_MOTION) && (state.mode == ILK_MODE_READY) && alarms.new_fault);
  GOAL(goal_arms, (before.pedal_armed == 0u) && (state.pedal_armed == 1u));
  GOAL(goal_locks_estop, (before.mode == ILK_MODE_MOTION) && (state.cause == ILK_CAUSE_ESTOP));
  GOAL(goal_locks_bus, (before.mode == ILK_MODE_MOTION) && (state.cause == ILK_CAUSE_BUS));
  GOAL(goal_locks_pedal, (before.mode == ILK_MODE_READY) && (state.cause == ILK_CAUSE_PEDAL));
  GOAL(goal_locks_overrun, (before.mode == ILK_MODE_READY) && (state.cause == ILK_CAUSE_OVERRUN));
  GOAL(goal_locks_integrity, (before.mode == ILK_MODE_READY) && (state.cause == ILK_CAUSE_INTEGRITY));
  GOAL(goal_lists_a_later_cause,
       (before.mode == ILK_MODE_LOCKED) && (state.causes_seen != before.causes_seen));
  GOAL(never_motion_from_locked, (before.mode == ILK_MODE_LOCKED) && (state.mode == ILK_MODE_MOTION));
  GOAL(never_motion_without_release,
       enters && (before.pedal_armed == 0u) && (before.pedal_released_ticks == 0u));
}
