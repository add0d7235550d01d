#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "proposals/motion_registry.hpp"
#include "proposals/proposal_json.hpp"
#include "robot_fixture.hpp"
#include "tasks.hpp"
#include "trajectory/trajectory_csv.hpp"

namespace interlock {
namespace {

using test::neuro;
using test::neuro_config;
using test::prostate;

constexpr std::uint32_t head_axis = 7;

Task along(std::vector<PathLeg> legs) {
  return {test::along({std::move(legs)}), "edna", RobotMode::coordinated};
}

Task draft_to(std::vector<AxisCounts> targets) { return along({MoveLeg{std::move(targets), 0.0, 0.0}}); }

Task file_draft() {
  const auto trajectory = read_trajectory("time [s],yaw [rad]\n0,-0.5\n2,-0.7\n", neuro());
  return {test::along({{TimedLeg{trajectory.value()}}}), "edna", RobotMode{"trajectory"}, TaskSource::file};
}

class PathProposalTest : public testing::Test {
 protected:
  PathProposalTest() : view_(test::ready_view()) {}

  void report(std::uint32_t proposal, TaskPhase phase, TaskReason reason = TaskReason::none) {
    ControlView view = view_;
    view.tasks.of<PathTask>() = {proposal, phase, reason, 0, 0};
    registry_.follow(view);
  }

  void expect_refused(const Task& draft, const std::string& code) {
    const auto proposal = registry_.propose(draft, view_);
    ASSERT_FALSE(proposal);
    EXPECT_EQ(proposal.error().code, code) << proposal.error().detail;
    EXPECT_FALSE(proposal.error().next_step.empty());
    EXPECT_THAT(sent_, testing::IsEmpty());
  }

  ilk_axis_t& axis(std::uint32_t slot) { return view_.snapshot.state.axis[slot]; }
  [[nodiscard]] ProposalState state(std::uint32_t id) const { return registry_.find(id)->state; }

  ControlView view_;
  UtcTime now_{std::chrono::milliseconds(1714566896789)};
  std::vector<Command> sent_;
  MotionRegistry registry_{neuro(), neuro_config(),
                           [this](const Command& command) {
                             sent_.push_back(command);
                             return true;
                           },
                           [this] { return now_; }};
};

TEST_F(PathProposalTest, ASeveralAxesMotionWaitsForItsOwnApprovalWhoeverProposesIt) {
  const auto waits = registry_.propose(draft_to({{test::yaw, -300}, {head_axis, -1000}}), view_);
  ASSERT_TRUE(waits) << waits.error().detail;
  EXPECT_EQ(waits->state, ProposalState::checked);
  EXPECT_THAT(sent_, testing::IsEmpty());
  EXPECT_EQ(registry_.propose({MoveTask{test::insertion, 1000}, "edna"}, view_)->state,
            ProposalState::approved)
      << "whoever moves one axis by hand sees what it does";
}

TEST_F(PathProposalTest, AConsolesPathIsCheckedApprovedAndOrdered) {
  const auto proposal = test::approved(registry_, draft_to({{test::yaw, -300}, {head_axis, -1000}}), view_);
  ASSERT_TRUE(proposal) << proposal.error().detail;
  EXPECT_EQ(proposal->state, ProposalState::approved);
  EXPECT_EQ(proposal->axes, (std::vector<std::string>{"yaw", "head"}));
  EXPECT_EQ(proposal->ends, (std::vector<AxisCounts>{{test::yaw, -300}, {head_axis, -1000}}));
  EXPECT_GT(proposal->duration_s, 1.0);
  ASSERT_EQ(sent_.size(), 1u);
  EXPECT_EQ(std::get<Approval>(sent_.front()).task->id, proposal->id);
  EXPECT_EQ(registry_.app_mode(), "coordinated");
  report(proposal->id, TaskPhase::executing);
  EXPECT_EQ(state(1), ProposalState::executing);
  report(proposal->id, TaskPhase::done, TaskReason::arrived);
  EXPECT_EQ(state(1), ProposalState::done);
  EXPECT_EQ(registry_.app_mode(), "manual");
}

TEST_F(PathProposalTest, WhatWasPlannedFromElsewhereIsLookedAtAgainBeforeItIsApproved) {
  const Task draft = draft_to({{test::yaw, -300}, {head_axis, -1000}});
  ASSERT_TRUE(registry_.propose(draft, view_));
  test::move(view_, test::yaw, -3);
  test::move(view_, test::insertion, 500);
  ASSERT_TRUE(registry_.approve(1, view_)) << "it stands there but for noise; the other is not moved";
  ASSERT_TRUE(registry_.propose(draft, view_));
  test::move(view_, head_axis, -50);
  const auto moved = registry_.approve(2, view_);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().code, "MOVED");
  EXPECT_EQ(state(2), ProposalState::checked);
  EXPECT_TRUE(registry_.approve(2, view_)) << "it was planned from there";
  ASSERT_TRUE(registry_.propose(draft_to({{head_axis, -1000}}), view_));
  test::move(view_, head_axis, -50);
  EXPECT_TRUE(registry_.approve(3, view_)) << "one axis goes straight there from wherever it is";
}

TEST_F(PathProposalTest, AFilesPathIsApprovedWithoutAClickOnlyWhereTheRobotFileSaysSo) {
  const auto waits = registry_.propose(file_draft(), view_);
  ASSERT_TRUE(waits) << waits.error().detail;
  EXPECT_EQ(waits->state, ProposalState::checked);
  EXPECT_THAT(sent_, testing::IsEmpty());

  Robot trainer = neuro();
  trainer.auto_approve = true;
  MotionRegistry registry{trainer, neuro_config(),
                          [this](const Command& command) {
                            sent_.push_back(command);
                            return true;
                          },
                          [this] { return now_; }};
  axis(test::yaw).state = ILK_AXIS_DISABLED;
  EXPECT_FALSE(registry.propose(file_draft(), view_)) << "its checks still have to pass";
  EXPECT_THAT(sent_, testing::IsEmpty());
  axis(test::yaw).state = ILK_AXIS_ENABLED;
  const auto approved = registry.propose(file_draft(), view_);
  ASSERT_TRUE(approved) << approved.error().detail;
  EXPECT_EQ(approved->state, ProposalState::approved);
  EXPECT_THAT(sent_, testing::SizeIs(1));
  Task of_a_program = file_draft();
  of_a_program.source = TaskSource::openigtlink;
  EXPECT_EQ(registry.propose(of_a_program, view_)->state, ProposalState::checked);
}

TEST_F(PathProposalTest, ATaskLivesUntilTheControlThreadLetsGoOfItAndIsFreedByTheBook) {
  std::weak_ptr<const Task> watched;
  TaskReference held;
  {
    ASSERT_TRUE(test::approved(registry_, draft_to({{test::yaw, -300}}), view_));
    held = std::get<Approval>(sent_.front()).task;
    watched = held;
    sent_.clear();
  }
  ASSERT_TRUE(registry_.abort(1));
  for (std::uint32_t id = 2; id < 2 + MotionRegistry::capacity; ++id) {
    ASSERT_TRUE(registry_.propose({MoveTask{test::insertion, 1000}, "edna"}, view_));
  }
  ASSERT_EQ(registry_.find(1), nullptr) << "the book has forgotten the proposal";
  report(1, TaskPhase::aborted, TaskReason::cancelled);
  held.reset();
  EXPECT_FALSE(watched.expired()) << "the control thread frees nothing";
  registry_.follow(view_);
  EXPECT_TRUE(watched.expired());
}

TEST_F(PathProposalTest, WhatCannotBeMovedIsRefusedWithItsReason) {
  axis(head_axis).homed = 0;
  expect_refused(draft_to({{head_axis, -1000}}), "NOT_HOMED");
  axis(head_axis).homed = 1;
  axis(head_axis).state = ILK_AXIS_DISABLED;
  expect_refused(draft_to({{test::yaw, -300}, {head_axis, -1000}}), "DISABLED");
  axis(head_axis).state = ILK_AXIS_FAULTED;
  expect_refused(draft_to({{head_axis, -1000}}), "FAULTED");
  axis(head_axis).state = ILK_AXIS_HOMING;
  expect_refused(draft_to({{head_axis, -1000}}), "BUSY");
  axis(head_axis).state = ILK_AXIS_ENABLED;
  expect_refused(draft_to({{head_axis, 1}}), "RANGE");
  view_.snapshot.state.system.mode = ILK_MODE_LOCKED;
  expect_refused(draft_to({{head_axis, -1000}}), "MODE");
}

TEST_F(PathProposalTest, ALaterLegIsCheckedFromWhereTheOneBeforeEnds) {
  const auto good = registry_.propose(
      along({MoveLeg{{{head_axis, -1000}}, 3.0, 0.5}, MoveLeg{{{head_axis, -5000}}, 0.0, 0.0}}), view_);
  ASSERT_TRUE(good);
  EXPECT_GT(good->duration_s, 3.5 + 4000.0 / 600.0);
  sent_.clear();
  expect_refused(along({MoveLeg{{{head_axis, -1000}}, 0.0, 0.0}, MoveLeg{{{head_axis, -12000}}, 0.0, 0.0}}),
                 "RANGE");
}

TEST_F(PathProposalTest, AFileWaitsForApprovalAndIsCheckedAnewThen) {
  const auto waiting = registry_.propose(file_draft(), view_);
  ASSERT_TRUE(waiting);
  EXPECT_EQ(waiting->state, ProposalState::checked);
  EXPECT_EQ(to_json(*waiting)["source"], "file");
  EXPECT_THAT(sent_, testing::IsEmpty());
  EXPECT_EQ(registry_.app_mode(), "manual");
  axis(test::yaw).homed = 0;
  const auto unfit = registry_.approve(1, view_);
  ASSERT_FALSE(unfit);
  EXPECT_EQ(unfit.error().code, "NOT_HOMED");
  EXPECT_EQ(state(1), ProposalState::refused);
  axis(test::yaw).homed = 1;
  ASSERT_TRUE(registry_.propose(file_draft(), view_));
  ASSERT_TRUE(registry_.approve(2, view_));
  EXPECT_EQ(std::get<Approval>(sent_.back()).task->id, 2u);
  EXPECT_EQ(registry_.app_mode(), "trajectory");
  const auto twice = registry_.approve(2, view_);
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().code, "NOT_WAITING");
}

TEST_F(PathProposalTest, AMotionThatCouldNotBePlannedIsToldInWords) {
  ASSERT_TRUE(test::approved(registry_, draft_to({{test::yaw, -300}}), view_));
  report(1, TaskPhase::aborted, TaskReason::no_path);
  EXPECT_EQ(state(1), ProposalState::aborted);
  EXPECT_THAT(registry_.find(1)->detail, testing::HasSubstr("No motion within the rates of the axes"));
}

TEST_F(PathProposalTest, ALockDiscardsWhatWaits) {
  ASSERT_TRUE(registry_.propose(file_draft(), view_));
  view_.snapshot.state.system.mode = ILK_MODE_LOCKED;
  registry_.follow(view_);
  EXPECT_EQ(state(1), ProposalState::aborted);
}

TEST_F(PathProposalTest, AnotherHomeOfItsAxisEndsWhatWaits) {
  ASSERT_TRUE(registry_.propose(file_draft(), view_));
  axis(test::yaw).raw -= 5;
  axis(test::yaw).position_counts += 5;
  axis(head_axis).position_counts += 7;
  registry_.follow(view_);
  EXPECT_EQ(state(1), ProposalState::checked) << "its axis moved, and another got a home position";
  axis(test::yaw).position_counts = 0;
  EXPECT_FALSE(registry_.approve(1, view_)) << "before anybody followed the view";
  EXPECT_EQ(state(1), ProposalState::aborted);
  EXPECT_THAT(registry_.find(1)->detail, testing::HasSubstr("The home position of yaw changed"));
}

TEST_F(PathProposalTest, NumbersGoOnFromThoseOfAnEarlierRun) {
  registry_.number_after(41);
  EXPECT_EQ(registry_.propose(file_draft(), view_)->id, 42u);
}

TEST_F(PathProposalTest, WhatNobodyApprovesExpires) {
  ASSERT_TRUE(registry_.propose(file_draft(), view_));
  now_ += std::chrono::minutes(10);
  registry_.follow(view_);
  EXPECT_EQ(state(1), ProposalState::checked);
  now_ += std::chrono::milliseconds(1);
  registry_.follow(view_);
  EXPECT_EQ(state(1), ProposalState::expired);
}

TEST_F(PathProposalTest, AFullBookTellsTheOldestThatWaitsThatItGoes) {
  std::vector<std::uint32_t> ended;
  registry_.on_change([&](const Proposal& each) {
    if (!is_open(each.state)) {
      ended.push_back(each.id);
    }
  });
  for (std::size_t i = 0; i <= MotionRegistry::capacity; ++i) {
    ASSERT_TRUE(registry_.propose(file_draft(), view_));
  }
  EXPECT_EQ(ended, std::vector<std::uint32_t>{1});
  EXPECT_EQ(registry_.find(1), nullptr);
}

TEST_F(PathProposalTest, ChangedTargetingEndsWhatFollowedFromIt) {
  Task aligned = draft_to({{head_axis, -1000}});
  aligned.targeting_revision = registry_.targeting_revision();
  ASSERT_TRUE(test::approved(registry_, aligned, view_));
  registry_.end_stale();
  EXPECT_EQ(state(1), ProposalState::aborted);
  EXPECT_EQ(std::get<Cancel>(sent_.back()).task, 1u);
  sent_.clear();
  expect_refused(aligned, "STALE");
  ASSERT_TRUE(test::approved(registry_, draft_to({{head_axis, -1000}}), view_));
  registry_.end_stale();
  EXPECT_EQ(state(3), ProposalState::approved) << "it names its targets itself";
}

TEST_F(PathProposalTest, APathReplacesEveryApprovedMotionAndKeepsMovesAway) {
  ASSERT_TRUE(registry_.propose({MoveTask{test::insertion, 1000}, "edna"}, view_));
  ASSERT_TRUE(test::approved(registry_, draft_to({{head_axis, -1000}}), view_));
  EXPECT_EQ(state(1), ProposalState::aborted);
  const auto move = registry_.propose({MoveTask{test::insertion, 900}, "edna"}, view_);
  ASSERT_FALSE(move);
  EXPECT_EQ(move.error().code, "MODE_PATH");
  ASSERT_TRUE(test::approved(registry_, draft_to({{head_axis, -900}}), view_));
  EXPECT_EQ(state(2), ProposalState::aborted);
}

TEST(PathRates, AnAxisWithoutMotionInItsFileIsNamedWithTheKeyThatIsMissing) {
  Robot robot = test::neuro();
  for (Axis& axis : robot.axes) {
    axis.motion.reset();
  }
  CheckList checks;
  const auto refused = check_path(robot, test::neuro_config(), test::ready_view(),
                                  {{MoveLeg{{{test::insertion, 1000}}, 0.0, 0.0}}}, checks);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, "NO_PATH");
  EXPECT_THAT(refused.error().expected, testing::HasSubstr("`motion`"));
  const auto trajectory = read_trajectory("time [s],yaw [rad]\n0,-0.5\n2,-0.7\n", robot);
  ASSERT_FALSE(trajectory) << "it could not be run either";
  EXPECT_EQ(code_name(trajectory.error().code), "NO_PATH");
  EXPECT_EQ(trajectory.error().column, "yaw [rad]");
}

TEST(PathSeparation, LinkedSlidersMayNotPartTooFarAtAnyTargetOrRow) {
  const ilk_config_t config = test::config_of(prostate());
  ControlView view;
  view.attached = true;
  view.snapshot.config_crc = config.crc;
  view.snapshot.state.system.mode = ILK_MODE_READY;
  for (const Axis& axis : prostate().axes) {
    ilk_axis_t& state = view.snapshot.state.axis[axis.slot];
    state.homed = 1;
    state.state = ILK_AXIS_ENABLED;
    const bool right = axis.name.ends_with("right");
    state.position_counts = axis.role == "insertion"  ? 1000
                            : axis.role == "rotation" ? 0
                            : right                   ? -375000
                                                      : 375000;
  }
  const auto code = [&](const PathProgram& program) {
    CheckList checks;
    const auto checked = check_path(prostate(), config, view, program, checks);
    return checked ? std::string("passes") : checked.error().code;
  };
  const std::uint32_t left = prostate().find("front_left")->slot;
  const std::uint32_t right = prostate().find("front_right")->slot;
  EXPECT_EQ(code({{MoveLeg{{{left, 460000}}, 0.0, 0.0}}}), "SEPARATION");
  EXPECT_EQ(code({{MoveLeg{{{left, 460000}, {right, -290000}}, 0.0, 0.0}}}), "passes");
  const auto timed = [](const std::string& rows) {
    return PathProgram{{TimedLeg{
        read_trajectory("time [s],front_left [mm],front_right [mm]\n" + rows, prostate()).value()}}};
  };
  EXPECT_EQ(code(timed("0,150,-150\n10,184,-116\n")), "passes");
  EXPECT_EQ(code(timed("0,150,-150\n10,184,-150\n")), "SEPARATION");
}

}  // namespace
}  // namespace interlock
