/**
 * @file
 * Asks Ruckig for a plan in numbers that suit its arithmetic, and once more where it finds none though there
 * is one.
 *
 * Ruckig 0.19 compares with fixed tolerances, such as 1e-12 of speed, that suit numbers around 1. So each
 * axis is given to it with lengths from where the axis is now, in a unit close to its velocity limit times a
 * second. The unit is a power of two: no number is rounded.
 */
#pragma once

#include <algorithm>
#include <cmath>
#include <ruckig/ruckig.hpp>

#include "robot/motion_rates.hpp"
#include "trajectory/piecewise_motion.hpp"
#include "trajectory/synchronised_plan.hpp"

namespace interlock {

/** The length unit in which Ruckig plans an axis, and where it counts from. */
struct RuckigUnit {
  double origin = 0.0;
  double length = 1.0;

  /** A state of Ruckig in the units of the axis. */
  [[nodiscard]] MotionState from_ruckig(double position, double velocity,
                                        double acceleration) const noexcept {
    return {origin + position * length, velocity * length, acceleration * length};
  }
};

/** The state at rest, at the target or at a limit that it exceeds, where a rounding error alone keeps it
 * away. */
inline MotionState without_rounding(MotionState now, double target, const RateLimits& limits) noexcept {
  const double slight_speed = limits.acceleration * rounding_s;
  const double slight_acceleration = limits.jerk * rounding_s;
  if (std::abs(now.acceleration) <= slight_acceleration) {
    now.acceleration = 0.0;
  } else if (std::abs(now.acceleration) <= limits.acceleration + slight_acceleration) {
    now.acceleration = std::clamp(now.acceleration, -limits.acceleration, limits.acceleration);
  }
  // Where the velocity leads when the acceleration ends as soon as it may.
  const double rise = now.acceleration * std::abs(now.acceleration) / (2 * limits.jerk);
  const double coming = now.velocity + rise;
  if (std::abs(now.velocity) <= slight_speed && now.acceleration == 0.0) {
    now.velocity = 0.0;
  } else if (std::abs(coming) <= limits.velocity + slight_speed) {
    now.velocity += std::clamp(coming, -limits.velocity, limits.velocity) - coming;
  }
  if (now.velocity == 0.0 && now.acceleration == 0.0 &&
      std::abs(now.position - target) <= limits.velocity * rounding_s) {
    now.position = target;
  }
  return now;
}

/** Gives Ruckig one axis; `limits` are above 0, all numbers finite. */
template <typename Input>
RuckigUnit put_axis(Input& input, std::size_t place, const MotionState& exact, double target,
                    const RateLimits& limits) noexcept {
  const MotionState now = without_rounding(exact, target, limits);
  const RuckigUnit unit{now.position, std::exp2(std::round(std::log2(limits.velocity)))};
  input.current_position[place] = 0.0;
  input.current_velocity[place] = now.velocity / unit.length;
  input.current_acceleration[place] = now.acceleration / unit.length;
  input.target_position[place] = (target - now.position) / unit.length;
  input.max_velocity[place] = limits.velocity / unit.length;
  input.max_acceleration[place] = limits.acceleration / unit.length;
  input.max_jerk[place] = limits.jerk / unit.length;
  return unit;
}

/**
 * What Ruckig says of the input. Where two shapes of the fastest motion meet, as at a distance of exactly
 * 2 a³/j² from rest to rest, Ruckig at times takes neither for valid (error -110). A jerk smaller by a
 * millionth leads around it, and is within the limits. Where it finds no common duration of the axes (error
 * -111), some microseconds more do.
 */
template <typename Planner, typename Input, typename Output>
ruckig::Result calculate(Planner& planner, Input& input, Output& output) {
  constexpr int most_attempts = 6;
  constexpr double less = 1.0 - 1e-6;
  double more_s = 1e-6;
  ruckig::Result result = planner.calculate(input, output);
  for (int attempt = 1; attempt < most_attempts && (result == ruckig::ErrorExecutionTimeCalculation ||
                                                    result == ruckig::ErrorSynchronizationCalculation);
       ++attempt) {
    for (double& jerk : input.max_jerk) {
      jerk *= less;
    }
    if (result == ruckig::ErrorSynchronizationCalculation) {
      input.minimum_duration = std::max(input.minimum_duration.value_or(0.0), output.get_duration() + more_s);
      more_s *= 4;
    }
    result = planner.calculate(input, output);
  }
  return result;
}

}  // namespace interlock
