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

/**
 * Adds the next slice of the configuration to the running CRC-32, and judges at the end of a pass.
 *
 * @return false when a pass ended with another CRC than at start.
 */
bool ilk_config_check_slice(const ilk_config_t *config, ilk_state_t *state);

#endif
