/**
 * @file
 * System modes: the only writer of `mode`, of the cause and of the consent (P2, P8, P9, P12).
 */
#ifndef ILK_MODE_H
#define ILK_MODE_H

#include <stdbool.h>

#include "interlock/types.h"

/** What the tick has seen that ends MOTION or locks, besides what the state itself tells. */
typedef struct {
  bool new_fault;             /**< an axis faulted in this tick */
  bool required_card_lost;    /**< a required card is lost */
  bool configuration_damaged; /**< a pass ended with another CRC, or what P1 to P3 rest on changed */
  uint32_t configuration_crc; /**< the CRC that the pass found; 0 within a pass */
} ilk_alarms_t;

/** Phase 3: pedal, E-stop, age of the app, overruns. */
void ilk_system_observe(const ilk_common_config_t *common, const ilk_inputs_t *in, ilk_system_t *system);

/** Phase 5: at most one transition per rule of the mode table. */
void ilk_mode_decide(const ilk_config_t *config, const ilk_inputs_t *in, const ilk_alarms_t *alarms,
                     ilk_state_t *state);

/** Enters `mode` and drops what does not survive the change. */
void ilk_mode_enter(ilk_mode_t mode, uint32_t boot_nonce, ilk_state_t *state);

/** RESET was accepted: READY, and no cause is remembered. */
void ilk_mode_unlock(ilk_state_t *state);

/** Takes back the consent that the pedal gave: it must be released and pressed anew. */
void ilk_pedal_disarm(ilk_system_t *system);

/** True while something that locks is there, or the app or the bus is not (RESET: CAUSE_PRESENT). */
bool ilk_cause_is_present(const ilk_state_t *state);

/** Power is on in READY and MOTION only. */
bool ilk_power_is_on(const ilk_system_t *system);

#endif
