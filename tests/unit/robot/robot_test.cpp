#include "robot/robot.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "kinematics/kinematics.hpp"
#include "neuro.hpp"

namespace interlock {
namespace {

TEST(Robot, finds_axes_by_name_and_by_slot) {
  const Robot robot = test::neuro();
  ASSERT_NE(robot.find("insertion"), nullptr);
  EXPECT_EQ(robot.find("insertion")->slot, 3u);
  EXPECT_EQ(robot.at_slot(3), robot.find("insertion"));
}

TEST(Robot, answers_null_for_a_name_or_slot_without_axis) {
  const Robot robot = test::neuro();
  EXPECT_EQ(robot.find("elbow"), nullptr);
  for (const std::uint32_t empty : {5u, 8u, 9u, 10u, std::numeric_limits<std::uint32_t>::max()}) {
    EXPECT_EQ(robot.at_slot(empty), nullptr) << empty;
  }
}

TEST(Robot, finds_axes_by_the_role_that_they_play) {
  const Robot robot = test::neuro();
  for (const Joint& joint : robot.kinematics->joints()) {
    ASSERT_NE(robot.with_role(joint.role), nullptr) << joint.role;
    EXPECT_EQ(robot.with_role(joint.role)->unit, joint.unit);
  }
  EXPECT_EQ(robot.with_role("elbow"), nullptr);
  EXPECT_EQ(robot.with_role(""), nullptr) << "an axis without a role plays none";
}

TEST(Robot, finds_steps_modes_and_sensors_by_name) {
  const Robot robot = test::neuro();
  ASSERT_NE(robot.find_home_step("angles"), nullptr);
  EXPECT_EQ(robot.find_home_step("angles")->title, "Angles");
  EXPECT_EQ(robot.find_home_step("elbow"), nullptr);
  EXPECT_TRUE(robot.has_mode("home"));
  EXPECT_FALSE(robot.has_mode("frequency_sweep"));
  EXPECT_EQ(robot.find_sensor("force"), nullptr);
  EXPECT_EQ(robot.sensor_at_slot(3), nullptr) << "an axis is no sensor";
}

TEST(Robot, converts_every_count_of_every_axis_to_its_unit_and_back) {
  for (const Axis& axis : test::neuro().axes) {
    for (std::int32_t counts = axis.soft_limits.min_counts; counts <= axis.soft_limits.max_counts; ++counts) {
      ASSERT_EQ(axis.to_counts(axis.to_unit(counts)), counts) << axis.name;
    }
  }
}

TEST(Robot, one_count_of_yaw_is_the_thesis_seven_hundredths_of_a_degree) {
  const Robot robot = test::neuro();
  EXPECT_NEAR(robot.find("yaw")->to_unit(1) * 180.0 / std::numbers::pi, 0.072, 0.0005);
}

TEST(Robot, refuses_positions_that_no_counter_can_hold) {
  const Axis axis = *test::neuro().find("head");
  using Limits = std::numeric_limits<double>;
  for (const double position :
       {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), 1e300, -1e300, 3e7}) {
    EXPECT_EQ(axis.to_counts(position), std::nullopt) << position;
  }
}

TEST(Robot, setpoints_keep_the_coasting_distance_from_the_soft_limits) {
  const Axis axis = *test::neuro().find("insertion");
  EXPECT_EQ(axis.lowest_setpoint_counts(), 12);
  EXPECT_EQ(axis.highest_setpoint_counts(), 1638);
}

TEST(Robot, accepts_setpoints_within_their_bounds_only) {
  const Axis axis = *test::neuro().find("insertion");
  EXPECT_TRUE(axis.accepts_setpoint(12));
  EXPECT_TRUE(axis.accepts_setpoint(1638));
  EXPECT_FALSE(axis.accepts_setpoint(11));
  EXPECT_FALSE(axis.accepts_setpoint(1639));
}

TEST(Robot, setpoint_bounds_saturate_instead_of_wrapping) {
  Axis axis;
  axis.soft_limits = {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()};
  axis.mechanics.coast_counts = std::numeric_limits<std::uint32_t>::max();
  EXPECT_EQ(axis.lowest_setpoint_counts(), std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(axis.highest_setpoint_counts(), std::numeric_limits<std::int32_t>::min());
}

}  // namespace
}  // namespace interlock
