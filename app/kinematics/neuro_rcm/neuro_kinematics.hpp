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
#include <array>
#include <numbers>

#include "kinematics/joints.hpp"
#include "kinematics/path.hpp"
#include "kinematics/pose.hpp"
#include "kinematics/trapezoid.hpp"

namespace interlock {

/** The lengths of the robot file. */
struct NeuroRcm {
  double side_link_mm = 0.0;
  double top_width_mm = 0.0;
  double home_separation_mm = 0.0; /**< of the sliders, when head and feet stand at 0 */
  double driver_to_rcm_mm = 0.0;   /**< from the needle driver's reference point to the RCM */
  PointMm home_rcm_mm{};           /**< RCM in the z-frame, when all axes stand at 0 */
  double min_separation_mm = 0.0;  /**< smallest separation that the mechanism allows */
  double max_separation_mm = 0.0;  /**< largest one */

  bool operator==(const NeuroRcm&) const = default;
};

/** Joint positions, in the sense and sign of the published motor table. */
struct NeuroJoints {
  double head_mm = 0.0; /**< axial slider on the side of the head */
  double feet_mm = 0.0; /**< axial slider on the side of the feet */
  double lateral_mm = 0.0;
  double insertion_mm = 0.0;
  double probe_rotation_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;

  bool operator==(const NeuroJoints&) const = default;
};

/** In the order of the columns of the Jacobian. */
inline constexpr std::array<JointField<NeuroJoints>, 7> neuro_joint_fields{{
    {{"head", "head_mm", Unit::mm, length_limit_mm}, &NeuroJoints::head_mm},
    {{"feet", "feet_mm", Unit::mm, length_limit_mm}, &NeuroJoints::feet_mm},
    {{"lateral", "lateral_mm", Unit::mm, length_limit_mm}, &NeuroJoints::lateral_mm},
    {{"insertion", "insertion_mm", Unit::mm, length_limit_mm}, &NeuroJoints::insertion_mm},
    {{"probe_rotation", "probe_rotation_rad", Unit::rad, angle_limit_rad}, &NeuroJoints::probe_rotation_rad},
    {{"pitch", "pitch_rad", Unit::rad, std::numbers::pi / 2}, &NeuroJoints::pitch_rad},
    {{"yaw", "yaw_rad", Unit::rad, std::numbers::pi}, &NeuroJoints::yaw_rad},
}};

/**
 * Velocity of the treatment point per joint velocity, in the zFrame: rows 0 to 2 the point (mm/mm, mm/rad),
 * rows 3 to 5 the angular velocity (rad/mm, rad/rad); columns as `neuro_joint_fields`.
 */
using NeuroJacobian = Eigen::Matrix<double, 6, 7>;

/** Cosine of the pitch below which the yaw is undetermined. */
inline constexpr double smallest_cos_pitch = 1e-3;

/** Closed forms of the robot with a remote centre of motion. */
class NeuroKinematics final : public Kinematics {
 public:
  /** Refused unless lengths are finite and within range and the home separation is inside of the window. */
  static KinematicsResult<NeuroKinematics> create(const NeuroRcm& geometry,
                                                  const ProbeOffsets& probe) noexcept;

  [[nodiscard]] const NeuroRcm& geometry() const noexcept { return geometry_; }

  [[nodiscard]] std::span<const Joint> joints() const noexcept override;
  [[nodiscard]] KinematicsResult<KinematicsPtr> with_probe(const ProbeOffsets& probe) const override;
  [[nodiscard]] KinematicsResult<Pose> zframe_from_treatment(
      std::span<const double> positions) const override;
  [[nodiscard]] KinematicsResult<Jacobian> jacobian(std::span<const double> positions) const override;
  [[nodiscard]] KinematicsResult<std::vector<double>> positions_for(const Eigen::Vector3d& entry,
                                                                    const Eigen::Vector3d& target,
                                                                    double rotation_rad) const override;
  [[nodiscard]] KinematicsResult<std::vector<double>> positions_for(
      const Pose& zframe_from_treatment, const std::optional<Eigen::Vector3d>& entry) const override;
  [[nodiscard]] KinematicsResult<RobotBody> zframe_body(std::span<const double> positions) const override;
  [[nodiscard]] std::optional<double> depth_mm(std::span<const double> positions) const override;
  [[nodiscard]] std::vector<CalibratedNumber> calibrated() const override;
  [[nodiscard]] std::span<const SliderPair> slider_pairs() const noexcept override { return pairs_; }

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
  std::array<SliderPair, 1> pairs_;
};

}  // namespace interlock
