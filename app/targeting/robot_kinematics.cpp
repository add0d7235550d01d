#include "targeting/robot_kinematics.hpp"

#include <algorithm>

#include "kinematics/domain.hpp"
#include "kinematics/manipulability.hpp"

namespace interlock {

/** A robot that was loaded has one axis for each role. */
RobotKinematics::RobotKinematics(const Robot& robot, KinematicsPtr kinematics, const ProbeOffsets& probe)
    : kinematics_(std::move(kinematics)), probe_(probe), axis_count_(robot.axes.size()) {
  for (const Joint& joint : kinematics_->joints()) {
    const auto axis = std::ranges::find(robot.axes, joint.role, &Axis::role);
    axis_of_joint_.push_back(static_cast<std::size_t>(axis - robot.axes.begin()));
  }
}

KinematicsResult<RobotKinematics> RobotKinematics::create(const Robot& robot) {
  return create(robot, robot.probe);
}

KinematicsResult<RobotKinematics> RobotKinematics::create(const Robot& robot, const ProbeOffsets& probe) {
  if (!robot.kinematics) {
    return tl::unexpected(KinematicsError{KinematicsError::Code::absent, "kinematics", {}});
  }
  return check_lengths({{"treatment_to_tip_mm", probe.treatment_to_tip_mm},
                        {"robot_to_entry_mm", probe.robot_to_entry_mm},
                        {"cannula_to_treatment_mm", probe.cannula_to_treatment_mm},
                        {"treatment_to_robot_at_home_mm", probe.treatment_to_robot_at_home_mm}})
      .and_then([&] { return robot.kinematics->with_probe(probe); })
      .map([&](const KinematicsPtr& kinematics) { return RobotKinematics(robot, kinematics, probe); });
}

std::vector<double> RobotKinematics::joints_of(std::span<const double> positions) const {
  std::vector<double> joints;
  for (const std::size_t axis : axis_of_joint_) {
    joints.push_back(positions[axis]);
  }
  return joints;
}

AxisPositions RobotKinematics::axes_of(std::span<const double> joints) const {
  AxisPositions positions(axis_count_, 0.0);
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    positions[axis_of_joint_[joint]] = joints[joint];
  }
  return positions;
}

KinematicsResult<Jacobian> RobotKinematics::jacobian(std::span<const double> positions) const {
  constexpr double radian_mm = 100.0;
  return kinematics_->jacobian(joints_of(positions)).and_then([&](const Jacobian& of_joints) {
    return manipulability(of_joints, kinematics_->joints(), radian_mm)
        .and_then([](const Manipulability& motion) {
          const auto check = [](double ratio) {
            return check_range("tool_motion_per_joint_motion", ratio, smallest_tool_motion,
                               1.0 / smallest_tool_motion, KinematicsError::Code::singular);
          };
          return check(motion.smallest).and_then([&] { return check(motion.largest); });
        })
        .map([&] {
          Jacobian of_axes = Jacobian::Zero(6, static_cast<Eigen::Index>(axis_count_));
          for (std::size_t joint = 0; joint < axis_of_joint_.size(); ++joint) {
            of_axes.col(static_cast<Eigen::Index>(axis_of_joint_[joint])) =
                of_joints.col(static_cast<Eigen::Index>(joint));
          }
          return of_axes;
        });
  });
}

KinematicsResult<AxisPositions> RobotKinematics::positions_for(const Eigen::Vector3d& entry,
                                                               const Eigen::Vector3d& target,
                                                               double rotation_rad) const {
  return kinematics_->positions_for(entry, target, rotation_rad).map([&](const std::vector<double>& joints) {
    return axes_of(joints);
  });
}

KinematicsResult<AxisPositions> RobotKinematics::positions_for(
    const Pose& zframe_from_treatment, const std::optional<Eigen::Vector3d>& entry) const {
  return kinematics_->positions_for(zframe_from_treatment, entry).map([&](const std::vector<double>& joints) {
    return axes_of(joints);
  });
}

}  // namespace interlock
