/**
 * @file
 * Where the robot stands in the scanner.
 */
#pragma once

#include "kinematics/pose.hpp"

namespace interlock {

/**
 * How far a registration may be from rigid: largest entry of RᵀR - I.
 * Navigation software sends single precision and rounds; what is farther off is no rotation.
 */
inline constexpr double registration_tolerance = 1e-3;

/** The robot's zFrame in the scanner's RAS frame; exactly rigid. */
class Registration {
 public:
  /** The robot's frame is the scanner's. */
  Registration() = default;

  /**
   * `numbers` carry zFrame coordinates to RAS, mm. What is rigid to `registration_tolerance` becomes the
   * nearest rotation; anything else is NOT_RIGID. With `ignore_rotation` only the translation counts, as
   * where the robot is set up parallel to the scanner.
   */
  static KinematicsResult<Registration> create(const RowMajor& numbers,
                                               bool ignore_rotation = false) noexcept;

  [[nodiscard]] const Pose& scanner_from_zframe() const noexcept { return scanner_from_zframe_; }

 private:
  explicit Registration(const Pose& pose) noexcept : scanner_from_zframe_(pose) {}

  Pose scanner_from_zframe_ = Pose::Identity();
};

}  // namespace interlock
