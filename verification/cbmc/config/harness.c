/**
 * @file
 * P13: when a whole configuration is valid, which rule it breaks first, and what a start makes of it. The
 * configuration is arbitrary bits.
 *
 * The rules of one slot are replaced by an arbitrary answer (proof config_slot), the CRC by an arbitrary one
 * (proof crc_words).
 */
#include "config.c"
#include "proof.h"
#include "valid.h"

static const ilk_config_t* judged;
static uint32_t true_crc;
static uint32_t slots_judged;
static uint32_t slot_answer[ILK_SLOTS];

uint32_t some_crc(const ilk_config_t* config) {
  (void)config;
  return true_crc;
}

ilk_config_error_t some_error(const ilk_axis_config_t* axis, const ilk_common_config_t* common) {
  slots_judged = (axis == &judged->axis[0]) ? 0u : slots_judged;
  SHOW((axis == &judged->axis[slots_judged]) && (common == &judged->common),
       "P13: each slot is judged in its turn");
  const ilk_config_error_t error = (ilk_config_error_t)slot_answer[slots_judged];
  slots_judged++;
  return error;
}

/** Sealing changes the seal alone (proof seal). */
void some_seal(ilk_state_t* state) {
  uint32_t seal;
  state->seal = seal;
}

static void show_start(const ilk_config_t* config, bool valid) {
  ilk_state_t state;
  uint32_t slot;
  GIVEN(slot < ILK_SLOTS);
  const ilk_config_verdict_t verdict = ilk_init(config, &state);
  SHOW((verdict.error == ILK_CONFIG_ERROR_NONE) == valid, "P13: a start tells the verdict of validation");
  SHOW(state.system.mode == (valid ? ILK_MODE_LOCKED : ILK_MODE_INIT),
       "P13: only a valid configuration leaves INIT");
  SHOW(state.system.cause == (valid ? ILK_CAUSE_BOOT : ILK_CAUSE_NONE), "P8: LOCKED (BOOT) at the start");
  SHOW(state.system.config_sound == (valid ? 1u : 0u), "P13: trusted when valid");
  SHOW((state.axis[slot].state == ILK_AXIS_DISABLED) && (state.axis[slot].homed == ILK_HOMED_NOT) &&
           (state.axis[slot].fault == ILK_FAULT_NONE),
       "P8: every axis starts DISABLED and not homed");
}

void harness(void) {
  ilk_config_t config;
  uint32_t arbitrary_crc;
  bool slots_valid = true;
  bool any_motor = false;
  uint32_t first_bad = ILK_SLOTS;
  judged = &config;
  true_crc = arbitrary_crc;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    uint32_t error;
    GIVEN(error < ILK_CONFIG_ERROR_COUNT);
    slot_answer[slot] = error;
    first_bad = (slots_valid && (error != ILK_CONFIG_ERROR_NONE)) ? slot : first_bad;
    slots_valid = slots_valid && (error == ILK_CONFIG_ERROR_NONE);
    any_motor = any_motor || is_motor_card(config.axis[slot].card);
  }
  const bool header = (config.common.version == ILK_CONFIG_VERSION) &&
                      (config.common.size_bytes == sizeof(ilk_config_t)) && (config.crc == true_crc);
  const ilk_config_verdict_t verdict = ilk_config_validate(&config);
  const bool valid = header && valid_common(&config.common);
  SHOW((verdict.error == ILK_CONFIG_ERROR_NONE) == (valid && slots_valid && any_motor),
       "P13: valid exactly when header, system, each slot and the sum of slots are");
  SHOW(verdict.error < ILK_CONFIG_ERROR_COUNT, "P13: a known error");
  SHOW(IMPLIES(valid && !slots_valid,
               (verdict.slot == first_bad) && (verdict.error == slot_answer[first_bad])),
       "P13: the first slot with an error is named, with its error");
  SHOW(IMPLIES(!valid || slots_valid, verdict.slot == ILK_SLOTS),
       "P13: an error of the system names no slot");
  SHOW(IMPLIES(!header, between(verdict.error, ILK_CONFIG_ERROR_VERSION, ILK_CONFIG_ERROR_CRC)),
       "P13: a header that does not fit is told before anything else is read");
  GOAL(goal_valid, verdict.error == ILK_CONFIG_ERROR_NONE);
  GOAL(goal_version, verdict.error == ILK_CONFIG_ERROR_VERSION);
  GOAL(goal_size, verdict.error == ILK_CONFIG_ERROR_SIZE);
  GOAL(goal_crc, verdict.error == ILK_CONFIG_ERROR_CRC);
  GOAL(goal_period, verdict.error == ILK_CONFIG_ERROR_PERIOD);
  GOAL(goal_pedal_channels, verdict.error == ILK_CONFIG_ERROR_PEDAL_CHANNELS);
  GOAL(goal_app_timeout, verdict.error == ILK_CONFIG_ERROR_APP_TIMEOUT);
  GOAL(goal_lease, verdict.error == ILK_CONFIG_ERROR_LEASE);
  GOAL(goal_pedal_debounce, verdict.error == ILK_CONFIG_ERROR_PEDAL_DEBOUNCE);
  GOAL(goal_pedal_disagree, verdict.error == ILK_CONFIG_ERROR_PEDAL_DISAGREE);
  GOAL(goal_power_up, verdict.error == ILK_CONFIG_ERROR_POWER_UP);
  GOAL(goal_switch_debounce, verdict.error == ILK_CONFIG_ERROR_SWITCH_DEBOUNCE);
  GOAL(goal_bad_frames, verdict.error == ILK_CONFIG_ERROR_BAD_FRAMES);
  GOAL(goal_overruns, verdict.error == ILK_CONFIG_ERROR_OVERRUNS);
  GOAL(goal_no_axis, verdict.error == ILK_CONFIG_ERROR_NO_AXIS);
  GOAL(goal_last_slot, (verdict.slot == (ILK_SLOTS - 1u)) && (verdict.error == ILK_CONFIG_ERROR_MAX_DELTA));
  GOAL(never_valid_without_motor, (verdict.error == ILK_CONFIG_ERROR_NONE) && !any_motor);
  show_start(&config, valid && slots_valid && any_motor);
}
