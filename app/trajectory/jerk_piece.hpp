/**
 * @file
 * Motion of constant jerk: a cubic in time, of which trajectories and plans are put together.
 */
#pragma once

#include "trajectory/motion_state.hpp"

namespace interlock {

struct JerkPiece {
  MotionState start;
  double jerk = 0.0;

  /** The cubic from one position and velocity to others (Hermite); `duration_s` is above 0. */
  static JerkPiece between(double from, double from_velocity, double to, double to_velocity,
                           double duration_s) noexcept;

  /** The straight line from one position to another; `duration_s` is above 0. */
  static JerkPiece line(double from, double to, double duration_s) noexcept;

  /** The state that long after the start. */
  [[nodiscard]] MotionState after(double time_s) const noexcept;

  /** Widens `range` to the start and to where the motion turns; its end is the start of the next piece. */
  void widen(PositionRange& range, double duration_s) const noexcept;

  /** Largest speed from start to end, both in it. */
  [[nodiscard]] double top_speed(double duration_s) const noexcept;
};

/** Widens `range` to hold `position`. */
void widen(PositionRange& range, double position) noexcept;

}  // namespace interlock
