/**
 * @file
 * System modes: the only writer of `mode` and of the cause (properties P2, P8, P9, P12).
 */
#ifndef ILK_MODE_H
#define ILK_MODE_H

#include <stdbool.h>

#include "interlock/acsl.h"
#include "interlock/types.h"

/** What the tick has seen that ends MOTION or locks, besides what the state itself tells. */
typedef struct {
  bool new_fault;             /**< an axis faulted in this tick */
  bool required_card_lost;    /**< a required card is lost */
  bool configuration_damaged; /**< a pass over the configuration ended with another CRC */
  uint32_t configuration_crc; /**< the CRC that it found */
} ilk_alarms_t;

/** Enters `mode` and drops what does not survive the change. */
void ilk_mode_enter(ilk_state_t *state, ilk_mode_t mode);

/** LOCKED with this cause, or one more cause in the list of those seen. */
void ilk_mode_lock(ilk_state_t *state, ilk_cause_t cause, uint32_t value);

/** Takes back the consent that the pedal gave: it must be released and pressed anew. */
/*@ requires valid: \valid(state);
  @ assigns  state->pedal_armed, state->pedal_pressed_ticks, state->pedal_released_ticks;
  @ ensures  P9_consent: state->pedal_armed == 0 && state->pedal_pressed_ticks == 0
  @   && state->pedal_released_ticks == 0;
  @*/
void ilk_pedal_disarm(ilk_state_t *state);

/** True while something that locks is there, or the app or the bus is not (RESET: CAUSE_PRESENT). */
/*@ requires readable: \valid_read(state);
  @ assigns  \nothing;
  @ ensures  P8_latch: \result <==> state->estop != 0 || state->bus_bad_ticks != 0 || state->overruns_in_row != 0
  @   || state->config_sound == 0 || state->app_alive == 0;
  @*/
bool ilk_cause_is_present(const ilk_state_t *state);

/** Phase 3: pedal, E-stop, age of the app, overruns. */
void ilk_observe_system(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in);

/** Phase 5: at most one transition per rule of the mode table. */
void ilk_change_mode(const ilk_config_t *config, ilk_state_t *state, const ilk_alarms_t *alarms,
                     const ilk_inputs_t *in);

#endif
