#include <algorithm>
#include <cmath>

#include "trajectory/piecewise_motion.hpp"

namespace interlock {

CubicSegment CubicSegment::between(double from, double from_velocity, double to, double to_velocity,
                                   double duration_s) noexcept {
  const double mean_velocity = (to - from) / duration_s;
  const double acceleration = (6 * mean_velocity - 4 * from_velocity - 2 * to_velocity) / duration_s;
  const double jerk = 6 * (from_velocity + to_velocity - 2 * mean_velocity) / (duration_s * duration_s);
  return {{from, from_velocity, acceleration}, jerk};
}

CubicSegment CubicSegment::line(double from, double to, double duration_s) noexcept {
  return {{from, (to - from) / duration_s, 0.0}, 0.0};
}

MotionState CubicSegment::after(double time_s) const noexcept {
  const auto& [position, velocity, acceleration] = start;
  return {position + time_s * (velocity + time_s * (acceleration / 2 + time_s * jerk / 6)),
          velocity + time_s * (acceleration + time_s * jerk / 2), acceleration + time_s * jerk};
}

void CubicSegment::widen(PositionRange& range, double duration_s) const noexcept {
  interlock::widen(range, start.position);
  const auto& [position, velocity, acceleration] = start;
  const double discriminant = acceleration * acceleration - 2 * jerk * velocity;
  if (discriminant < 0) {
    return;
  }
  // Both roots of the velocity without cancellation. A root that does not exist is infinite or no number, and
  // fails the comparison.
  const double sum = -(acceleration + std::copysign(std::sqrt(discriminant), acceleration));
  for (const double turn_s : {sum / jerk, 2 * velocity / sum}) {
    if (turn_s > 0 && turn_s < duration_s) {
      interlock::widen(range, after(turn_s).position);
    }
  }
}

double CubicSegment::top_speed(double duration_s) const noexcept {
  const double fastest = std::max(std::abs(start.velocity), std::abs(after(duration_s).velocity));
  const double bend_s = -start.acceleration / jerk;
  return bend_s > 0 && bend_s < duration_s ? std::max(fastest, std::abs(after(bend_s).velocity)) : fastest;
}

void widen(PositionRange& range, double position) noexcept {
  range.lowest = std::min(range.lowest, position);
  range.highest = std::max(range.highest, position);
}

}  // namespace interlock
