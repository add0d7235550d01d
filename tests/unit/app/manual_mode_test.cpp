#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "modes/manual/mode.hpp"
#include "motion/realtime_channel.hpp"
#include "robot_fixture.hpp"
#include "tasks.hpp"

namespace interlock {
namespace {

using test::insertion;
using test::minute_ticks;
using test::neuro;
using test::neuro_config;

class ManualModeTest : public testing::Test {
 protected:
  ManualModeTest() : snapshot_(test::ready_view().snapshot), mode_(RobotPlan(neuro(), neuro_config())) {}

  void order(std::uint32_t proposal = 1, std::uint32_t slot = insertion, std::int32_t target = 1500,
             std::uint32_t drive = 0) {
    mode_.take(test::task_of(proposal, MoveTask{slot, target, drive}), snapshot_.state.system.tick);
  }

  std::vector<KernelRequest> tick(std::uint32_t ticks = 1) {
    snapshot_.state.system.tick += ticks;
    KernelRequests requests;
    mode_.tick(snapshot_, requests);
    return {requests.all().begin(), requests.all().end()};
  }

  void press() {
    snapshot_.state.system.mode = ILK_MODE_MOTION;
    (void)tick();
  }

  ilk_axis_t& axis() { return snapshot_.state.axis[insertion]; }
  [[nodiscard]] TaskStatus status(std::uint32_t slot = insertion) const {
    ControlView view;
    mode_.report(view);
    return view.tasks.move(slot);
  }

  ilk_snapshot_t snapshot_;
  ManualMode mode_;
};

TEST_F(ManualModeTest, SendsNothingBeforeThePedal) {
  order();
  EXPECT_THAT(tick(), testing::IsEmpty());
  EXPECT_EQ(status().phase, TaskPhase::waiting);
}

TEST_F(ManualModeTest, MovesTowardsTheTargetWhileThePedalIsHeld) {
  order();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  const auto requests = tick();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].origin.task, 1u);
  EXPECT_EQ(requests[0].origin.slot, insertion);
  EXPECT_EQ(requests[0].target_counts, 1501) << "so that it rests at 1500";
  EXPECT_EQ(requests[0].drive, neuro_config().axis[insertion].max_drive);
  EXPECT_EQ(status().phase, TaskPhase::executing);
}

TEST_F(ManualModeTest, KeepsTheBoundOfTheProposal) {
  order(1, insertion, 1500, 9000);
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  EXPECT_EQ(tick().at(0).drive, 9000u);
}

TEST_F(ManualModeTest, KeepsTheUnhomedBound) {
  axis().homed = 0;
  order();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  EXPECT_EQ(tick().at(0).drive, neuro_config().axis[insertion].unhomed_max_drive);
}

TEST_F(ManualModeTest, RenewsTheLeaseTwiceBeforeItRunsOut) {
  order();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  const std::uint32_t lease = tick().at(0).lease_ticks;
  EXPECT_LE(lease, neuro_config().common.lease_max_ticks);
  std::uint32_t renewals = 0;
  for (std::uint32_t i = 1; i < lease; ++i) {
    renewals += static_cast<std::uint32_t>(tick().size());
  }
  EXPECT_GE(renewals, 2u);
  EXPECT_LE(renewals, 5u);
}

TEST_F(ManualModeTest, TellsTheKernelAtOnceToSlowDown) {
  order();
  press();
  axis().position_counts = 1490;
  EXPECT_LT(tick().at(0).drive, neuro_config().axis[insertion].max_drive);
}

TEST_F(ManualModeTest, WishesAtMostOnceAnAxisAndTick) {
  for (const Axis& each : neuro().axes) {
    order(each.slot + 1, each.slot, each.lowest_setpoint_counts());
    order(each.slot + 11, each.slot, each.highest_setpoint_counts());
  }
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  EXPECT_EQ(tick().size(), neuro().axes.size());
}

TEST_F(ManualModeTest, ReleasePausesAndPressGoesOn) {
  order();
  press();
  snapshot_.state.system.mode = ILK_MODE_READY;
  EXPECT_THAT(tick(), testing::IsEmpty());
  EXPECT_EQ(status().phase, TaskPhase::paused);
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  EXPECT_EQ(tick(minute_ticks).size(), 1u);
  EXPECT_EQ(status().phase, TaskPhase::executing);
}

TEST_F(ManualModeTest, ExpiresAfterAMinuteOfKernelTimeWithoutThePedal) {
  order();
  press();
  snapshot_.state.system.mode = ILK_MODE_READY;
  (void)tick();
  (void)tick(minute_ticks);
  EXPECT_EQ(status().phase, TaskPhase::paused);
  (void)tick();
  EXPECT_EQ(status().phase, TaskPhase::expired);
}

TEST_F(ManualModeTest, APressAfterAMinuteFindsNothingToMove) {
  order();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  EXPECT_THAT(tick(minute_ticks + 1), testing::IsEmpty());
  EXPECT_EQ(status().phase, TaskPhase::expired);
}

TEST_F(ManualModeTest, LockedDiscardsTheOrder) {
  order();
  press();
  snapshot_.state.system.mode = ILK_MODE_LOCKED;
  snapshot_.state.system.cause = ILK_CAUSE_ESTOP;
  EXPECT_THAT(tick(), testing::IsEmpty());
  EXPECT_EQ(status().phase, TaskPhase::aborted);
  EXPECT_EQ(status().reason, TaskReason::locked);
  EXPECT_EQ(status().code, static_cast<std::uint32_t>(ILK_CAUSE_ESTOP));
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  EXPECT_THAT(tick(), testing::IsEmpty());
}

TEST_F(ManualModeTest, StopAbortsEveryOpenOrder) {
  order(1, insertion);
  order(2, test::rotation, 100);
  press();
  mode_.end_all(TaskReason::stopped, snapshot_.state.system.tick);
  for (const std::uint32_t slot : {insertion, test::rotation}) {
    EXPECT_EQ(status(slot).phase, TaskPhase::aborted);
    EXPECT_EQ(status(slot).reason, TaskReason::stopped);
  }
}

TEST_F(ManualModeTest, AnAxisTakenOutOfMotionEndsItsOrder) {
  order();
  axis().state = ILK_AXIS_DISABLED;
  (void)tick();
  EXPECT_EQ(status().reason, TaskReason::axis_disabled);
}

TEST_F(ManualModeTest, AFaultEndsTheOrderAndIsNamed) {
  order();
  press();
  axis().state = ILK_AXIS_FAULTED;
  axis().fault = ILK_FAULT_STALL;
  snapshot_.state.system.mode = ILK_MODE_READY;
  (void)tick();
  EXPECT_EQ(status().reason, TaskReason::axis_faulted);
  EXPECT_EQ(status().code, static_cast<std::uint32_t>(ILK_FAULT_STALL));
}

TEST_F(ManualModeTest, HomingTakesTheAxisOver) {
  order();
  press();
  axis().state = ILK_AXIS_HOMING;
  EXPECT_THAT(tick(), testing::IsEmpty());
  EXPECT_EQ(status().reason, TaskReason::axis_homing);
}

TEST_F(ManualModeTest, ARefusalOfTheKernelEndsTheOrderWithItsVerdict) {
  order();
  press();
  mode_.on_verdict({ILK_REQUEST_MOVE, insertion, 1}, ILK_VERDICT_RANGE, 1234);
  EXPECT_EQ(status().phase, TaskPhase::refused);
  EXPECT_EQ(status().code, static_cast<std::uint32_t>(ILK_VERDICT_RANGE));
  EXPECT_EQ(status().tick, 1234u);
  EXPECT_EQ(tick().at(0).lease_ticks, 1u) << "an earlier lease may still drive the axis";
  EXPECT_THAT(tick(), testing::IsEmpty());
}

TEST_F(ManualModeTest, AVerdictOnAnOlderOrderDoesNotTouchTheNewerOne) {
  order(1);
  press();
  order(2);
  mode_.on_verdict({ILK_REQUEST_MOVE, insertion, 1}, ILK_VERDICT_RANGE, 1234);
  EXPECT_EQ(status().task, 2u);
  EXPECT_EQ(status().phase, TaskPhase::waiting);
}

TEST_F(ManualModeTest, APedalReleasedMeanwhileIsNoRefusal) {
  order();
  press();
  mode_.on_verdict({ILK_REQUEST_MOVE, insertion, 1}, ILK_VERDICT_MODE, 1234);
  EXPECT_EQ(status().phase, TaskPhase::executing);
}

TEST_F(ManualModeTest, CancellingGivesBackTheLease) {
  order();
  press();
  axis().state = ILK_AXIS_MOVING;
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  const auto requests = tick();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].drive, 1u);
  EXPECT_EQ(requests[0].lease_ticks, 1u);
  EXPECT_THAT(tick(), testing::IsEmpty());
}

TEST_F(ManualModeTest, CancellingGivesBackALeaseThatNoSnapshotShowsYet) {
  order();
  press();
  ASSERT_EQ(axis().state, static_cast<std::uint32_t>(ILK_AXIS_ENABLED));
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  const auto requests = tick();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].drive, 1u);
  EXPECT_EQ(requests[0].lease_ticks, 1u);
  EXPECT_THAT(tick(), testing::IsEmpty());
}

TEST_F(ManualModeTest, CancellingGivesBackTheLeaseWhoseRenewalWasNotSent) {
  order();
  press();
  axis().state = ILK_AXIS_MOVING;
  const auto renewal = tick(neuro_config().common.lease_max_ticks);
  mode_.on_unsent(renewal.at(0));
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  const auto requests = tick();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].drive, 1u);
  EXPECT_EQ(requests[0].lease_ticks, 1u);
}

TEST_F(ManualModeTest, CancellingGivesBackTheLeaseOfTheOrderThatItReplaced) {
  order(1);
  press();
  axis().state = ILK_AXIS_MOVING;
  order(2, insertion, 1000);
  mode_.on_unsent(tick().at(0));
  mode_.end(2, TaskReason::cancelled, snapshot_.state.system.tick);
  const auto requests = tick();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].drive, 1u);
  EXPECT_EQ(requests[0].lease_ticks, 1u);
}

TEST_F(ManualModeTest, NothingIsGivenBackWhereNothingWasSent) {
  order();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  mode_.on_unsent(tick().at(0));
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  EXPECT_THAT(tick(), testing::IsEmpty());
}

TEST_F(ManualModeTest, AWishThatWasNotSentIsRepeated) {
  order();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  const auto requests = tick();
  mode_.on_unsent(requests.at(0));
  EXPECT_EQ(tick().size(), 1u);
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  axis().state = ILK_AXIS_MOVING;
  const auto release = tick();
  mode_.on_unsent(release.at(0));
  EXPECT_EQ(tick().size(), 1u);
}

TEST_F(ManualModeTest, IsDoneAfterFiftyTicksAtRestWithinTheDeadband) {
  order();
  press();
  axis().position_counts = 1499;
  (void)tick();
  for (int i = 0; i < 49; ++i) {
    (void)tick();
    EXPECT_EQ(status().phase, TaskPhase::executing);
  }
  (void)tick();
  EXPECT_EQ(status().phase, TaskPhase::done);
}

TEST_F(ManualModeTest, NoiseOfTheCounterDoesNotDelayArrival) {
  order();
  press();
  for (std::int32_t i = 0; i < 52; ++i) {
    axis().position_counts = 1500 + i % 2;
    (void)tick();
  }
  EXPECT_EQ(status().phase, TaskPhase::done);
}

TEST_F(ManualModeTest, PassingThroughTheTargetIsNotArrival) {
  order();
  press();
  for (std::int32_t i = 0; i < 200; ++i) {
    axis().position_counts = i % 40 < 30 ? 1500 : 1510;
    (void)tick();
  }
  EXPECT_EQ(status().phase, TaskPhase::executing);
}

TEST_F(ManualModeTest, ALimitThatHoldsTheAxisBackEndsTheOrder) {
  order();
  press();
  snapshot_.gate[insertion] = ILK_GATE_HARD_LIMIT;
  (void)tick(499);
  EXPECT_EQ(status().phase, TaskPhase::executing);
  (void)tick();
  EXPECT_EQ(status().phase, TaskPhase::aborted);
  EXPECT_EQ(status().reason, TaskReason::blocked);
  EXPECT_EQ(status().code, static_cast<std::uint32_t>(ILK_GATE_HARD_LIMIT));
}

TEST_F(ManualModeTest, SurvivesTheWrapOfTheTickCounter) {
  snapshot_.state.system.tick = UINT32_MAX - 10;
  order();
  press();
  EXPECT_EQ(tick(20).size(), 1u);
  EXPECT_EQ(status().phase, TaskPhase::executing);
}

TEST_F(ManualModeTest, IgnoresASlotThatDoesNotExist) {
  mode_.take(test::task_of(1, MoveTask{ILK_SLOTS, 0}), 0);
  mode_.end(1, TaskReason::cancelled, 0);
  mode_.on_verdict({ILK_REQUEST_MOVE, ILK_SLOTS, 1}, ILK_VERDICT_RANGE, 0);
  EXPECT_THAT(tick(), testing::IsEmpty());
}

}  // namespace
}  // namespace interlock
