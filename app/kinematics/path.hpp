/**
 * @file
 * The straight way from entry to target.
 */
#pragma once

#include <Eigen/Core>

#include "kinematics/kinematics_error.hpp"

namespace interlock {

/** Entry and target closer than this give no direction. */
inline constexpr double shortest_path_mm = 1e-3;

/** Distance of both points (mm), each checked; DEGENERATE below `shortest_path_mm`. */
KinematicsResult<double> path_length_mm(const Eigen::Vector3d& entry, const Eigen::Vector3d& target) noexcept;

}  // namespace interlock
