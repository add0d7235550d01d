/**
 * @file
 * One axis: what its card says, what it did, what that means (properties P5, P6, P7).
 */
#ifndef ILK_AXIS_H
#define ILK_AXIS_H

#include <stdbool.h>
#include <stdint.h>

#include "frame.h"
#include "interlock/types.h"

/** Ends a move or homing; the axis stays enabled. */
void ilk_axis_drop_motion(ilk_axis_t *axis);

/** Takes the axis out of motion. A FAULTED axis stays FAULTED. */
void ilk_axis_disable(ilk_axis_t *axis);

/** True when the card has given `bad_frame_limit` bad frames in a row. */
bool ilk_card_is_lost(const ilk_config_t *config, const ilk_axis_t *axis);

/** Phase 2: judges a card's frame and counts bad ones. */
void ilk_observe_card(ilk_axis_t *axis, const ilk_reading_t *reading, bool received, uint32_t tick);

/** Phase 4: a card without an axis is seen or lost, nothing more. */
void ilk_observe_sensor(const ilk_config_t *config, ilk_axis_t *axis);

/**
 * Phase 4: follows the axis and judges what it did since its last valid frame.
 *
 * @return true when the axis faulted in this tick.
 */
bool ilk_observe_axis(const ilk_config_t *config, const ilk_axis_config_t *axis_config, ilk_axis_t *axis,
                      const ilk_reading_t *reading, uint32_t tick);

/** Notes that the axis is driven in this tick. */
void ilk_axis_note_drive(const ilk_axis_config_t *config, ilk_axis_t *axis, uint32_t direction);

/** Notes that the axis stands in the deadband of its setpoint. */
void ilk_axis_note_arrival(ilk_axis_t *axis);

#endif
