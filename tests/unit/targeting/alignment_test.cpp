#include "targeting/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
using Code = KinematicsError::Code;

Registration registered(const Pose& scanner_from_zframe) {
  return *Registration::create(row_major(scanner_from_zframe));
}

KinematicsResult<Alignment> aligned(const Robot& robot, const Pose& scanner_from_zframe,
                                    const EntryTarget& aim) {
  return align(robot, kinematics_of(robot), registered(scanner_from_zframe), aim);
}

/** The aim of the reference's second golden value, or another one, carried into the scanner. */
EntryTarget aim_in(const Pose& scanner_from_zframe, const Vector3d& entry = {-5, 262, 55},
                   const Vector3d& target = {0, 215, 45}) {
  return {scanner_from_zframe * entry, scanner_from_zframe * target, 0.0};
}

const AxisSetpoint& of_role(const Robot& robot, const Alignment& alignment, std::string_view role) {
  const std::uint32_t slot = robot.with_role(role)->slot;
  return *std::ranges::find(alignment.setpoints, slot, &AxisSetpoint::slot);
}

double position_of(const Robot& robot, const Alignment& alignment, std::string_view role) {
  return robot.with_role(role)->to_unit(of_role(robot, alignment, role).counts);
}

TEST(Alignment, SetpointsAreTheReferencesJointsInCounts) {
  std::mt19937_64 generator(1);
  const Pose scanner_from_zframe = test::random_pose(generator, 300.0);
  const auto alignment = aligned(neuro(), scanner_from_zframe, aim_in(scanner_from_zframe));
  ASSERT_TRUE(alignment) << alignment.error().message();
  EXPECT_EQ(alignment->setpoints.size(), neuro().axes.size());
  const std::pair<const char*, double> golden[] = {
      {"head", -42.060069},    {"feet", -21.703594}, {"lateral", -16.334084}, {"insertion", 12.311489},
      {"probe_rotation", 0.0}, {"pitch", -0.103681}, {"yaw", -0.209640}};
  for (const auto& [role, position] : golden) {
    const double count = 1.0 / neuro().with_role(role)->counts_per_unit;
    EXPECT_LE(std::abs(position_of(neuro(), *alignment, role) - position), 0.51 * std::abs(count)) << role;
  }
}

TEST(Alignment, DesiredIsTheAimAndReachableIsWithinTheRoundingToCounts) {
  std::mt19937_64 generator(2);
  int reached = 0;
  for (int round = 0; round < 2000; ++round) {
    const Pose scanner_from_zframe = test::random_pose(generator, 300.0);
    const NeuroJoints joints = test::random_neuro_joints(generator);
    const auto own = NeuroKinematics::create(
        dynamic_cast<const NeuroKinematics&>(*neuro().kinematics).geometry(), neuro().probe);
    const Vector3d entry = own->zframe_from_entry(joints)->translation();
    const Vector3d target = own->zframe_from_treatment(joints)->translation();
    const EntryTarget aim{scanner_from_zframe * entry, scanner_from_zframe * target,
                          joints.probe_rotation_rad};
    const auto alignment = aligned(neuro(), scanner_from_zframe, aim);
    ASSERT_TRUE(alignment) << alignment.error().message();
    EXPECT_LE((alignment->desired.translation() - aim.target).norm(), 1e-9);
    for (const AxisSetpoint& setpoint : alignment->setpoints) {
      EXPECT_TRUE(neuro().at_slot(setpoint.slot)->accepts_setpoint(setpoint.counts));
    }
    if (std::ranges::none_of(alignment->setpoints, &AxisSetpoint::clamped)) {
      ++reached;
      // Half a count of every axis: 0.01 mm of each slide, 0.0006 rad of each angle at a lever of 73 mm.
      EXPECT_LE(alignment->deviation.distance_mm, 0.15);
      EXPECT_LE(alignment->deviation.angle_rad, 2 * 0.5 / 795.8);
    }
  }
  EXPECT_GT(reached, 1000);
}

TEST(Alignment, AClampedAxisIsNamedAndTheReachablePoseFallsShort) {
  const Pose here = Pose::Identity();
  const auto alignment = aligned(neuro(), here, aim_in(here, {8, 250, 70}, {5, 160, 50}));
  ASSERT_TRUE(alignment) << alignment.error().message();
  const AxisSetpoint& insertion = of_role(neuro(), *alignment, "insertion");
  EXPECT_TRUE(insertion.clamped);
  EXPECT_EQ(insertion.counts, neuro().with_role("insertion")->highest_setpoint_counts());
  EXPECT_FALSE(of_role(neuro(), *alignment, "yaw").clamped);
  const double desired = std::sqrt(9.0 + 8100.0 + 400.0) - 41.0 + 5.0;
  const double missing = desired - position_of(neuro(), *alignment, "insertion");
  EXPECT_NEAR(alignment->deviation.distance_mm, missing, 0.15);
  EXPECT_NEAR(alignment->deviation.offset_mm.norm(), alignment->deviation.distance_mm, 1e-12);
  EXPECT_LE(alignment->deviation.angle_rad, 2 * 0.5 / 795.8);
}

TEST(Alignment, TheRegistrationMovesPosesAndNothingElse) {
  std::mt19937_64 generator(3);
  const auto here = aligned(neuro(), Pose::Identity(), aim_in(Pose::Identity()));
  const Pose scanner_from_zframe = test::random_pose(generator, 300.0);
  const auto there = aligned(neuro(), scanner_from_zframe, aim_in(scanner_from_zframe));
  EXPECT_LE(test::distance(there->reachable, scanner_from_zframe * here->reachable), 1e-9);
  EXPECT_NEAR(there->deviation.distance_mm, here->deviation.distance_mm, 1e-9);
  for (std::size_t axis = 0; axis < here->setpoints.size(); ++axis) {
    EXPECT_EQ(there->setpoints[axis].counts, here->setpoints[axis].counts);
  }
}

TEST(Alignment, OffsetsAAndCTellTipAndCannula) {
  const auto alignment = aligned(neuro(), Pose::Identity(), aim_in(Pose::Identity()));
  const Vector3d ahead = alignment->reachable.linear().col(2);
  EXPECT_LE((alignment->reachable_tip - alignment->reachable.translation() - 10.0 * ahead).norm(), 1e-9);
  EXPECT_NEAR(*alignment->cannula_length_mm, 41.0 + position_of(neuro(), *alignment, "insertion") - 5.0,
              1e-9);
}

TEST(Alignment, OffsetsThatLeaveACannulaNoLengthTellNone) {
  ProbeOffsets probe = neuro().probe;
  probe.cannula_to_treatment_mm = 500.0;
  const auto alignment = align(neuro(), *RobotKinematics::create(neuro(), probe),
                               registered(Pose::Identity()), aim_in(Pose::Identity()));
  EXPECT_FALSE(alignment->cannula_length_mm);
}

TEST(Alignment, TheProstateAlignsInItsZframe) {
  std::mt19937_64 generator(4);
  const Pose scanner_from_zframe = test::random_pose(generator, 300.0);
  const EntryTarget aim = aim_in(scanner_from_zframe, {0.0, -20.0, 0.0}, {0.0, -20.0, 60.0});
  const auto alignment = aligned(prostate(), scanner_from_zframe, aim);
  ASSERT_TRUE(alignment) << alignment.error().message();
  EXPECT_LE(alignment->deviation.distance_mm, 0.01);
  EXPECT_FALSE(alignment->cannula_length_mm);
  EXPECT_NEAR(position_of(prostate(), *alignment, "insertion"), 60.0 + 239.71 + 15.0 - 224.0, 1e-3);
}

TEST(Alignment, AnAimThatNobodyReachesIsRefusedWithTheReason) {
  const Pose here = Pose::Identity();
  EXPECT_EQ(aligned(neuro(), here, aim_in(here, {0, 215, 45}, {0, 215, 45})).error().code, Code::degenerate);
  EXPECT_EQ(aligned(neuro(), here, aim_in(here, {0, 300, 45}, {0, 250, 45})).error().code,
            Code::out_of_reach);
  EXPECT_EQ(aligned(neuro(), here, aim_in(here, {NAN, 300, 45}, {0, 250, 45})).error().code,
            Code::not_finite);
  // Yaw 0, aside by more than the window of the prostate's sliders.
  EXPECT_EQ(aligned(prostate(), here, aim_in(here, {0, 100, 0}, {0, 100, 60})).error().code,
            Code::out_of_reach);
}

TEST(Deviation, IsOfTheTreatmentPointAndOfTheWayAhead) {
  const Pose desired = Pose::Identity();
  Pose reached = Pose::Identity();
  reached.translation() = Vector3d(0.3, 0.0, -0.4);
  reached.linear() = rotation_x(0.01) * rotation_z(1.0);
  const Deviation found = deviation(reached, desired);
  EXPECT_EQ(found.offset_mm, Vector3d(0.3, 0.0, -0.4));
  EXPECT_DOUBLE_EQ(found.distance_mm, 0.5);
  EXPECT_NEAR(found.angle_rad, 0.01, 1e-15);
  reached.linear() = rotation_x(std::numbers::pi);
  EXPECT_NEAR(deviation(reached, desired).angle_rad, std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace interlock
