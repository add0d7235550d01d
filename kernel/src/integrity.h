/**
 * @file
 * Integrity of state and configuration (property P14).
 */
#ifndef ILK_INTEGRITY_H
#define ILK_INTEGRITY_H

#include <stdbool.h>

#include "interlock/types.h"

/** Writes the seal that `ilk_state_is_sound` looks for. */
void ilk_state_seal(ilk_state_t *state);

/** True when the seal matches and the fields agree with each other: the invariant of every step. */
bool ilk_state_is_sound(const ilk_state_t *state);

/** Puts a state in place that owes nothing to the one before: LOCKED, positions unknown. */
void ilk_state_rebuild(ilk_state_t *state, const ilk_config_t *config, ilk_cause_t cause, uint32_t value);

/** What a look at the configuration found. */
typedef struct {
  bool damaged; /**< a pass ended with another CRC-32 than at start */
  uint32_t crc; /**< CRC-32 that the pass found; 0 before the end of a pass */
} ilk_config_check_t;

/** Adds the next slice of the configuration to the running CRC-32, and judges at the end of a pass. */
ilk_config_check_t ilk_config_check_slice(const ilk_config_t *config, ilk_state_t *state);

#endif
