/**
 * @file
 * How fast an axis may move, in counts and in its unit.
 */
#pragma once

#include <cstdint>

namespace interlock {

/**
 * Ranges within which motion is planned, in the axis' unit (mm or rad) and seconds: far beyond all robots,
 * and such that every intermediate result stays finite.
 */
inline constexpr double position_limit = 1e6;
inline constexpr double smallest_rate = 1e-6; /**< of velocity, acceleration and jerk */
inline constexpr double largest_rate = 1e6;
inline constexpr double shortest_ramp_s = 1e-3;  /**< to a limit of velocity or of acceleration */
inline constexpr double longest_plan_s = 7600.0; /**< longer plans are refused: Ruckig's limit */

/** Largest magnitudes of an axis' rates, in its unit (mm or rad) and seconds. */
struct RateLimits {
  double velocity = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
};

/** How an axis may move together with others, along a path in time. */
struct MotionRates {
  double velocity_counts_per_s =
      0.0; /**< largest planned speed, below full speed: the rest is for catching up */
  double acceleration_counts_per_s2 = 0.0;
  double jerk_counts_per_s3 = 0.0;
  std::uint32_t following_error_counts = 0; /**< distance from the path that ends the motion */

  /** What planned motion of an axis of that scale, which is above 0, keeps to. */
  [[nodiscard]] constexpr RateLimits in_units(double counts_per_unit) const noexcept {
    return {velocity_counts_per_s / counts_per_unit, acceleration_counts_per_s2 / counts_per_unit,
            jerk_counts_per_s3 / counts_per_unit};
  }

  bool operator==(const MotionRates&) const = default;
};

}  // namespace interlock
