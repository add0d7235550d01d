#include "service/alarms.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "robot_fixture.hpp"
#include "store/audit.hpp"

namespace interlock {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class AlarmsTest : public testing::Test {
 protected:
  /** Looks at the view some time after the last look. */
  std::vector<Alarm> look(milliseconds later = milliseconds(33)) {
    now_ += later;
    view_.received = frozen_ ? view_.received : now_;
    return alarms_.see(view_, now_, UtcTime(now_.time_since_epoch()));
  }

  ilk_system_t& system() { return view_.snapshot.state.system; }

  void lock(std::uint32_t cause) {
    system().mode = ILK_MODE_LOCKED;
    system().cause = cause;
    system().cause_tick = 5000;
  }

  void fault(std::uint32_t slot, std::uint32_t fault, std::uint32_t tick = 5000) {
    view_.snapshot.state.axis[slot].fault = fault;
    view_.snapshot.state.axis[slot].fault_tick = tick;
  }

  [[nodiscard]] std::vector<std::string> codes() const {
    std::vector<std::string> codes;
    for (const Alarm& alarm : alarms_.present()) {
      codes.push_back(alarm.condition.code);
    }
    return codes;
  }

  ControlView view_ = test::ready_view();
  SteadyTime now_{std::chrono::hours(1000)};
  bool frozen_ = false;
  Alarms alarms_{test::neuro(), test::neuro_config()};
};

TEST_F(AlarmsTest, AReadyRobotAndOneThatHasJustStartedAlarmNobody) {
  EXPECT_THAT(look(), IsEmpty());
  lock(ILK_CAUSE_BOOT);
  EXPECT_THAT(look(), IsEmpty());
  EXPECT_THAT(alarms_.present(), IsEmpty());
}

TEST_F(AlarmsTest, EveryLockAndFaultHasAnAlarmOfItsOwnThatEndsWithIt) {
  for (std::uint32_t cause = ILK_CAUSE_ESTOP; cause < ILK_CAUSE_COUNT; ++cause) {
    lock(cause);
    ASSERT_THAT(look(), SizeIs(1)) << cause;
    EXPECT_FALSE(alarms_.present().front().condition.next_step.empty());
    system().mode = ILK_MODE_READY;
    ASSERT_THAT(look(), SizeIs(1)) << cause;
    EXPECT_THAT(alarms_.present(), IsEmpty());
  }
  for (std::uint32_t each = ILK_FAULT_STALL; each < ILK_FAULT_COUNT; ++each) {
    fault(test::insertion, each);
    look();
    ASSERT_THAT(alarms_.present(), SizeIs(1)) << each;
    EXPECT_THAT(alarms_.present().front().condition.axes, ElementsAre("insertion"));
    EXPECT_THAT(alarms_.present().front().condition.text, HasSubstr("Probe insertion: "));
    fault(test::insertion, ILK_FAULT_NONE);
    look(seconds(61));
  }
  EXPECT_THAT(alarms_.past(), testing::Not(IsEmpty()));
}

TEST_F(AlarmsTest, TheWorstComesFirst) {
  fault(test::insertion, ILK_FAULT_STALL);
  look();
  lock(ILK_CAUSE_ESTOP);
  look();
  EXPECT_THAT(codes(), ElementsAre("ESTOP", "STALL"));
  fault(0, ILK_FAULT_DRIFT);
  look();
  EXPECT_THAT(codes(), ElementsAre("ESTOP", "STALL", "DRIFT"));
  alarms_.acknowledge(alarms_.present()[1].id, {"ann", UtcTime{}});
  EXPECT_THAT(codes(), ElementsAre("ESTOP", "DRIFT", "STALL"));
}

TEST_F(AlarmsTest, OneEventOfTheBusIsOneAlarmFromItsLockToTheLastClearedFault) {
  lock(ILK_CAUSE_BUS);
  look();
  const std::uint32_t id = alarms_.present().front().id;
  for (const Axis& axis : test::neuro().axes) {
    fault(axis.slot, axis.slot % 2 == 0 ? ILK_FAULT_CARD : ILK_FAULT_JUMP, 5000 + axis.slot);
    look();
    ASSERT_THAT(codes(), ElementsAre("BUS"));
  }
  EXPECT_THAT(alarms_.present().front().condition.axes, SizeIs(test::neuro().axes.size()));
  system().mode = ILK_MODE_READY;
  look();
  ASSERT_THAT(codes(), ElementsAre("BUS")) << "unlocked, its faults are still there";
  EXPECT_EQ(alarms_.present().front().id, id);
  EXPECT_THAT(alarms_.present().front().condition.text, HasSubstr("lost together"));
  EXPECT_THAT(alarms_.present().front().condition.next_step, testing::Not(HasSubstr("unlock")));
  for (const Axis& axis : test::neuro().axes) {
    ASSERT_THAT(codes(), ElementsAre("BUS")) << "also of the last that is not cleared";
    fault(axis.slot, ILK_FAULT_NONE);
    look();
  }
  EXPECT_THAT(alarms_.present(), IsEmpty());
}

TEST_F(AlarmsTest, ACardThatIsLostByItselfIsNoEventOfTheBus) {
  fault(0, ILK_FAULT_CARD, 5000);
  fault(test::insertion, ILK_FAULT_CARD, 90000);
  fault(1, ILK_FAULT_STALL, 5000);
  look();
  EXPECT_THAT(codes(), testing::UnorderedElementsAre("CARD", "STALL"));
  EXPECT_EQ(alarms_.present().front().condition.layer, "card");
}

TEST_F(AlarmsTest, CardsThatAreLostWhileThisComputerIsLateAreBlamedOnTheComputer) {
  look();
  ++view_.snapshot.overruns;
  fault(0, ILK_FAULT_CARD);
  look();
  look(seconds(10));
  ASSERT_THAT(codes(), ElementsAre("CARD")) << "it is late no more";
  EXPECT_EQ(alarms_.present().front().condition.layer, "computer");
  EXPECT_THAT(to_json(alarms_.present().front())["text"].get<std::string>(),
              HasSubstr("This computer was late"));
}

TEST_F(AlarmsTest, OverrunsOfBeforeTheAppWasStartedAreNoLateness) {
  view_.snapshot.overruns = 7;
  EXPECT_THAT(look(), IsEmpty());
}

TEST_F(AlarmsTest, OneThatBeginsAnewWithinAMinuteIsTheSameAndHasToBeAcknowledgedAnew) {
  fault(0, ILK_FAULT_STALL);
  look();
  const std::uint32_t id = alarms_.present().front().id;
  alarms_.acknowledge(id, {"ann", UtcTime{}});
  EXPECT_TRUE(alarms_.find(id)->acknowledged);
  fault(0, ILK_FAULT_NONE);
  look();
  fault(0, ILK_FAULT_STALL);
  look(seconds(30));
  ASSERT_THAT(alarms_.present(), SizeIs(1));
  EXPECT_EQ(alarms_.present().front().id, id);
  EXPECT_EQ(alarms_.present().front().count, 2u);
  EXPECT_FALSE(alarms_.present().front().acknowledged);
  EXPECT_GT(alarms_.present().front().last, alarms_.present().front().begun);
  fault(0, ILK_FAULT_NONE);
  look();
  fault(0, ILK_FAULT_STALL);
  look(seconds(61));
  EXPECT_NE(alarms_.present().front().id, id);
}

TEST_F(AlarmsTest, AnotherAxisWithTheSameFaultHasToBeAcknowledgedToo) {
  fault(0, ILK_FAULT_STALL);
  look();
  alarms_.acknowledge(1, {"ann", UtcTime{}});
  fault(1, ILK_FAULT_STALL);
  EXPECT_THAT(look(), SizeIs(1));
  ASSERT_THAT(alarms_.present(), SizeIs(1));
  EXPECT_FALSE(alarms_.present().front().acknowledged);
}

TEST_F(AlarmsTest, AKernelThatIsSilentOrGoneForASecondIsAnAlarmAndNoOtherIsBelieved) {
  look();
  frozen_ = true;
  EXPECT_THAT(look(milliseconds(900)), IsEmpty());
  look(milliseconds(200));
  EXPECT_THAT(codes(), ElementsAre("SILENT"));
  frozen_ = false;
  look();
  lock(ILK_CAUSE_ESTOP);
  view_.attached = false;
  look();
  EXPECT_THAT(codes(), IsEmpty());
  look(seconds(1));
  EXPECT_THAT(codes(), ElementsAre("NO_KERNEL"));
}

TEST_F(AlarmsTest, ThePedalsChannelsMayDisagreeWhileSomebodyPressesIt) {
  system().pedal = ILK_PEDAL_DISAGREE;
  EXPECT_THAT(look(), IsEmpty());
  look(milliseconds(900));
  EXPECT_THAT(codes(), IsEmpty());
  look(milliseconds(100));
  EXPECT_THAT(codes(), ElementsAre("PEDAL"));
}

TEST_F(AlarmsTest, AnEStopThatIsPulledWhileAnotherCauseHoldsTheLockIsAnAlarmOfItsOwn) {
  lock(ILK_CAUSE_BOOT);
  system().estop = 1;
  look();
  EXPECT_THAT(codes(), ElementsAre("ESTOP"));
}

TEST_F(AlarmsTest, AMotionThatEndsByItselfIsAnAlarmUntilSomebodyAcknowledgesItOrTheNextOneBegins) {
  Proposal proposal;
  proposal.id = 12;
  proposal.axes = {"yaw"};
  proposal.detail = "An axis strayed from its path.";
  proposal.state = ProposalState::aborted;
  proposal.changed_by = "ann";
  alarms_.follow(proposal);
  EXPECT_THAT(look(), IsEmpty()) << "somebody ended it";
  proposal.changed_by = audit_actor::app;
  alarms_.follow(proposal);
  look();
  ASSERT_THAT(codes(), ElementsAre("MOTION"));
  EXPECT_THAT(alarms_.present().front().condition.text, HasSubstr("Motion 12 ended by itself. An axis"));
  alarms_.acknowledge(alarms_.present().front().id, {"ann", UtcTime{}});
  look();
  EXPECT_THAT(codes(), IsEmpty());
  alarms_.follow(proposal);
  look();
  ASSERT_THAT(codes(), ElementsAre("MOTION"));
  proposal.state = ProposalState::executing;
  alarms_.follow(proposal);
  look();
  EXPECT_THAT(codes(), IsEmpty());
  proposal.state = ProposalState::aborted;
  alarms_.follow(proposal);
  fault(0, ILK_FAULT_STALL);
  look();
  EXPECT_THAT(codes(), ElementsAre("STALL")) << "which says why it ended";
}

TEST_F(AlarmsTest, AMotionThatEndedStaysAnAlarmWhateverComesAfterIt) {
  alarms_.note_ended_motion(12, "The app ended while it went on.");
  look();
  lock(ILK_CAUSE_BUS);
  look();
  EXPECT_THAT(codes(), ElementsAre("BUS", "MOTION"));
  system().mode = ILK_MODE_READY;
  look();
  EXPECT_THAT(codes(), ElementsAre("MOTION"));
}

TEST_F(AlarmsTest, WhoUnlocksIsToldOnceThePedalsChannelsAgreeAgain) {
  lock(ILK_CAUSE_PEDAL);
  look();
  EXPECT_THAT(alarms_.present().front().condition.next_step, HasSubstr("Press Unlock"));
  EXPECT_EQ(alarms_.present().front().condition.layer, "pedal");
}

TEST_F(AlarmsTest, AnExpiredRegistrationIsAnAlarmUntilOneIsSet) {
  alarms_.note_registration("The table moved.");
  look();
  EXPECT_THAT(codes(), ElementsAre("REGISTRATION"));
  alarms_.note_registration("");
  look();
  EXPECT_THAT(codes(), IsEmpty());
}

TEST_F(AlarmsTest, ARecordingThatIsShownAlarmsNobody) {
  lock(ILK_CAUSE_ESTOP);
  view_.replay = true;
  EXPECT_THAT(look(), IsEmpty());
}

TEST_F(AlarmsTest, WhatIsOverIsKeptUpToItsBound) {
  for (std::size_t round = 0; round < 2 * Alarms::most_past; ++round) {
    fault(0, ILK_FAULT_STALL);
    look(seconds(61));
    fault(0, ILK_FAULT_NONE);
    look();
  }
  EXPECT_THAT(alarms_.past(), SizeIs(Alarms::most_past));
  EXPECT_EQ(alarms_.past().front().id, 2 * Alarms::most_past);
}

}  // namespace
}  // namespace interlock
