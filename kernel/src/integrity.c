#include "integrity.h"

#include <stddef.h>

#include "arith.h"
#include "config.h"
#include "crc32.h"
#include "interlock/kernel.h"

/** Seeded, each lane by its own, so that cleared memory fails: equal lanes would mix to zero. */
#define SEAL_SEED 0x494c4b31u
#define ODD_SEED 0x494c4b32u
/** Odd, so that a product with it can be undone. */
#define SEAL_FACTOR 0x9e3779b1u

#define BYTE_MAX 0xffu
/** No three bytes make it. */
#define WIRING_UNKNOWN UINT32_MAX

/** Mixes a word into the digest. The step can be undone, so a change of any one word changes the result;
   product and rotation together spread it over all bits, so that changes of several words do not cancel. */
/*@ assigns \nothing;
  @ ensures P14_mix: \result == mixed(digest, word);
  @*/
static uint32_t mix(uint32_t digest, uint32_t word) {
  const uint32_t mixed = digest ^ word;
  return ((mixed << 13) | (mixed >> 19)) * SEAL_FACTOR;
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P14_every_word: \result == axis_seal(axis);
  @*/
static uint32_t axis_digest(const ilk_axis_t *axis) {
  /*@ assert readable: \valid_read(&axis->state) && \valid_read(&axis->fault)
    @   && \valid_read(&axis->fault_tick) && \valid_read(&axis->fault_value) && \valid_read(&axis->homed)
    @   && \valid_read(&axis->switch_triggered) && \valid_read(&axis->card_valid)
    @   && \valid_read(&axis->card_seen) && \valid_read(&axis->bad_frames)
    @   && \valid_read(&axis->checksum_failures) && \valid_read(&axis->heartbeat)
    @   && \valid_read(&axis->card_time_us) && \valid_read(&axis->card_status)
    @   && \valid_read(&axis->ticks_since_frame) && \valid_read(&axis->raw)
    @   && \valid_read(&axis->position_counts) && \valid_read(&axis->delta_counts)
    @   && \valid_read(&axis->setpoint_counts) && \valid_read(&axis->drive) && \valid_read(&axis->amplitude)
    @   && \valid_read(&axis->lease_ticks) && \valid_read(&axis->driven_direction)
    @   && \valid_read(&axis->press_travel_counts) && \valid_read(&axis->stall_driven_ticks)
    @   && \valid_read(&axis->stall_mark_raw) && \valid_read(&axis->stall_direction)
    @   && \valid_read(&axis->setpoint_changed) && \valid_read(&axis->reverse_mark_raw)
    @   && \valid_read(&axis->reverse_direction) && \valid_read(&axis->drift_mark_raw)
    @   && \valid_read(&axis->undriven_ticks) && \valid_read(&axis->homing_phase)
    @   && \valid_read(&axis->homing_ticks) && \valid_read(&axis->homing_mark_raw)
    @   && \valid_read(&axis->rest_ticks) && \valid_read(&axis->wiring);
    @*/
  uint32_t even = SEAL_SEED;
  uint32_t odd = ODD_SEED;
  even = mix(even, axis->state);
  odd = mix(odd, axis->fault);
  even = mix(even, axis->fault_tick);
  odd = mix(odd, (uint32_t)axis->fault_value);
  even = mix(even, axis->homed);
  odd = mix(odd, axis->switch_triggered);
  even = mix(even, axis->card_valid);
  odd = mix(odd, axis->card_seen);
  even = mix(even, axis->bad_frames);
  odd = mix(odd, axis->checksum_failures);
  even = mix(even, axis->heartbeat);
  odd = mix(odd, axis->card_time_us);
  even = mix(even, axis->card_status);
  odd = mix(odd, axis->ticks_since_frame);
  even = mix(even, axis->raw);
  odd = mix(odd, (uint32_t)axis->position_counts);
  even = mix(even, (uint32_t)axis->delta_counts);
  odd = mix(odd, (uint32_t)axis->setpoint_counts);
  even = mix(even, axis->drive);
  odd = mix(odd, axis->amplitude);
  even = mix(even, axis->lease_ticks);
  odd = mix(odd, axis->driven_direction);
  even = mix(even, (uint32_t)axis->press_travel_counts);
  odd = mix(odd, axis->stall_driven_ticks);
  even = mix(even, axis->stall_mark_raw);
  odd = mix(odd, axis->stall_direction);
  even = mix(even, axis->setpoint_changed);
  odd = mix(odd, axis->reverse_mark_raw);
  even = mix(even, axis->reverse_direction);
  odd = mix(odd, axis->drift_mark_raw);
  even = mix(even, axis->undriven_ticks);
  odd = mix(odd, axis->homing_phase);
  even = mix(even, axis->homing_ticks);
  odd = mix(odd, axis->homing_mark_raw);
  even = mix(even, axis->rest_ticks);
  odd = mix(odd, axis->wiring);
  return mix(even, odd);
}
_Static_assert(sizeof(ilk_axis_t) == (36u * sizeof(uint32_t)), "every word is sealed");

/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P14_every_word: \result == seal_of(state, 0);
  @*/
static uint32_t system_digest(const ilk_state_t *state) {
  /*@ assert readable: \valid_read(&state->tick) && \valid_read(&state->mode) && \valid_read(&state->cause)
    @   && \valid_read(&state->cause_tick) && \valid_read(&state->cause_value)
    @   && \valid_read(&state->causes_seen) && \valid_read(&state->pedal) && \valid_read(&state->pedal_armed)
    @   && \valid_read(&state->pedal_pressed_ticks) && \valid_read(&state->pedal_released_ticks)
    @   && \valid_read(&state->pedal_disagree_ticks) && \valid_read(&state->estop)
    @   && \valid_read(&state->app_age_ticks) && \valid_read(&state->app_alive) && \valid_read(&state->holder)
    @   && \valid_read(&state->link_generation) && \valid_read(&state->last_sequence)
    @   && \valid_read(&state->overruns_in_row) && \valid_read(&state->overruns)
    @   && \valid_read(&state->bus_bad_ticks) && \valid_read(&state->config_crc)
    @   && \valid_read(&state->config_slice) && \valid_read(&state->config_partial_crc)
    @   && \valid_read(&state->config_sound) && \valid_read(&state->pedal_channels)
    @   && \valid_read(&state->app_timeout_ticks) && \valid_read(&state->requests_accepted)
    @   && \valid_read(&state->requests_refused);
    @*/
  uint32_t even = SEAL_SEED;
  uint32_t odd = ODD_SEED;
  odd = mix(odd, state->tick);
  even = mix(even, state->mode);
  odd = mix(odd, state->cause);
  even = mix(even, state->cause_tick);
  odd = mix(odd, state->cause_value);
  even = mix(even, state->causes_seen);
  odd = mix(odd, state->pedal);
  even = mix(even, state->pedal_armed);
  odd = mix(odd, state->pedal_pressed_ticks);
  even = mix(even, state->pedal_released_ticks);
  odd = mix(odd, state->pedal_disagree_ticks);
  even = mix(even, state->estop);
  odd = mix(odd, state->app_age_ticks);
  even = mix(even, state->app_alive);
  odd = mix(odd, state->holder);
  even = mix(even, state->link_generation);
  odd = mix(odd, state->last_sequence);
  even = mix(even, state->overruns_in_row);
  odd = mix(odd, state->overruns);
  even = mix(even, state->bus_bad_ticks);
  odd = mix(odd, state->config_crc);
  even = mix(even, state->config_slice);
  odd = mix(odd, state->config_partial_crc);
  even = mix(even, state->config_sound);
  odd = mix(odd, state->pedal_channels);
  even = mix(even, state->app_timeout_ticks);
  odd = mix(odd, state->requests_accepted);
  even = mix(even, state->requests_refused);
  return mix(even, odd);
}
_Static_assert(sizeof(ilk_state_t) == (((size_t)ILK_SLOTS * sizeof(ilk_axis_t)) + (29u * sizeof(uint32_t))),
               "every word is sealed, or is the seal");

/** Each part has a digest of its own, made in two lanes, so that a processor can work on several at once. */
/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P14_every_word: \result == seal_of(state, ILK_SLOTS);
  @*/
static uint32_t state_digest(const ilk_state_t *state) {
  uint32_t digest = system_digest(state);
  /*@ loop invariant bounds: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P14_every_word: digest == seal_of(state, slot);
    @ loop assigns slot, digest;
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    digest = mix(digest, axis_digest(&state->axis[slot]));
  }
  return digest;
}

/*@ requires valid: \valid(state);
  @ assigns  state->seal;
  @ ensures  P14_seal: state->seal == seal;
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @ ensures  P14_blank: \old(blank_axes(state)) ==> blank_axes(state);
  @*/
static void write_seal(ilk_state_t *state, uint32_t seal) { state->seal = seal; }

void ilk_state_seal(ilk_state_t *state) { write_seal(state, state_digest(state)); }

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> known_codes(axis);
  @*/
static bool axis_codes_are_known(const ilk_axis_t *axis) {
  return (axis->state < ILK_AXIS_COUNT) && (axis->fault < ILK_FAULT_COUNT) &&
         (axis->driven_direction < ILK_DIRECTION_COUNT) && (axis->stall_direction < ILK_DIRECTION_COUNT) &&
         (axis->reverse_direction < ILK_DIRECTION_COUNT) && (axis->homing_phase < ILK_HOMING_COUNT) &&
         (axis->homed <= 1u);
}

/*@ assigns \nothing;
  @ ensures exact: \result <==> (a <==> b);
  @*/
static bool both_or_neither(bool a, bool b) { return a == b; }

/** Each state of an axis has exactly the company that belongs to it. */
/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P14_invariant: \result && known_codes(axis) <==> sound_axis(axis);
  @*/
static bool axis_agrees(const ilk_axis_t *axis) {
  const bool faulted = axis->state == (uint32_t)ILK_AXIS_FAULTED;
  const bool moving = axis->state == (uint32_t)ILK_AXIS_MOVING;
  const bool homing = axis->state == (uint32_t)ILK_AXIS_HOMING;
  return both_or_neither(faulted, axis->fault != (uint32_t)ILK_FAULT_NONE) &&
         both_or_neither(moving, axis->lease_ticks != 0u) &&
         both_or_neither(homing, axis->homing_phase != (uint32_t)ILK_HOMING_NONE) &&
         (!homing || (axis->homed == 0u));
}

/** What the mode allows an axis to be. */
/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P14_invariant: \result <==> fits_mode(axis, mode);
  @*/
static bool axis_fits_mode(const ilk_axis_t *axis, uint32_t mode) {
  const bool in_motion =
      (axis->state == (uint32_t)ILK_AXIS_MOVING) || (axis->state == (uint32_t)ILK_AXIS_HOMING);
  const bool out_of_service =
      (axis->state == (uint32_t)ILK_AXIS_DISABLED) || (axis->state == (uint32_t)ILK_AXIS_FAULTED);
  bool fits = false;
  switch (mode) {
    case (uint32_t)ILK_MODE_MOTION:
      fits = true;
      break;
    case (uint32_t)ILK_MODE_READY:
      fits = !in_motion;
      break;
    default: /* INIT and LOCKED */
      fits = out_of_service;
      break;
  }
  return fits;
}

/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P14_invariant: \result <==> sound_system(state);
  @*/
static bool system_agrees(const ilk_state_t *state) {
  const bool locked = state->mode == (uint32_t)ILK_MODE_LOCKED;
  return (state->mode < ILK_MODE_COUNT) && (state->cause < ILK_CAUSE_COUNT) &&
         both_or_neither(locked, state->cause != (uint32_t)ILK_CAUSE_NONE) &&
         (state->pedal < ILK_PEDAL_COUNT) && (state->config_slice < (uint32_t)ILK_SLOTS);
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P14_invariant: \result <==> sound_axis(axis) && fits_mode(axis, mode);
  @*/
static bool axis_is_sound(const ilk_axis_t *axis, uint32_t mode) {
  return axis_codes_are_known(axis) && axis_agrees(axis) && axis_fits_mode(axis, mode);
}

/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P14_codes: \result ==> sound_axes(state);
  @ ensures  P14_mode: \result ==> axes_fit_mode(state);
  @ ensures  only: !\result ==> !(sound_axes(state) && axes_fit_mode(state));
  @*/
static bool axes_are_sound(const ilk_state_t *state) {
  bool sound = true;
  /*@ loop invariant bounds: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P14_codes: sound ==> \forall integer index; 0 <= index < slot ==>
    @   sound_axis(&state->axis[index]);
    @ loop invariant P14_mode: sound ==> \forall integer index; 0 <= index < slot ==>
    @   fits_mode(&state->axis[index], state->mode);
    @ loop invariant only: !sound ==> 0 < slot
    @   && !(sound_axis(&state->axis[slot - 1]) && fits_mode(&state->axis[slot - 1], state->mode));
    @ loop assigns slot, sound;
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; (slot < (uint32_t)ILK_SLOTS) && sound; slot++) {
    sound = axis_is_sound(&state->axis[slot], state->mode);
  }
  return sound;
}

bool ilk_state_is_sound(const ilk_state_t *state) {
  return (state->seal == state_digest(state)) && system_agrees(state) && axes_are_sound(state);
}

/*@ assigns \nothing;
  @ ensures P14_blank: \result.state == ILK_AXIS_DISABLED && \result.fault == ILK_FAULT_NONE
  @   && \result.homed == 0 && \result.card_valid == 0 && \result.card_seen == 0 && \result.lease_ticks == 0
  @   && \result.homing_phase == ILK_HOMING_NONE && \result.driven_direction == ILK_DIRECTION_NONE
  @   && \result.stall_direction == ILK_DIRECTION_NONE && \result.reverse_direction == ILK_DIRECTION_NONE;
  @*/
static ilk_axis_t unknown_axis(void) {
  static const ilk_axis_t unknown = {0};
  return unknown;
}

/*@ requires valid: \valid(axis);
  @ assigns  *axis;
  @ ensures  P14_blank: blank_axis(axis);
  @*/
static void forget_axis(ilk_axis_t *axis) { *axis = unknown_axis(); }

/*@ requires valid: \valid(state);
  @ assigns  state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P14_blank: blank_axes(state);
  @*/
static void forget_axes(ilk_state_t *state) {
  /*@ loop invariant bounds: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P14_blank: \forall integer index; 0 <= index < slot ==> blank_axis(&state->axis[index]);
    @ loop assigns slot, state->axis[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    forget_axis(&state->axis[slot]);
  }
}

/** What direction on the wire and switch of an axis mean. Equal words of two configurations, of which one is
   valid, say that card, switch end and motor sense are equal. */
/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P14_wiring: \result == wiring(axis);
  @*/
static uint32_t axis_wiring(const ilk_axis_config_t *axis) {
  uint32_t wiring = WIRING_UNKNOWN;
  if ((axis->card <= BYTE_MAX) && (axis->limit_side <= BYTE_MAX) && (axis->motor_direction <= BYTE_MAX)) {
    wiring = axis->card + (axis->limit_side * 0x100u) + (axis->motor_direction * 0x10000u);
  }
  return wiring;
}

/*@ requires valid: \valid(state) && \valid_read(config) && \separated(state, config);
  @ assigns  state->pedal_channels, state->app_timeout_ticks, state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P14_basis: basis_kept(config, state);
  @ ensures  P14_blank: \old(blank_axes(state)) ==> blank_axes(state);
  @*/
static void remember_basis(ilk_state_t *state, const ilk_config_t *config) {
  state->pedal_channels = config->pedal_channels;
  state->app_timeout_ticks = config->app_timeout_ticks;
  /*@ loop invariant bounds: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P14_basis: \forall integer index; 0 <= index < slot ==>
    @   state->axis[index].wiring == wiring(&config->axis[index]);
    @ loop invariant P14_blank: \at(blank_axes(state), Pre) ==> blank_axes(state);
    @ loop assigns slot, state->axis[0 .. ILK_SLOTS - 1];
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    state->axis[slot].wiring = axis_wiring(&config->axis[slot]);
  }
}

/*@ requires valid: \valid(state) && \valid_read(config) && \separated(state, config);
  @ assigns  state->pedal_channels, state->app_timeout_ticks, state->axis[0 .. ILK_SLOTS - 1];
  @ ensures  P14_basis: basis_kept(config, state);
  @ ensures  P14_blank: blank_axes(state);
  @*/
static void forget_axes_but_basis(ilk_state_t *state, const ilk_config_t *config) {
  forget_axes(state);
  remember_basis(state, config);
}

void ilk_state_rebuild(ilk_state_t *state, const ilk_config_t *config, ilk_cause_t cause, uint32_t value) {
  state->tick = 0u;
  state->mode = (uint32_t)ILK_MODE_LOCKED;
  state->cause = (uint32_t)cause;
  state->cause_tick = 0u;
  state->cause_value = value;
  state->causes_seen = 1u << (uint32_t)cause;
  state->pedal = (uint32_t)ILK_PEDAL_DISAGREE;
  state->pedal_armed = 0u;
  state->pedal_pressed_ticks = 0u;
  state->pedal_released_ticks = 0u;
  state->pedal_disagree_ticks = 0u;
  state->estop = 1u;
  state->app_age_ticks = UINT32_MAX;
  state->app_alive = 0u;
  state->holder = 0u;
  state->link_generation = 0u;
  state->last_sequence = 0u;
  state->overruns_in_row = 0u;
  state->overruns = 0u;
  state->bus_bad_ticks = 0u;
  state->config_crc = config->crc;
  state->config_slice = 0u;
  state->config_partial_crc = ILK_CRC32_START;
  state->config_sound = 0u;
  state->requests_accepted = 0u;
  state->requests_refused = 0u;
  state->seal = 0u;
  forget_axes_but_basis(state, config);
  /*@ assert P15_system: sound_system(state); */
  /*@ assert P15_axes: sound_axes(state); */
  /*@ assert P15_mode: axes_fit_mode(state); */
}

/** A configuration that was not trusted becomes so by a whole pass that agrees and by being valid (P13). */
/*@ requires readable: \valid_read(config) && \valid_read(state);
  @ assigns  \nothing;
  @ ensures  flag: \result == 0 || \result == 1;
  @ ensures  trusted: state->config_sound != 0 ==> \result == 1;
  @ ensures  P13_valid: state->config_sound == 0 && \result == 1 ==> valid_config(config);
  @*/
static uint32_t trust_after_pass(const ilk_config_t *config, const ilk_state_t *state) {
  return flag_of((state->config_sound != 0u) ||
                 (ilk_config_validate(config).error == (uint32_t)ILK_CONFIG_ERROR_NONE));
}

/** The pass goes on with the next slice. */
/*@ requires valid: \valid(state) && state->config_slice < ILK_SLOTS - 1;
  @ assigns  state->config_partial_crc, state->config_slice;
  @ ensures  P14_next: state->config_partial_crc == crc && state->config_slice == \old(state->config_slice) + 1;
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @*/
static void go_on(ilk_state_t *state, uint32_t crc) {
  state->config_partial_crc = crc;
  state->config_slice++;
}

/** The pass ends, and the next one begins. */
/*@ requires valid: \valid(state);
  @ assigns  state->config_partial_crc, state->config_slice, state->config_sound;
  @ ensures  P14_pass: state->config_sound == trust && state->config_partial_crc == 0xffffffff
  @   && state->config_slice == 0;
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @*/
static void end_pass(ilk_state_t *state, uint32_t trust) {
  state->config_sound = trust;
  state->config_partial_crc = ILK_CRC32_START;
  state->config_slice = 0u;
}

ilk_config_check_t ilk_config_check_slice(const ilk_config_t *config, ilk_state_t *state) {
  ilk_config_check_t check = {.damaged = false, .crc = 0u};
  uint32_t crc = state->config_partial_crc;
  if (state->config_slice == 0u) {
    crc = ilk_crc_system_config(ILK_CRC32_START, config);
  }
  crc = ilk_crc_axis_config(crc, &config->axis[state->config_slice]);
  if (state->config_slice < ((uint32_t)ILK_SLOTS - 1u)) {
    go_on(state, crc);
  } else {
    check.crc = ilk_crc32_finish(crc);
    check.damaged = (check.crc != state->config_crc) || (config->crc != state->config_crc);
    end_pass(state, check.damaged ? 0u : trust_after_pass(config, state));
  }
  return check;
}

/*@ requires readable: \valid_read(config) && \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P14_basis: \result <==> basis_kept(config, state);
  @*/
static bool basis_is_kept(const ilk_config_t *config, const ilk_state_t *state) {
  bool kept = (config->pedal_channels == state->pedal_channels) &&
              (config->app_timeout_ticks == state->app_timeout_ticks);
  /*@ loop invariant bounds: 0 <= slot <= ILK_SLOTS;
    @ loop invariant P14_basis: kept <==> config->pedal_channels == state->pedal_channels
    @   && config->app_timeout_ticks == state->app_timeout_ticks
    @   && \forall integer index; 0 <= index < slot ==>
    @        state->axis[index].wiring == wiring(&config->axis[index]);
    @ loop assigns slot, kept;
    @ loop variant ILK_SLOTS - slot;
    @*/
  for (uint32_t slot = 0u; (slot < (uint32_t)ILK_SLOTS) && kept; slot++) {
    kept = axis_wiring(&config->axis[slot]) == state->axis[slot].wiring;
  }
  return kept;
}

bool ilk_config_check_basis(const ilk_config_t *config, ilk_state_t *state) {
  const bool kept = basis_is_kept(config, state);
  if (!kept) {
    state->config_sound = 0u;
  }
  return kept;
}

/** A state that was just rebuilt waits for RESET, or for another configuration. */
/*@ requires valid: \valid(state);
  @ requires rebuilt: state->mode == ILK_MODE_LOCKED;
  @ assigns  state->config_sound, state->mode, state->cause, state->causes_seen;
  @ ensures  P13_trusted: valid ==> state->config_sound == 1
  @   && state->mode == ILK_MODE_LOCKED && state->cause == \old(state->cause);
  @ ensures  P13_refused: !valid ==> state->config_sound == 0
  @   && state->mode == ILK_MODE_INIT && state->cause == ILK_CAUSE_NONE && state->causes_seen == 0;
  @ ensures  P15_system: \old(sound_system(state)) ==> sound_system(state);
  @ ensures  P15_axes: \old(sound_axes(state)) ==> sound_axes(state);
  @ ensures  P15_mode: \old(axes_fit_mode(state)) ==> axes_fit_mode(state);
  @ ensures  P14_blank: \old(blank_axes(state)) ==> blank_axes(state);
  @*/
static void begin(ilk_state_t *state, bool valid) {
  state->config_sound = flag_of(valid);
  if (!valid) {
    state->mode = (uint32_t)ILK_MODE_INIT;
    state->cause = (uint32_t)ILK_CAUSE_NONE;
    state->causes_seen = 0u;
  }
}

ilk_config_verdict_t ilk_init(const ilk_config_t *config, ilk_state_t *state) {
  const ilk_config_verdict_t verdict = ilk_config_validate(config);
  const bool valid = verdict.error == (uint32_t)ILK_CONFIG_ERROR_NONE;
  ilk_state_rebuild(state, config, ILK_CAUSE_BOOT, 0u);
  begin(state, valid);
  ilk_state_seal(state);
  return verdict;
}
