/**
 * @file
 * The invariant of the state, seal apart. The proof `soundness` shows that `ilk_state_is_sound` is this and
 * the seal.
 */
#ifndef ILK_PROOF_SOUND_H
#define ILK_PROOF_SOUND_H

#include <stdbool.h>

#include "interlock/types.h"

/** What an axis may be at all. */
static bool sound_axis_alone(const ilk_axis_t* axis) {
  return (axis->state < ILK_AXIS_COUNT) && (axis->fault < ILK_FAULT_COUNT) && (axis->homed <= 1u) &&
         (axis->driven_direction < ILK_DIRECTION_COUNT) && (axis->stall_direction < ILK_DIRECTION_COUNT) &&
         (axis->reverse_direction < ILK_DIRECTION_COUNT) && (axis->homing_phase < ILK_HOMING_COUNT) &&
         ((axis->state == ILK_AXIS_FAULTED) == (axis->fault != ILK_FAULT_NONE)) &&
         ((axis->state == ILK_AXIS_MOVING) == (axis->lease_ticks != 0u)) &&
         ((axis->state == ILK_AXIS_HOMING) == (axis->homing_phase != ILK_HOMING_NONE)) &&
         ((axis->state != ILK_AXIS_HOMING) || (axis->homed == 0u));
}

/** What an axis may be in this mode. */
static bool sound_axis(const ilk_axis_t* axis, uint32_t mode) {
  const bool in_motion = (axis->state == ILK_AXIS_MOVING) || (axis->state == ILK_AXIS_HOMING);
  const bool enabled = in_motion || (axis->state == ILK_AXIS_ENABLED);
  return sound_axis_alone(axis) && (!in_motion || (mode == ILK_MODE_MOTION)) &&
         (!enabled || (mode == ILK_MODE_READY) || (mode == ILK_MODE_MOTION));
}

/** The system's words. */
static bool sound_system(const ilk_state_t* state) {
  return (state->mode < ILK_MODE_COUNT) && (state->cause < ILK_CAUSE_COUNT) &&
         ((state->mode == ILK_MODE_LOCKED) == (state->cause != ILK_CAUSE_NONE)) &&
         (state->pedal < ILK_PEDAL_COUNT) && (state->config_slice < ILK_SLOTS);
}

#endif
