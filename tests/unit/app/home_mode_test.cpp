#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "modes/homing/mode.hpp"
#include "motion/realtime_channel.hpp"
#include "robot_fixture.hpp"
#include "tasks.hpp"

namespace interlock {
namespace {

using test::angles;
using test::insertion;
using test::neuro;
using test::neuro_config;
using test::pitch;
using test::rotation;
using test::yaw;

class HomeModeTest : public testing::Test {
 protected:
  HomeModeTest() : snapshot_(test::ready_view().snapshot), mode_(RobotPlan(neuro(), neuro_config())) {}

  void home_axis(std::uint32_t proposal = 1, std::uint32_t slot = insertion) {
    mode_.take(test::task_of(proposal, HomeTask{0, 0, {slot}}), snapshot_.state.system.tick);
  }

  void home_angles(std::uint32_t proposal = 1) {
    mode_.take(test::task_of(proposal, HomeTask{angles, 1, {}}), snapshot_.state.system.tick);
  }

  std::vector<KernelRequest> tick(std::uint32_t ticks = 1) {
    snapshot_.state.system.tick += ticks;
    KernelRequests requests;
    mode_.tick(snapshot_, requests);
    return {requests.all().begin(), requests.all().end()};
  }

  std::vector<std::uint32_t> kinds(std::uint32_t ticks = 1) {
    std::vector<std::uint32_t> found;
    for (const KernelRequest& request : tick(ticks)) {
      found.push_back(request.origin.kind);
    }
    return found;
  }

  void press() { snapshot_.state.system.mode = ILK_MODE_MOTION; }
  void release() { snapshot_.state.system.mode = ILK_MODE_READY; }

  void judge(std::uint32_t slot, std::uint32_t verdict, std::uint32_t proposal = 1) {
    mode_.on_verdict({ILK_REQUEST_HOME, slot, proposal}, verdict, snapshot_.state.system.tick);
  }

  void accept(std::uint32_t slot) {
    judge(slot, ILK_VERDICT_ACCEPTED);
    axis(slot).state = ILK_AXIS_HOMING;
    axis(slot).homed = 0;
  }

  void arrive(std::uint32_t slot) {
    axis(slot).state = ILK_AXIS_ENABLED;
    axis(slot).homed = 1;
  }

  ilk_axis_t& axis(std::uint32_t slot) { return snapshot_.state.axis[slot]; }
  [[nodiscard]] TaskStatus status() const {
    ControlView view;
    mode_.report(view);
    return view.tasks.of<HomeTask>();
  }
  [[nodiscard]] TaskPhase phase() const { return status().phase; }
  [[nodiscard]] TaskReason reason() const { return status().reason; }

  ilk_snapshot_t snapshot_;
  HomeMode mode_;
};

TEST_F(HomeModeTest, SendsNothingBeforeThePedal) {
  home_axis();
  EXPECT_THAT(tick(), testing::IsEmpty());
  EXPECT_EQ(phase(), TaskPhase::waiting);
}

TEST_F(HomeModeTest, AsksOnceForEveryAxisOfTheStep) {
  home_angles();
  press();
  const auto requests = tick();
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_EQ(requests[0].origin, (ModeOrigin{ILK_REQUEST_HOME, yaw, 1}));
  EXPECT_EQ(requests[1].origin, (ModeOrigin{ILK_REQUEST_HOME, pitch, 1}));
  EXPECT_EQ(phase(), TaskPhase::executing);
  EXPECT_EQ(status().step, angles);
  EXPECT_THAT(tick(), testing::IsEmpty());
}

TEST_F(HomeModeTest, IsDoneWhenEveryAxisOfTheStepIsHomed) {
  home_angles();
  press();
  (void)tick();
  accept(yaw);
  accept(pitch);
  (void)tick();
  arrive(yaw);
  (void)tick();
  EXPECT_EQ(phase(), TaskPhase::executing);
  arrive(pitch);
  EXPECT_THAT(tick(), testing::IsEmpty());
  EXPECT_EQ(phase(), TaskPhase::done);
}

TEST_F(HomeModeTest, AnAxisThatWasHomedBeforeDoesNotCount) {
  home_axis();
  press();
  (void)tick();
  (void)tick(100);
  EXPECT_EQ(phase(), TaskPhase::executing);
}

TEST_F(HomeModeTest, ASnapshotOlderThanTheAcceptanceDoesNotCount) {
  home_axis();
  press();
  (void)tick();
  mode_.on_verdict({ILK_REQUEST_HOME, insertion, 1}, ILK_VERDICT_ACCEPTED, snapshot_.state.system.tick + 3);
  (void)tick(3);
  EXPECT_EQ(phase(), TaskPhase::executing);
  (void)tick();
  EXPECT_EQ(phase(), TaskPhase::done);
}

TEST_F(HomeModeTest, ReleasePausesAndTheNextPressAsksAgain) {
  home_axis();
  press();
  (void)tick();
  accept(insertion);
  (void)tick();
  axis(insertion).state = ILK_AXIS_ENABLED;
  release();
  EXPECT_THAT(tick(), testing::IsEmpty());
  EXPECT_EQ(phase(), TaskPhase::paused);
  EXPECT_EQ(reason(), TaskReason::pedal_released);
  press();
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_HOME));
}

TEST_F(HomeModeTest, APressGoesOnOnlyWithTheAxesThatAreNotHomedYet) {
  home_angles();
  press();
  (void)tick();
  accept(yaw);
  accept(pitch);
  (void)tick();
  arrive(yaw);
  (void)tick();
  axis(pitch).state = ILK_AXIS_ENABLED;
  release();
  (void)tick();
  press();
  const auto requests = tick();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].origin.slot, pitch);
}

TEST_F(HomeModeTest, APressThatNobodySawReleasedAsksAgain) {
  home_axis();
  press();
  (void)tick();
  accept(insertion);
  (void)tick();
  axis(insertion).state = ILK_AXIS_ENABLED;
  EXPECT_THAT(kinds(30), testing::ElementsAre(ILK_REQUEST_HOME));
}

TEST_F(HomeModeTest, APedalReleasedMeanwhileIsNoRefusal) {
  home_axis();
  press();
  (void)tick();
  judge(insertion, ILK_VERDICT_MODE);
  EXPECT_EQ(phase(), TaskPhase::executing);
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_HOME));
}

TEST_F(HomeModeTest, ARefusalEndsItWithItsVerdictAndStopsTheOthers) {
  home_angles();
  press();
  (void)tick();
  accept(yaw);
  judge(pitch, ILK_VERDICT_BUSY);
  EXPECT_EQ(phase(), TaskPhase::refused);
  EXPECT_EQ(status().code, static_cast<std::uint32_t>(ILK_VERDICT_BUSY));
  EXPECT_EQ(status().slot, pitch);
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_STOP));
}

TEST_F(HomeModeTest, AVerdictOnAnEarlierOrderChangesNothing) {
  home_axis(1);
  press();
  (void)tick();
  home_axis(2);
  judge(insertion, ILK_VERDICT_BUSY, 1);
  EXPECT_EQ(phase(), TaskPhase::waiting);
}

TEST_F(HomeModeTest, ALostVerdictEndsIt) {
  home_axis();
  press();
  (void)tick();
  mode_.on_verdict_lost({ILK_REQUEST_HOME, insertion, 1}, snapshot_.state.system.tick);
  EXPECT_EQ(phase(), TaskPhase::aborted);
  EXPECT_EQ(reason(), TaskReason::verdict_lost);
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_STOP));
}

TEST_F(HomeModeTest, CancellingAsksForStopUntilMotionHasEnded) {
  home_axis();
  press();
  (void)tick();
  accept(insertion);
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  EXPECT_EQ(reason(), TaskReason::cancelled);
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_STOP));
  EXPECT_THAT(kinds(49), testing::IsEmpty());
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_STOP));
  release();
  EXPECT_THAT(kinds(50), testing::IsEmpty());
  press();
  EXPECT_THAT(kinds(50), testing::IsEmpty());
}

TEST_F(HomeModeTest, CancellingWhatDoesNotRunAsksForNothing) {
  home_axis();
  (void)tick();
  press();
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  EXPECT_THAT(kinds(), testing::IsEmpty());
}

TEST_F(HomeModeTest, EndsOnlyTheProposalThatIsMeant) {
  home_axis(2);
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  EXPECT_EQ(phase(), TaskPhase::waiting);
}

TEST_F(HomeModeTest, ANewerOrderWaitsUntilTheOlderOneIsStopped) {
  home_axis(1);
  press();
  (void)tick();
  accept(insertion);
  home_angles(2);
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_STOP));
  EXPECT_THAT(kinds(), testing::IsEmpty());
  EXPECT_EQ(phase(), TaskPhase::waiting);
  release();
  (void)tick();
  press();
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_HOME, ILK_REQUEST_HOME));
}

TEST_F(HomeModeTest, WishesThatWereNotSentAreRepeated) {
  home_axis();
  press();
  mode_.on_unsent(tick().at(0));
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_HOME));
  mode_.end(1, TaskReason::cancelled, snapshot_.state.system.tick);
  mode_.on_unsent(tick().at(0));
  EXPECT_THAT(kinds(), testing::ElementsAre(ILK_REQUEST_STOP));
}

TEST_F(HomeModeTest, ExpiresAfterAMinuteOfKernelTimeWithoutThePedal) {
  home_axis();
  (void)tick(test::minute_ticks);
  EXPECT_EQ(phase(), TaskPhase::waiting);
  (void)tick();
  EXPECT_EQ(phase(), TaskPhase::expired);
  EXPECT_EQ(reason(), TaskReason::waited_too_long);
}

TEST_F(HomeModeTest, TheMinuteBeginsAnewWithEachPause) {
  home_axis();
  (void)tick(test::minute_ticks - 1);
  press();
  (void)tick();
  release();
  (void)tick();
  (void)tick(test::minute_ticks);
  EXPECT_EQ(phase(), TaskPhase::paused);
  (void)tick();
  EXPECT_EQ(phase(), TaskPhase::expired);
}

TEST_F(HomeModeTest, APressAfterAMinuteFindsNothingToHome) {
  home_axis();
  press();
  EXPECT_THAT(tick(test::minute_ticks + 1), testing::IsEmpty());
  EXPECT_EQ(phase(), TaskPhase::expired);
}

TEST_F(HomeModeTest, TellsWhatIsLeftOfTheLongestNudgeThereIs) {
  Robot robot = neuro();
  robot.home_steps = {{"far", "Far", {}, {{yaw, INT32_MIN}, {pitch, 5}}, {}}};
  HomeMode mode(RobotPlan(robot, neuro_config()));
  const auto tick = [&](std::uint32_t system_mode) {
    ++snapshot_.state.system.tick;
    snapshot_.state.system.mode = system_mode;
    KernelRequests requests;
    mode.tick(snapshot_, requests);
  };
  mode.take(test::task_of(1, HomeTask{0, 1, {}}), snapshot_.state.system.tick);
  tick(ILK_MODE_MOTION);
  tick(ILK_MODE_READY);
  const auto status = [&mode] {
    ControlView view;
    mode.report(view);
    return view.tasks.of<HomeTask>();
  };
  EXPECT_EQ(status().phase, TaskPhase::paused);
  EXPECT_EQ(status().slot, yaw);
  EXPECT_EQ(status().left_counts, INT32_MIN);
  axis(yaw).raw += neuro_config().axis[yaw].direction_correction != 0 ? -1u : 1u;
  tick(ILK_MODE_MOTION);
  tick(ILK_MODE_READY);
  EXPECT_EQ(status().left_counts, INT32_MIN) << "a distance beyond 32 bits";
}

TEST_F(HomeModeTest, SurvivesTheWrapOfTheTickCounter) {
  snapshot_.state.system.tick = UINT32_MAX - 10;
  home_axis();
  press();
  (void)tick();
  accept(insertion);
  (void)tick(20);
  arrive(insertion);
  (void)tick();
  EXPECT_EQ(phase(), TaskPhase::done);
}

TEST_F(HomeModeTest, LockedEndsIt) {
  home_axis();
  press();
  (void)tick();
  snapshot_.state.system.mode = ILK_MODE_LOCKED;
  snapshot_.state.system.cause = ILK_CAUSE_ESTOP;
  EXPECT_THAT(tick(), testing::IsEmpty());
  EXPECT_EQ(reason(), TaskReason::locked);
  EXPECT_EQ(status().code, static_cast<std::uint32_t>(ILK_CAUSE_ESTOP));
}

TEST_F(HomeModeTest, AnAxisTakenOutOfMotionEndsIt) {
  home_angles();
  axis(pitch).state = ILK_AXIS_DISABLED;
  (void)tick();
  EXPECT_EQ(reason(), TaskReason::axis_disabled);
  EXPECT_EQ(status().slot, pitch);
}

TEST_F(HomeModeTest, AnAxisBesideItMayBeDisabled) {
  axis(rotation).state = ILK_AXIS_DISABLED;
  home_axis();
  (void)tick();
  EXPECT_EQ(phase(), TaskPhase::waiting);
}

TEST_F(HomeModeTest, ANewFaultOfAnyAxisEndsIt) {
  home_axis();
  (void)tick();
  axis(rotation).state = ILK_AXIS_FAULTED;
  axis(rotation).fault = ILK_FAULT_DRIFT;
  (void)tick();
  EXPECT_EQ(reason(), TaskReason::axis_faulted);
  EXPECT_EQ(status().slot, rotation);
  EXPECT_EQ(status().code, static_cast<std::uint32_t>(ILK_FAULT_DRIFT));
}

TEST_F(HomeModeTest, AFaultBesideItFromBeforeDoesNotUntilItComesAgain) {
  axis(rotation).state = ILK_AXIS_FAULTED;
  home_axis();
  (void)tick();
  EXPECT_EQ(phase(), TaskPhase::waiting);
  axis(rotation).state = ILK_AXIS_ENABLED;
  (void)tick();
  axis(rotation).state = ILK_AXIS_FAULTED;
  (void)tick();
  EXPECT_EQ(reason(), TaskReason::axis_faulted);
}

TEST_F(HomeModeTest, RefusesWhatTheRobotDoesNotHave) {
  const auto steps = static_cast<std::uint32_t>(neuro().home_steps.size());
  const HomeTask beyond[] = {{steps, 1, {}}, {0, steps + 1, {}}, {1, UINT32_MAX, {}}, {0, 0, {ILK_SLOTS}}};
  press();
  for (const HomeTask& task : beyond) {
    mode_.take(test::task_of(1, task), snapshot_.state.system.tick);
    EXPECT_EQ(phase(), TaskPhase::refused);
    EXPECT_EQ(status().code, static_cast<std::uint32_t>(ILK_VERDICT_AXIS));
    EXPECT_THAT(tick(), testing::IsEmpty());
  }
  mode_.take(test::task_of(5, HomeTask{0, steps, {}}), snapshot_.state.system.tick);
  EXPECT_EQ(phase(), TaskPhase::waiting);
}

}  // namespace
}  // namespace interlock
