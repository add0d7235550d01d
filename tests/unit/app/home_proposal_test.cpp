#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "proposals/checks.hpp"
#include "proposals/motion_registry.hpp"
#include "proposals/proposal_json.hpp"
#include "robot_fixture.hpp"
#include "tasks.hpp"

namespace interlock {
namespace {

using test::angles;
using test::insertion;
using test::neuro_config;
using test::pitch;
using test::rotation;
using test::yaw;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/** The neuro robot, with a nudge before its steps and a move after them. */
const Robot& robot() {
  static const Robot changed = [] {
    Robot robot = test::neuro();
    robot.home_steps.push_back({"aside", "Aside", {}, {{rotation, 500}}, {}});
    robot.home_steps.push_back({"park", "Park", {}, {}, {{insertion, 500}, {rotation, 0}}});
    return robot;
  }();
  return changed;
}

constexpr std::uint32_t aside = 3;
constexpr std::uint32_t park = 4;

class HomeProposalTest : public testing::Test {
 protected:
  HomeProposalTest()
      : view_(test::ready_view()),
        registry_(
            robot(), neuro_config(),
            [this](const Command& command) {
              if (accepts_) {
                sent_.push_back(command);
              }
              return accepts_;
            },
            [] { return UtcTime{}; }) {
    registry_.on_mode_change([this](std::string_view mode) { modes_.emplace_back(mode); });
  }

  tl::expected<Proposal, Refusal> home(HomeTask task, TaskSource source = TaskSource::console) {
    Task asked{std::move(task), "ann", RobotMode::home, source};
    return source == TaskSource::console ? test::approved(registry_, std::move(asked), view_)
                                         : registry_.propose(std::move(asked), view_);
  }
  tl::expected<Proposal, Refusal> home_axis(std::uint32_t slot = insertion) {
    return home(interlock::home_axis(slot));
  }
  tl::expected<Proposal, Refusal> home_step(const std::string& step) {
    return interlock::home_step(robot(), step).and_then([&](HomeTask task) { return home(std::move(task)); });
  }
  tl::expected<Proposal, Refusal> home_all() {
    return interlock::home_all(robot()).and_then([&](HomeTask task) { return home(std::move(task)); });
  }
  tl::expected<Proposal, Refusal> move(std::uint32_t slot = insertion) {
    return registry_.propose({MoveTask{slot, 1000}, "ann"}, view_);
  }

  void report(const TaskStatus& status) {
    ControlView view;
    view.tasks.of<HomeTask>() = status;
    registry_.follow(view);
  }
  void report(TaskPhase phase, TaskReason reason = TaskReason::none, std::uint32_t code = 0,
              std::uint32_t step = 0, std::uint32_t slot = insertion, std::int32_t left_counts = 0) {
    report(TaskStatus{1, phase, reason, code, 0, slot, step, left_counts});
  }

  ilk_axis_t& axis(std::uint32_t slot) { return view_.snapshot.state.axis[slot]; }
  [[nodiscard]] ProposalState state(std::uint32_t id) const { return registry_.find(id)->state; }
  [[nodiscard]] const std::string& detail() const { return registry_.find(1)->detail; }

  void expect_refused(const tl::expected<Proposal, Refusal>& proposal, const std::string& code) {
    ASSERT_FALSE(proposal);
    EXPECT_EQ(proposal.error().code, code);
    EXPECT_FALSE(proposal.error().next_step.empty());
    EXPECT_THAT(sent_, IsEmpty());
    EXPECT_EQ(registry_.app_mode(), "manual");
  }

  ControlView view_;
  bool accepts_ = true;
  std::vector<Command> sent_;
  std::vector<std::string> modes_;
  MotionRegistry registry_;
};

TEST_F(HomeProposalTest, OrdersOneAxis) {
  const auto proposal = home_axis();
  ASSERT_TRUE(proposal);
  EXPECT_EQ(proposal->state, ProposalState::approved);
  EXPECT_EQ(proposal->task->author, "ann");
  const Task& task = *std::get<Approval>(sent_.at(0)).task;
  const auto& order = task.work.as<HomeTask>();
  EXPECT_EQ(task.id, 1u);
  EXPECT_EQ(order.step_count, 0u);
  EXPECT_EQ(order.slots.front(), insertion);
}

TEST_F(HomeProposalTest, AWishFromOpenIgtLinkWaitsUntilSomebodyApprovesIt) {
  const auto waiting = home(interlock::home_axis(insertion), TaskSource::openigtlink);
  ASSERT_TRUE(waiting);
  EXPECT_EQ(waiting->state, ProposalState::checked);
  EXPECT_EQ(waiting->task->source, TaskSource::openigtlink);
  EXPECT_THAT(sent_, IsEmpty());
  EXPECT_EQ(registry_.app_mode(), "manual");
  ASSERT_TRUE(registry_.approve(waiting->id, view_));
  EXPECT_EQ(std::get<Approval>(sent_.at(0)).task->work.as<HomeTask>().slots.front(), insertion);
  EXPECT_EQ(registry_.app_mode(), "home");
}

TEST_F(HomeProposalTest, WhatWaitsIsCheckedAnewWhenItIsApproved) {
  const auto waiting = home(interlock::home_axis(insertion), TaskSource::openigtlink);
  ASSERT_TRUE(waiting);
  axis(insertion).state = ILK_AXIS_DISABLED;
  const auto refused = registry_.approve(waiting->id, view_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, "DISABLED");
  EXPECT_EQ(state(waiting->id), ProposalState::refused);
  EXPECT_THAT(sent_, IsEmpty());
}

TEST_F(HomeProposalTest, OrdersOneStepByItsName) {
  const auto proposal = home_step("angles");
  ASSERT_TRUE(proposal);
  EXPECT_THAT(proposal->slots, ElementsAre(yaw, pitch));
  const auto& order = std::get<Approval>(sent_.at(0)).task->work.as<HomeTask>();
  EXPECT_EQ(order.first_step, angles);
  EXPECT_EQ(order.step_count, 1u);
}

TEST_F(HomeProposalTest, OrdersAllStepsInTheOrderOfTheFile) {
  const auto proposal = home_all();
  ASSERT_TRUE(proposal);
  EXPECT_THAT(proposal->slots, ElementsAre(insertion, yaw, pitch, 4u, 7u, rotation));
  const auto& order = std::get<Approval>(sent_.at(0)).task->work.as<HomeTask>();
  EXPECT_EQ(order.first_step, 0u);
  EXPECT_EQ(order.step_count, robot().home_steps.size());
}

TEST_F(HomeProposalTest, ShowsWhatTheInterfaceDescribes) {
  (void)home_step("angles");
  const nlohmann::json open = to_json(*registry_.find(1));
  EXPECT_EQ(open["kind"], "home");
  EXPECT_TRUE(open["slot"].is_null());
  EXPECT_TRUE(open["axis"].is_null());
  EXPECT_EQ(open["axes"], nlohmann::json({"yaw", "pitch"}));
  EXPECT_EQ(open["step"], "angles");
  EXPECT_EQ(open["author"], "ann");
  EXPECT_TRUE(open["target"].is_null());
  EXPECT_TRUE(open["target_counts"].is_null());
  report(TaskPhase::done, TaskReason::arrived, 0, angles);
  EXPECT_TRUE(to_json(*registry_.find(1))["step"].is_null());
  (void)home_axis();
  EXPECT_EQ(to_json(*registry_.find(2))["slot"], insertion);
  EXPECT_EQ(to_json(*registry_.find(2))["axis"], "insertion");
  EXPECT_TRUE(to_json(*registry_.find(2))["step"].is_null());
}

TEST_F(HomeProposalTest, ReplacesEveryOpenProposal) {
  (void)move(insertion);
  (void)move(rotation);
  (void)home_axis();
  (void)home_step("angles");
  for (const std::uint32_t id : {1u, 2u, 3u}) {
    EXPECT_EQ(state(id), ProposalState::aborted) << id;
  }
  EXPECT_THAT(registry_.find(3)->detail, HasSubstr("proposal 4"));
  EXPECT_EQ(registry_.open_home()->id, 4u);
}

TEST_F(HomeProposalTest, ARefusedOneReplacesNothing) {
  (void)move(rotation);
  axis(insertion).state = ILK_AXIS_DISABLED;
  EXPECT_FALSE(home_axis());
  EXPECT_EQ(state(1), ProposalState::approved);
  EXPECT_EQ(state(2), ProposalState::refused);
  EXPECT_EQ(registry_.find(2)->verdict, "DISABLED");
}

TEST_F(HomeProposalTest, MovesAreRefusedUntilItHasEnded) {
  (void)home_axis(yaw);
  const auto refused = move();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, "MODE_HOME");
  EXPECT_EQ(state(1), ProposalState::approved);
  EXPECT_EQ(state(2), ProposalState::refused);
  EXPECT_EQ(sent_.size(), 1u);
  report(TaskPhase::done, TaskReason::arrived);
  EXPECT_TRUE(move());
}

TEST_F(HomeProposalTest, TellsTheModeOnEachChange) {
  EXPECT_EQ(registry_.app_mode(), "manual");
  (void)move();
  EXPECT_THAT(modes_, IsEmpty());
  (void)home_axis();
  EXPECT_EQ(registry_.app_mode(), "home");
  (void)home_step("angles");
  (void)registry_.abort(3);
  EXPECT_EQ(registry_.app_mode(), "manual");
  (void)home_axis();
  registry_.abort_all("STOP.");
  EXPECT_THAT(modes_, ElementsAre("home", "manual", "home", "manual"));
}

TEST_F(HomeProposalTest, KnowsWhichAxesAreBeingHomed) {
  (void)home_step("angles");
  EXPECT_TRUE(registry_.homes(yaw));
  EXPECT_FALSE(registry_.homes(insertion));
  EXPECT_EQ(registry_.open_of(yaw), nullptr);
  (void)registry_.abort(1);
  EXPECT_FALSE(registry_.homes(yaw));
}

TEST_F(HomeProposalTest, AbortCancelsTheOrder) {
  (void)home_axis();
  ASSERT_TRUE(registry_.abort(1));
  EXPECT_EQ(std::get<Cancel>(sent_.at(1)).task, 1u);
}

TEST_F(HomeProposalTest, RefusesAnotherConfigurationThanTheKernels) {
  view_.snapshot.config_crc ^= 1u;
  view_.snapshot.state.system.mode = ILK_MODE_LOCKED;
  expect_refused(home_axis(), "CONFIG_MISMATCH");
}

TEST_F(HomeProposalTest, RefusesWhileLockedAndBeforeThat) {
  axis(insertion).state = ILK_AXIS_FAULTED;
  for (const std::uint32_t mode : {ILK_MODE_LOCKED, ILK_MODE_INIT}) {
    view_.snapshot.state.system.mode = mode;
    expect_refused(home_axis(), "MODE");
  }
}

TEST_F(HomeProposalTest, RefusesWhenAnyAxisOfItIsFaulted) {
  axis(pitch).state = ILK_AXIS_FAULTED;
  expect_refused(home_step("angles"), "FAULTED");
  expect_refused(home_all(), "FAULTED");
  EXPECT_TRUE(home_axis());
}

TEST_F(HomeProposalTest, RefusesWhenAnyAxisOfItIsDisabled) {
  axis(pitch).state = ILK_AXIS_DISABLED;
  expect_refused(home_step("angles"), "DISABLED");
  EXPECT_TRUE(home_axis());
}

TEST_F(HomeProposalTest, RefusesAnAxisWithoutASwitch) {
  expect_refused(home_axis(rotation), "NO_SWITCH");
  EXPECT_TRUE(home_step("aside"));
}

TEST_F(HomeProposalTest, RefusesAMoveOfAnAxisThatIsNotHomedByThen) {
  axis(insertion).homed = 0;
  EXPECT_TRUE(home_all());
  ASSERT_TRUE(registry_.abort(1));
  sent_.clear();
  expect_refused(home_step("park"), "NOT_HOMED");
  axis(insertion).homed = 1;
  axis(rotation).homed = 0;
  expect_refused(home_all(), "NOT_HOMED");
  axis(rotation).homed = 1;
  EXPECT_TRUE(home_step("park"));
}

TEST_F(HomeProposalTest, RefusesWhatTheRobotDoesNotHave) {
  expect_refused(home_axis(test::empty_slot), "AXIS");
  expect_refused(home_step("nowhere"), "NOT_FOUND");
  EXPECT_THAT(home_step("nowhere").error().expected, HasSubstr("probe_out, angles, base"));
  EXPECT_THAT(registry_.newest_first(), IsEmpty());
}

TEST_F(HomeProposalTest, SaysWhenTheControlThreadTakesNothing) {
  accepts_ = false;
  expect_refused(home_axis(), "OVERLOADED");
}

TEST_F(HomeProposalTest, TellsEachStepInWords) {
  std::vector<std::string> told;
  (void)home_all();
  registry_.on_change(
      [&](const Proposal& proposal) { told.push_back(proposal.step + ": " + proposal.detail); });
  report(TaskPhase::executing, TaskReason::none, 0, 0);
  report(TaskPhase::executing, TaskReason::none, 0, 0);
  report(TaskPhase::executing, TaskReason::none, 0, angles);
  report(TaskPhase::executing, TaskReason::none, 0, aside);
  report(TaskPhase::paused, TaskReason::press_again, 0, aside, rotation, 224);
  report(TaskPhase::paused, TaskReason::pedal_released, 0, aside, rotation, 224);
  report(TaskPhase::executing, TaskReason::none, 0, park);
  EXPECT_THAT(told,
              ElementsAre("probe_out: Homes probe insertion; step 1 of 5.",
                          "angles: Homes yaw and pitch; step 2 of 5.",
                          "aside: Moves probe rotation out of the way; step 4 of 5.",
                          "aside: Release the pedal and press it again to go on: 10.0 degrees left.",
                          "aside: Motion ended; press and hold the pedal within 60 s to go on: 10.0 "
                          "degrees left.",
                          "park: Moves probe insertion and probe rotation into position; step 5 of 5."));
}

TEST_F(HomeProposalTest, SaysHomedOnlyOfAxesThatWentToTheirSwitch) {
  (void)home_step("angles");
  report(TaskPhase::done, TaskReason::arrived, 0, angles);
  EXPECT_EQ(detail(), "Homed yaw and pitch.");
}

TEST_F(HomeProposalTest, SaysOfAStepThatOnlyMovesThatNothingWasHomed) {
  (void)home_step("aside");
  report(TaskPhase::done, TaskReason::arrived, 0, aside);
  EXPECT_EQ(detail(), "Moved probe rotation; nothing was homed by it.");
}

TEST_F(HomeProposalTest, SaysWhatIsLeftInTheUnitOfTheAxis) {
  (void)home_all();
  report(TaskPhase::paused, TaskReason::press_again, 0, aside, insertion, -586);
  EXPECT_EQ(detail(), "Release the pedal and press it again to go on: 12.4 mm left.");
}

TEST_F(HomeProposalTest, NamesTheAxisThatEndedIt) {
  (void)home_step("angles");
  report(TaskPhase::aborted, TaskReason::axis_faulted, ILK_FAULT_STALL, angles, pitch);
  EXPECT_EQ(state(1), ProposalState::aborted);
  EXPECT_EQ(registry_.find(1)->verdict, "FAULTED");
  EXPECT_THAT(detail(), HasSubstr("Pitch faulted. STALL"));
}

TEST_F(HomeProposalTest, AKernelRefusalEndsItWithItsVerdict) {
  (void)home_axis();
  report(TaskPhase::refused, TaskReason::kernel_refused, ILK_VERDICT_BUSY);
  EXPECT_EQ(state(1), ProposalState::refused);
  EXPECT_EQ(registry_.find(1)->verdict, "BUSY");
}

TEST_F(HomeProposalTest, AnEndIsFinalWhateverALateReportSays) {
  (void)home_axis();
  ASSERT_TRUE(registry_.abort(1));
  report(TaskPhase::executing);
  report(TaskPhase::done, TaskReason::arrived);
  EXPECT_EQ(state(1), ProposalState::aborted);
  EXPECT_EQ(registry_.app_mode(), "manual");
}

TEST_F(HomeProposalTest, ExpiresAsTheOrderDoes) {
  (void)home_axis();
  report(TaskPhase::expired, TaskReason::waited_too_long);
  EXPECT_EQ(state(1), ProposalState::expired);
  EXPECT_TRUE(move());
}

}  // namespace
}  // namespace interlock
