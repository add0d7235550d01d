/**
 * @file
 * Facts that follow from the configuration alone.
 */
#ifndef ILK_CONFIG_H
#define ILK_CONFIG_H

#include <stdint.h>

#include "interlock/acsl.h"
#include "interlock/types.h"

/** The running CRC-32 after one axis' words. */
uint32_t ilk_crc_axis_config(uint32_t crc, const ilk_axis_config_t *axis);

/** The running CRC-32 after the system words that come before the axes. */
uint32_t ilk_crc_system_config(uint32_t crc, const ilk_config_t *config);

/** Largest drive that the card's word can carry; 0 for a slot without a motor. */
/*@ assigns \nothing;
  @ ensures exact: \result == card_drive(card);
  @*/
uint32_t ilk_card_max_drive(uint32_t card);

#endif
