/**
 * @file
 * The kinematics of a robot by the positions of its axes instead of its joints.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kinematics/workspace.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** Position of every axis in its unit (mm, rad), in the order of the robot's axes; 0 for one that plays no
 * role in the kinematics. */
using AxisPositions = std::vector<double>;

/** Singular value of the Jacobian, a radian as 100 mm, below which a pose counts as near a singular one. */
inline constexpr double smallest_tool_motion = 0.01;

/** Kinematics (kinematics/kinematics.hpp) with a probe. Each call needs one position for each axis; axes
 * without a role play no part. */
class RobotKinematics {
 public:
  /** With the probe of the robot's file. Refused when the geometry cannot work; NO_KINEMATICS of a robot that
   * has none. */
  static KinematicsResult<RobotKinematics> create(const Robot& robot);
  /** With another probe than that of the robot's file. */
  static KinematicsResult<RobotKinematics> create(const Robot& robot, const ProbeOffsets& probe);

  [[nodiscard]] const ProbeOffsets& probe() const { return probe_; }

  /** As of `Kinematics`, by the positions of all axes. */
  [[nodiscard]] KinematicsResult<Pose> zframe_from_treatment(std::span<const double> positions) const {
    return kinematics_->zframe_from_treatment(joints_of(positions));
  }
  /** As of `Kinematics`, by the positions of all axes: a column for each axis, zero for one without a role.
   * SINGULAR where the joints move the treatment point in some direction by less than
   * `smallest_tool_motion` of their own motion, or by more than its inverse: there neither the Jacobian nor
   * its inverse says what a small error does. */
  [[nodiscard]] KinematicsResult<Jacobian> jacobian(std::span<const double> positions) const;
  /** As of `Kinematics`, by the positions of all axes. */
  [[nodiscard]] KinematicsResult<RobotBody> zframe_body(std::span<const double> positions) const {
    return kinematics_->zframe_body(joints_of(positions));
  }
  /** As of `Kinematics`, by the positions of all axes. */
  [[nodiscard]] std::optional<double> depth_mm(std::span<const double> positions) const {
    return kinematics_->depth_mm(joints_of(positions));
  }

  /** What `count` random positions reach, each between its ends. */
  [[nodiscard]] KinematicsResult<Workspace> workspace(std::span<const double> lowest,
                                                      std::span<const double> highest, std::size_t count,
                                                      std::uint64_t seed) const {
    return sample_workspace(*kinematics_, joints_of(lowest), joints_of(highest), count, seed);
  }

  /** As of `Kinematics`; positions of all axes. */
  [[nodiscard]] KinematicsResult<AxisPositions> positions_for(const Eigen::Vector3d& entry,
                                                              const Eigen::Vector3d& target,
                                                              double rotation_rad) const;
  /** As of `Kinematics`; positions of all axes. */
  [[nodiscard]] KinematicsResult<AxisPositions> positions_for(
      const Pose& zframe_from_treatment, const std::optional<Eigen::Vector3d>& entry) const;

 private:
  RobotKinematics(const Robot& robot, KinematicsPtr kinematics, const ProbeOffsets& probe);

  [[nodiscard]] std::vector<double> joints_of(std::span<const double> positions) const;
  [[nodiscard]] AxisPositions axes_of(std::span<const double> joints) const;

  KinematicsPtr kinematics_;
  ProbeOffsets probe_;
  std::size_t axis_count_;
  std::vector<std::size_t> axis_of_joint_;
};

}  // namespace interlock
