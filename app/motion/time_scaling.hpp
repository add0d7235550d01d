/**
 * @file
 * How the time of a trajectory goes by while axes follow it.
 *
 * Axes at rest cannot leap onto a trajectory that is in motion where it is begun, nor stop at once where its
 * rows end in motion. So its time comes up to that of the clock, and goes down before the last row, as slowly
 * as the axes need: every position is the trajectory's, only later, and at its last row all axes are at rest.
 *
 * The pace is the time of the trajectory that passes in a second. It rises as 3 s^2 - 2 s^3 of the share s of
 * its duration to its peak, stays, and falls in the same way. What is left of a trajectory may be too short
 * to come up to it; then rise and fall last as long, and the pace stays below.
 *
 * The peak is 1, and there is neither rise nor fall, for a trajectory that is at rest at both ends. Else the
 * peak is below 1 where the trajectory leaves too little of an axis' acceleration and jerk for the change.
 */
#pragma once

#include <cstddef>
#include <cstdint>

#include "robot/motion_rates.hpp"
#include "trajectory/timed_trajectory.hpp"

namespace interlock {

class TimeScaling {
 public:
  /** Nothing is left to go. */
  TimeScaling() = default;

  /** For `way_s` of a trajectory, with so long a rise to `peak`, which is above 0, and a fall; none is
   * negative. */
  TimeScaling(double way_s, double peak, double rise_s, double fall_s) noexcept;

  /**
   * Least time of a change between rest and that pace, for a trajectory whose rates are nowhere above `top`:
   * such that velocity, acceleration and jerk keep to `limits` all the while. Infinite when nothing of them
   * is left for it.
   */
  static double change_s(const RateLimits& top, const RateLimits& limits, double pace) noexcept;

  static constexpr double tick_s = 1e-3;

  /** Whether an axis may leap between rest and an end of a trajectory: by what its limits make up in
   * a tick, there and a tick into the trajectory, where a walk has its first point and its last. */
  static bool is_rest(const MotionState& there, const MotionState& tick_away,
                      const RateLimits& limits) noexcept;

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
  const auto& axes = trajectory.axes();
  const double way_s = std::max(0.0, trajectory.end_s() - from_s);
  bool rises = false;
  bool falls = false;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const RateLimits limits = limits_of(axes[axis].slot);
    const double begun_s = std::min(from_s + TimeScaling::tick_s, trajectory.end_s());
    const double ending_s = std::max(trajectory.end_s() - TimeScaling::tick_s, from_s);
    rises = rises || !TimeScaling::is_rest(trajectory.at(axis, from_s), trajectory.at(axis, begun_s), limits);
    falls = falls || !TimeScaling::is_rest(trajectory.end(axis), trajectory.at(axis, ending_s), limits);
  }
  TimeScaling shortest(way_s, 1.0, 0.0, 0.0);
  if (!rises && !falls) {
    return shortest;
  }
  // Nearly the whole pace costs little time, and leaves some of every limit.
  constexpr std::array peaks{0.95, 0.98, 0.99, 1.0};
  bool is_first = true;
  for (const double peak : peaks) {
    double change_s = 0.0;
    for (const TrajectoryAxis& axis : axes) {
      change_s = std::max(change_s, TimeScaling::change_s(axis.top, limits_of(axis.slot), peak));
    }
    const TimeScaling scaling(way_s, peak, rises ? change_s : 0.0, falls ? change_s : 0.0);
    if (is_first || scaling.duration_s() < shortest.duration_s()) {
      shortest = scaling;
      is_first = false;
    }
  }
  return shortest;
}

}  // namespace interlock
