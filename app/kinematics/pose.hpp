/**
 * @file
 * Rigid poses. `a_from_b` carries coordinates in frame b to coordinates in frame a: p_a = a_from_b * p_b.
 * Translations in mm; rotations right-handed, determinant +1.
 */
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "kinematics/kinematics_error.hpp"

namespace interlock {

/** A rigid transform; lengths in mm. */
using Pose = Eigen::Isometry3d;

/** Sixteen numbers of a homogeneous matrix, row by row, as the HTTP interface and the command line write it.
 */
using RowMajor = std::array<double, 16>;

/** Largest entry of RᵀR - I of a matrix that counts as rigid; its determinant is then within 3 times of +1.
 */
inline constexpr double rigid_tolerance = 1e-6;

/** Standard right-handed rotations. */
Eigen::Matrix3d rotation_x(double angle_rad) noexcept;
Eigen::Matrix3d rotation_y(double angle_rad) noexcept;
Eigen::Matrix3d rotation_z(double angle_rad) noexcept;

/** Nothing, when the pose is finite, its rotation proper to the tolerance, its translation within range. */
KinematicsResult<void> check_rigid(const Pose& pose, double tolerance = rigid_tolerance) noexcept;

/** The pose of a homogeneous matrix, when it is rigid to the tolerance and its last row is exactly 0 0 0 1.
 */
KinematicsResult<Pose> pose_from(const RowMajor& numbers, double tolerance = rigid_tolerance) noexcept;

/** The homogeneous matrix of a pose. */
RowMajor row_major(const Pose& pose) noexcept;

/** How far a reached pose of the treatment point is from a desired one. */
struct Deviation {
  Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero(); /**< reached minus desired, in the poses' frame */
  double distance_mm = 0.0;
  double angle_rad = 0.0; /**< between the two ways in which the probe advances, 0 to pi */
};

/** Of `reached` from `desired`. */
Deviation deviation(const Pose& reached, const Pose& desired) noexcept;

}  // namespace interlock
