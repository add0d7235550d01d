#include "parts.h"

#define CLOSED 1u
#define OPEN 0u
/** Odd, so that no two ticks give the same product. */
#define CONSENT_FACTOR 0x9e3779b1u

bool ilk_power_is_on(const ilk_system_t *system) {
  return (system->mode == (uint32_t)ILK_MODE_READY) || (system->mode == (uint32_t)ILK_MODE_MOTION);
}

void ilk_pedal_disarm(ilk_system_t *system) {
  system->pedal_armed = 0u;
  system->pedal_pressed_ticks = 0u;
  system->pedal_released_ticks = 0u;
}

/** Another one in each of 2^32 ticks and never 0: that of tick `boot_nonce` would be, and has that of tick 0,
   in which no MOTION begins. */
static uint32_t consent_of(uint32_t boot_nonce, uint32_t tick) {
  const uint32_t mixed = (tick == boot_nonce) ? boot_nonce : (tick ^ boot_nonce);
  return mixed * CONSENT_FACTOR;
}

void ilk_mode_enter(ilk_mode_t mode, uint32_t boot_nonce, ilk_state_t *state) {
  state->system.mode = (uint32_t)mode;
  state->system.consent = (mode == ILK_MODE_MOTION) ? consent_of(boot_nonce, state->system.tick) : 0u;
  state->system.cause = (uint32_t)ILK_CAUSE_NONE;
  state->system.cause_tick = 0u;
  state->system.cause_value = 0u;
  state->system.causes_seen = 0u;
  ilk_pedal_disarm(&state->system);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    ilk_axis_drop_motion(&state->axis[slot]);
    if (mode == ILK_MODE_LOCKED) {
      ilk_axis_disable(&state->axis[slot]);
    }
    if (mode == ILK_MODE_MOTION) {
      ilk_axis_begin_press(&state->axis[slot]);
    }
  }
}

/* --- Phase 3 ----------------------------------------------------------------------------------- */

/** Any reading that is neither clearly pressed nor clearly released is a disagreement. */
static ilk_pedal_t pedal_reading(const ilk_common_config_t *common, const ilk_inputs_t *in) {
  const bool single = common->pedal_channels == 1u;
  const bool pressed = (in->pedal_no_closed == CLOSED) && (single || (in->pedal_nc_closed == OPEN));
  const bool released = (in->pedal_no_closed == OPEN) && (single || (in->pedal_nc_closed == CLOSED));
  const ilk_pedal_t unpressed = released ? ILK_PEDAL_RELEASED : ILK_PEDAL_DISAGREE;
  return pressed ? ILK_PEDAL_PRESSED : unpressed;
}

static void observe_app(const ilk_common_config_t *common, const ilk_inputs_t *in, ilk_system_t *system) {
  if (in->link_generation != system->link_generation) {
    system->link_generation = in->link_generation;
    system->last_sequence = 0u;
    system->app_age_ticks = UINT32_MAX;
  }
  system->app_age_ticks = count_up(system->app_age_ticks, UINT32_MAX);
  system->app_alive = flag_of(system->app_age_ticks < common->app_timeout_ticks);
}

/** A release arms only when seen whole in READY with the app alive; without the app no consent lasts. */
static void observe_pedal(const ilk_common_config_t *common, const ilk_inputs_t *in, ilk_system_t *system) {
  const ilk_pedal_t pedal = pedal_reading(common, in);
  const uint32_t debounce = common->pedal_debounce_ticks;
  const bool may_arm = (system->mode == (uint32_t)ILK_MODE_READY) && (system->app_alive != 0u);
  const bool released = may_arm && (pedal == ILK_PEDAL_RELEASED);
  if (!may_arm) {
    ilk_pedal_disarm(system);
  }
  system->pedal = (uint32_t)pedal;
  system->pedal_disagree_ticks =
      ticks_in_row(pedal == ILK_PEDAL_DISAGREE, system->pedal_disagree_ticks, UINT32_MAX);
  system->pedal_released_ticks = ticks_in_row(released, system->pedal_released_ticks, debounce);
  system->pedal_pressed_ticks = ticks_in_row((pedal == ILK_PEDAL_PRESSED) && (system->pedal_armed != 0u),
                                             system->pedal_pressed_ticks, debounce);
  if (released && (system->pedal_released_ticks >= debounce)) {
    system->pedal_armed = 1u;
  }
}

void ilk_system_observe(const ilk_common_config_t *common, const ilk_inputs_t *in, ilk_system_t *system) {
  const uint32_t missed = in->deadlines_missed;
  system->estop = flag_of(in->estop_loop_closed != CLOSED);
  observe_app(common, in, system);
  observe_pedal(common, in, system);
  system->overruns = sum_saturating(system->overruns, missed);
  system->overruns_in_row = (missed != 0u) ? sum_saturating(system->overruns_in_row, missed) : 0u;
}

/* --- Phase 5 ----------------------------------------------------------------------------------- */

/** The slot of the first axis that is run away, or ILK_SLOTS. */
static uint32_t runaway_slot(const ilk_state_t *state) {
  uint32_t slot = 0u;
  while ((slot < (uint32_t)ILK_SLOTS) && (state->axis[slot].runaway == 0u)) {
    slot++;
  }
  return slot;
}

bool ilk_cause_is_present(const ilk_state_t *state) {
  const ilk_system_t *system = &state->system;
  return (system->estop != 0u) || (system->bus_bad_ticks != 0u) || (system->overruns_in_row != 0u) ||
         (system->config_sound == 0u) || (system->app_alive == 0u) ||
         (runaway_slot(state) < (uint32_t)ILK_SLOTS);
}

/** Every cause joins the list of those seen since RESET; the first one locks. */
static void lock_if(bool present, ilk_cause_t cause, uint32_t value, ilk_state_t *state) {
  if (present) {
    if (state->system.mode != (uint32_t)ILK_MODE_LOCKED) {
      ilk_mode_enter(ILK_MODE_LOCKED, 0u, state);
      state->system.cause = (uint32_t)cause;
      state->system.cause_tick = state->system.tick;
      state->system.cause_value = value;
    }
    state->system.causes_seen |= 1u << (uint32_t)cause;
  }
}

static void follow_causes(const ilk_common_config_t *common, const ilk_inputs_t *in,
                          const ilk_alarms_t *alarms, ilk_state_t *state) {
  const ilk_system_t *system = &state->system;
  const uint32_t runaway = runaway_slot(state);
  const uint32_t contacts =
      flag_of(in->pedal_no_closed != OPEN) + (2u * flag_of(in->pedal_nc_closed != OPEN));
  lock_if(alarms->configuration_damaged, ILK_CAUSE_INTEGRITY, alarms->configuration_crc, state);
  lock_if(system->estop != 0u, ILK_CAUSE_ESTOP, in->estop_loop_closed, state);
  lock_if(system->bus_bad_ticks >= common->bad_frame_limit, ILK_CAUSE_BUS, system->bus_bad_ticks, state);
  lock_if(system->pedal_disagree_ticks > common->pedal_disagree_ticks, ILK_CAUSE_PEDAL, contacts, state);
  lock_if(system->overruns_in_row >= common->overrun_limit, ILK_CAUSE_OVERRUN, system->overruns_in_row,
          state);
  lock_if(runaway < (uint32_t)ILK_SLOTS, ILK_CAUSE_RUNAWAY, runaway, state);
}

/** MOTION holds only while the pedal is pressed, the app lives and nothing new is wrong. */
static bool motion_must_end(const ilk_system_t *system, const ilk_alarms_t *alarms) {
  return (system->pedal != (uint32_t)ILK_PEDAL_PRESSED) || (system->app_alive == 0u) || alarms->new_fault ||
         alarms->required_card_lost;
}

/** An axis that nobody enabled moved by more than `drift_counts` in the last `rest_ticks` ticks, by hand or
   by itself, or was not read for so long. */
static bool disabled_axis_moves(const ilk_config_t *config, const ilk_state_t *state) {
  bool moves = false;
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const bool disabled = state->axis[slot].state == (uint32_t)ILK_AXIS_DISABLED;
    const bool moved = state->axis[slot].calm.ticks < config->axis[slot].rest_ticks;
    moves = moves || (has_axis(&config->axis[slot]) && disabled && moved);
  }
  return moves;
}

static bool press_completes(const ilk_common_config_t *common, const ilk_system_t *system) {
  return (system->mode == (uint32_t)ILK_MODE_READY) && (system->pedal_armed != 0u) &&
         (system->pedal == (uint32_t)ILK_PEDAL_PRESSED) &&
         (system->pedal_pressed_ticks >= common->pedal_debounce_ticks);
}

/** Consent begins MOTION or is used up, its loss ends it. INIT and LOCKED are left by ilk_init and RESET
 * alone. */
static void follow_consent(const ilk_config_t *config, const ilk_inputs_t *in, const ilk_alarms_t *alarms,
                           ilk_state_t *state) {
  const bool asked = press_completes(&config->common, &state->system);
  const bool begins = asked && (state->system.tick != 0u) &&
                      (state->system.powered_ticks >= config->common.power_up_ticks) &&
                      !alarms->required_card_lost && !disabled_axis_moves(config, state);
  const bool ends =
      (state->system.mode == (uint32_t)ILK_MODE_MOTION) && motion_must_end(&state->system, alarms);
  if (begins) {
    ilk_mode_enter(ILK_MODE_MOTION, in->boot_nonce, state);
  }
  if (ends) {
    ilk_mode_enter(ILK_MODE_READY, 0u, state);
  }
  if (asked && !begins) {
    ilk_pedal_disarm(&state->system);
  }
}

void ilk_mode_decide(const ilk_config_t *config, const ilk_inputs_t *in, const ilk_alarms_t *alarms,
                     ilk_state_t *state) {
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    /* A damaged configuration may have counted the wrong way until it was found. */
    ilk_axis_t *axis = &state->axis[slot];
    axis->homed = alarms->configuration_damaged ? (uint32_t)ILK_HOMED_NOT : axis->homed;
  }
  follow_causes(&config->common, in, alarms, state);
  follow_consent(config, in, alarms, state);
}
