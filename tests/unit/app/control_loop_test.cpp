#include "motion/control_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <thread>

#include "control_loop_fixture.hpp"
#include "interlock/sim_bus.h"

namespace interlock {
namespace {

using test::insertion;
using test::neuro_config;

using ControlLoopTest = test::ControlLoopTest;

TEST_F(ControlLoopTest, AnApprovalThatComesAfterItsDeadlineStartsNothing) {
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  Approval late = test::approval_of(1, MoveTask{insertion, 1500});
  late.deadline = std::chrono::steady_clock::now();
  command(late);
  tick();
  EXPECT_EQ(move().phase, TaskPhase::aborted);
  EXPECT_EQ(move().reason, TaskReason::approved_late);
  EXPECT_EQ(sent(ILK_REQUEST_MOVE), nullptr);
  approve(2, MoveTask{insertion, 1500});
  tick();
  EXPECT_NE(sent(ILK_REQUEST_MOVE), nullptr);
}

TEST_F(ControlLoopTest, TellsTheKernelOfAChangedHolderInTheNextTick) {
  tick();
  channel_->holder = 7;
  tick();
  ASSERT_NE(sent(ILK_REQUEST_HEARTBEAT), nullptr);
  EXPECT_EQ(sent(ILK_REQUEST_HEARTBEAT)->holder, 7u);
}

TEST_F(ControlLoopTest, BeatsAtOnceAndWellWithinTheAppTimeout) {
  tick();
  ASSERT_NE(sent(ILK_REQUEST_HEARTBEAT), nullptr);
  EXPECT_EQ(sent(ILK_REQUEST_HEARTBEAT)->holder, 0u) << "nobody is in control yet";
  std::uint32_t longest = 0;
  for (std::uint32_t since = 1, i = 0; i < 500; ++i, ++since) {
    tick();
    longest = std::max(longest, since);
    since = sent(ILK_REQUEST_HEARTBEAT) != nullptr ? 0 : since;
  }
  EXPECT_LE(longest, 20u);
  EXPECT_LE(longest, neuro_config().common.app_timeout_ticks / 4);
}

TEST_F(ControlLoopTest, ShowsTheNewestSnapshotToTheNetwork) {
  tick();
  EXPECT_TRUE(channel_->view.newest().attached);
  EXPECT_EQ(channel_->view.newest().snapshot.state.system.tick, snapshot_.state.system.tick);
}

TEST_F(ControlLoopTest, BringsBackTheVerdictOfACall) {
  command(ask(7, ILK_REQUEST_ENABLE));
  tick();
  ASSERT_NE(sent(ILK_REQUEST_ENABLE), nullptr);
  EXPECT_EQ(sent(ILK_REQUEST_ENABLE)->axis, insertion);
  kernel_.push_verdict(*sent(ILK_REQUEST_ENABLE), ILK_VERDICT_CARD, 77);
  tick();
  const auto answers = notices<KernelResponse>();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].call_id, 7u);
  EXPECT_EQ(answers[0].verdict, static_cast<std::uint32_t>(ILK_VERDICT_CARD));
  EXPECT_EQ(answers[0].tick, 77u);
}

TEST_F(ControlLoopTest, NeverSendsACallForWhichNobodyWaitsAnyMore) {
  KernelCall late = ask(7, ILK_REQUEST_RESET);
  late.deadline = std::chrono::steady_clock::now() - std::chrono::seconds(1);
  command(late);
  tick();
  EXPECT_EQ(sent(ILK_REQUEST_RESET), nullptr);
  const auto answers = notices<KernelResponse>();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_FALSE(answers[0].verdict);
}

TEST_F(ControlLoopTest, ARestoreCarriesItsPosition) {
  KernelCall restore = ask(7, ILK_REQUEST_RESTORE);
  restore.target_counts = -321;
  command(restore);
  tick();
  ASSERT_NE(sent(ILK_REQUEST_RESTORE), nullptr);
  EXPECT_EQ(sent(ILK_REQUEST_RESTORE)->target_counts, -321);
}

TEST_F(ControlLoopTest, CarriesOutAnOrderAndFollowsItsVerdict) {
  approve(1, MoveTask{test::insertion, 1500});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  ASSERT_NE(sent(ILK_REQUEST_MOVE), nullptr);
  EXPECT_EQ(sent(ILK_REQUEST_MOVE)->target_counts, 1501) << "so that it rests at 1500";
  EXPECT_EQ(move().phase, TaskPhase::executing);
  kernel_.push_verdict(*sent(ILK_REQUEST_MOVE), ILK_VERDICT_RANGE, 5);
  tick();
  EXPECT_EQ(move().phase, TaskPhase::refused);
  EXPECT_EQ(notices<ilk_event_t>().size(), 1u);
}

TEST_F(ControlLoopTest, DoesNotReportRoutineAcceptances) {
  approve(1, MoveTask{test::insertion, 1500});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  for (const ilk_request_t& request : requests_) {
    kernel_.push_verdict(request, ILK_VERDICT_ACCEPTED, 5);
  }
  tick();
  EXPECT_THAT(notices<ilk_event_t>(), testing::IsEmpty());
}

TEST_F(ControlLoopTest, StopComesBeforeAnythingThatWaits) {
  approve(1, MoveTask{test::insertion, 1500});
  command(ask(7, ILK_REQUEST_ENABLE));
  stop();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  ASSERT_FALSE(requests_.empty());
  EXPECT_EQ(requests_.front().kind, static_cast<std::uint32_t>(ILK_REQUEST_STOP));
  kernel_.push_verdict(requests_.front(), ILK_VERDICT_ACCEPTED, 9);
  tick();
  const auto answers = notices<StopAnswer>();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].stops, 1u);
}

TEST_F(ControlLoopTest, APauseEndsMotionInTheSameTickAndTheOrderGoesOnAfterAnotherPress) {
  approve(1, MoveTask{test::insertion, 1500});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  EXPECT_EQ(move().phase, TaskPhase::executing);
  channel_->pauses.fetch_add(1, std::memory_order_release);
  tick();
  ASSERT_FALSE(requests_.empty());
  EXPECT_EQ(requests_.front().kind, static_cast<std::uint32_t>(ILK_REQUEST_STOP));
  kernel_.push_verdict(requests_.front(), ILK_VERDICT_ACCEPTED, snapshot_.state.system.tick);
  snapshot_.state.system.mode = ILK_MODE_READY;
  tick();
  EXPECT_EQ(sent(ILK_REQUEST_STOP), nullptr) << "once";
  EXPECT_EQ(move().phase, TaskPhase::paused);
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  EXPECT_EQ(move().phase, TaskPhase::executing);
  EXPECT_THAT(notices<StopAnswer>(), testing::IsEmpty()) << "it is no STOP";
}

TEST_F(ControlLoopTest, ASignalOfTheBreathingGateGrowsOldOnTheControlThreadAndConsolesLearnOfIt) {
  snapshot_.clock = ILK_CLOCK_SIM;
  snapshot_.period_us = 1000;
  tick();
  OutsideHolds& holds = channel_->holds.writing();
  holds = {};
  holds.gate.in_use = true;
  holds.gate.open = true;
  holds.gate.signal = DeadmanTimer(std::chrono::milliseconds(300));
  holds.gate.signal.hold(
      {std::chrono::steady_clock::now(), snapshot_.state.system.tick, snapshot_.period_us});
  channel_->holds.publish();
  tick(299);
  EXPECT_EQ(channel_->view.newest().gate, GateState::open);
  channel_->network_wake.clear();
  tick(1);
  EXPECT_EQ(channel_->view.newest().gate, GateState::no_signal);
  pollfd wake{channel_->network_wake.descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&wake, 1, 0), 1);
}

TEST_F(ControlLoopTest, ABreathingGateThatIsTurnedOffWhileItHoldsLetsNothingGoOnBeforeTheNextPress) {
  snapshot_.clock = ILK_CLOCK_SIM;
  snapshot_.period_us = 1000;
  approve(1, MoveTask{test::insertion, 1500});
  channel_->holds.writing() = {};
  channel_->holds.writing().gate.in_use = true;
  channel_->holds.publish();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  EXPECT_EQ(move().reason, TaskReason::breathing);
  channel_->holds.writing() = {};
  channel_->holds.publish();
  tick(100);
  EXPECT_EQ(channel_->view.newest().gate, GateState::off);
  EXPECT_EQ(sent(ILK_REQUEST_MOVE), nullptr);
  EXPECT_EQ(move().reason, TaskReason::gate_turned_off);
  BreathingGate& gate = channel_->holds.writing().gate;
  gate = {.in_use = true, .open = true};
  gate.signal.hold({std::chrono::steady_clock::now(), snapshot_.state.system.tick, snapshot_.period_us});
  channel_->holds.publish();
  tick(100);
  EXPECT_EQ(channel_->view.newest().gate, GateState::open);
  EXPECT_EQ(sent(ILK_REQUEST_MOVE), nullptr);
  snapshot_.state.system.mode = ILK_MODE_READY;
  tick();
  EXPECT_NE(move().reason, TaskReason::gate_turned_off);
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick(2);
  EXPECT_EQ(move().phase, TaskPhase::executing);
}

TEST_F(ControlLoopTest, AScanEndsMotionInTheSameTickForAsLongAsItLasts) {
  approve(1, MoveTask{test::insertion, 1500});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  EXPECT_EQ(move().phase, TaskPhase::executing);
  channel_->holds.writing() = {{}, true};
  channel_->holds.publish();
  for (int press = 0; press < 2; ++press) {
    tick();
    EXPECT_NE(sent(ILK_REQUEST_STOP), nullptr);
    EXPECT_EQ(sent(ILK_REQUEST_MOVE), nullptr);
    EXPECT_EQ(move().phase, TaskPhase::paused);
    EXPECT_EQ(move().reason, TaskReason::scanning);
    EXPECT_TRUE(channel_->view.newest().scanning);
  }
  channel_->holds.writing() = {};
  channel_->holds.publish();
  tick();
  EXPECT_EQ(move().phase, TaskPhase::executing) << "a press after it";
}

TEST_F(ControlLoopTest, AJogEndsInTheTickInWhichItsHoldIsOldEnough) {
  snapshot_.clock = ILK_CLOCK_SIM;
  snapshot_.period_us = 1000;
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  const auto held_at = [&](std::uint32_t tick) {
    return Moment{std::chrono::steady_clock::now(), tick, snapshot_.period_us};
  };
  const std::uint32_t begun = snapshot_.state.system.tick;
  approve(1, MoveTask{insertion, 1500, std::nullopt, true}, 0, held_at(begun));
  tick(199);
  EXPECT_EQ(move().phase, TaskPhase::executing);
  command(Renewal{1, held_at(begun + 199)});
  tick(199);
  EXPECT_EQ(move().phase, TaskPhase::executing) << "it was renewed";
  tick(1);
  EXPECT_EQ(move().phase, TaskPhase::aborted);
  EXPECT_EQ(move().reason, TaskReason::let_go);
  command(Renewal{1, held_at(begun + 399)});
  tick(1);
  EXPECT_EQ(move().phase, TaskPhase::aborted) << "a late renewal brings no jog back";
}

TEST_F(ControlLoopTest, AnOrderThatNobodyHoldsOutlivesEveryRenewal) {
  approve(1, MoveTask{test::insertion, 1500});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  for (std::uint32_t i = 0; i < 10; ++i) {
    tick(100);
  }
  EXPECT_EQ(move().phase, TaskPhase::executing);
}

/** Ticks for as long as it takes until the control thread misses those who serve people. */
class NobodyServedTest : public ControlLoopTest {
 protected:
  [[nodiscard]] bool stops_within(std::uint32_t ticks) {
    for (std::uint32_t i = 0; i < ticks; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      tick();
      if (sent(ILK_REQUEST_STOP) != nullptr) {
        return true;
      }
    }
    return false;
  }
};

constexpr std::uint32_t far_longer_than_timeout = 10'000;

TEST_F(NobodyServedTest, MotionEndsOnceWhenTheNetworkStandsStillAndNothingStartsUntilItGoesOn) {
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  approve(1, MoveTask{test::insertion, 1500});
  channel_->served = 1;
  ASSERT_TRUE(stops_within(far_longer_than_timeout));
  EXPECT_EQ(move().phase, TaskPhase::aborted);
  EXPECT_EQ(move().reason, TaskReason::nobody_served);
  approve(2, MoveTask{test::insertion, 1500}, channel_->stops.load());
  EXPECT_FALSE(stops_within(300)) << "once";
  EXPECT_EQ(move().phase, TaskPhase::aborted);
  channel_->served = 2;
  approve(3, MoveTask{test::insertion, 1500}, channel_->stops.load());
  tick();
  EXPECT_EQ(move().phase, TaskPhase::executing);
}

TEST_F(NobodyServedTest, MotionEndsWhenTheDoorStandsStill) {
  channel_->door_kept = 1;
  EXPECT_TRUE(stops_within(far_longer_than_timeout));
}

TEST_F(NobodyServedTest, NothingIsMissedOfThreadsThatNeverBegan) { EXPECT_FALSE(stops_within(300)); }

TEST_F(ControlLoopTest, AnOrderOlderThanTheStopNeverMoves) {
  approve(1, MoveTask{test::insertion, 1500});
  stop();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  EXPECT_EQ(sent(ILK_REQUEST_MOVE), nullptr);
  EXPECT_EQ(move().phase, TaskPhase::aborted);
  EXPECT_EQ(move().reason, TaskReason::stopped);
}

TEST_F(ControlLoopTest, ARequestOlderThanTheStopIsNotSent) {
  command(ask(7, ILK_REQUEST_ENABLE));
  command(ask(8, ILK_REQUEST_DISABLE));
  stop();
  tick();
  EXPECT_EQ(sent(ILK_REQUEST_ENABLE), nullptr);
  EXPECT_NE(sent(ILK_REQUEST_DISABLE), nullptr);
  const auto answers = notices<KernelResponse>();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].call_id, 7u);
  EXPECT_FALSE(answers[0].verdict);
}

TEST_F(ControlLoopTest, ARequestNewerThanTheStopIsSent) {
  stop();
  KernelCall newer = ask(7, ILK_REQUEST_ENABLE);
  newer.stops = 1;
  command(newer);
  tick();
  EXPECT_NE(sent(ILK_REQUEST_ENABLE), nullptr);
}

TEST_F(ControlLoopTest, AnAxisThatIsGivenAnotherPositionOrDisabledLosesItsOrder) {
  std::uint32_t proposal = 0;
  for (const auto& [kind, reason] : {std::pair(ILK_REQUEST_SET_HOME, TaskReason::position_declared),
                                     std::pair(ILK_REQUEST_RESTORE, TaskReason::position_declared),
                                     std::pair(ILK_REQUEST_DISABLE, TaskReason::axis_disabled)}) {
    approve(++proposal, MoveTask{test::insertion, 1500});
    command(ask(7, kind));
    tick();
    ASSERT_NE(sent(kind), nullptr);
    ASSERT_EQ(move().phase, TaskPhase::waiting);
    kernel_.push_verdict(*sent(kind), ILK_VERDICT_ACCEPTED, 5);
    tick();
    EXPECT_EQ(move().phase, TaskPhase::aborted);
    EXPECT_EQ(move().reason, reason);
  }
}

TEST_F(ControlLoopTest, ARefusedRequestLeavesTheOrderAlone) {
  approve(1, MoveTask{test::insertion, 1500});
  command(ask(7, ILK_REQUEST_SET_HOME));
  tick();
  kernel_.push_verdict(*sent(ILK_REQUEST_SET_HOME), ILK_VERDICT_PEDAL_DOWN, 5);
  tick();
  EXPECT_EQ(move().phase, TaskPhase::waiting);
}

TEST_F(ControlLoopTest, HomingOfAnAxisThatIsGivenAnotherPositionEnds) {
  approve(1, HomeTask{0, 0, {insertion}});
  command(ask(7, ILK_REQUEST_SET_HOME));
  tick();
  kernel_.push_verdict(*sent(ILK_REQUEST_SET_HOME), ILK_VERDICT_ACCEPTED, 5);
  tick();
  EXPECT_EQ(home().phase, TaskPhase::aborted);
  EXPECT_EQ(home().reason, TaskReason::position_declared);
}

TEST_F(ControlLoopTest, AnOrderNewerThanTheStopMoves) {
  stop();
  approve(1, MoveTask{test::insertion, 1500}, 1);
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  EXPECT_NE(sent(ILK_REQUEST_MOVE), nullptr);
}

TEST_F(ControlLoopTest, ManyStopsInOneTickAreOneRequest) {
  stop();
  stop();
  stop();
  tick();
  EXPECT_EQ(std::count_if(requests_.begin(), requests_.end(),
                          [](const auto& each) { return each.kind == ILK_REQUEST_STOP; }),
            1);
}

TEST_F(ControlLoopTest, SendsAtMostSixteenRequestsATickAndLosesNone) {
  for (std::uint32_t call_id = 1; call_id <= 40; ++call_id) {
    command(ask(call_id, ILK_REQUEST_ENABLE));
  }
  std::size_t asked = 0;
  for (int i = 0; i < 4; ++i) {
    tick();
    EXPECT_LE(requests_.size(), static_cast<std::size_t>(ILK_REQUESTS_PER_TICK));
    for (const ilk_request_t& request : requests_) {
      asked += request.kind == ILK_REQUEST_ENABLE ? 1u : 0u;
      kernel_.push_verdict(request, ILK_VERDICT_ACCEPTED, 1);
    }
  }
  tick();
  EXPECT_EQ(asked, 40u);
  EXPECT_EQ(notices<KernelResponse>().size(), 40u);
}

TEST_F(ControlLoopTest, PassesKernelEventsOn) {
  kernel_.push_event({0, ILK_EVENT_FAULT, 12, {insertion, ILK_FAULT_STALL, 1, 0}});
  tick();
  const auto events = notices<ilk_event_t>();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, static_cast<std::uint32_t>(ILK_EVENT_FAULT));
}

TEST_F(ControlLoopTest, ReportsLostEventsAndTheAnswersThatWentWithThem) {
  command(ask(7, ILK_REQUEST_ENABLE));
  tick();
  lose_events();
  tick();
  std::uint32_t lost = 0;
  std::size_t unanswered = 0;
  channel_->notices.consume_all([&](const Notice& notice) {
    if (const auto* gap = std::get_if<EventsLost>(&notice)) {
      lost += gap->count;
    } else if (const auto* answer = std::get_if<KernelResponse>(&notice)) {
      unanswered += answer->verdict ? 0u : 1u;
    }
  });
  EXPECT_EQ(lost, 3u);
  EXPECT_EQ(unanswered, 1u);
}

TEST_F(ControlLoopTest, ALostVerdictThatMayHaveEndedAnOrderEndsIt) {
  std::uint32_t proposal = 0;
  for (const auto kind : {ILK_REQUEST_DISABLE, ILK_REQUEST_SET_HOME, ILK_REQUEST_RESTORE}) {
    approve(++proposal, MoveTask{test::insertion, 1500});
    command(ask(7, kind));
    tick();
    ASSERT_NE(sent(kind), nullptr);
    kernel_.push_verdict(*sent(kind), ILK_VERDICT_ACCEPTED, 5);
    lose_events();
    tick();
    EXPECT_EQ(move().phase, TaskPhase::aborted);
    EXPECT_EQ(move().reason, TaskReason::verdict_lost);
  }
}

TEST_F(ControlLoopTest, LostEventsLeaveOtherOrdersToTheSnapshot) {
  approve(1, MoveTask{test::insertion, 1500});
  KernelCall other_axis = ask(7, ILK_REQUEST_DISABLE);
  other_axis.slot = test::rotation;
  command(other_axis);
  command(ask(8, ILK_REQUEST_ENABLE));
  tick();
  lose_events();
  tick();
  EXPECT_EQ(move().phase, TaskPhase::waiting);
  snapshot_.state.axis[insertion].state = ILK_AXIS_DISABLED;
  lose_events();
  tick();
  EXPECT_EQ(move().phase, TaskPhase::aborted);
  EXPECT_EQ(move().reason, TaskReason::axis_disabled);
}

TEST_F(ControlLoopTest, ALostLinkEndsOrdersAndAnswersAsksAndIsAttachedAgain) {
  approve(1, MoveTask{test::insertion, 1500});
  command(ask(7, ILK_REQUEST_ENABLE));
  tick();
  kernel_.close();
  kernel_.accept();
  tick();
  EXPECT_EQ(move().phase, TaskPhase::aborted);
  EXPECT_EQ(move().reason, TaskReason::link_lost);
  EXPECT_EQ(channel_->view.newest().generation, 2u);
  const auto answers = notices<KernelResponse>();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_FALSE(answers[0].verdict);
  ASSERT_NE(sent(ILK_REQUEST_HEARTBEAT), nullptr);
  EXPECT_EQ(sent(ILK_REQUEST_HEARTBEAT)->sequence, 1u);
}

TEST_F(ControlLoopTest, HomesAnAxisAndFollowsItsVerdict) {
  approve(1, HomeTask{0, 0, {insertion}});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  ASSERT_NE(sent(ILK_REQUEST_HOME), nullptr);
  EXPECT_EQ(sent(ILK_REQUEST_HOME)->axis, insertion);
  EXPECT_EQ(home().phase, TaskPhase::executing);
  kernel_.push_verdict(*sent(ILK_REQUEST_HOME), ILK_VERDICT_ACCEPTED, snapshot_.state.system.tick);
  snapshot_.state.axis[insertion].homed = 1;
  tick();
  EXPECT_EQ(home().phase, TaskPhase::done);
  EXPECT_EQ(notices<ilk_event_t>().size(), 1u);
}

TEST_F(ControlLoopTest, OnlyOneModeHasOpenOrders) {
  approve(1, MoveTask{test::insertion, 1500});
  approve(2, HomeTask{0, 0, {insertion}});
  tick();
  EXPECT_EQ(move().phase, TaskPhase::aborted);
  EXPECT_EQ(move().reason, TaskReason::axis_homing);
  EXPECT_EQ(home().phase, TaskPhase::waiting);
  approve(3, MoveTask{test::insertion, 1500});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  EXPECT_EQ(sent(ILK_REQUEST_MOVE), nullptr);
  EXPECT_EQ(move().phase, TaskPhase::aborted);
}

TEST_F(ControlLoopTest, AHomeOrderOlderThanTheStopNeverStarts) {
  approve(1, HomeTask{0, 0, {insertion}});
  stop();
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  EXPECT_EQ(sent(ILK_REQUEST_HOME), nullptr);
  EXPECT_EQ(home().reason, TaskReason::stopped);
}

TEST_F(ControlLoopTest, CancellingHomingAsksTheKernelToStop) {
  approve(1, HomeTask{0, 0, {insertion}});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  command(Cancel{1});
  tick();
  EXPECT_NE(sent(ILK_REQUEST_STOP), nullptr);
  EXPECT_EQ(home().reason, TaskReason::cancelled);
}

TEST_F(ControlLoopTest, ALostVerdictEndsHoming) {
  approve(1, HomeTask{0, 0, {insertion}});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  lose_events();
  tick();
  EXPECT_EQ(home().reason, TaskReason::verdict_lost);
}

TEST_F(ControlLoopTest, ALostLinkEndsHoming) {
  approve(1, HomeTask{0, 0, {insertion}});
  snapshot_.state.system.mode = ILK_MODE_MOTION;
  tick();
  kernel_.close();
  kernel_.accept();
  snapshot_.state.system.mode = ILK_MODE_READY;
  tick();
  EXPECT_EQ(home().phase, TaskPhase::aborted);
  EXPECT_EQ(home().reason, TaskReason::link_lost);
}

TEST_F(ControlLoopTest, AsksTheKernelToEndMotionWhenItEnds) {
  tick();
  thread_.request_stop();
  thread_.join();
  const auto request = kernel_.take_request();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->kind, static_cast<std::uint32_t>(ILK_REQUEST_STOP));
}

class ReplayTest : public ControlLoopTest {
 protected:
  ReplayTest() : ControlLoopTest(LinkUse::replay) {}
};

TEST_F(ReplayTest, SendsNothingAndTellsWhoeverAsks) {
  channel_->holder = 7;
  stop();
  command(ask(7, ILK_REQUEST_ENABLE));
  approve(1, MoveTask{test::insertion, 1500});
  for (int ticks = 0; ticks < 100; ++ticks) {
    tick();
    ASSERT_TRUE(requests_.empty());
  }
  EXPECT_TRUE(channel_->view.newest().replay);
  EXPECT_EQ(channel_->view.newest().snapshot.state.system.tick, snapshot_.state.system.tick);
  EXPECT_EQ(move().reason, TaskReason::link_lost);
  bool asked = false;
  bool stopped = false;
  channel_->notices.consume_all([&](const Notice& notice) {
    const auto* answer = std::get_if<KernelResponse>(&notice);
    const auto* stop_answer = std::get_if<StopAnswer>(&notice);
    asked |= answer != nullptr && answer->call_id == 7 && !answer->verdict;
    stopped |= stop_answer != nullptr && !stop_answer->verdict;
  });
  EXPECT_TRUE(asked);
  EXPECT_TRUE(stopped);
}

TEST_F(ReplayTest, BringsWhatHappenedThen) {
  tick();
  kernel_.push_event({0, ILK_EVENT_MODE, 5, {ILK_MODE_READY, ILK_MODE_LOCKED, ILK_CAUSE_ESTOP, 0}});
  tick();
  const auto events = notices<ilk_event_t>();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].tick, 5u);
}

}  // namespace
}  // namespace interlock
