#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "proposals/checks.hpp"
#include "proposals/motion_registry.hpp"
#include "robot/robot_file.hpp"
#include "robot_fixture.hpp"
#include "tasks.hpp"

namespace interlock {
namespace {

using test::prostate;
using testing::HasSubstr;
using testing::IsEmpty;

class SeparationTest : public testing::Test {
 protected:
  SeparationTest() : config_(test::config_of(prostate())), view_(test::ready_view()) {
    view_.snapshot.config_crc = config_.crc;
    for (const Axis& axis : prostate().axes) {
      ilk_axis_t& state = view_.snapshot.state.axis[axis.slot];
      state = {};
      state.state = ILK_AXIS_ENABLED;
    }
  }

  void homed_at(const char* name, double mm) {
    const Axis& axis = *prostate().find(name);
    view_.snapshot.state.axis[axis.slot].homed = 1;
    view_.snapshot.state.axis[axis.slot].position_counts = *axis.to_counts(mm);
  }

  void left_homed_at(double mm) {
    homed_at("back_left", mm);
    homed_at("front_left", mm);
  }

  void right_homed_at(double mm) {
    homed_at("back_right", mm);
    homed_at("front_right", mm);
  }

  /** The code that refuses the step; empty when it may run. */
  std::string step(const std::string& name) { return code_of(home(*home_step(prostate(), name))); }
  std::string axis(const char* name) { return code_of(home(home_axis(prostate().find(name)->slot))); }
  std::string all() { return code_of(home(*home_all(prostate()))); }

  tl::expected<Proposal, Refusal> home(HomeTask task) {
    return test::approved(registry_, {std::move(task), "ann", RobotMode::home}, view_);
  }

  static std::string code_of(const tl::expected<Proposal, Refusal>& proposal) {
    return proposal ? "" : proposal.error().code;
  }

  const ilk_config_t config_;
  ControlView view_;
  std::vector<Command> sent_;
  MotionRegistry registry_{prostate(), config_,
                           [this](const Command& command) {
                             sent_.push_back(command);
                             return true;
                           },
                           [] { return UtcTime{}; }};
};

TEST_F(SeparationTest, AllStepsMakeRoomForEachOtherWhereverTheSlidersStand) {
  EXPECT_EQ(all(), "");
  left_homed_at(187.0);
  EXPECT_EQ(all(), "");
  right_homed_at(-187.0);
  EXPECT_EQ(all(), "");
}

TEST_F(SeparationTest, OneSideDoesNotHomeWhileTheOtherIsUnknown) {
  EXPECT_EQ(step("left_home"), "SEPARATION");
  EXPECT_EQ(step("right_home"), "SEPARATION");
  for (const char* name : {"back_left", "front_left", "back_right", "front_right"}) {
    EXPECT_EQ(axis(name), "SEPARATION") << name;
  }
  EXPECT_THAT(sent_, IsEmpty());
}

TEST_F(SeparationTest, TheRefusalNamesThePairAndTheWayOut) {
  const auto refused = home(*home_step(prostate(), "left_home"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().detail, HasSubstr("back_left and back_right could part by 372.8 mm"));
  EXPECT_THAT(refused.error().expected, HasSubstr("308.0 mm"));
  EXPECT_THAT(refused.error().next_step, HasSubstr("Run all home steps"));
}

TEST_F(SeparationTest, ASideHomesWhenTheOtherIsHomedFarEnoughInward) {
  right_homed_at(-119.0);
  EXPECT_EQ(step("left_home"), "");
  right_homed_at(-119.2);
  EXPECT_EQ(step("left_home"), "SEPARATION") << "the front pair";
  EXPECT_EQ(axis("back_left"), "") << "its own pair has room";
  EXPECT_EQ(axis("front_left"), "SEPARATION");
  left_homed_at(40.4);
  EXPECT_EQ(step("right_home"), "");
}

TEST_F(SeparationTest, OneSliderOfTheOtherSideThatIsNotHomedIsEnough) {
  homed_at("back_right", -50.0);
  EXPECT_EQ(axis("back_left"), "");
  EXPECT_EQ(axis("front_left"), "SEPARATION");
  EXPECT_EQ(step("left_home"), "SEPARATION");
}

TEST_F(SeparationTest, ParkingASideNeedsRoomToo) {
  left_homed_at(187.0);
  right_homed_at(-50.0);
  EXPECT_EQ(step("right_park"), "SEPARATION");
  left_homed_at(158.0);
  EXPECT_EQ(step("right_park"), "");
  right_homed_at(-150.0);
  left_homed_at(40.4);
  EXPECT_EQ(step("left_park"), "");
}

TEST_F(SeparationTest, StepsThatOnlyBringSlidersTogetherAreAllowed) {
  EXPECT_EQ(step("needle_out"), "");
  EXPECT_EQ(step("right_inward"), "");
  left_homed_at(187.0);
  EXPECT_EQ(step("left_inward"), "");
  right_homed_at(-187.0);
  EXPECT_EQ(step("left_inward"), "") << "found too far apart";
  EXPECT_EQ(step("right_park"), "") << "farther out than where it parks";
}

TEST_F(SeparationTest, ANudgeOutwardsCountsInFull) {
  Robot robot = prostate();
  const Axis& back_right = *robot.find("back_right");
  robot.home_steps = {{"out", "Out", {}, {{back_right.slot, -25000}}, {}}};
  right_homed_at(-100.0);
  left_homed_at(187.0);
  EXPECT_TRUE(check_separation(robot, states_of(view_), robot.home_steps));
  homed_at("back_right", -112.0);
  EXPECT_FALSE(check_separation(robot, states_of(view_), robot.home_steps));
}

/** The neuro robot: separation 143 mm at home, from 75 to 146 mm; the feet's slider has no switch. */
class NeuroSeparationTest : public testing::Test {
 protected:
  NeuroSeparationTest() : view_(test::ready_view()) {
    for (const Axis& axis : test::neuro().axes) {
      stands_at(axis.name, 0.0);
    }
  }

  ilk_axis_t& state(const std::string& name) {
    return view_.snapshot.state.axis[test::neuro().find(name)->slot];
  }
  void stands_at(const std::string& name, double unit) {
    state(name).position_counts = *test::neuro().find(name)->to_counts(unit);
  }
  static AxisCounts target(const std::string& name, double mm) {
    const Axis& axis = *test::neuro().find(name);
    return {axis.slot, *axis.to_counts(mm)};
  }

  /** The code that refuses what is proposed; empty when it may be approved. */
  std::string code_of(Work work) {
    last_ = test::approved(registry_, {std::move(work), "ann", RobotMode::manual}, view_);
    return last_ ? "" : last_.error().code;
  }
  std::string move(const std::string& name, double mm) {
    const AxisCounts to = target(name, mm);
    return code_of(MoveTask{to.slot, to.counts, std::nullopt, false});
  }
  std::string path(std::vector<AxisCounts> targets) {
    PathProgram program;
    program.legs.emplace_back(MoveLeg{std::move(targets)});
    return code_of(PathTask{std::make_shared<const PathProgram>(std::move(program))});
  }
  std::string home() { return code_of(*home_all(test::neuro())); }

  ControlView view_;
  tl::expected<Proposal, Refusal> last_;
  MotionRegistry registry_{test::neuro(), test::neuro_config(), [](const Command&) { return true; },
                           [] { return UtcTime{}; }};
};

TEST_F(NeuroSeparationTest, APathKeepsTheLinkageWithinItsBounds) {
  EXPECT_EQ(path({target("head", -10.0), target("feet", -69.0)}), "SEPARATION");
  EXPECT_THAT(last_.error().detail, HasSubstr("head and feet would part by 202.0 mm"));
  EXPECT_THAT(last_.error().expected, HasSubstr("75.0 mm to 146.0 mm"));
  EXPECT_EQ(path({target("head", -70.0), target("feet", -2.5)}), "");
  EXPECT_EQ(path({target("head", -70.0), target("feet", 0.0)}), "SEPARATION") << "73 mm";
  EXPECT_EQ(path({target("head", -70.0), target("feet", -69.0)}), "");
}

TEST_F(NeuroSeparationTest, ASliderThatIsNotHomedMayBeAnywhere) {
  state("feet").homed = 0;
  EXPECT_EQ(path({target("head", -40.0)}), "SEPARATION");
  EXPECT_THAT(last_.error().next_step, HasSubstr("Set Home"));
  EXPECT_EQ(path({target("yaw", -0.5)}), "") << "moves no slider";
  stands_at("head", -20.0);
  EXPECT_EQ(home(), "SEPARATION") << "the head's slider would go to its switch";
  state("feet").homed = 1;
  state("head").homed = 0;
  EXPECT_EQ(home(), "");
  stands_at("feet", -3.5);
  EXPECT_EQ(home(), "SEPARATION") << "146.5 mm";
}

TEST_F(NeuroSeparationTest, AMoveOfOneSliderLooksAtTheOther) {
  EXPECT_EQ(move("head", -67.9), "");
  stands_at("feet", 40.0);
  EXPECT_EQ(move("head", -28.1), "SEPARATION");
  EXPECT_EQ(move("head", -27.9), "");
  stands_at("head", -50.0);
  EXPECT_EQ(move("head", -40.0), "") << "back to where the linkage allows it";
  EXPECT_EQ(move("head", -51.0), "SEPARATION");
}

TEST_F(NeuroSeparationTest, AMoveLooksAtWhereTheOtherSliderIsBound) {
  stands_at("head", -30.0);
  EXPECT_EQ(move("feet", -25.0), "");
  EXPECT_EQ(move("head", -8.0), "SEPARATION") << "160 mm once both have come to rest";
  EXPECT_EQ(move("head", -31.0), "");
}

TEST_F(NeuroSeparationTest, AnotherHomeOfTheOtherSliderEndsWhatWasApproved) {
  EXPECT_EQ(move("head", -30.0), "");
  const std::uint32_t id = last_->id;
  ilk_axis_t& feet = state("feet");
  feet.raw += 100;
  feet.position_counts += test::neuro_config().axis[6].direction_correction != 0 ? -100 : 100;
  registry_.follow(view_);
  EXPECT_EQ(registry_.find(id)->state, ProposalState::approved) << "it moved";
  feet.position_counts += 1500;
  registry_.follow(view_);
  EXPECT_EQ(registry_.find(id)->state, ProposalState::aborted);
  EXPECT_THAT(registry_.find(id)->detail, HasSubstr("The home position of axial feet changed"));
  EXPECT_EQ(move("head", -30.0), "");
  feet.homed = 0;
  registry_.follow(view_);
  EXPECT_EQ(registry_.find(last_->id)->state, ProposalState::aborted) << "it lost it";
}

TEST_F(NeuroSeparationTest, AJogEndsWhereTheLinkageDoes) {
  const AxisStates axes = states_of(view_);
  const Robot& neuro = test::neuro();
  const AxisCounts inwards = target("head", -140.0);
  EXPECT_EQ(linked_end(neuro, axes, inwards), static_cast<std::int32_t>(-68.0 * 78.74));
  const AxisCounts outwards = target("feet", -60.0);
  EXPECT_EQ(linked_end(neuro, axes, outwards), static_cast<std::int32_t>(-3.0 * 78.74));
  const AxisCounts yaw = target("yaw", -1.0);
  EXPECT_EQ(linked_end(neuro, axes, yaw), yaw.counts);
}

}  // namespace
}  // namespace interlock
