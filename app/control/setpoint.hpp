/**
 * @file
 * Where an axis should be and how it should move, in encoder counts and seconds.
 */
#pragma once

namespace interlock {

struct Setpoint {
  double position_counts = 0.0;
  double velocity_counts_per_s = 0.0;
  double acceleration_counts_per_s2 = 0.0;

  bool operator==(const Setpoint&) const = default;
};

}  // namespace interlock
