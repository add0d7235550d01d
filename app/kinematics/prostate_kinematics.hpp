/**
 * @file
 * Kinematics of the prostate robot in closed form, with angulation.
 *
 * Base frame: x towards the left sliders, y up, z along the needle when both stages stand alike. A stage is a
 * pair of sliders (x1 left, x2 right) under a plate with a pivot; the needle driver lies in both pivots,
 * `front` and `back`.
 *
 *     stage   X = (x1 + x2)/2,  Y = H1 + H2 + sqrt(L² - ((x1 - x2 - B)/2)²)
 *     yaw     a = atan2(X_front - X_back, Dt)
 *     pitch   b = atan2(Y_back - Y_front, hypot(Dt, X_front - X_back))
 *     tip     (X_front, Y_front, -C) + Ry(a) Rx(b) (0, h, N + insertion),  rotation Ry(a) Rx(b) Rz(rotation)
 *
 * Source: the published angulated kinematics, made consistent: there the inverse leaves out C and measures Dt
 * along z in one place and along the needle in another; here the inverse is exact. The rotation of the needle
 * about its own axis in the pose is ours. The form of the thesis is the case N = 259.075, C = 0 with no
 * angulation allowed, which admits parallel stages only.
 *
 * In `ProstateTrapezoids`: L side_link, B top_width, H1 lower_height, H2 upper_height, Dt stage_distance, N
 * needle_tip, C front_pivot_offset, h needle_height.
 *
 * Domain: both separations from `dead_centre_clearance_mm` beyond B to the geometry's largest, to 1e-9 mm;
 * both angles within the angulation, to 1e-9 rad; coordinates and sliders within 10 m. Soft limits of the
 * axes are not looked at here: they are in counts and belong to the robot file. Nothing allocates or throws.
 */
#pragma once

#include <Eigen/Core>

#include "kinematics/joints.hpp"
#include "kinematics/path.hpp"
#include "kinematics/pose.hpp"
#include "kinematics/trapezoid.hpp"
#include "robot/kinematics.hpp"

namespace interlock {

/**
 * Velocity of the needle tip per joint velocity, in the base frame: rows 0 to 2 the tip (mm/mm, mm/rad), rows
 * 3 to 5 the angular velocity (rad/mm, rad/rad); columns as `prostate_joint_fields`.
 */
using ProstateJacobian = Eigen::Matrix<double, 6, 6>;

/**
 * The sliders of a pair stay this much wider apart than their plate: straight above them the plate's height
 * barely follows the sliders, and the inverse loses its digits. Ours; no lower end is published.
 */
inline constexpr double dead_centre_clearance_mm = 1.0;

/** Largest angulation that a geometry may allow. */
inline constexpr double steepest_angulation_rad = 1.0;

/** Closed forms of the robot with two trapezoid stages. */
class ProstateKinematics {
 public:
  /** Refused unless lengths are finite and within range, and the angulation at most
   * `steepest_angulation_rad`. */
  static KinematicsResult<ProstateKinematics> create(const ProstateTrapezoids& geometry) noexcept;

  /** Pose of the needle tip; its z axis is the way the needle advances. */
  [[nodiscard]] KinematicsResult<Pose> base_from_tip(const ProstateJoints& joints) const noexcept;

  /** Pose of the needle guide, on the line of the needle and not moved by the insertion. */
  [[nodiscard]] KinematicsResult<Pose> base_from_needle_guide(const ProstateJoints& joints) const noexcept;

  /** Joints for a pose of the tip. The rotation comes out within half a turn of 0. */
  [[nodiscard]] KinematicsResult<ProstateJoints> joints_for(const Pose& base_from_tip) const noexcept;

  /** Joints that put the tip at `target`, coming straight from `entry` (mm, base frame). DEGENERATE when too
   * close. */
  [[nodiscard]] KinematicsResult<ProstateJoints> joints_for(const Eigen::Vector3d& entry,
                                                            const Eigen::Vector3d& target,
                                                            double rotation_rad = 0.0) const noexcept;

  /** Joints that put the tip at `target` with the needle parallel to z. */
  [[nodiscard]] KinematicsResult<ProstateJoints> joints_for(const Eigen::Vector3d& target,
                                                            double rotation_rad = 0.0) const noexcept;

  /** Closed form, at any joints that forward kinematics accepts. */
  [[nodiscard]] KinematicsResult<ProstateJacobian> jacobian(const ProstateJoints& joints) const noexcept;

 private:
  struct Stages;

  struct Angles {
    double yaw_rad;
    double pitch_rad;
    double rotation_rad;
  };

  ProstateKinematics(const ProstateTrapezoids& geometry, const Trapezoid& trapezoid) noexcept;

  [[nodiscard]] KinematicsResult<Stages> stages(const ProstateJoints& joints) const noexcept;
  [[nodiscard]] KinematicsResult<void> check_angles(const Angles& angles) const noexcept;
  [[nodiscard]] Pose pose_along_needle(const Stages& stages, double rotation_rad,
                                       double length_mm) const noexcept;
  [[nodiscard]] KinematicsResult<ProstateJoints> solve(const Angles& angles,
                                                       const Eigen::Vector3d& target) const noexcept;

  ProstateTrapezoids geometry_;
  Trapezoid trapezoid_;
};

}  // namespace interlock
