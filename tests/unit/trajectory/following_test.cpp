#include "trajectory/following.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "project_robots.hpp"
#include "trajectory/trajectory_csv.hpp"

namespace interlock {
namespace {

using FollowingCode = FollowingState::Code;

TimedTrajectory two_axes() {
  return read_trajectory("time [s],yaw [rad],insertion [mm]\n0,-0.5,10\n2,-0.9,14\n", test::neuro()).value();
}

const FollowingRules tolerances{{{.path = 0.1, .goal = 0.01}, {.path = 1.0, .goal = 0.2}}, 0.5};

FollowingState followed(double time_s, double yaw, double insertion) {
  return follow(two_axes(), tolerances, time_s, std::array{yaw, insertion});
}

TEST(Following, IsUnderWayWhileAllAxesAreNearTheirPath) {
  EXPECT_EQ(followed(1.0, -0.7, 12.9).code, FollowingCode::under_way);
  EXPECT_EQ(followed(1.999, -0.9, 14.0).code, FollowingCode::under_way);
}

TEST(Following, NamesTheAxisThatLeavesItsPath) {
  const FollowingState state = followed(1.0, -0.75, 13.5);
  EXPECT_EQ(state.code, FollowingCode::off_path);
  EXPECT_EQ(state.axis, 1u);
  EXPECT_DOUBLE_EQ(state.distance, 1.5);
  EXPECT_EQ(followed(9.0, -0.9, 12.9).code, FollowingCode::off_path);
  EXPECT_EQ(followed(1.0, std::nan(""), 12.0).code, FollowingCode::off_path);
  EXPECT_EQ(followed(1.0, -0.7, HUGE_VAL).axis, 1u);
}

TEST(Following, ReachesTheGoalOnlyAfterTheEndAndWithinAllTolerances) {
  EXPECT_EQ(followed(2.0, -0.905, 14.1).code, FollowingCode::reached);
  EXPECT_EQ(followed(2.0, -0.92, 14.1).code, FollowingCode::under_way);
  EXPECT_EQ(followed(2.5, -0.92, 14.1).code, FollowingCode::under_way);
  const FollowingState late = followed(2.51, -0.92, 14.1);
  EXPECT_EQ(late.code, FollowingCode::goal_late);
  EXPECT_EQ(late.axis, 0u);
  EXPECT_EQ(followed(2.51, -0.905, 14.1).code, FollowingCode::reached);
}

TEST(Following, RulesNeedToleranceForEachAxisAndAGoalWithinThePath) {
  const TimedTrajectory trajectory = two_axes();
  EXPECT_TRUE(check_rules(tolerances, trajectory));
  EXPECT_FALSE(check_rules({{{0.1, 0.01}}, 0.0}, trajectory));
  EXPECT_EQ(check_rules({{{0.1, 0.2}, {1.0, 0.2}}, 0.0}, trajectory).error().column, "yaw goal tolerance");
  EXPECT_EQ(check_rules({{{0.1, 0.1}, {0.0, 0.0}}, 0.0}, trajectory).error().column,
            "insertion path tolerance");
  EXPECT_EQ(check_rules({{{0.1, 0.1}, {1.0, 0.2}}, std::nan("")}, trajectory).error().column,
            "goal wait [s]");
}

}  // namespace
}  // namespace interlock
