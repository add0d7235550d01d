#include <gmock/gmock.h>

#include "kinematics/neuro_rcm/neuro_kinematics.hpp"
#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"
#include "robots.hpp"
#include "targeting/reach.hpp"

namespace interlock {
namespace {

using Eigen::Vector3d;
using test::kinematics_of;
using test::neuro;
using test::place_of;
using test::prostate;

double length(const BodyPart& part) { return (part.to_mm - part.from_mm).norm(); }

std::vector<BodyPart> parts(const RobotBody& body, std::string_view name) {
  std::vector<BodyPart> found;
  for (const BodyPart& part : body) {
    if (part.name == name) {
      found.push_back(part);
    }
  }
  return found;
}

/** Somewhere off home where no angle and no way is 0. */
AxisPositions neuro_positions() {
  AxisPositions positions(neuro().axes.size(), 0.0);
  const std::pair<std::string_view, double> joints[] = {{"head", -20.0},    {"feet", 10.0},
                                                        {"lateral", -15.0}, {"insertion", 12.0},
                                                        {"pitch", 0.2},     {"yaw", -0.7}};
  for (const auto& [role, position] : joints) {
    positions[place_of(neuro(), role)] = position;
  }
  return positions;
}

AxisPositions prostate_positions() {
  AxisPositions positions(prostate().axes.size(), 0.0);
  const std::pair<std::string_view, double> joints[] = {{"front_left", 149.0},
                                                        {"front_right", -139.0},
                                                        {"back_left", 140.0},
                                                        {"back_right", -140.0},
                                                        {"insertion", 40.0}};
  for (const auto& [role, position] : joints) {
    positions[place_of(prostate(), role)] = position;
  }
  return positions;
}

TEST(RobotBodyTest, TheNeuroRobotsPartsAreAsLongAsItsFileSays) {
  const auto geometry = dynamic_cast<const NeuroKinematics&>(*neuro().kinematics).geometry();
  const ProbeOffsets& probe = neuro().probe;
  const auto body = kinematics_of(neuro()).zframe_body(neuro_positions());
  ASSERT_TRUE(body);
  ASSERT_EQ(parts(*body, "link").size(), 2u);
  for (const BodyPart& link : parts(*body, "link")) {
    EXPECT_NEAR(length(link), geometry.side_link_mm, 1e-9);
  }
  EXPECT_NEAR(length(parts(*body, "plate").front()), geometry.top_width_mm, 1e-9);
  EXPECT_NEAR(length(parts(*body, "rail").front()), geometry.home_separation_mm - 20.0 - 10.0, 1e-9);
  EXPECT_NEAR(length(parts(*body, "lateral").front()), 15.0, 1e-9);
  EXPECT_NEAR(length(parts(*body, "arm").front()), geometry.driver_to_rcm_mm, 1e-9);
  EXPECT_NEAR(length(parts(*body, "guide").front()), probe.robot_to_entry_mm, 1e-9);
  EXPECT_NEAR(length(body->back()), probe.treatment_to_robot_at_home_mm + probe.treatment_to_tip_mm, 1e-9);
}

TEST(RobotBodyTest, TheNeuroRobotsProbeEndsAtTheTipOfForwardKinematics) {
  const RobotKinematics kinematics = kinematics_of(neuro());
  const Pose treatment = *kinematics.zframe_from_treatment(neuro_positions());
  const RobotBody body = *kinematics.zframe_body(neuro_positions());
  const Vector3d tip = treatment * Vector3d(0.0, 0.0, neuro().probe.treatment_to_tip_mm);
  EXPECT_EQ(body.back().name, "probe");
  EXPECT_LE((body.back().to_mm - tip).norm(), 1e-9);
}

TEST(RobotBodyTest, TheProstateRobotsPartsMeetAndAreAsLongAsItsFileSays) {
  const auto geometry = dynamic_cast<const ProstateKinematics&>(*prostate().kinematics).geometry();
  const RobotKinematics kinematics = kinematics_of(prostate());
  const auto body = kinematics.zframe_body(prostate_positions());
  ASSERT_TRUE(body) << body.error().message();
  ASSERT_EQ(parts(*body, "link").size(), 4u);
  for (const BodyPart& link : parts(*body, "link")) {
    EXPECT_NEAR(length(link), geometry.side_link_mm, 1e-9);
  }
  for (const BodyPart& plate : parts(*body, "plate")) {
    EXPECT_NEAR(length(plate), geometry.top_width_mm, 1e-9);
  }
  const BodyPart carrier = parts(*body, "carrier").front();
  EXPECT_NEAR(carrier.to_mm.z() - carrier.from_mm.z(), geometry.stage_distance_mm, 1e-9);
  const BodyPart guide = parts(*body, "guide").front();
  EXPECT_LE((carrier.to_mm - guide.from_mm).norm(), 1e-9) << "the needle's line begins at the front pivot";
  // Both ends of the carrier lie on the line of the needle: forward kinematics and the stages agree.
  EXPECT_LE((carrier.to_mm - carrier.from_mm).cross(guide.to_mm - guide.from_mm).norm(), 1e-6);
  const Pose tip = *kinematics.zframe_from_treatment(prostate_positions());
  EXPECT_LE((body->back().to_mm - tip.translation()).norm(), 1e-9);
}

TEST(RobotBodyTest, JointsThatGeometryForbidsHaveNoBody) {
  AxisPositions apart = neuro_positions();
  apart[place_of(neuro(), "head")] = 0.0;
  apart[place_of(neuro(), "feet")] = -70.0;
  const auto body = kinematics_of(neuro()).zframe_body(apart);
  ASSERT_FALSE(body);
  EXPECT_EQ(body.error().code, KinematicsError::Code::separation);
}

TEST(ReachTest, EveryCellOfTheShellHoldsAPlaceThatTheRobotReaches) {
  for (const Robot* robot : {&neuro(), &prostate()}) {
    const RobotKinematics kinematics = kinematics_of(*robot);
    const Reach reach = *reach_of(*robot, kinematics, 4'000);
    AxisPositions lowest;
    AxisPositions highest;
    for (const Axis& axis : robot->axes) {
      lowest.push_back(axis.to_unit(axis.lowest_setpoint_counts()));
      highest.push_back(axis.to_unit(axis.highest_setpoint_counts()));
    }
    const Workspace points = *kinematics.workspace(lowest, highest, 4'000, 1);
    EXPECT_GT(reach.shell_mm.size(), 100u) << robot->name;
    EXPECT_LE(reach.shell_mm.size(), reach.cells);
    EXPECT_EQ(points.zframe_mm.size() + points.refused, 4'000u);
    for (const Vector3d& centre : reach.shell_mm) {
      const auto inside = [&](const Vector3d& point) {
        return ((point - centre).array().abs() <= reach.cell_mm / 2 + 1e-9).all();
      };
      ASSERT_TRUE(std::ranges::any_of(points.zframe_mm, inside)) << robot->name << ": " << centre.transpose();
    }
  }
}

TEST(ReachTest, TheCellsWithinAreLeftOutAndAnswersAreBounded) {
  const Reach reach = *reach_of(neuro(), kinematics_of(neuro()), 200'000);
  EXPECT_LT(reach.shell_mm.size(), reach.cells) << "some cells have neighbours on all sides";
  const auto side = static_cast<std::size_t>(reach_cells_a_side) + 1;
  EXPECT_LE(reach.cells, side * side * side);
}

}  // namespace
}  // namespace interlock
