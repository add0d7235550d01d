/**
 * @file
 * Kinematics of the NeuroRobot in closed form.
 *
 * zFrame: the registration fiducials on the robot's base. RCM frame: origin at the remote centre of motion,
 * +z the way the probe advances; at yaw = pitch = 0 the probe points along -y of the zFrame, at yaw = -90
 * degrees along -z, and positive pitch tilts it towards -x. All positions in mm, all angles in rad.
 *
 *     separation  S = S0 + head - feet          rise h = sqrt(L² - ((S - W)/2)²),  h0 = rise at S0
 *     RCM         c = (x0 + lateral,  y0 + h - h0,  z0 + (head + feet)/2)
 *     rotation    R = R0 Rx(yaw) Ry(pitch) Rz(probe rotation)
 *     treatment   p = c + R (0, 0, insertion + D - d);  entry: (0, 0, B - d)
 *
 * In `NeuroRcm`: L side_link, W top_width, S0 home_separation, d driver_to_rcm, (x0, y0, z0) home_rcm; in
 * `ProbeOffsets`: B robot_to_entry, D treatment_to_robot_at_home.
 *
 * Source: the equations and calibrations published with the successors of the thesis' NeuroRobot. The pitch
 * comes from atan2(n_x, hypot(n_y, n_z)); the atan(n_x / n_z) of early copies is wrong wherever the yaw is
 * not 0.
 *
 * Domain: separation within the geometry's window to 1e-9 mm; |pitch| <= 90 degrees, |yaw| <= 180 degrees,
 * coordinates and joints within 10 m. Soft limits of the axes are not looked at here: they are in counts and
 * belong to the robot file. Nothing allocates or throws.
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
 * Velocity of the treatment point per joint velocity, in the zFrame: rows 0 to 2 the point (mm/mm, mm/rad),
 * rows 3 to 5 the angular velocity (rad/mm, rad/rad); columns as `neuro_joint_fields`.
 */
using NeuroJacobian = Eigen::Matrix<double, 6, 7>;

/** Largest distance of the unit vectors along entry to target and along the z axis of the pose. */
inline constexpr double axis_tolerance = 1e-4;

/** Cosine of the pitch below which the yaw is undetermined. */
inline constexpr double smallest_cos_pitch = 1e-3;

/** Closed forms of the robot with a remote centre of motion. */
class NeuroKinematics {
 public:
  /** Refused unless lengths are finite and within range and the home separation is inside of the window. */
  static KinematicsResult<NeuroKinematics> create(const NeuroRcm& geometry,
                                                  const ProbeOffsets& probe) noexcept;

  /** Pose of the treatment point; its z axis is the way the probe advances. */
  [[nodiscard]] KinematicsResult<Pose> zframe_from_treatment(const NeuroJoints& joints) const noexcept;

  /** Pose of the entry point, on the axis of the probe and not moved by the insertion. */
  [[nodiscard]] KinematicsResult<Pose> zframe_from_entry(const NeuroJoints& joints) const noexcept;

  /** Pose of the remote centre of motion. */
  [[nodiscard]] KinematicsResult<Pose> zframe_from_rcm(const NeuroJoints& joints) const noexcept;

  /**
   * Joints that put the entry point at `entry` and the treatment point at `target` (mm, zFrame). DEGENERATE
   * below `shortest_path_mm`, SINGULAR at a pitch of 90 degrees, OUT_OF_REACH or SEPARATION where the
   * trapezoid ends.
   */
  [[nodiscard]] KinematicsResult<NeuroJoints> joints_for(const Eigen::Vector3d& entry,
                                                         const Eigen::Vector3d& target,
                                                         double probe_rotation_rad = 0.0) const noexcept;

  /**
   * Joints for a pose of the treatment point whose axis leads through `entry` (mm, zFrame). The pose is met
   * exactly; OFF_AXIS when the direction from entry to the pose is not its z axis to `axis_tolerance`.
   */
  [[nodiscard]] KinematicsResult<NeuroJoints> joints_for(const Pose& zframe_from_treatment,
                                                         const Eigen::Vector3d& entry) const noexcept;

  /**
   * Joints for a pose at a given insertion. A pose alone leaves the robot one freedom: insertion against the
   * three translations of the base.
   */
  [[nodiscard]] KinematicsResult<NeuroJoints> joints_at_insertion(const Pose& zframe_from_treatment,
                                                                  double insertion_mm) const noexcept;

  /** Closed form, at any joints that forward kinematics accepts. */
  [[nodiscard]] KinematicsResult<NeuroJacobian> jacobian(const NeuroJoints& joints) const noexcept;

 private:
  struct Angles {
    double probe_rotation_rad;
    double pitch_rad;
    double yaw_rad;
  };

  NeuroKinematics(const NeuroRcm& geometry, const ProbeOffsets& probe, const Trapezoid& trapezoid,
                  double home_rise_mm) noexcept;

  [[nodiscard]] KinematicsResult<Pose> pose_along_probe(const NeuroJoints& joints,
                                                        double offset_mm) const noexcept;
  [[nodiscard]] KinematicsResult<NeuroJoints> solve(const Angles& angles, const Eigen::Vector3d& target,
                                                    double insertion_mm) const noexcept;

  NeuroRcm geometry_;
  ProbeOffsets probe_;
  Trapezoid trapezoid_;
  double home_rise_mm_;
};

}  // namespace interlock
