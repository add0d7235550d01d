#include "motion/time_scaling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace interlock {
namespace {

// The largest magnitudes of a rise to 1 that takes a second: of its first derivative, of its second, and of
// the product of the rise and its first, 0.9902.
constexpr double steepest = 1.5;
constexpr double sharpest = 6.0;
constexpr double weightiest = 0.991;
constexpr double rounding = 1.0 + 1e-4;

double pace_of(double share) noexcept { return share * share * (3.0 - 2.0 * share); }

/** Of a rise that takes a second, what has passed at that share of it; half a second in all. */
double passed_of(double share) noexcept { return share * share * share * (1.0 - share / 2); }

double slope_of(double share) noexcept { return 6.0 * share * (1.0 - share); }

}  // namespace

TimeScaling::TimeScaling(double way_s, double peak, double rise_s, double fall_s) noexcept
    : way_s_(way_s), rise_s_(rise_s), fall_s_(fall_s), peak_(peak) {
  const double changing_s = (rise_s + fall_s) / 2;
  if (way_s < peak * changing_s) {
    peak_ = way_s / changing_s;
  } else {
    cruise_s_ = way_s / peak - changing_s;
  }
}

// Followed at the pace p, a path with velocity v, acceleration a and jerk j has the acceleration
// a p^2 + v p' and the jerk j p^3 + 3 a p p' + v p''. A change that takes T up to P is slow enough when
//   a P^2 + 1.5 v P / T <= A  and  j P^3 + 3 (0.991) a P^2 / T + 6 v P / T^2 <= J.
double TimeScaling::change_s(const RateLimits& top, const RateLimits& limits, double pace) noexcept {
  const double velocity = top.velocity * pace;
  const double acceleration = top.acceleration * pace * pace;
  const double acceleration_left = limits.acceleration - acceleration;
  const double jerk_left = limits.jerk - top.jerk * pace * pace * pace;
  if (!(acceleration_left > 0.0) || !(jerk_left > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  const double half = 3 * weightiest * acceleration / 2;
  const double by_jerk = (half + std::sqrt(half * half + sharpest * velocity * jerk_left)) / jerk_left;
  return std::max(steepest * velocity / acceleration_left, by_jerk);
}

bool TimeScaling::is_rest(const MotionState& there, const MotionState& tick_away,
                          const RateLimits& limits) noexcept {
  const double velocity = std::max(std::abs(there.velocity), std::abs(tick_away.velocity));
  const double acceleration = std::max(std::abs(there.acceleration), std::abs(tick_away.acceleration));
  return velocity <= limits.acceleration * tick_s * rounding &&
         acceleration <= limits.jerk * tick_s * rounding;
}

double TimeScaling::passed_s(double time_s) const noexcept {
  if (time_s >= duration_s()) {
    return way_s_;
  }
  if (time_s < rise_s_) {
    return peak_ * rise_s_ * passed_of(time_s / rise_s_);
  }
  if (time_s < rise_s_ + cruise_s_) {
    return peak_ * (time_s - rise_s_ / 2);
  }
  return way_s_ - peak_ * fall_s_ * passed_of((duration_s() - time_s) / fall_s_);
}

double TimeScaling::pace(double time_s) const noexcept {
  if (time_s >= duration_s()) {
    return 0.0;
  }
  if (time_s < rise_s_) {
    return peak_ * pace_of(time_s / rise_s_);
  }
  return time_s < rise_s_ + cruise_s_ ? peak_ : peak_ * pace_of((duration_s() - time_s) / fall_s_);
}

double TimeScaling::pace_per_s(double time_s) const noexcept {
  if (time_s < rise_s_) {
    return peak_ * slope_of(time_s / rise_s_) / rise_s_;
  }
  if (time_s < rise_s_ + cruise_s_ || time_s >= duration_s()) {
    return 0.0;
  }
  return -peak_ * slope_of((duration_s() - time_s) / fall_s_) / fall_s_;
}

}  // namespace interlock
