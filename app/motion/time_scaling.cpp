#include "motion/time_scaling.hpp"

namespace interlock {
namespace {

/** Largest rise of the pace a second, and of that, for a rise of one second. */
constexpr double steepest = 1.5;
constexpr double sharpest = 6.0;

double pace_of(double share) noexcept { return share * share * (3.0 - 2.0 * share); }

/** Of a rise that takes a second, what has passed at that share of it; half a second in all. */
double passed_of(double share) noexcept { return share * share * share * (1.0 - share / 2); }

double slope_of(double share) noexcept { return 6.0 * share * (1.0 - share); }

}  // namespace

TimeScaling::TimeScaling(double way_s, double rise_s, double fall_s) noexcept
    : way_s_(way_s), rise_s_(rise_s), fall_s_(fall_s) {
  const double changing_s = (rise_s + fall_s) / 2;
  if (way_s < changing_s) {
    peak_ = way_s / changing_s;
  } else {
    cruise_s_ = way_s - changing_s;
  }
}

double TimeScaling::change_s(double speed, const RateLimits& limits) noexcept {
  return std::max(steepest * speed / limits.acceleration, std::sqrt(sharpest * speed / limits.jerk));
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
