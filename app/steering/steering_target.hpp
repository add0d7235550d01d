/**
 * @file
 * Where a target lies as a needle's tip sees it, and the circle that leads there.
 *
 * The tip frame has its origin at the tip, z ahead along the needle; a bevel at rest bends the path towards
 * -y. To bend it towards the target the needle turns by `turn_rad` first:
 *
 *     turn = atan2(-x, y) + pi,   curvature = 2 r / (r^2 + z^2),   r = hypot(x, y)
 *
 * Straight ahead (r = 0) the curvature is 0 and the turn means nothing; it is 0 then.
 */
#pragma once

#include <Eigen/Core>

#include "kinematics/kinematics_error.hpp"

namespace interlock {

struct SteeringTarget {
  double turn_rad = 0.0;         /**< from the present rotation, within [0, 2 pi) */
  double curvature_per_mm = 0.0; /**< of the circle through tip and target that leaves the tip along z */
  double arc_mm = 0.0;           /**< along that circle */
  double extra_mm = 0.0;         /**< by how much the arc is longer than straight ahead */
  double beside_mm = 0.0;        /**< of the tip's way ahead */
};

/**
 * By how much a needle misses a target that lies `beside_mm` of its way and `ahead_mm` ahead, when it bends
 * towards it as far as it can; 0 for a target within reach.
 */
KinematicsResult<double> smallest_miss_mm(double beside_mm, double ahead_mm,
                                          double largest_curvature_per_mm) noexcept;

/** Shortest distance ahead for which there is a way to steer. */
inline constexpr double shortest_ahead_mm = 1e-3;

/** Of a target in the tip frame (mm); OUT_OF_REACH when it is not ahead of the tip. */
KinematicsResult<SteeringTarget> steering_target(const Eigen::Vector3d& target_in_tip) noexcept;

}  // namespace interlock
