#include "steering/cooperative_insertion.hpp"

#include <algorithm>

#include "kinematics/domain.hpp"

namespace interlock {

KinematicsResult<void> check_cooperative(const CooperativeParameters& parameters) noexcept {
  return check_range("deadband_n", parameters.deadband_n, 0.0, 100.0)
      .and_then([&] { return check_range("gain_mm_s_n", parameters.gain_mm_s_n, 0.0, 100.0); })
      .and_then([&] { return check_range("fastest_mm_s", parameters.fastest_mm_s, 0.0, 100.0); })
      .and_then([&] { return check_range("approach_per_s", parameters.approach_per_s, 0.0, 1000.0); });
}

KinematicsResult<double> cooperative_speed(const CooperativeParameters& parameters, double hand_force_n,
                                           bool pedal, double left_mm) noexcept {
  return check_cooperative(parameters)
      .and_then([&] { return check_range("hand_force_n", hand_force_n, -1000.0, 1000.0); })
      .and_then([&] { return check_range("left_mm", left_mm, -length_limit_mm, length_limit_mm); })
      .map([&] {
        const double asked = parameters.gain_mm_s_n * (hand_force_n - parameters.deadband_n);
        const double allowed = std::min(parameters.fastest_mm_s, parameters.approach_per_s * left_mm);
        return pedal ? std::max(0.0, std::min(asked, allowed)) : 0.0;
      });
}

}  // namespace interlock
