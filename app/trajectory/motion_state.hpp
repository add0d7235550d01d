/**
 * @file
 * Where an axis is and how it moves, in the axis' unit (mm or rad) and seconds.
 */
#pragma once

#include "robot/motion_rates.hpp"

namespace interlock {

/** Position and its first two derivatives. */
struct MotionState {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;

  bool operator==(const MotionState&) const = default;
};

constexpr MotionState operator+(const MotionState& one, const MotionState& other) noexcept {
  return {one.position + other.position, one.velocity + other.velocity,
          one.acceleration + other.acceleration};
}

constexpr MotionState operator-(const MotionState& state) noexcept {
  return {-state.position, -state.velocity, -state.acceleration};
}

/** Positions between which an axis may be, both ends in it. */
struct PositionRange {
  double lowest = 0.0;
  double highest = 0.0;

  bool operator==(const PositionRange&) const = default;
};

}  // namespace interlock
