/**
 * @file
 * Facts that follow from the configuration alone.
 */
#ifndef ILK_CONFIG_H
#define ILK_CONFIG_H

#include <stdint.h>

#include "crc32.h"
#include "interlock/acsl_config.h"
#include "interlock/types.h"

/*@ // P14: every word of an axis, then every word of the system, in the CRC.
  @ logic integer axis_crc(integer crc, ilk_axis_config_t *axis) =
  @   crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(
  @     crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(
  @     crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc, axis->card), axis->required),
  @     axis->motor_direction), axis->direction_correction), axis->limit_side), (uint32_t)axis->min_counts),
  @     (uint32_t)axis->max_counts), (uint32_t)axis->home_offset_counts), axis->coast_counts),
  @     axis->backlash_counts), axis->noise_counts), axis->deadband_counts), axis->max_drive),
  @     axis->unhomed_max_drive), axis->max_amplitude), axis->unhomed_travel_counts), axis->home_drive),
  @     axis->home_amplitude), axis->home_travel_counts), axis->home_backoff_counts),
  @     axis->home_timeout_ticks), axis->home_rest_ticks), axis->home_speed_counts_per_s),
  @     axis->stall_ticks), axis->stall_min_counts), axis->reverse_counts), axis->drift_counts),
  @     axis->settle_ticks), axis->max_delta_counts);
  @
  @ logic integer system_crc(integer crc, ilk_config_t *config) =
  @   crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc_step(crc,
  @     config->version), config->size_bytes), config->period_us), config->pedal_channels),
  @     config->app_timeout_ticks), config->lease_max_ticks), config->pedal_debounce_ticks),
  @     config->pedal_disagree_ticks), config->bad_frame_limit), config->overrun_limit);
  @
  @ // The system's words, then the first axes.
  @ logic integer crc_of_axes(ilk_config_t *config, integer slots) =
  @   slots <= 0 ? system_crc(0xffffffff, config)
  @              : axis_crc(crc_of_axes(config, slots - 1), &config->axis[slots - 1]);
  @
  @ logic integer config_crc(ilk_config_t *config) = crc_of_axes(config, ILK_SLOTS) ^ 0xffffffff;
  @*/

/** The running CRC-32 after one axis' words. */
/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P14_every_word: \result == axis_crc(crc, axis);
  @*/
uint32_t ilk_crc_axis_config(uint32_t crc, const ilk_axis_config_t *axis);

/** The running CRC-32 after the system words that come before the axes. */
/*@ requires readable: \valid_read(config);
  @ assigns  \nothing;
  @ ensures  P14_every_word: \result == system_crc(crc, config);
  @*/
uint32_t ilk_crc_system_config(uint32_t crc, const ilk_config_t *config);

/** Largest drive that the card's word can carry; 0 for a slot without a motor. */
/*@ assigns \nothing;
  @ ensures exact: \result == card_drive(card);
  @*/
uint32_t ilk_card_max_drive(uint32_t card);

#endif
