/**
 * @file
 * Angles on the circle.
 */
#pragma once

#include <cmath>
#include <numbers>

namespace interlock {

inline constexpr double full_turn_rad = 2.0 * std::numbers::pi;

/** The same angle within [-pi, pi]. */
inline double wrapped_rad(double angle_rad) noexcept { return std::remainder(angle_rad, full_turn_rad); }

/** The same angle within [0, 2 pi). */
inline double within_turn_rad(double angle_rad) noexcept {
  const double rest_rad = std::fmod(angle_rad, full_turn_rad);
  const double positive_rad = rest_rad < 0.0 ? rest_rad + full_turn_rad : rest_rad;
  return positive_rad < full_turn_rad ? positive_rad : 0.0;  // the sum may round up to a full turn
}

}  // namespace interlock
