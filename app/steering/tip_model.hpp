/**
 * @file
 * How a needle's tip moves: as a unicycle on SE(3).
 *
 *     pose <- pose exp(insertion V1 + rotation V2),   V1 = (v = e3, omega = curvature e1),  V2 = (v = 0,
 * omega = e3)
 *
 * The step is exact while insertion and rotation keep their ratio, however large it is. Insertion is that of
 * the tip along its own path: shaft and tissue do not stretch here.
 */
#pragma once

#include "kinematics/pose.hpp"

namespace interlock {

/** How far the needle was pushed and turned; positive is ahead, and right-handed about it. */
struct NeedleMotion {
  double insertion_mm = 0.0;
  double rotation_rad = 0.0;
};

/** Rotation vector of that motion in the tip frame, rad. */
Eigen::Vector3d tip_rotation(const NeedleMotion& motion, double curvature_per_mm) noexcept;

/** Exponential of a twist: `rotation` in rad, `translation` in mm, both in the moving frame. */
Pose exponential(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) noexcept;

/** Nothing, when the motion goes ahead or stands, and all is finite and within range. */
KinematicsResult<void> check_motion(const NeedleMotion& motion, double curvature_per_mm) noexcept;

/**
 * The tip's pose after a motion. A needle that is withdrawn follows its own track, which this model does not
 * know: an insertion below 0 is OUT_OF_RANGE.
 */
KinematicsResult<Pose> moved_tip(const Pose& tip, const NeedleMotion& motion,
                                 double curvature_per_mm) noexcept;

}  // namespace interlock
