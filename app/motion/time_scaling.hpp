/**
 * @file
 * How the time of a trajectory goes by while axes follow it.
 *
 * Axes at rest cannot leap onto a trajectory that is in motion where it is begun, nor stop at once where its
 * rows end in motion. So its time comes up to that of the clock, and goes down before the last row, as slowly
 * as the axes need: every position is the trajectory's, only later, and at its last row all axes are at rest.
 *
 * The pace is the time of the trajectory that passes in a second. It rises as 3 s^2 - 2 s^3 of the share s of
 * its duration, is 1, and falls in the same way. What is left of a trajectory may be too short to come up to
 * 1; then rise and fall last as long, and the pace stays below.
 */
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "robot/motion_rates.hpp"
#include "trajectory/timed_trajectory.hpp"

namespace interlock {

class TimeScaling {
 public:
  /** Nothing is left to go. */
  TimeScaling() = default;

  /** For `way_s` of a trajectory, with so long a rise and a fall; none is negative. */
  TimeScaling(double way_s, double rise_s, double fall_s) noexcept;

  /** Least time in which the pace rises to 1 for an axis with that speed on the trajectory. */
  static double change_s(double speed, const RateLimits& limits) noexcept;

  /** Until the whole way has passed. */
  [[nodiscard]] double duration_s() const noexcept { return rise_s_ + cruise_s_ + fall_s_; }

  /** Time of the trajectory that has passed so long after the beginning. */
  [[nodiscard]] double passed_s(double time_s) const noexcept;
  /** How fast the trajectory's time runs then, 1 being as stated. */
  [[nodiscard]] double pace(double time_s) const noexcept;
  /** How fast the pace changes then. */
  [[nodiscard]] double pace_per_s(double time_s) const noexcept;

 private:
  double way_s_ = 0.0;
  double rise_s_ = 0.0;
  double fall_s_ = 0.0;
  double peak_ = 1.0;
  double cruise_s_ = 0.0; /**< at the peak */
};

/**
 * The pace from `from_s` to the end of a trajectory, for axes at rest there and at its last row.
 * `limits_of(slot)` are the rates of an axis in its unit.
 */
template <typename LimitsOf>
TimeScaling pace_along(const TimedTrajectory& trajectory, double from_s, const LimitsOf& limits_of) noexcept {
  double rise_s = 0.0;
  double fall_s = 0.0;
  for (std::size_t axis = 0; axis < trajectory.axes().size(); ++axis) {
    const RateLimits limits = limits_of(trajectory.axes()[axis].slot);
    const double begin_speed = std::abs(trajectory.at(axis, from_s).velocity);
    rise_s = std::max(rise_s, TimeScaling::change_s(begin_speed, limits));
    fall_s = std::max(fall_s, TimeScaling::change_s(std::abs(trajectory.last_velocity(axis)), limits));
  }
  return {std::max(0.0, trajectory.end_s() - from_s), rise_s, fall_s};
}

}  // namespace interlock
