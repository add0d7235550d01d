/**
 * @file
 * What makes a configuration valid (P13), rule by rule in the order of validation, in the words of contracts.
 * Arithmetic is that of the integers. ACSL only: a compiler sees comments.
 */
#ifndef INTERLOCK_ACSL_CONFIG_H
#define INTERLOCK_ACSL_CONFIG_H

#include "interlock/acsl.h"

/*@ // At least one tick, no longer than a limit.
  @ logic boolean lasts(integer ticks, integer period_us, integer limit_ms) =
  @   0 < ticks && ticks * period_us <= limit_ms * 1000;
  @
  @ // The system's rules after the CRC.
  @ logic integer system_rule(ilk_config_t *config) =
  @   !(125 <= config->period_us <= 2000)                             ? ILK_CONFIG_ERROR_PERIOD
  @   : !(1 <= config->pedal_channels <= 2)                           ? ILK_CONFIG_ERROR_PEDAL_CHANNELS
  @   : !lasts(config->app_timeout_ticks, config->period_us, 150)     ? ILK_CONFIG_ERROR_APP_TIMEOUT
  @   : !lasts(config->lease_max_ticks, config->period_us, 150)       ? ILK_CONFIG_ERROR_LEASE
  @   : !lasts(config->pedal_debounce_ticks, config->period_us, 50)   ? ILK_CONFIG_ERROR_PEDAL_DEBOUNCE
  @   : !lasts(config->pedal_disagree_ticks, config->period_us, 50)   ? ILK_CONFIG_ERROR_PEDAL_DISAGREE
  @   : !(1 <= config->bad_frame_limit <= 5)                          ? ILK_CONFIG_ERROR_BAD_FRAMES
  @   : !(1 <= config->overrun_limit <= 10)                           ? ILK_CONFIG_ERROR_OVERRUNS
  @                                                                   : ILK_CONFIG_ERROR_NONE;
  @
  @ // All rules that are no slot's; `crc` is that of the words that are there.
  @ logic integer common_rule(ilk_config_t *config, integer crc) =
  @   config->version != ILK_CONFIG_VERSION           ? ILK_CONFIG_ERROR_VERSION
  @   : config->size_bytes != sizeof(ilk_config_t)    ? ILK_CONFIG_ERROR_SIZE
  @   : config->crc != crc                            ? ILK_CONFIG_ERROR_CRC
  @                                                   : system_rule(config);
  @
  @ logic boolean ordered_limits(ilk_axis_config_t *axis) =
  @   -1073741824 <= axis->min_counts < axis->max_counts <= 1073741824;
  @
  @ logic integer range(ilk_axis_config_t *axis) = axis->max_counts - axis->min_counts;
  @
  @ logic integer geometry_rule(ilk_axis_config_t *axis) =
  @   axis->required > 1 || axis->motor_direction > 1 || axis->direction_correction > 1 ? ILK_CONFIG_ERROR_FLAG
  @   : axis->limit_side >= ILK_LIMIT_COUNT                             ? ILK_CONFIG_ERROR_LIMIT_SIDE
  @   : !ordered_limits(axis)                                           ? ILK_CONFIG_ERROR_SOFT_LIMITS
  @   : !(axis->min_counts <= axis->home_offset_counts <= axis->max_counts) ? ILK_CONFIG_ERROR_HOME_OFFSET
  @   : !(0 < 2 * axis->coast_counts < range(axis))                     ? ILK_CONFIG_ERROR_COAST
  @   : !(0 < 2 * axis->deadband_counts < range(axis))                  ? ILK_CONFIG_ERROR_DEADBAND
  @                                                                     : ILK_CONFIG_ERROR_NONE;
  @
  @ logic boolean amplitude_allowed(ilk_axis_config_t *axis) =
  @   axis->card == ILK_CARD_HIGH_FREQUENCY ? 1 <= axis->max_amplitude <= 255 : axis->max_amplitude == 0;
  @
  @ logic integer drive_rule(ilk_axis_config_t *axis) =
  @   !(1 <= axis->max_drive <= card_drive(axis->card))                 ? ILK_CONFIG_ERROR_MAX_DRIVE
  @   : !(1 <= axis->unhomed_max_drive <= axis->max_drive / 10)         ? ILK_CONFIG_ERROR_UNHOMED_DRIVE
  @   : !amplitude_allowed(axis) || axis->home_amplitude > axis->max_amplitude ? ILK_CONFIG_ERROR_AMPLITUDE
  @   : !(axis->coast_counts < axis->unhomed_travel_counts <= range(axis) / 10) ? ILK_CONFIG_ERROR_UNHOMED_TRAVEL
  @                                                                     : ILK_CONFIG_ERROR_NONE;
  @
  @ // L2: at its slowest the axis backs off, crosses the whole travel and rests before homing times out.
  @ logic boolean homing_suffices(ilk_axis_config_t *axis, integer period_us) =
  @   axis->home_timeout_ticks * period_us <= 600000000
  @   && ((axis->home_timeout_ticks - axis->home_rest_ticks) * period_us) * axis->home_speed_counts_per_s
  @     >= (axis->home_travel_counts + axis->home_backoff_counts) * 1000000;
  @
  @ logic integer homing_rule(ilk_axis_config_t *axis, integer period_us) =
  @   !(1 <= axis->home_drive <= axis->unhomed_max_drive)               ? ILK_CONFIG_ERROR_HOME_DRIVE
  @   : !(range(axis) + axis->coast_counts <= axis->home_travel_counts <= 2 * range(axis))
  @     ? ILK_CONFIG_ERROR_HOME_TRAVEL
  @   : !(1 <= axis->home_backoff_counts <= range(axis) / 10)           ? ILK_CONFIG_ERROR_HOME_BACKOFF
  @   : !(1 <= axis->home_rest_ticks <= axis->home_timeout_ticks)       ? ILK_CONFIG_ERROR_HOME_REST
  @   : !homing_suffices(axis, period_us)                               ? ILK_CONFIG_ERROR_HOME_TIMEOUT
  @                                                                     : ILK_CONFIG_ERROR_NONE;
  @
  @ logic integer switchless_rule(ilk_axis_config_t *axis) =
  @   axis->home_drive != 0            ? ILK_CONFIG_ERROR_HOME_DRIVE
  @   : axis->home_travel_counts != 0  ? ILK_CONFIG_ERROR_HOME_TRAVEL
  @   : axis->home_backoff_counts != 0 ? ILK_CONFIG_ERROR_HOME_BACKOFF
  @   : axis->home_rest_ticks != 0     ? ILK_CONFIG_ERROR_HOME_REST
  @   : axis->home_timeout_ticks != 0 || axis->home_speed_counts_per_s != 0 ? ILK_CONFIG_ERROR_HOME_TIMEOUT
  @                                    : ILK_CONFIG_ERROR_NONE;
  @
  @ // What an axis may move without being at fault.
  @ logic integer innocent(ilk_axis_config_t *axis) =
  @   axis->coast_counts + axis->backlash_counts + axis->noise_counts;
  @
  @ // P5 and P6.
  @ logic integer watch_rule(ilk_axis_config_t *axis, integer period_us) =
  @   !lasts(axis->stall_ticks, period_us, 500)
  @     || !(axis->noise_counts < axis->stall_min_counts <= range(axis) / 10)   ? ILK_CONFIG_ERROR_STALL
  @   : !(innocent(axis) <= axis->reverse_counts <= range(axis) / 10)           ? ILK_CONFIG_ERROR_REVERSE
  @   : !(innocent(axis) <= axis->drift_counts <= range(axis) / 10)             ? ILK_CONFIG_ERROR_DRIFT
  @   : !lasts(axis->settle_ticks, period_us, 1000)                             ? ILK_CONFIG_ERROR_SETTLE
  @   : !(1 <= axis->max_delta_counts <= range(axis) / 2)                       ? ILK_CONFIG_ERROR_MAX_DELTA
  @                                                                             : ILK_CONFIG_ERROR_NONE;
  @
  @ logic integer axis_rule(ilk_axis_config_t *axis, integer period_us) =
  @   geometry_rule(axis) != ILK_CONFIG_ERROR_NONE ? geometry_rule(axis)
  @   : drive_rule(axis) != ILK_CONFIG_ERROR_NONE  ? drive_rule(axis)
  @   : axis->limit_side == ILK_LIMIT_NONE && switchless_rule(axis) != ILK_CONFIG_ERROR_NONE
  @     ? switchless_rule(axis)
  @   : axis->limit_side != ILK_LIMIT_NONE && homing_rule(axis, period_us) != ILK_CONFIG_ERROR_NONE
  @     ? homing_rule(axis, period_us)
  @                                                : watch_rule(axis, period_us);
  @
  @ // Nothing that only a motor has.
  @ logic boolean bare(ilk_axis_config_t *axis) =
  @   axis->motor_direction == 0 && axis->direction_correction == 0 && axis->limit_side == 0
  @   && axis->min_counts == 0 && axis->max_counts == 0 && axis->home_offset_counts == 0
  @   && axis->coast_counts == 0 && axis->backlash_counts == 0 && axis->noise_counts == 0
  @   && axis->deadband_counts == 0 && axis->max_drive == 0 && axis->unhomed_max_drive == 0
  @   && axis->max_amplitude == 0 && axis->unhomed_travel_counts == 0 && axis->home_drive == 0
  @   && axis->home_amplitude == 0 && axis->home_travel_counts == 0
  @   && axis->home_backoff_counts == 0 && axis->home_timeout_ticks == 0
  @   && axis->home_rest_ticks == 0 && axis->home_speed_counts_per_s == 0 && axis->stall_ticks == 0
  @   && axis->stall_min_counts == 0 && axis->reverse_counts == 0 && axis->drift_counts == 0
  @   && axis->settle_ticks == 0 && axis->max_delta_counts == 0;
  @
  @ logic integer slot_rule(ilk_axis_config_t *axis, integer period_us) =
  @   axis->card >= ILK_CARD_COUNT ? ILK_CONFIG_ERROR_CARD
  @   : ILK_CARD_PWM <= axis->card <= ILK_CARD_HIGH_FREQUENCY ? axis_rule(axis, period_us)
  @   : axis->required > 1         ? ILK_CONFIG_ERROR_FLAG
  @   : !bare(axis) || (axis->card == ILK_CARD_NONE && axis->required != 0) ? ILK_CONFIG_ERROR_EMPTY_SLOT
  @                                : ILK_CONFIG_ERROR_NONE;
  @
  @ predicate some_axis(ilk_config_t *config, integer slots) =
  @   \exists integer slot; 0 <= slot < slots && carries_axis(&config->axis[slot]);
  @
  @ predicate valid_slots(ilk_config_t *config, integer slots) =
  @   \forall integer slot; 0 <= slot < slots ==>
  @     slot_rule(&config->axis[slot], config->period_us) == ILK_CONFIG_ERROR_NONE;
  @
  @ // P13: every rule besides the CRC.
  @ predicate valid_config(ilk_config_t *config) =
  @   config->version == ILK_CONFIG_VERSION && config->size_bytes == sizeof(ilk_config_t)
  @   && system_rule(config) == ILK_CONFIG_ERROR_NONE && valid_slots(config, ILK_SLOTS)
  @   && some_axis(config, ILK_SLOTS);
  @*/

#endif
