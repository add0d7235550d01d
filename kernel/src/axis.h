/**
 * @file
 * One axis: its card, what it is seen to do, what it was told to do, and its faults (P5, P6, P7).
 */
#ifndef ILK_AXIS_H
#define ILK_AXIS_H

#include <stdbool.h>

#include "frame.h"
#include "interlock/types.h"

/** Phase 2: whether the frame of this tick is valid; bad ones in a row are counted. */
void ilk_card_observe(const ilk_system_t *system, const ilk_reading_t *reading, bool received,
                      ilk_axis_t *axis);

/** True when its last `bad_frame_limit` frames were bad. */
bool ilk_card_is_lost(const ilk_common_config_t *common, const ilk_axis_t *axis);

/**
 * Phase 4: place and marks follow the frame of this tick, and every rule about motion is judged.
 *
 * @param periods loop periods since the tick before, 1 when no deadline was missed.
 * @return true when the axis faulted in this tick.
 */
bool ilk_axis_observe(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                      const ilk_system_t *system, const ilk_reading_t *reading, uint32_t periods,
                      ilk_axis_t *axis);

/** In the last `rest_ticks` ticks undriven, read validly, and still within `noise_counts`. */
bool ilk_axis_is_at_rest(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** Moved by more than `drift_counts` in the last `rest_ticks` ticks, or not read for so long. */
bool ilk_axis_has_moved(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** Driven as long, or with as much drive, as is allowed without progress. */
bool ilk_axis_has_stalled(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** The switch has read one way for the debounce time. */
bool ilk_switch_is_steady(const ilk_common_config_t *common, const ilk_axis_t *axis, bool triggered);

/** Drops setpoint, lease and homing. */
void ilk_axis_drop_motion(ilk_axis_t *axis);

/** DISABLED, unless FAULTED; it must come to rest anew. */
void ilk_axis_disable(ilk_axis_t *axis);

/** A new press: the budgets of travel and of homing are whole. */
void ilk_axis_begin_press(ilk_axis_t *axis);

/** ENABLED where it stands: marks of motion begin there. */
void ilk_axis_enable(ilk_axis_t *axis);

/** Takes the fault back. A stall that was acknowledged is forgotten, no other fault excuses one. */
void ilk_axis_clear_fault(ilk_axis_t *axis);

/** Phase 7: the axis is driven in this tick. */
void ilk_axis_note_drive(const ilk_command_t *command, ilk_axis_t *axis);

/** Phase 7: the axis stands in the deadband of a live move. */
void ilk_axis_note_arrival(const ilk_axis_config_t *config, ilk_axis_t *axis);

#endif
