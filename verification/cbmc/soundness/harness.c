/**
 * @file
 * The invariant that every proof takes for granted is the one that the kernel checks at run time, and a start
 * and a rebuilt state satisfy it.
 */
#include "integrity.h"
#include "interlock/kernel.h"
#include "proof.h"
#include "sound.h"

static uint32_t digest_of_state;
static uint32_t error_of_config;

/** Stands for `state_digest`: the digest of this one state. */
uint32_t some_digest(const ilk_state_t* state) {
  (void)state;
  return digest_of_state;
}

/** Stands for `ilk_config_validate`: any verdict. */
ilk_config_verdict_t some_validation(const ilk_config_t* config) {
  (void)config;
  const ilk_config_verdict_t verdict = {.error = error_of_config, .slot = 0u};
  return verdict;
}

static bool sound_but_seal(const ilk_state_t* state) {
  bool sound = sound_system(state);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    sound = sound && sound_axis(&state->axis[slot], state->mode);
  }
  return sound;
}

/** An arbitrary slot of a state that owes nothing to the one before. */
static void show_blank(const ilk_state_t* state, uint32_t slot) {
  const ilk_axis_t blank = state->axis[slot];
  const ilk_axis_t* axis = &blank;
  SHOW(sound_system(state) && sound_axis(axis, state->mode), "P15: it satisfies the invariant");
  SHOW((axis->state == ILK_AXIS_DISABLED) && (axis->homed == 0u) && (axis->card_seen == 0u),
       "P14: a rebuilt axis is disabled, not homed, and its card unknown");
  SHOW((axis->lease_ticks == 0u) && (axis->drive == 0u) && (axis->fault == ILK_FAULT_NONE) &&
           (axis->stall_driven_ticks == 0u) && (axis->bad_frames == 0u),
       "P14: nothing of the axis before is left");
}

static void show_rebuilt(const ilk_config_t* config, ilk_state_t* state, uint32_t slot, uint32_t value) {
  ilk_state_rebuild(state, config, ILK_CAUSE_INTEGRITY, value);
  SHOW((state->mode == ILK_MODE_LOCKED) && (state->cause == ILK_CAUSE_INTEGRITY) &&
           (state->cause_value == value) && (state->causes_seen == (1u << ILK_CAUSE_INTEGRITY)) &&
           (state->cause_tick == 0u) && (state->tick == 0u),
       "P14: damage ends in LOCKED (INTEGRITY)");
  SHOW((state->pedal == ILK_PEDAL_DISAGREE) && (state->pedal_armed == 0u) &&
           (state->pedal_pressed_ticks == 0u) && (state->pedal_released_ticks == 0u) &&
           (state->pedal_disagree_ticks == 0u) && (state->estop == 1u) && (state->app_alive == 0u) &&
           (state->app_age_ticks == UINT32_MAX),
       "P9, P10: no consent and no app survive");
  SHOW((state->config_sound == 0u) && (state->config_slice == 0u) && (state->config_crc == config->crc) &&
           (state->config_partial_crc == 0xffffffffu),
       "P13: the configuration must be shown sound anew");
  SHOW((state->holder == 0u) && (state->link_generation == 0u) && (state->last_sequence == 0u) &&
           (state->requests_accepted == 0u) && (state->requests_refused == 0u) && (state->overruns == 0u) &&
           (state->overruns_in_row == 0u) && (state->bus_bad_ticks == 0u),
       "P14: counters start anew");
  show_blank(state, slot);
}

static void show_started(const ilk_config_t* config, ilk_state_t* state, uint32_t slot) {
  const ilk_config_verdict_t verdict = ilk_init(config, state);
  const bool valid = verdict.error == ILK_CONFIG_ERROR_NONE;
  SHOW(verdict.error == error_of_config, "P13: the verdict of validation is told");
  SHOW(state->mode == (valid ? ILK_MODE_LOCKED : ILK_MODE_INIT),
       "P13: only a valid configuration leaves INIT");
  SHOW(state->cause == (valid ? ILK_CAUSE_BOOT : ILK_CAUSE_NONE), "P8: LOCKED (BOOT) at the start");
  SHOW(state->causes_seen == (valid ? (1u << ILK_CAUSE_BOOT) : 0u), "P8: BOOT is in the list");
  SHOW(state->config_sound == (valid ? 1u : 0u), "P13: trusted when valid");
  show_blank(state, slot);
  SHOW(state->seal == digest_of_state, "P14: and is sealed");
}

void harness(void) {
  ilk_config_t config;
  ilk_state_t state;
  uint32_t slot;
  uint32_t digest;
  uint32_t error;
  uint32_t value;
  digest_of_state = digest;
  error_of_config = error;
  GIVEN(slot < ILK_SLOTS);

  const bool sound = ilk_state_is_sound(&state);
  SHOW(sound == ((state.seal == digest_of_state) && sound_but_seal(&state)),
       "P14, P15: the invariant is the one that the kernel checks");
  const ilk_axis_t axis = state.axis[slot];
  GOAL(goal_sound_in_motion, sound && (state.mode == ILK_MODE_MOTION) && (axis.state == ILK_AXIS_HOMING));
  GOAL(goal_unsound_by_one_axis, !sound && (state.seal == digest_of_state) && sound_system(&state));
  GOAL(never_sound_with_a_wrong_seal, sound && (state.seal != digest_of_state));
  GOAL(never_sound_moving_in_ready,
       sound && (state.mode == ILK_MODE_READY) && (axis.state == ILK_AXIS_MOVING));
  show_rebuilt(&config, &state, slot, value);
  show_started(&config, &state, slot);
  GOAL(goal_started, state.mode == ILK_MODE_LOCKED);
  GOAL(goal_refused, state.mode == ILK_MODE_INIT);
}
