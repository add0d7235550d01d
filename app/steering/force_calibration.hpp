/**
 * @file
 * What a reading of a force sensor means in newtons.
 *
 *     force = slope counts + intercept - zero,   over the units in a newton
 *
 * Slope, intercept and reference of the prostate robot's sensors are published, their unit is not: so the
 * robot file says "unspecified", and whoever asks for newtons says how many units make one.
 */
#pragma once

#include <cstdint>
#include <span>

#include "kinematics/kinematics_error.hpp"
#include "robot/sensor.hpp"

namespace interlock {

/** Largest reading of the converter: 16 bits on the wire. */
inline constexpr std::uint32_t largest_reading = 65535;

/** When the mean of some readings may become the zero. */
struct ZeroingRules {
  std::size_t least_readings = 100;
  double widest_spread_n = 0.2; /**< from the smallest to the largest reading: more is a hand, not noise */
  double farthest_n = 5.0;      /**< from the zero of the robot file: more is a load or a broken sensor */
};

/** From readings of a channel to newtons. */
class ForceCalibration {
 public:
  /** The zero is the channel's reference until it is taken anew. @param units_per_newton sign included */
  static KinematicsResult<ForceCalibration> create(const SensorChannel& channel,
                                                   double units_per_newton) noexcept;

  /** Force of a reading, N; 0 at the zero. */
  [[nodiscard]] KinematicsResult<double> force_n(std::uint32_t reading) const noexcept;

  /**
   * The zeroing action: the same calibration with the mean of these readings as its zero. OUT_OF_RANGE names
   * what speaks against: too few readings, a spread or a distance that noise does not explain.
   */
  [[nodiscard]] KinematicsResult<ForceCalibration> zeroed(std::span<const std::uint32_t> readings,
                                                          const ZeroingRules& rules) const noexcept;

  /** Mean reading that counts as no force. */
  [[nodiscard]] double zero_counts() const noexcept { return zero_counts_; }

 private:
  ForceCalibration(double newton_per_count, double zero_counts) noexcept
      : newton_per_count_(newton_per_count), zero_counts_(zero_counts), file_zero_counts_(zero_counts) {}

  double newton_per_count_;
  double zero_counts_;
  double file_zero_counts_;
};

}  // namespace interlock
