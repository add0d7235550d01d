#include "targeting/robot_kinematics.hpp"

#include <algorithm>
#include <type_traits>

#include "kinematics/workspace.hpp"

namespace interlock {
namespace {

/** For each joint, the place of its axis in the robot; a robot that was loaded has one for each role. */
template <typename Joints, std::size_t count>
std::array<std::size_t, count> axes_of(const Robot& robot,
                                       const std::array<JointField<Joints>, count>& fields) {
  std::array<std::size_t, count> places{};
  std::ranges::transform(fields, places.begin(), [&](const JointField<Joints>& field) {
    const auto axis = std::ranges::find(robot.axes, field.role, &Axis::role);
    return static_cast<std::size_t>(axis - robot.axes.begin());
  });
  return places;
}

template <typename Family>
typename Family::Joints joints_of(const Family& family, std::span<const double> positions) {
  typename Family::Joints joints;
  for (std::size_t joint = 0; joint < family.axis_of_joint.size(); ++joint) {
    joints.*Family::fields[joint].position = positions[family.axis_of_joint[joint]];
  }
  return joints;
}

template <typename Family>
AxisPositions positions_of(const Family& family, const typename Family::Joints& joints, std::size_t count) {
  AxisPositions positions(count, 0.0);
  for (std::size_t joint = 0; joint < family.axis_of_joint.size(); ++joint) {
    positions[family.axis_of_joint[joint]] = joints.*Family::fields[joint].position;
  }
  return positions;
}

template <typename Family>
KinematicsResult<ReachedPoints> points_of(const Family& family, std::span<const double> lowest,
                                          std::span<const double> highest, std::size_t count,
                                          std::uint64_t seed, const Eigen::Vector3d& zframe) {
  const JointRange<typename Family::Joints> range{joints_of(family, lowest), joints_of(family, highest)};
  return sample_workspace(family.kinematics, range, count, seed).map([&](const auto& workspace) {
    ReachedPoints points{{}, workspace.refused, workspace.bounds};
    points.bounds.translate(-zframe);
    for (const auto& sample : workspace.samples) {
      points.zframe_mm.emplace_back(sample.position_mm - zframe);
    }
    return points;
  });
}

}  // namespace

KinematicsResult<RobotKinematics> RobotKinematics::create(const Robot& robot) {
  return create(robot, robot.probe);
}

KinematicsResult<RobotKinematics> RobotKinematics::create(const Robot& robot, const ProbeOffsets& probe) {
  const std::size_t count = robot.axes.size();
  if (const auto* const geometry = std::get_if<NeuroRcm>(&robot.kinematics)) {
    return NeuroKinematics::create(*geometry, probe).map([&](const NeuroKinematics& kinematics) {
      return RobotKinematics(Neuro{kinematics, *geometry, axes_of(robot, neuro_joint_fields)}, probe, count);
    });
  }
  const auto& geometry = std::get<ProstateTrapezoids>(robot.kinematics);
  const Eigen::Vector3d base_to_zframe(geometry.base_to_zframe_mm.data());
  return ProstateKinematics::create(geometry).map([&](const ProstateKinematics& kinematics) {
    return RobotKinematics(
        Prostate{kinematics, geometry, base_to_zframe, axes_of(robot, prostate_joint_fields)}, probe, count);
  });
}

KinematicsResult<Pose> RobotKinematics::zframe_from_treatment(std::span<const double> positions) const {
  if (const auto* const neuro = std::get_if<Neuro>(&family_)) {
    return neuro->kinematics.zframe_from_treatment(joints_of(*neuro, positions));
  }
  const auto& prostate = std::get<Prostate>(family_);
  return prostate.kinematics.base_from_tip(joints_of(prostate, positions)).map([&](Pose pose) {
    pose.pretranslate(-prostate.base_to_zframe);
    return pose;
  });
}

KinematicsResult<RobotBody> RobotKinematics::zframe_body(std::span<const double> positions) const {
  if (const auto* const neuro = std::get_if<Neuro>(&family_)) {
    return body_of(neuro->kinematics, neuro->geometry, probe_, joints_of(*neuro, positions));
  }
  const auto& prostate = std::get<Prostate>(family_);
  return body_of(prostate.kinematics, prostate.geometry, joints_of(prostate, positions))
      .map([&](RobotBody body) {
        for (BodyPart& part : body) {
          part.from_mm -= prostate.base_to_zframe;
          part.to_mm -= prostate.base_to_zframe;
        }
        return body;
      });
}

KinematicsResult<ReachedPoints> RobotKinematics::reached_points(std::span<const double> lowest,
                                                                std::span<const double> highest,
                                                                std::size_t count, std::uint64_t seed) const {
  if (const auto* const neuro = std::get_if<Neuro>(&family_)) {
    return points_of(*neuro, lowest, highest, count, seed, Eigen::Vector3d::Zero());
  }
  const auto& prostate = std::get<Prostate>(family_);
  return points_of(prostate, lowest, highest, count, seed, prostate.base_to_zframe);
}

KinematicsResult<AxisPositions> RobotKinematics::positions_for(const Eigen::Vector3d& entry,
                                                               const Eigen::Vector3d& target,
                                                               double rotation_rad) const {
  if (const auto* const neuro = std::get_if<Neuro>(&family_)) {
    return neuro->kinematics.joints_for(entry, target, rotation_rad).map([&](const NeuroJoints& joints) {
      return positions_of(*neuro, joints, axis_count_);
    });
  }
  const auto& prostate = std::get<Prostate>(family_);
  const Eigen::Vector3d& shift = prostate.base_to_zframe;
  return prostate.kinematics.joints_for(entry + shift, target + shift, rotation_rad)
      .map([&](const ProstateJoints& joints) { return positions_of(prostate, joints, axis_count_); });
}

}  // namespace interlock
