/**
 * @file
 * P13: when a whole configuration is valid, and which rule it breaks first. The configuration is arbitrary
 * bits.
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

ilk_config_error_t some_error(const ilk_axis_config_t* axis, uint32_t period_us) {
  SHOW((axis == &judged->axis[slots_judged]) && (period_us == judged->period_us),
       "P13: each slot is judged in its turn, with the control period");
  const ilk_config_error_t error = (ilk_config_error_t)slot_answer[slots_judged];
  slots_judged++;
  return error;
}

static bool lasts(uint32_t ticks, uint32_t period_us, int64_t longest_us) {
  return (ticks > 0u) && (((int64_t)ticks * (int64_t)period_us) <= longest_us);
}

/** The first rule of header and system that is broken, in the order of the catalog; NONE when all are kept.
 */
static uint32_t first_broken_rule(const ilk_config_t* config) {
  const uint32_t period_us = config->period_us;
  return (config->version != ILK_CONFIG_VERSION)                  ? ILK_CONFIG_ERROR_VERSION
         : (config->size_bytes != sizeof(ilk_config_t))           ? ILK_CONFIG_ERROR_SIZE
         : (config->crc != true_crc)                              ? ILK_CONFIG_ERROR_CRC
         : !between(period_us, 125, 2000)                         ? ILK_CONFIG_ERROR_PERIOD
         : !between(config->pedal_channels, 1, 2)                 ? ILK_CONFIG_ERROR_PEDAL_CHANNELS
         : !lasts(config->app_timeout_ticks, period_us, 150000)   ? ILK_CONFIG_ERROR_APP_TIMEOUT
         : !lasts(config->lease_max_ticks, period_us, 150000)     ? ILK_CONFIG_ERROR_LEASE
         : !lasts(config->pedal_debounce_ticks, period_us, 50000) ? ILK_CONFIG_ERROR_PEDAL_DEBOUNCE
         : !lasts(config->pedal_disagree_ticks, period_us, 50000) ? ILK_CONFIG_ERROR_PEDAL_DISAGREE
         : !between(config->bad_frame_limit, 1, 5)                ? ILK_CONFIG_ERROR_BAD_FRAMES
         : !between(config->overrun_limit, 1, 10)                 ? ILK_CONFIG_ERROR_OVERRUNS
                                                                  : ILK_CONFIG_ERROR_NONE;
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
  const bool header = (config.version == ILK_CONFIG_VERSION) && (config.size_bytes == sizeof(ilk_config_t)) &&
                      (config.crc == true_crc);
  const ilk_config_verdict_t verdict = ilk_config_validate(&config);
  const bool valid = header && valid_system(&config);
  SHOW((verdict.error == ILK_CONFIG_ERROR_NONE) == (valid && slots_valid && any_motor),
       "P13: valid exactly when header, system, each slot and the sum of slots are");
  SHOW(verdict.error < ILK_CONFIG_ERROR_COUNT, "P13: a known error");
  SHOW(IMPLIES(valid && !slots_valid,
               (verdict.slot == first_bad) && (verdict.error == slot_answer[first_bad])),
       "P13: the first slot with an error is named, with its error");
  SHOW(IMPLIES(!valid || slots_valid, verdict.slot == ILK_SLOTS),
       "P13: an error of the system names no slot");
  const uint32_t broken = first_broken_rule(&config);
  SHOW((broken == ILK_CONFIG_ERROR_NONE) == valid, "P13: valid header and system break no rule");
  SHOW(IMPLIES(!valid, verdict.error == broken), "P13: the first broken rule is told, before those of slots");
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
  GOAL(goal_bad_frames, verdict.error == ILK_CONFIG_ERROR_BAD_FRAMES);
  GOAL(goal_overruns, verdict.error == ILK_CONFIG_ERROR_OVERRUNS);
  GOAL(goal_no_axis, verdict.error == ILK_CONFIG_ERROR_NO_AXIS);
  GOAL(goal_last_slot, (verdict.slot == (ILK_SLOTS - 1u)) && (verdict.error == ILK_CONFIG_ERROR_MAX_DELTA));
  GOAL(never_valid_without_motor, (verdict.error == ILK_CONFIG_ERROR_NONE) && !any_motor);
}
