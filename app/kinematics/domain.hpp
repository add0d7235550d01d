/**
 * @file
 * Checks at the door of every function: finite, and within the range in which the number means something.
 *
 * The outer ranges are far beyond both robots, and keep every intermediate result finite.
 */
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "kinematics/kinematics_error.hpp"

namespace interlock {

/** Lengths and coordinates lie within plus and minus this. */
inline constexpr double length_limit_mm = 10000.0;

/** Angles of joints lie within plus and minus this: the prostate's needle may turn many times. */
inline constexpr double angle_limit_rad = 1000.0;

/**
 * Rounding is forgiven by this much (mm or rad) at the ends of a range that the robot's geometry gives, so
 * that a pose which forward kinematics answered is never refused by the inverse for its last digits.
 */
inline constexpr double boundary_slack = 1e-9;

/** Nothing, when `value` is finite and within both ends. */
KinematicsResult<void> check_range(std::string_view quantity, double value, double lowest, double highest,
                                   KinematicsError::Code code = KinematicsError::Code::out_of_range) noexcept;

/** As `check_range`, with `boundary_slack` at both ends. */
KinematicsResult<void> check_geometry(std::string_view quantity, double value, double lowest, double highest,
                                      KinematicsError::Code code) noexcept;

/** Nothing, when every length, given with its name, is finite and within `length_limit_mm` either way. */
KinematicsResult<void> check_lengths(
    std::initializer_list<std::pair<std::string_view, double>> lengths) noexcept;

/** Nothing, when all three coordinates are finite and within `length_limit_mm`. `quantities` names x, y, z.
 */
KinematicsResult<void> check_point(const std::string_view (&quantities)[3],
                                   const Eigen::Vector3d& point) noexcept;

}  // namespace interlock
