#include "parts.h"

/** Seeded, each lane by its own, so that cleared memory fails: equal lanes would mix to zero. */
#define SEAL_SEED 0x494c4b31u
#define ODD_SEED 0x494c4b32u
/** Odd, so that a product with it can be undone. */
#define SEAL_FACTOR 0x9e3779b1u

#define BYTE_MAX 0xffu

_Static_assert(sizeof(ilk_state_t) == (sizeof(ilk_system_t) + sizeof(ilk_axis_t[ILK_SLOTS]) + 4u),
               "all is words, and every word is sealed or is the seal");
_Static_assert((sizeof(ilk_state_t) % 8u) == 0u, "an odd number of words is sealed");

/** Mixes a word into the digest. The step can be undone, so a change of any one word changes the result;
   product and rotation together spread it over all bits, so that changes of several words do not cancel. */
static uint32_t mix(uint32_t digest, uint32_t word) {
  const uint32_t mixed = digest ^ word;
  return ((mixed << 13) | (mixed >> 19)) * SEAL_FACTOR;
}

/** Of an odd number of words, in two lanes, so that a processor can work on both at once. */
static uint32_t digest_of(const uint8_t bytes[], uint32_t words) {
  uint32_t even = SEAL_SEED;
  uint32_t odd = ODD_SEED;
  for (uint32_t word = 0u; (word + 1u) < words; word += 2u) {
    even = mix(even, word_at(&bytes[4u * word]));
    odd = mix(odd, word_at(&bytes[4u * (word + 1u)]));
  }
  return mix(mix(even, word_at(&bytes[4u * (words - 1u)])), odd);
}

static uint32_t state_digest(const ilk_state_t *state) {
  return digest_of((const uint8_t *)state, (uint32_t)(sizeof(*state) / 4u) - 1u);
}

bool ilk_state_is_sealed(const ilk_state_t *state) { return state->seal == state_digest(state); }

void ilk_state_seal(ilk_state_t *state) { state->seal = state_digest(state); }

/** What direction on the wire and switch of an axis mean: card, switch end and motor sense, a byte each. */
static uint32_t wiring_of(const ilk_axis_config_t *axis) {
  return axis->card | (axis->limit_side << 8) | (axis->motor_direction << 16);
}

/** Exactly, so that what no byte holds is wired in no way. */
static bool is_wired(const ilk_axis_config_t *axis, uint32_t wiring) {
  return (axis->card == (wiring & BYTE_MAX)) && (axis->limit_side == ((wiring >> 8) & BYTE_MAX)) &&
         (axis->motor_direction == (wiring >> 16));
}

/** A state that owes nothing to the one before: LOCKED for a cause, INIT without one; positions unknown. */
static void begin_state(const ilk_config_t *config, ilk_cause_t cause, ilk_state_t *state) {
  static const ilk_state_t nothing_known = {0};
  const uint32_t seal = state->seal;
  *state = nothing_known;
  state->system.mode = (uint32_t)((cause != ILK_CAUSE_NONE) ? ILK_MODE_LOCKED : ILK_MODE_INIT);
  state->system.cause = (uint32_t)cause;
  state->system.cause_value = (cause == ILK_CAUSE_INTEGRITY) ? seal : 0u;
  state->system.causes_seen = (cause != ILK_CAUSE_NONE) ? (1u << (uint32_t)cause) : 0u;
  state->system.pedal = (uint32_t)ILK_PEDAL_DISAGREE;
  state->system.estop = 1u;
  state->system.app_age_ticks = UINT32_MAX;
  state->system.config_crc = config->crc;
  state->system.config_sound = flag_of(cause == ILK_CAUSE_BOOT);
  state->system.pedal_channels = config->common.pedal_channels;
  state->system.app_timeout_ticks = config->common.app_timeout_ticks;
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    state->axis[slot].wiring = wiring_of(&config->axis[slot]);
    if (has_axis(&config->axis[slot]) && (cause == ILK_CAUSE_INTEGRITY)) {
      state->axis[slot].state = (uint32_t)ILK_AXIS_FAULTED;
      state->axis[slot].fault = (uint32_t)ILK_FAULT_INTEGRITY;
    }
  }
}

static bool is_valid(const ilk_config_t *config) {
  return ilk_config_validate(config).error == (uint32_t)ILK_CONFIG_ERROR_NONE;
}

ilk_config_verdict_t ilk_init(const ilk_config_t *config, ilk_state_t *state) {
  begin_state(config, is_valid(config) ? ILK_CAUSE_BOOT : ILK_CAUSE_NONE, state);
  ilk_state_seal(state);
  return ilk_config_validate(config);
}

/** Adds the next slice of the configuration to the running CRC-32, and judges at the end of a pass. */
static void check_slice(const ilk_config_t *config, ilk_system_t *system, ilk_alarms_t *alarms) {
  const uint32_t slice = (system->config_slice < (uint32_t)ILK_SLOTS) ? system->config_slice : 0u;
  const uint32_t so_far = (slice != 0u) ? system->config_partial_crc
                                        : ilk_crc32_words(ILK_CRC32_START, (const uint8_t *)&config->common,
                                                          (uint32_t)(sizeof(config->common) / 4u));
  const uint32_t crc = ilk_crc32_words(so_far, (const uint8_t *)&config->axis[slice],
                                       (uint32_t)(sizeof(config->axis[slice]) / 4u));
  system->config_partial_crc = crc;
  system->config_slice = slice + 1u;
  if (system->config_slice == (uint32_t)ILK_SLOTS) {
    alarms->configuration_crc = crc ^ ILK_CRC32_START;
    alarms->configuration_damaged =
        (alarms->configuration_crc != system->config_crc) || (config->crc != system->config_crc);
    /* What was not trusted becomes so by a whole pass that agrees and by being valid (P13). */
    system->config_sound =
        flag_of(!alarms->configuration_damaged && ((system->config_sound != 0u) || is_valid(config)));
    system->config_slice = 0u;
  }
}

/** Words of the configuration that P1 to P3 rest on. A pass over the slices would find a change of them too
 * late. */
static bool basis_is_kept(const ilk_config_t *config, const ilk_state_t *state) {
  bool kept = (config->common.pedal_channels == state->system.pedal_channels) &&
              (config->common.app_timeout_ticks == state->system.app_timeout_ticks);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    kept = kept && is_wired(&config->axis[slot], state->axis[slot].wiring);
  }
  return kept;
}

ilk_alarms_t ilk_integrity_check(const ilk_config_t *config, ilk_state_t *state) {
  ilk_alarms_t alarms = {.new_fault = false};
  if (!ilk_state_is_sealed(state)) {
    begin_state(config, ILK_CAUSE_INTEGRITY, state);
  }
  if (state->system.mode != (uint32_t)ILK_MODE_INIT) {
    check_slice(config, &state->system, &alarms);
    if (!basis_is_kept(config, state)) {
      alarms.configuration_damaged = true;
      state->system.config_sound = 0u;
    }
  }
  return alarms;
}
