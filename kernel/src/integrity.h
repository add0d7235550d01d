/**
 * @file
 * Integrity of state and configuration (property P14).
 */
#ifndef ILK_INTEGRITY_H
#define ILK_INTEGRITY_H

#include <stdbool.h>

#include "interlock/types.h"
#include "mode.h"

/** The digest of all words is the one that was written. */
bool ilk_state_is_sealed(const ilk_state_t *state);

/** Phase 1: puts a new state in place of a damaged one, and looks for damage in the configuration. */
ilk_alarms_t ilk_integrity_check(const ilk_config_t *config, ilk_state_t *state);

/** Phase 8: writes the seal that the next tick looks for. */
void ilk_state_seal(ilk_state_t *state);

#endif
