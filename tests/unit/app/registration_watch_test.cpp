#include "service/registration_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robot_fixture.hpp"

namespace interlock {
namespace {

using testing::HasSubstr;

class RegistrationWatchTest : public testing::Test {
 protected:
  RegistrationWatchTest() { EXPECT_EQ(see(), ""); }

  std::string see() { return watch_.see(view_); }

  void begin_homing() {
    yaw_.homed = ILK_HOMED_NOT;
    yaw_.state = ILK_AXIS_HOMING;
    EXPECT_EQ(see(), "");
  }

  void move(std::int32_t counts) { test::move(view_, test::yaw, counts); }

  ControlView view_ = test::ready_view();
  ilk_axis_t& yaw_ = view_.snapshot.state.axis[test::yaw];
  RegistrationWatch watch_{test::neuro(), test::neuro_config()};
};

TEST_F(RegistrationWatchTest, MotionExpiresNothing) {
  move(-250);
  EXPECT_EQ(see(), "");
}

TEST_F(RegistrationWatchTest, AnotherHomeDoes) {
  yaw_.position_counts += 3;
  EXPECT_EQ(see(), "Yaw was given another home.");
  EXPECT_EQ(see(), "") << "once";
}

TEST_F(RegistrationWatchTest, ALostHomeDoes) {
  yaw_.homed = ILK_HOMED_NOT;
  EXPECT_EQ(see(), "Yaw lost its home.");
  yaw_.homed = ILK_HOMED_BY_HAND;
  EXPECT_EQ(see(), "Yaw was given a home.") << "what was set meanwhile knew of none";
  EXPECT_EQ(see(), "") << "once";
}

TEST_F(RegistrationWatchTest, SeveralAxesAreNamed) {
  yaw_.homed = ILK_HOMED_NOT;
  view_.snapshot.state.axis[test::pitch].homed = ILK_HOMED_NOT;
  EXPECT_THAT(see(), HasSubstr("Yaw lost its home. Pitch lost its home."));
}

TEST_F(RegistrationWatchTest, HomingExpiresNothingWhenItFindsTheSwitchWhereItWas) {
  begin_homing();
  yaw_.state = ILK_AXIS_ENABLED;
  EXPECT_EQ(see(), "") << "the pedal was released meanwhile";
  move(700);
  yaw_.homed = ILK_HOMED_BY_SWITCH;
  yaw_.position_counts -= 2;
  EXPECT_EQ(see(), "");
}

TEST_F(RegistrationWatchTest, HomingAtAnotherPlaceDoesWhateverTheKernelMeasured) {
  for (const auto& [homed, shift] : {std::pair{ILK_HOMED_BY_SWITCH, 500}, std::pair{ILK_HOMED_BY_HAND, 1}}) {
    begin_homing();
    yaw_.homed = static_cast<std::uint32_t>(homed);
    yaw_.position_counts += shift;
    EXPECT_EQ(see(), "Yaw was homed at another place.");
    EXPECT_EQ(see(), "");
  }
}

TEST_F(RegistrationWatchTest, SmallDifferencesCountTogether) {
  const auto tolerance = test::neuro_config().axis[test::yaw].home_tolerance_counts;
  for (std::uint32_t shift = 1; shift <= tolerance; ++shift) {
    begin_homing();
    yaw_.homed = ILK_HOMED_BY_SWITCH;
    yaw_.position_counts += 1;
    EXPECT_EQ(see(), "") << shift;
  }
  begin_homing();
  yaw_.homed = ILK_HOMED_BY_SWITCH;
  yaw_.position_counts += 1;
  EXPECT_EQ(see(), "Yaw was homed at another place.");
}

TEST_F(RegistrationWatchTest, AnotherStartOfTheKernelLosesEveryHome) {
  view_.attached = false;
  EXPECT_EQ(see(), "");
  view_ = test::ready_view();
  for (ilk_axis_t& axis : view_.snapshot.state.axis) {
    axis.homed = ILK_HOMED_NOT;
  }
  EXPECT_THAT(see(), HasSubstr("Yaw lost its home."));
}

TEST_F(RegistrationWatchTest, AnAxisWithoutARoleDoesNotMatter) {
  Robot robot = test::neuro();
  robot.axes.front().role.clear();
  RegistrationWatch watch(robot, test::neuro_config());
  EXPECT_EQ(watch.see(view_), "");
  view_.snapshot.state.axis[robot.axes.front().slot].homed = ILK_HOMED_NOT;
  EXPECT_EQ(watch.see(view_), "");
}

}  // namespace
}  // namespace interlock
