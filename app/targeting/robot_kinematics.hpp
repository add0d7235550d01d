/**
 * @file
 * The kinematics of whichever robot a file describes, between its axes and its zFrame.
 *
 * The treatment point is the NeuroRobot's treatment point and the prostate robot's needle tip; its z axis is
 * the way the probe or needle advances.
 */
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "kinematics/neuro_kinematics.hpp"
#include "kinematics/prostate_kinematics.hpp"
#include "robot/robot.hpp"
#include "targeting/robot_body.hpp"

namespace interlock {

/** Position of every axis in its unit (mm, rad), in the order of the robot's axes; 0 for one that plays no
 * role in the kinematics. */
using AxisPositions = std::vector<double>;

/** Where random positions put the treatment point. */
struct ReachedPoints {
  std::vector<Eigen::Vector3d> zframe_mm;
  std::size_t refused = 0; /**< positions that geometry does not allow */
  Eigen::AlignedBox3d bounds;
};

/** The kinematics of a robot, of whatever family. */
class RobotKinematics {
 public:
  /** With the probe of the robot's file, or another one. Refused when the geometry cannot work. */
  static KinematicsResult<RobotKinematics> create(const Robot& robot);
  /** With another probe than that of the robot's file. */
  static KinematicsResult<RobotKinematics> create(const Robot& robot, const ProbeOffsets& probe);

  [[nodiscard]] const ProbeOffsets& probe() const { return probe_; }

  /** Pose of the treatment point. Needs one position for each axis of the robot. */
  [[nodiscard]] KinematicsResult<Pose> zframe_from_treatment(std::span<const double> positions) const;

  /** What the robot looks like, in the zFrame. Needs one position for each axis of the robot. */
  [[nodiscard]] KinematicsResult<RobotBody> zframe_body(std::span<const double> positions) const;

  /** Of `count` random positions, each between its ends (kinematics/workspace.hpp); those of axes without a
   * role play no part. */
  [[nodiscard]] KinematicsResult<ReachedPoints> reached_points(std::span<const double> lowest,
                                                               std::span<const double> highest,
                                                               std::size_t count, std::uint64_t seed) const;

  /** Positions that put the treatment point at `target`, coming straight from `entry` (mm, zFrame), with the
   * probe turned by `rotation_rad`. Soft limits play no part. */
  [[nodiscard]] KinematicsResult<AxisPositions> positions_for(const Eigen::Vector3d& entry,
                                                              const Eigen::Vector3d& target,
                                                              double rotation_rad) const;

 private:
  struct Neuro {
    using Joints = NeuroJoints;
    static constexpr const auto& fields = neuro_joint_fields;
    NeuroKinematics kinematics;
    NeuroRcm geometry;
    std::array<std::size_t, neuro_joint_fields.size()> axis_of_joint;
  };

  struct Prostate {
    using Joints = ProstateJoints;
    static constexpr const auto& fields = prostate_joint_fields;
    ProstateKinematics kinematics;
    ProstateTrapezoids geometry;
    Eigen::Vector3d base_to_zframe;
    std::array<std::size_t, prostate_joint_fields.size()> axis_of_joint;
  };

  using Family = std::variant<Neuro, Prostate>;

  RobotKinematics(const Family& family, const ProbeOffsets& probe, std::size_t axis_count)
      : family_(family), probe_(probe), axis_count_(axis_count) {}

  Family family_;
  ProbeOffsets probe_;
  std::size_t axis_count_;
};

}  // namespace interlock
