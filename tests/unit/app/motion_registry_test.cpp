#include "proposals/motion_registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "proposals/checks.hpp"
#include "proposals/proposal_json.hpp"
#include "robot_fixture.hpp"

namespace interlock {
namespace {

using test::insertion;
using test::neuro;
using test::neuro_config;

class MotionRegistryTest : public testing::Test {
 protected:
  MotionRegistryTest()
      : view_(test::ready_view()),
        registry_(
            neuro(), neuro_config(),
            [this](const Command& command) {
              if (accepts_) {
                sent_.push_back(command);
              }
              return accepts_;
            },
            [this] { return now_; }) {
    registry_.on_change([this](const Proposal& proposal) { changes_.push_back(proposal.state); });
  }

  tl::expected<Proposal, Refusal> propose(std::int32_t target = 1000, std::uint32_t slot = insertion) {
    return registry_.propose({MoveTask{slot, target}, "console"}, view_);
  }

  void report(std::uint32_t proposal, TaskPhase phase, TaskReason reason = TaskReason::none,
              std::uint32_t code = 0) {
    ControlView view;
    view.tasks.move(insertion) = {proposal, phase, reason, code, 0};
    registry_.follow(view);
  }

  ilk_axis_t& axis() { return view_.snapshot.state.axis[insertion]; }
  [[nodiscard]] ProposalState state(std::uint32_t id) const { return registry_.find(id)->state; }

  void expect_refused(const std::string& code) {
    const auto proposal = propose();
    ASSERT_FALSE(proposal);
    EXPECT_EQ(proposal.error().code, code);
    EXPECT_FALSE(proposal.error().next_step.empty());
    EXPECT_EQ(state(1), ProposalState::refused);
    EXPECT_EQ(registry_.find(1)->verdict, code);
    EXPECT_TRUE(registry_.find(1)->ended);
    EXPECT_THAT(sent_, testing::IsEmpty());
  }

  ControlView view_;
  UtcTime now_{std::chrono::milliseconds(1714566896789)};
  bool accepts_ = true;
  std::vector<Command> sent_;
  std::vector<ProposalState> changes_;
  MotionRegistry registry_;
};

TEST_F(MotionRegistryTest, DraftsChecksApprovesAndOrders) {
  const auto proposal = propose();
  ASSERT_TRUE(proposal);
  EXPECT_EQ(proposal->id, 1u);
  EXPECT_EQ(proposal->state, ProposalState::approved);
  EXPECT_THAT(changes_,
              testing::ElementsAre(ProposalState::drafted, ProposalState::checked, ProposalState::approved));
  ASSERT_EQ(sent_.size(), 1u);
  const Task& task = *std::get<Approval>(sent_[0]).task;
  EXPECT_EQ(task.id, 1u);
  EXPECT_EQ(task.work.as<MoveTask>().slot, insertion);
  EXPECT_EQ(task.work.as<MoveTask>().target_counts, 1000);
}

TEST_F(MotionRegistryTest, FollowsTheOrderToItsEnd) {
  (void)propose();
  report(1, TaskPhase::executing);
  EXPECT_EQ(state(1), ProposalState::executing);
  report(1, TaskPhase::paused, TaskReason::pedal_released);
  EXPECT_EQ(state(1), ProposalState::paused);
  report(1, TaskPhase::executing);
  report(1, TaskPhase::done, TaskReason::arrived);
  EXPECT_EQ(state(1), ProposalState::done);
  EXPECT_EQ(registry_.find(1)->ended, now_);
}

TEST_F(MotionRegistryTest, SaysNothingWhenNothingChanged) {
  (void)propose();
  changes_.clear();
  report(1, TaskPhase::waiting);
  report(1, TaskPhase::executing);
  report(1, TaskPhase::executing);
  EXPECT_THAT(changes_, testing::ElementsAre(ProposalState::executing));
}

TEST_F(MotionRegistryTest, AnEndIsFinalWhateverALateReportSays) {
  (void)propose();
  ASSERT_TRUE(registry_.abort(1));
  report(1, TaskPhase::executing);
  report(1, TaskPhase::done, TaskReason::arrived);
  EXPECT_EQ(state(1), ProposalState::aborted);
}

TEST_F(MotionRegistryTest, AKernelRefusalEndsItWithVerdictAndNextStep) {
  (void)propose();
  report(1, TaskPhase::refused, TaskReason::kernel_refused, ILK_VERDICT_DISABLED);
  EXPECT_EQ(state(1), ProposalState::refused);
  EXPECT_EQ(registry_.find(1)->verdict, "DISABLED");
  EXPECT_THAT(registry_.find(1)->detail, testing::HasSubstr("Enable the axis."));
}

TEST_F(MotionRegistryTest, AFaultEndsItByName) {
  (void)propose();
  report(1, TaskPhase::aborted, TaskReason::axis_faulted, ILK_FAULT_STALL);
  EXPECT_EQ(state(1), ProposalState::aborted);
  EXPECT_THAT(registry_.find(1)->detail, testing::HasSubstr("STALL"));
}

TEST_F(MotionRegistryTest, ANewerProposalOfTheAxisReplacesTheOlder) {
  (void)propose();
  (void)propose(1200);
  EXPECT_EQ(state(1), ProposalState::aborted);
  EXPECT_THAT(registry_.find(1)->detail, testing::HasSubstr("proposal 2"));
  EXPECT_EQ(registry_.open_of(insertion)->id, 2u);
}

TEST_F(MotionRegistryTest, ARefusedDraftReplacesNothing) {
  (void)propose();
  EXPECT_FALSE(propose(100000));
  EXPECT_EQ(state(1), ProposalState::approved);
}

TEST_F(MotionRegistryTest, ProposalsOfDifferentAxesStandSideBySide) {
  (void)propose();
  (void)propose(100, test::rotation);
  EXPECT_EQ(state(1), ProposalState::approved);
  EXPECT_EQ(state(2), ProposalState::approved);
}

TEST_F(MotionRegistryTest, StopAbortsAllThatIsOpen) {
  (void)propose();
  report(1, TaskPhase::done, TaskReason::arrived);
  (void)propose();
  (void)propose(100, test::rotation);
  registry_.abort_all("STOP.", "bob");
  EXPECT_EQ(state(1), ProposalState::done);
  EXPECT_EQ(registry_.find(1)->changed_by, "console") << "that was her motion";
  EXPECT_EQ(registry_.find(2)->changed_by, "bob");
  EXPECT_EQ(state(2), ProposalState::aborted);
  EXPECT_EQ(state(3), ProposalState::aborted);
}

TEST_F(MotionRegistryTest, AnApprovalThatOvertookTheStopIsCancelledByItsNumber) {
  (void)propose();
  registry_.abort_all("STOP.", "bob");
  ASSERT_EQ(sent_.size(), 2u);
  EXPECT_EQ(std::get<Cancel>(sent_[1]).task, 1u);
}

TEST_F(MotionRegistryTest, WhatHasEndedHereEndsOnTheControlThreadForAsLongAsThatShowsItOpen) {
  (void)propose();
  accepts_ = false;
  registry_.abort_all("STOP.", "bob");
  accepts_ = true;
  for (const TaskPhase phase : {TaskPhase::waiting, TaskPhase::executing, TaskPhase::paused}) {
    sent_.clear();
    report(1, phase);
    ASSERT_EQ(sent_.size(), 1u);
    EXPECT_EQ(std::get<Cancel>(sent_[0]).task, 1u);
  }
  sent_.clear();
  report(1, TaskPhase::aborted);
  EXPECT_THAT(sent_, testing::IsEmpty());
}

TEST_F(MotionRegistryTest, HomingIsApprovedFromWhereverTheAxisIs) {
  const auto waits =
      registry_.propose({home_axis(insertion), "ann", RobotMode::home, TaskSource::openigtlink}, view_);
  test::move(view_, insertion, 50);
  EXPECT_TRUE(registry_.approve(waits->id, view_));
}

TEST_F(MotionRegistryTest, WhatRestsOnWhereAxesStandIsStaleOnceTheyDoNot) {
  const std::int32_t there = view_.snapshot.state.axis[test::rotation].position_counts;
  Task task{MoveTask{insertion, 1000}, "ann", RobotMode::manual, TaskSource::openigtlink};
  task.rests_on = {{test::rotation, there}};
  const auto waits = registry_.propose(task, view_);
  ASSERT_TRUE(waits);
  test::move(view_, test::rotation, 50);
  const auto stale = registry_.approve(waits->id, view_);
  ASSERT_FALSE(stale);
  EXPECT_EQ(stale.error().code, "STALE");
  EXPECT_EQ(state(waits->id), ProposalState::refused);
}

TEST_F(MotionRegistryTest, ALockByAnyCauseDiscardsWhatWaitsForApproval) {
  ControlView locked = view_;
  locked.snapshot.state.system.mode = ILK_MODE_LOCKED;
  for (std::uint32_t cause = ILK_CAUSE_BOOT; cause < ILK_CAUSE_COUNT; ++cause) {
    const auto waits =
        registry_.propose({home_axis(insertion), "ann", RobotMode::home, TaskSource::openigtlink}, view_);
    ASSERT_TRUE(waits) << waits.error().detail;
    ASSERT_EQ(waits->state, ProposalState::checked);
    locked.snapshot.state.system.cause = cause;
    registry_.follow(locked);
    EXPECT_EQ(state(waits->id), ProposalState::aborted) << cause;
  }
}

TEST_F(MotionRegistryTest, TheLossOfAnAuthorPausesWhatIsApprovedSaysSoAndEndsWhatIsNot) {
  (void)registry_.propose({home_axis(insertion), "ann", RobotMode::home, TaskSource::openigtlink}, view_);
  (void)propose();
  report(2, TaskPhase::executing);
  (void)propose(100, test::rotation);
  registry_.lose_author(TaskSource::openigtlink, "Gone.");
  EXPECT_EQ(state(1), ProposalState::aborted) << "nobody had approved it";
  EXPECT_EQ(state(2), ProposalState::executing) << "until the kernel leaves MOTION";
  EXPECT_EQ(state(3), ProposalState::approved);
  EXPECT_THAT(registry_.find(3)->detail, testing::StartsWith("Gone. Waits for the pedal"));
  report(2, TaskPhase::paused, TaskReason::pedal_released);
  EXPECT_EQ(state(2), ProposalState::paused);
  EXPECT_THAT(registry_.find(2)->detail, testing::StartsWith("Gone. Motion ended; press"));
  report(2, TaskPhase::executing);
  report(2, TaskPhase::paused, TaskReason::pedal_released);
  EXPECT_THAT(registry_.find(2)->detail, testing::StartsWith("Motion ended")) << "that was the pedal";
}

TEST_F(MotionRegistryTest, AbortCancelsTheOrder) {
  (void)propose();
  const auto aborted = registry_.abort(1);
  ASSERT_TRUE(aborted);
  EXPECT_EQ(aborted->state, ProposalState::aborted);
  EXPECT_EQ(std::get<Cancel>(sent_.at(1)).task, 1u);
}

TEST_F(MotionRegistryTest, WhoEndsAProposalIsNamedWhoeverWroteIt) {
  (void)propose();
  EXPECT_EQ(registry_.find(1)->changed_by, "console");
  EXPECT_EQ(registry_.abort(1, "bob")->detail, "Ended by bob.");
  EXPECT_EQ(registry_.find(1)->changed_by, "bob");
  (void)propose();
  EXPECT_EQ(registry_.abort(2, "console")->detail, "Ended by its author.");
  (void)propose();
  report(3, TaskPhase::aborted, TaskReason::let_go);
  EXPECT_EQ(registry_.find(3)->changed_by, "app") << "nobody asked for it";
}

TEST_F(MotionRegistryTest, WhatHasEndedCannotBeAborted) {
  (void)propose();
  (void)registry_.abort(1);
  EXPECT_EQ(registry_.abort(1).error().code, "ENDED");
}

TEST_F(MotionRegistryTest, RefusesAnotherConfigurationThanTheKernels) {
  view_.snapshot.config_crc ^= 1u;
  expect_refused("CONFIG_MISMATCH");
}

TEST_F(MotionRegistryTest, RefusesWhileLocked) {
  view_.snapshot.state.system.mode = ILK_MODE_LOCKED;
  expect_refused("MODE");
}

TEST_F(MotionRegistryTest, RefusesAFaultedAxis) {
  axis().state = ILK_AXIS_FAULTED;
  expect_refused("FAULTED");
}

TEST_F(MotionRegistryTest, RefusesADisabledAxis) {
  axis().state = ILK_AXIS_DISABLED;
  expect_refused("DISABLED");
}

TEST_F(MotionRegistryTest, RefusesAHomingAxis) {
  axis().state = ILK_AXIS_HOMING;
  expect_refused("BUSY");
}

TEST_F(MotionRegistryTest, RefusesOneCountBeyondTheRange) {
  const std::int32_t highest = neuro().at_slot(insertion)->highest_setpoint_counts();
  EXPECT_TRUE(propose(highest));
  const auto beyond = propose(highest + 1);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, "RANGE");
  EXPECT_THAT(beyond.error().expected, testing::HasSubstr(std::to_string(highest)));
}

TEST_F(MotionRegistryTest, RefusesADriveAboveTheUnhomedBound) {
  axis().homed = 0;
  const std::uint32_t bound = neuro_config().axis[insertion].unhomed_max_drive;
  const std::int32_t here = axis().position_counts;
  EXPECT_TRUE(registry_.propose({MoveTask{insertion, here, bound}, "console"}, view_));
  EXPECT_EQ(registry_.propose({MoveTask{insertion, here, bound + 1}, "console"}, view_).error().code,
            "DRIVE");
}

TEST_F(MotionRegistryTest, RefusesAnEmptySlot) {
  EXPECT_EQ(propose(0, test::empty_slot).error().code, "AXIS");
}

TEST_F(MotionRegistryTest, SaysWhenTheControlThreadTakesNothing) {
  accepts_ = false;
  EXPECT_EQ(propose().error().code, "OVERLOADED");
  EXPECT_EQ(state(1), ProposalState::refused);
}

TEST_F(MotionRegistryTest, KeepsTheNewestTwoHundredAndWhateverIsOpen) {
  (void)propose(100, test::rotation);
  for (int i = 0; i < 300; ++i) {
    (void)propose();
  }
  const auto all = registry_.newest_first();
  EXPECT_EQ(all.size(), MotionRegistry::capacity);
  EXPECT_EQ(all.front().id, 301u);
  EXPECT_EQ(all.back().id, 1u);
  EXPECT_EQ(state(1), ProposalState::approved);
}

TEST_F(MotionRegistryTest, ShowsTimesInUtcWithMillisecondsAndTick) {
  (void)propose();
  const nlohmann::json json = to_json(*registry_.find(1));
  EXPECT_EQ(json["created"], "2024-05-01T12:34:56.789Z");
  EXPECT_EQ(json["created_tick"], 1000);
  EXPECT_TRUE(json["ended"].is_null());
  EXPECT_FALSE(json.contains("drive"));
}

}  // namespace
}  // namespace interlock
