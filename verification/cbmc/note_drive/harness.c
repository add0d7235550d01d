/**
 * @file
 * What an axis remembers of a driven tick and of an arrival, and P5 by induction over both ends of a tick.
 */
#include "axis.h"
#include "axis_effects.h"
#include "counts.h"
#include "proof.h"
#include "sound.h"

/** After a driven tick: marks start anew when the direction changes or the axis had settled. */
static ilk_axis_t expect_driven(const ilk_axis_config_t* config, ilk_axis_t axis, uint32_t direction) {
  const bool settled = axis.undriven_ticks >= config->settle_ticks;
  if (settled || (direction != axis.reverse_direction)) {
    axis.reverse_mark_raw = axis.raw;
  }
  if (settled || (direction != axis.stall_direction)) {
    axis.stall_mark_raw = axis.raw;
  }
  axis.reverse_direction = direction;
  axis.stall_direction = direction;
  axis.driven_direction = direction;
  axis.stall_driven_ticks = (uint32_t)one_more(axis.stall_driven_ticks, UINT32_MAX);
  return axis;
}

/** After an arrival: only at a setpoint that did not change while the count ran. */
static ilk_axis_t expect_arrived(ilk_axis_t axis) {
  if (axis.setpoint_changed == 0u) {
    axis.stall_driven_ticks = 0u;
    axis.stall_mark_raw = axis.raw;
  }
  return axis;
}

void harness(void) {
  ilk_axis_config_t config;
  ilk_axis_t axis;
  uint32_t mode;
  uint32_t direction;
  uint32_t bits;
  const bool drives = (bits & 1u) != 0u;
  GIVEN(sound_axis(&axis, mode) && (direction < ILK_DIRECTION_COUNT));

  const ilk_axis_t before = axis;
  ilk_axis_t expected = before;
  if (drives) {
    expected = expect_driven(&config, before, direction);
    ilk_axis_note_drive(&config, &axis, direction);
  } else {
    expected = expect_arrived(before);
    ilk_axis_note_arrival(&axis);
  }
  show_same_axis(&axis, &expected);
  SHOW(sound_axis(&axis, mode), "P15: the invariant is kept");
  SHOW(!drives || (before.stall_driven_ticks >= config.stall_ticks) ||
           (axis.stall_driven_ticks <= config.stall_ticks),
       "P5: the tick that may reach stall_ticks is the last driven one");

  GOAL(goal_direction_changes, drives && (before.stall_mark_raw != axis.stall_mark_raw));
  GOAL(goal_arrival_clears, !drives && (before.stall_driven_ticks > axis.stall_driven_ticks));
  GOAL(goal_arrival_at_another_setpoint,
       !drives && (before.stall_driven_ticks > 0u) && (before.stall_driven_ticks == axis.stall_driven_ticks));
  GOAL(never_driven_without_counting, drives && (axis.stall_driven_ticks == 0u));
}
