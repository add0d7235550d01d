#include "trajectory/trapezoid_profile.hpp"

#include <algorithm>
#include <cmath>

namespace interlock {
namespace {

TrajectoryResult<void> check(double from, double to, const TrapezoidRules& rules) {
  return check_within("from", from, -position_limit, position_limit)
      .and_then([&] { return check_within("to", to, -position_limit, position_limit); })
      .and_then(
          [&] { return check_within("cruise_velocity", rules.cruise_velocity, smallest_rate, largest_rate); })
      .and_then([&] {
        return check_within("max_acceleration", rules.max_acceleration, smallest_rate, largest_rate);
      })
      .and_then([&] { return check_within("ramp_share", rules.ramp_share, smallest_ramp_share, 0.5); })
      .and_then([&] {
        return check_within("floor_velocity", rules.floor_velocity, smallest_rate, rules.cruise_velocity);
      });
}

}  // namespace

TrajectoryResult<TrapezoidProfile> TrapezoidProfile::create(double from, double to,
                                                            const TrapezoidRules& rules) {
  return check(from, to, rules).map([&] { return TrapezoidProfile(from, to, rules); });
}

TrapezoidProfile::TrapezoidProfile(double from, double to, const TrapezoidRules& rules) noexcept
    : from_(from), to_(to), way_(std::abs(to - from)), floor_(rules.floor_velocity) {
  const double share = rules.ramp_share * way_;
  const double needed = rules.cruise_velocity * rules.cruise_velocity / rules.max_acceleration;
  ramp_ = std::min(std::max(share, needed), way_ / 2);
  peak_ = std::clamp(std::sqrt(rules.max_acceleration * ramp_), floor_, rules.cruise_velocity);
  floor_end_s_ = ramp_ / peak_;
  ramp_end_s_ = floor_end_s_ * (1 + std::log(peak_ / floor_));
  duration_s_ = 2 * ramp_end_s_ + (way_ - 2 * ramp_) / peak_;
}

MotionState TrapezoidProfile::at(double time_s) const noexcept {
  if (time_s >= duration_s_) {
    return {to_, 0.0, 0.0};
  }
  if (!(time_s >= 0.0)) {
    return {from_, 0.0, 0.0};
  }
  const double forward = to_ >= from_ ? 1.0 : -1.0;
  if (time_s <= duration_s_ / 2) {
    const MotionState rising = first_half(time_s);
    return {from_ + forward * rising.position, forward * rising.velocity, forward * rising.acceleration};
  }
  const MotionState mirrored = first_half(duration_s_ - time_s);
  return {to_ - forward * mirrored.position, forward * mirrored.velocity, -forward * mirrored.acceleration};
}

MotionState TrapezoidProfile::first_half(double time_s) const noexcept {
  if (time_s < floor_end_s_) {
    return {floor_ * time_s, floor_, 0.0};
  }
  if (time_s < ramp_end_s_) {
    const double rate = peak_ / ramp_;
    const double velocity = floor_ * std::exp((time_s - floor_end_s_) * rate);
    return {velocity / rate, velocity, velocity * rate};
  }
  return {ramp_ + peak_ * (time_s - ramp_end_s_), peak_, 0.0};
}

}  // namespace interlock
