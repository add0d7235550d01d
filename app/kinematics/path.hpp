/**
 * @file
 * The straight way from entry to target.
 */
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kinematics/kinematics_error.hpp"
#include "kinematics/pose.hpp"

namespace interlock {

/** Entry and target closer than this give no direction. */
inline constexpr double shortest_path_mm = 1e-3;

/** Largest distance of the unit vectors along entry to target and along the z axis of the pose. */
inline constexpr double axis_tolerance = 1e-4;

/** Distance of both points (mm), each checked; DEGENERATE below `shortest_path_mm`. */
KinematicsResult<double> path_length_mm(const Eigen::Vector3d& entry, const Eigen::Vector3d& target) noexcept;

/** Nothing, when the pose is rigid and the entry, if there is one, lies behind it on its z axis; else
 * OFF_AXIS. */
KinematicsResult<void> check_on_axis(const Pose& pose, const std::optional<Eigen::Vector3d>& entry) noexcept;

}  // namespace interlock
