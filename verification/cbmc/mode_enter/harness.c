/**
 * @file
 * What entering a mode does to the system and to each axis.
 */
#include "axis_effects.h"
#include "mode.h"
#include "proof.h"
#include "sound.h"

static ilk_state_t state;

static void show_slot(const ilk_axis_t* before, const ilk_axis_t* after, uint32_t mode_before,
                      uint32_t mode) {
  const ilk_axis_t expected = after_entering(mode, *before);
  const bool ready_or_motion = (mode == ILK_MODE_READY) || (mode == ILK_MODE_MOTION);
  const bool suits = ready_or_motion || (mode == ILK_MODE_LOCKED);
  show_same_axis(after, &expected);
  SHOW(!suits || !sound_axis(before, mode_before) || sound_axis(after, mode), "P15: the invariant is kept");
  SHOW((after->lease_ticks == 0u) && (after->state != ILK_AXIS_MOVING) && (after->state != ILK_AXIS_HOMING),
       "P12: after a change of mode nothing moves");
  SHOW((before->state != ILK_AXIS_FAULTED) || (after->state == ILK_AXIS_FAULTED),
       "P8: no mode clears a fault");
}

static void show_entry(uint32_t mode) {
  const ilk_state_t before = state;
  ilk_state_t expected = before;
  expected.mode = mode;
  expected.pedal_armed = 0u;
  expected.pedal_pressed_ticks = 0u;
  expected.pedal_released_ticks = 0u;
  ilk_mode_enter(&state, (ilk_mode_t)mode);
  show_same_system(&state, &expected);
  show_slot(&before.axis[0], &state.axis[0], before.mode, mode);
  show_slot(&before.axis[4], &state.axis[4], before.mode, mode);
  show_slot(&before.axis[9], &state.axis[9], before.mode, mode);
  GOAL(goal_disabled,
       (before.axis[4].state == ILK_AXIS_MOVING) && (state.axis[4].state == ILK_AXIS_DISABLED));
  GOAL(goal_enabled, (before.axis[4].state == ILK_AXIS_HOMING) && (state.axis[4].state == ILK_AXIS_ENABLED));
  GOAL(goal_press_begins,
       (before.axis[4].press_travel_counts != 0) && (state.axis[4].press_travel_counts == 0));
  GOAL(never_armed, state.pedal_armed != 0u);
}

void harness(void) {
  ilk_state_t any_state;
  uint32_t mode;
  state = any_state;
  if (mode == ILK_MODE_LOCKED) {
    show_entry(ILK_MODE_LOCKED);
  } else if (mode == ILK_MODE_READY) {
    show_entry(ILK_MODE_READY);
  } else {
    show_entry(ILK_MODE_MOTION);
  }
}
