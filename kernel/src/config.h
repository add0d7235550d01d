/**
 * @file
 * Facts that follow from the configuration alone.
 */
#ifndef ILK_CONFIG_H
#define ILK_CONFIG_H

#include <stdint.h>

/** Largest drive that the card's word can carry; 0 for a slot without a motor. */
uint32_t ilk_card_max_drive(uint32_t card);

#endif
