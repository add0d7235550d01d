#include "integrity.h"

#include "arith.h"
#include "config.h"
#include "crc32.h"
#include "interlock/kernel.h"

/** Sum of the words and sum of the partial sums. A change of any one word changes `sum`; words that
    change places change `order`. Seeded, so that cleared memory does not pass. */
typedef struct {
  uint32_t sum;
  uint32_t order;
} seal_t;

static const seal_t seal_start = {.sum = 0x494c4b31u, .order = 0x5ea15ea1u};

static seal_t seal_word(seal_t seal, uint32_t word) {
  seal_t next = seal;
  next.sum += word;
  next.order += next.sum;
  return next;
}

static seal_t seal_axis(seal_t seal, const ilk_axis_t *axis) {
  seal_t next = seal;
  next = seal_word(next, axis->state);
  next = seal_word(next, axis->fault);
  next = seal_word(next, axis->fault_tick);
  next = seal_word(next, (uint32_t)axis->fault_value);
  next = seal_word(next, axis->homed);
  next = seal_word(next, axis->switch_triggered);
  next = seal_word(next, axis->card_valid);
  next = seal_word(next, axis->card_seen);
  next = seal_word(next, axis->bad_frames);
  next = seal_word(next, axis->checksum_failures);
  next = seal_word(next, axis->heartbeat);
  next = seal_word(next, axis->card_time_us);
  next = seal_word(next, axis->card_status);
  next = seal_word(next, axis->ticks_since_frame);
  next = seal_word(next, axis->raw);
  next = seal_word(next, (uint32_t)axis->position_counts);
  next = seal_word(next, (uint32_t)axis->delta_counts);
  next = seal_word(next, (uint32_t)axis->setpoint_counts);
  next = seal_word(next, axis->drive);
  next = seal_word(next, axis->amplitude);
  next = seal_word(next, axis->lease_ticks);
  next = seal_word(next, axis->driven_direction);
  next = seal_word(next, (uint32_t)axis->press_travel_counts);
  next = seal_word(next, axis->stall_driven_ticks);
  next = seal_word(next, axis->stall_mark_raw);
  next = seal_word(next, axis->stall_direction);
  next = seal_word(next, axis->setpoint_changed);
  next = seal_word(next, axis->reverse_mark_raw);
  next = seal_word(next, axis->reverse_direction);
  next = seal_word(next, axis->drift_mark_raw);
  next = seal_word(next, axis->undriven_ticks);
  next = seal_word(next, axis->homing_phase);
  next = seal_word(next, axis->homing_ticks);
  next = seal_word(next, axis->homing_mark_raw);
  next = seal_word(next, axis->rest_ticks);
  return next;
}
_Static_assert(sizeof(ilk_axis_t) == (35u * sizeof(uint32_t)), "every word is sealed");

static seal_t seal_system(seal_t seal, const ilk_state_t *state) {
  seal_t next = seal;
  next = seal_word(next, state->tick);
  next = seal_word(next, state->mode);
  next = seal_word(next, state->cause);
  next = seal_word(next, state->cause_tick);
  next = seal_word(next, state->cause_value);
  next = seal_word(next, state->causes_seen);
  next = seal_word(next, state->pedal);
  next = seal_word(next, state->pedal_armed);
  next = seal_word(next, state->pedal_pressed_ticks);
  next = seal_word(next, state->pedal_released_ticks);
  next = seal_word(next, state->pedal_disagree_ticks);
  next = seal_word(next, state->estop);
  next = seal_word(next, state->app_age_ticks);
  next = seal_word(next, state->app_alive);
  next = seal_word(next, state->holder);
  next = seal_word(next, state->link_generation);
  next = seal_word(next, state->last_sequence);
  next = seal_word(next, state->overruns_in_row);
  next = seal_word(next, state->overruns);
  next = seal_word(next, state->bus_bad_ticks);
  next = seal_word(next, state->config_crc);
  next = seal_word(next, state->config_slice);
  next = seal_word(next, state->config_partial_crc);
  next = seal_word(next, state->config_sound);
  next = seal_word(next, state->requests_accepted);
  next = seal_word(next, state->requests_refused);
  return next;
}
_Static_assert(sizeof(ilk_state_t) == ((ILK_SLOTS * sizeof(ilk_axis_t)) + (28u * sizeof(uint32_t))),
               "every word is sealed, or is the seal");

static seal_t seal_of(const ilk_state_t *state) {
  seal_t seal = seal_system(seal_start, state);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    seal = seal_axis(seal, &state->axis[slot]);
  }
  return seal;
}

void ilk_state_seal(ilk_state_t *state) {
  const seal_t seal = seal_of(state);
  state->seal_sum = seal.sum;
  state->seal_order = seal.order;
}

static bool axis_codes_are_known(const ilk_axis_t *axis) {
  return (axis->state < ILK_AXIS_COUNT) && (axis->fault < ILK_FAULT_COUNT) &&
         (axis->driven_direction < ILK_DIRECTION_COUNT) && (axis->stall_direction < ILK_DIRECTION_COUNT) &&
         (axis->reverse_direction < ILK_DIRECTION_COUNT) && (axis->homing_phase < ILK_HOMING_COUNT) &&
         (axis->homed <= 1u);
}

/** Each state of an axis has exactly the company that belongs to it. */
static bool axis_agrees(const ilk_axis_t *axis) {
  const bool faulted = axis->state == (uint32_t)ILK_AXIS_FAULTED;
  const bool moving = axis->state == (uint32_t)ILK_AXIS_MOVING;
  const bool homing = axis->state == (uint32_t)ILK_AXIS_HOMING;
  return (faulted == (axis->fault != (uint32_t)ILK_FAULT_NONE)) && (moving == (axis->lease_ticks != 0u)) &&
         (homing == (axis->homing_phase != (uint32_t)ILK_HOMING_NONE)) && (!homing || (axis->homed == 0u));
}

/** What the mode allows an axis to be. */
static bool axis_fits_mode(const ilk_axis_t *axis, uint32_t mode) {
  bool fits = false;
  switch (mode) {
    case (uint32_t)ILK_MODE_MOTION:
      fits = true;
      break;
    case (uint32_t)ILK_MODE_READY:
      fits = (axis->state != (uint32_t)ILK_AXIS_MOVING) && (axis->state != (uint32_t)ILK_AXIS_HOMING);
      break;
    default: /* INIT and LOCKED */
      fits = (axis->state == (uint32_t)ILK_AXIS_DISABLED) || (axis->state == (uint32_t)ILK_AXIS_FAULTED);
      break;
  }
  return fits;
}

static bool system_agrees(const ilk_state_t *state) {
  const bool locked = state->mode == (uint32_t)ILK_MODE_LOCKED;
  return (state->mode < ILK_MODE_COUNT) && (state->cause < ILK_CAUSE_COUNT) &&
         (locked == (state->cause != (uint32_t)ILK_CAUSE_NONE)) && (state->pedal < ILK_PEDAL_COUNT) &&
         (state->config_slice < (uint32_t)ILK_SLOTS);
}

bool ilk_state_is_sound(const ilk_state_t *state) {
  const seal_t seal = seal_of(state);
  bool sound = (seal.sum == state->seal_sum) && (seal.order == state->seal_order) && system_agrees(state);
  for (uint32_t slot = 0u; (slot < (uint32_t)ILK_SLOTS) && sound; slot++) {
    const ilk_axis_t *axis = &state->axis[slot];
    sound = axis_codes_are_known(axis) && axis_agrees(axis) && axis_fits_mode(axis, state->mode);
  }
  return sound;
}

void ilk_state_rebuild(ilk_state_t *state, const ilk_config_t *config, ilk_cause_t cause, uint32_t value) {
  static const ilk_axis_t blank = {0};
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    state->axis[slot] = blank;
  }
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
  state->seal_sum = 0u;
  state->seal_order = 0u;
}

bool ilk_config_check_slice(const ilk_config_t *config, ilk_state_t *state) {
  bool sound = true;
  uint32_t crc = state->config_partial_crc;
  if (state->config_slice == 0u) {
    crc = ilk_crc_system_config(ILK_CRC32_START, config);
  }
  crc = ilk_crc_axis_config(crc, &config->axis[state->config_slice]);
  if (state->config_slice < ((uint32_t)ILK_SLOTS - 1u)) {
    state->config_partial_crc = crc;
    state->config_slice++;
  } else {
    sound = (ilk_crc32_finish(crc) == state->config_crc) && (config->crc == state->config_crc);
    /* A configuration that was not trusted becomes so by a whole pass and by being valid (P13). */
    if (!sound) {
      state->config_sound = 0u;
    } else if (state->config_sound == 0u) {
      state->config_sound = (ilk_config_validate(config).error == (uint32_t)ILK_CONFIG_ERROR_NONE) ? 1u : 0u;
    } else {
      state->config_sound = 1u;
    }
    state->config_partial_crc = ILK_CRC32_START;
    state->config_slice = 0u;
  }
  return sound;
}

ilk_config_verdict_t ilk_init(const ilk_config_t *config, ilk_state_t *state) {
  const ilk_config_verdict_t verdict = ilk_config_validate(config);
  const bool valid = verdict.error == (uint32_t)ILK_CONFIG_ERROR_NONE;
  ilk_state_rebuild(state, config, ILK_CAUSE_BOOT, 0u);
  state->config_sound = valid ? 1u : 0u;
  if (!valid) {
    state->mode = (uint32_t)ILK_MODE_INIT;
    state->cause = (uint32_t)ILK_CAUSE_NONE;
    state->causes_seen = 0u;
  }
  ilk_state_seal(state);
  return verdict;
}
