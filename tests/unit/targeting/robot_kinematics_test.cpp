#include "targeting/robot_kinematics.hpp"

#include <gtest/gtest.h>

#include "kinematics/neuro_rcm/neuro_kinematics.hpp"
#include "random_joints.hpp"
#include "robots.hpp"

namespace interlock {
namespace {

using Eigen::Vector3d;
using test::kinematics_of;
using test::neuro;
using test::place_of;
using test::prostate;

/** An axis whose joint is missed would show, as each stands elsewhere. */
AxisPositions staggered(const Robot& robot) {
  AxisPositions positions;
  for (const Axis& axis : robot.axes) {
    const double middle = axis.to_unit(axis.soft_limits.min_counts / 2 + axis.soft_limits.max_counts / 2);
    positions.push_back(middle + 0.01 * static_cast<double>(positions.size()));
  }
  return positions;
}

TEST(RobotKinematics, NeuroTakesEachAxisForItsJoint) {
  const auto own = NeuroKinematics::create(
      dynamic_cast<const NeuroKinematics&>(*neuro().kinematics).geometry(), neuro().probe);
  const AxisPositions positions = staggered(neuro());
  NeuroJoints joints;
  for (const auto& field : neuro_joint_fields) {
    joints.*field.position = positions[place_of(neuro(), field.role)];
  }
  joints.head_mm = joints.feet_mm = 0.0;
  AxisPositions with_sliders = positions;
  with_sliders[place_of(neuro(), "head")] = with_sliders[place_of(neuro(), "feet")] = 0.0;
  EXPECT_EQ(test::distance(*kinematics_of(neuro()).zframe_from_treatment(with_sliders),
                           *own->zframe_from_treatment(joints)),
            0.0);
}

TEST(RobotKinematics, TheProstatesZframeStandsWhereItsFileSays) {
  const RobotKinematics kinematics = kinematics_of(prostate());
  AxisPositions positions(prostate().axes.size(), 0.0);
  positions[place_of(prostate(), "front_left")] = positions[place_of(prostate(), "back_left")] = 150.0;
  positions[place_of(prostate(), "front_right")] = positions[place_of(prostate(), "back_right")] = -150.0;
  // Published: needle tip at (0, Y, N - C) in the base with Y = 140.426185 at home; zFrame at (0, 167.4,
  // 239.71).
  const Vector3d tip = kinematics.zframe_from_treatment(positions)->translation();
  EXPECT_LE((tip - Vector3d(0.0, 140.426185 - 167.4, 224.0 - 15.0 - 239.71)).norm(), 1e-6);
}

TEST(RobotKinematics, PositionsLeadToTheTarget) {
  struct Case {
    const Robot& robot;
    Vector3d entry;
    Vector3d target;
  };
  for (const Case& each : {Case{neuro(), {8, 250, 70}, {5, 200, 60}},
                           Case{prostate(), {10.0, -20.0, 0.0}, {12.0, -18.0, 60.0}}}) {
    const RobotKinematics kinematics = kinematics_of(each.robot);
    const auto positions = kinematics.positions_for(each.entry, each.target, 0.25);
    ASSERT_TRUE(positions) << positions.error().message();
    const Pose reached = *kinematics.zframe_from_treatment(*positions);
    EXPECT_LE((reached.translation() - each.target).norm(), 1e-9) << each.robot.name;
    EXPECT_LE((reached.linear().col(2) - (each.target - each.entry).normalized()).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace interlock
