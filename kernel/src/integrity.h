/**
 * @file
 * Integrity of state and configuration (property P14).
 */
#ifndef ILK_INTEGRITY_H
#define ILK_INTEGRITY_H

#include <stdbool.h>

#include "config.h"
#include "interlock/acsl.h"
#include "interlock/types.h"

/** Writes the seal that `ilk_state_is_sound` looks for. */
/*@ requires valid: \valid(state);
  @ assigns  state->seal;
  @ ensures  P14_every_word: state->seal == \old(seal_of(state, ILK_SLOTS));
  @ ensures  P15_invariant: \old(sound(state)) ==> sound(state);
  @ ensures  P14_blank: \old(blank_axes(state)) ==> blank_axes(state);
  @*/
void ilk_state_seal(ilk_state_t *state);

/** True when the seal matches and the fields agree with each other: the invariant of every step. */
/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P14_seal: \result ==> sealed(state);
  @ ensures  P14_invariant: \result ==> sound(state);
  @ ensures  only: sealed(state) && sound(state) ==> \result;
  @*/
bool ilk_state_is_sound(const ilk_state_t *state);

/** Puts a state in place that owes nothing to the one before: LOCKED, positions unknown. */
/*@ requires valid: \valid(state) && \valid_read(config) && \separated(state, config);
  @ requires cause: ILK_CAUSE_NONE < cause < ILK_CAUSE_COUNT;
  @ assigns  *state;
  @ ensures  P14_invariant: sound(state);
  @ ensures  P14_locked: state->mode == ILK_MODE_LOCKED && state->cause == cause
  @   && state->cause_value == value && state->cause_tick == 0 && state->causes_seen == 1 << cause;
  @ ensures  P14_blank: blank_axes(state);
  @ ensures  P9_consent: state->pedal == ILK_PEDAL_DISAGREE && state->pedal_armed == 0
  @   && state->pedal_pressed_ticks == 0 && state->pedal_released_ticks == 0
  @   && state->pedal_disagree_ticks == 0;
  @ ensures  P2_stop: state->estop == 1 && state->app_alive == 0 && state->app_age_ticks == UINT32_MAX;
  @ ensures  P13_untrusted: state->config_sound == 0 && state->config_slice == 0
  @   && state->config_partial_crc == 0xffffffff && state->config_crc == config->crc;
  @ ensures  P14_basis: basis_kept(config, state);
  @ ensures  counts: state->tick == 0 && state->holder == 0 && state->link_generation == 0
  @   && state->last_sequence == 0 && state->overruns_in_row == 0 && state->overruns == 0
  @   && state->bus_bad_ticks == 0 && state->requests_accepted == 0 && state->requests_refused == 0;
  @*/
void ilk_state_rebuild(ilk_state_t *state, const ilk_config_t *config, ilk_cause_t cause, uint32_t value);

/** What a look at the configuration found. */
typedef struct {
  bool damaged; /**< a pass ended with another CRC-32 than at start, or the basis is not kept */
  uint32_t crc; /**< CRC-32 that the pass found; 0 before the end of a pass */
} ilk_config_check_t;

/** Adds the next slice of the configuration to the running CRC-32, and judges at the end of a pass. */
/*@ requires valid: \valid_read(config) && \valid(state) && \separated(config, state);
  @ requires sound: state->config_slice < ILK_SLOTS;
  @ assigns  state->config_partial_crc, state->config_slice, state->config_sound;
  @ ensures  P14_next: state->config_slice == (\old(state->config_slice) + 1) % ILK_SLOTS;
  @ ensures  P14_within: \old(state->config_slice) < ILK_SLOTS - 1 ==> !\result.damaged && \result.crc == 0
  @   && state->config_sound == \old(state->config_sound) && state->config_partial_crc
  @     == axis_crc(\old(state->config_slice) == 0 ? system_crc(0xffffffff, config)
  @                                                : \old(state->config_partial_crc),
  @                 &config->axis[\old(state->config_slice)]);
  @ ensures  P14_damaged: \old(state->config_slice) == ILK_SLOTS - 1 ==>
  @   (\result.damaged <==> \result.crc != state->config_crc || config->crc != state->config_crc);
  @ ensures  P14_pass: \old(state->config_slice) == ILK_SLOTS - 1 ==> state->config_partial_crc == 0xffffffff
  @   && \result.crc
  @     == (axis_crc(\old(state->config_partial_crc), &config->axis[ILK_SLOTS - 1]) ^ 0xffffffff);
  @ ensures  P14_distrust: \result.damaged ==> state->config_sound == 0;
  @ ensures  P13_valid: \old(state->config_sound) == 0 && state->config_sound != 0 ==>
  @   \old(valid_config(config));
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @*/
ilk_config_check_t ilk_config_check_slice(const ilk_config_t *config, ilk_state_t *state);

/**
 * Compares the words of the configuration that P1 to P3 rest on with those of the start: pedal channels, time
 * without app, and of each axis card, switch end and motor sense. A pass over the slices would find a change
 * of them too late.
 *
 * @return false when one of them changed; the configuration is not trusted then.
 */
/*@ requires valid: \valid_read(config) && \valid(state) && \separated(config, state);
  @ assigns  state->config_sound;
  @ ensures  P14_basis: \result <==> \old(basis_kept(config, state));
  @ ensures  P14_distrust: state->config_sound == (\result ? \old(state->config_sound) : 0);
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @*/
bool ilk_config_check_basis(const ilk_config_t *config, ilk_state_t *state);

#endif
