#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "closed_loop.hpp"
#include "unhomed_bounds.hpp"

namespace interlock {
namespace {

using test::angles;
using test::ClosedLoop;
using test::insertion;
using test::neuro;
using test::pitch;
using test::rotation;
using test::UnhomedBounds;
using test::yaw;

const HomeTask every_step{0, 3, {}};
const HomeTask the_angles{angles, 1, {}};
const HomeTask the_insertion{0, 0, {insertion}};

/** The neuro robot with other home steps. */
Robot neuro_with(std::vector<HomeStep> steps) {
  Robot robot = neuro();
  robot.home_steps = std::move(steps);
  return robot;
}

/** Latency of the link in ticks: the real clock, and the farthest that a simulated kernel runs ahead. */
class HomingOnThePlant : public testing::TestWithParam<std::uint32_t> {
 protected:
  /** Runs until the order has ended, pressing the pedal anew whenever a slice of a nudge is used up. */
  static std::uint32_t presses_to_the_end(ClosedLoop& loop,
                                          std::uint32_t most_ticks = 4 * test::minute_ticks) {
    std::uint32_t presses = 1;
    loop.pedal(true);
    for (std::uint32_t i = 0; i < most_ticks && is_open(loop.home().phase); ++i) {
      loop.tick();
      if (loop.home().reason == TaskReason::press_again) {
        loop.pedal(false);
        loop.pedal(true);
        ++presses;
      }
    }
    return presses;
  }

  template <typename Condition>
  static bool run_until(ClosedLoop& loop, Condition condition) {
    for (std::uint32_t i = 0; i < test::minute_ticks && !condition(); ++i) {
      loop.tick();
    }
    return condition();
  }

  static bool homing(const ClosedLoop& loop, std::uint32_t slot) {
    return loop.state().axis[slot].state == ILK_AXIS_HOMING;
  }
  static bool homed(const ClosedLoop& loop, std::uint32_t slot) { return loop.state().axis[slot].homed != 0; }

  static void expect_nothing_driven(const ClosedLoop& loop) {
    for (const Axis& axis : neuro().axes) {
      EXPECT_EQ(loop.outputs().command[axis.slot].drive, 0u) << axis.name;
      EXPECT_FALSE(homing(loop, axis.slot)) << axis.name;
    }
  }
};

TEST_P(HomingOnThePlant, HomesOneAxisAtItsSwitch) {
  ClosedLoop loop(3, GetParam());
  loop.enable_all();
  loop.give(1, the_insertion);
  EXPECT_EQ(presses_to_the_end(loop), 1u);
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
  EXPECT_TRUE(homed(loop, insertion));
  EXPECT_NEAR(loop.state().axis[insertion].position_counts, loop.true_position(insertion), 2.0);
  EXPECT_EQ(loop.refusals(), 0u);
}

TEST_P(HomingOnThePlant, HomesTheAxesOfAStepTogether) {
  ClosedLoop loop(5, GetParam());
  loop.enable_all();
  loop.give(1, the_angles);
  loop.pedal(true);
  EXPECT_TRUE(homing(loop, yaw));
  EXPECT_TRUE(homing(loop, pitch));
  ASSERT_TRUE(run_until(loop, [&] { return loop.home().phase == TaskPhase::done; }));
  EXPECT_TRUE(homed(loop, yaw));
  EXPECT_TRUE(homed(loop, pitch));
  EXPECT_FALSE(homed(loop, insertion));
}

TEST_P(HomingOnThePlant, HomesTheWholeRobotInTheOrderOfItsFile) {
  ClosedLoop loop(7, GetParam());
  UnhomedBounds bounds(loop, neuro());
  loop.enable_all();
  loop.give(1, every_step);
  loop.watch([&] {
    bounds.check();
    for (std::uint32_t step = 0; step < neuro().home_steps.size(); ++step) {
      for (const std::uint32_t slot : neuro().home_steps[step].home) {
        ASSERT_TRUE(!homing(loop, slot) || loop.home().step == step) << "slot " << slot;
      }
    }
  });
  EXPECT_EQ(presses_to_the_end(loop), 1u);
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
  for (const HomeStep& step : neuro().home_steps) {
    for (const std::uint32_t slot : step.home) {
      EXPECT_TRUE(homed(loop, slot)) << "slot " << slot;
    }
  }
  EXPECT_EQ(loop.refusals(), 0u);
  expect_nothing_driven(loop);
}

TEST_P(HomingOnThePlant, AReleaseInEachStepDropsHomingAndTheNextPressGoesOn) {
  ClosedLoop loop(11, GetParam());
  loop.enable_all();
  loop.give(1, every_step);
  loop.pedal(true);
  for (std::uint32_t step = 0; step < neuro().home_steps.size(); ++step) {
    SCOPED_TRACE(neuro().home_steps[step].name);
    const std::uint32_t slot = neuro().home_steps[step].home.front();
    ASSERT_TRUE(run_until(loop, [&] { return homing(loop, slot); }));
    loop.run(100);
    loop.pedal(false);
    EXPECT_EQ(loop.home().phase, TaskPhase::paused);
    EXPECT_EQ(loop.home().step, step);
    EXPECT_FALSE(homed(loop, slot));
    expect_nothing_driven(loop);
    loop.pedal(true);
  }
  ASSERT_TRUE(run_until(loop, [&] { return !is_open(loop.home().phase); }));
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
}

TEST_P(HomingOnThePlant, WhatIsHomedInThisRunIsNotHomedAgain) {
  ClosedLoop loop(13, GetParam());
  loop.enable_all();
  loop.give(1, the_angles);
  loop.pedal(true);
  ASSERT_TRUE(run_until(loop, [&] { return homed(loop, yaw) != homed(loop, pitch); }));
  const std::uint32_t first = homed(loop, yaw) ? yaw : pitch;
  loop.run(GetParam() + 1);
  loop.pedal(false);
  loop.watch([&] { ASSERT_TRUE(homed(loop, first)); });
  EXPECT_EQ(presses_to_the_end(loop), 1u);
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
}

TEST_P(HomingOnThePlant, SetHomeInAPauseDoesNotCount) {
  ClosedLoop loop(17, GetParam());
  loop.enable_all();
  loop.give(1, the_insertion);
  loop.pedal(true);
  ASSERT_TRUE(homing(loop, insertion));
  loop.pedal(false);
  loop.request(ILK_REQUEST_SET_HOME, insertion);
  ASSERT_TRUE(homed(loop, insertion));
  loop.pedal(true);
  EXPECT_TRUE(homing(loop, insertion));
  EXPECT_EQ(loop.home().phase, TaskPhase::executing);
}

TEST_P(HomingOnThePlant, AFailureOfOneAxisEndsAll) {
  ClosedLoop loop(19, GetParam());
  loop.enable_all();
  loop.give(1, every_step);
  loop.pedal(true);
  ASSERT_TRUE(run_until(loop, [&] { return homing(loop, yaw); }));
  loop.happen(plant::command::JamAxis{yaw, true});
  ASSERT_TRUE(run_until(loop, [&] { return !is_open(loop.home().phase); }));
  EXPECT_EQ(loop.home().phase, TaskPhase::aborted);
  EXPECT_EQ(loop.home().reason, TaskReason::axis_faulted);
  EXPECT_EQ(loop.home().slot, yaw);
  EXPECT_FALSE(homed(loop, yaw));
  loop.pedal(false);
  loop.pedal(true);
  loop.run(1000);
  expect_nothing_driven(loop);
}

TEST_P(HomingOnThePlant, ALostCardBesideItEndsIt) {
  ClosedLoop loop(23, GetParam());
  loop.enable_all();
  loop.give(1, the_insertion);
  loop.pedal(true);
  loop.happen(plant::command::PowerCard{rotation, false});
  loop.run(20 + GetParam());
  EXPECT_EQ(loop.home().reason, TaskReason::axis_faulted);
  EXPECT_EQ(loop.home().slot, rotation);
  expect_nothing_driven(loop);
}

TEST_P(HomingOnThePlant, StopEndsItForGood) {
  ClosedLoop loop(29, GetParam());
  loop.enable_all();
  loop.give(1, the_angles);
  loop.pedal(true);
  ASSERT_TRUE(homing(loop, yaw));
  loop.stop();
  EXPECT_EQ(loop.home().reason, TaskReason::stopped);
  loop.pedal(false);
  loop.pedal(true);
  loop.run(1000);
  expect_nothing_driven(loop);
  EXPECT_FALSE(homed(loop, yaw));
}

TEST_P(HomingOnThePlant, CancellingStopsTheKernelsHoming) {
  ClosedLoop loop(31, GetParam());
  loop.enable_all();
  loop.give(1, the_angles);
  loop.pedal(true);
  ASSERT_TRUE(homing(loop, yaw));
  loop.cancel(1);
  loop.run(2 + GetParam());
  EXPECT_EQ(loop.state().system.mode, static_cast<std::uint32_t>(ILK_MODE_READY));
  expect_nothing_driven(loop);
}

TEST_P(HomingOnThePlant, DisablingOneAxisEndsTheOthersToo) {
  ClosedLoop loop(37, GetParam());
  loop.enable_all();
  loop.give(1, the_angles);
  loop.pedal(true);
  ASSERT_TRUE(homing(loop, yaw));
  loop.request(ILK_REQUEST_DISABLE, pitch);
  EXPECT_EQ(loop.home().reason, TaskReason::axis_disabled);
  EXPECT_EQ(loop.home().slot, pitch);
  expect_nothing_driven(loop);
}

TEST_P(HomingOnThePlant, ANudgeGoesAPressAtATimeNeverFartherThanUnhomedTravel) {
  const Robot robot = neuro_with({{"out", "Out", {}, {{insertion, 400}}, {}}});
  ClosedLoop loop(41, GetParam(), robot);
  UnhomedBounds bounds(loop, robot);
  loop.enable_all();
  const double start = loop.true_position(insertion);
  loop.watch([&] { bounds.check(); });
  loop.give(1, HomeTask{0, 1, {}});
  loop.pedal(true);
  ASSERT_TRUE(run_until(loop, [&] { return loop.home().reason == TaskReason::press_again; }));
  EXPECT_EQ(loop.home().phase, TaskPhase::paused);
  EXPECT_NEAR(loop.home().left_counts, 283, 3);
  const double used_up = loop.true_position(insertion);
  loop.run(1000);
  EXPECT_NEAR(loop.true_position(insertion), used_up, 1.0);
  loop.pedal(false);
  EXPECT_EQ(loop.home().reason, TaskReason::pedal_released);
  EXPECT_EQ(presses_to_the_end(loop), 3u);
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
  EXPECT_NEAR(loop.true_position(insertion) - start, 400, 4.0);
  EXPECT_EQ(loop.refusals(), 0u);
}

TEST_P(HomingOnThePlant, ANudgeEndsAtItsSwitch) {
  const Robot robot = neuro_with({{"in", "In", {}, {{insertion, -1000}}, {}}});
  ClosedLoop loop(43, GetParam(), robot);
  UnhomedBounds bounds(loop, robot);
  loop.enable_all();
  loop.watch([&] { bounds.check(); });
  loop.give(1, HomeTask{0, 1, {}});
  EXPECT_EQ(presses_to_the_end(loop), 3u);
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
  EXPECT_LE(loop.true_position(insertion), 1.0);
  EXPECT_FALSE(homed(loop, insertion));
}

TEST_P(HomingOnThePlant, ARestoredPositionDoesNotChangeHowFarANudgeGoes) {
  const Robot robot = neuro_with({{"out", "Out", {}, {{insertion, 200}}, {}}});
  ClosedLoop loop(47, GetParam(), robot);
  loop.enable_all();
  const double start = loop.true_position(insertion);
  loop.give(1, HomeTask{0, 1, {}});
  loop.pedal(true);
  ASSERT_TRUE(run_until(loop, [&] { return loop.home().reason == TaskReason::press_again; }));
  loop.pedal(false);
  loop.request(ILK_REQUEST_RESTORE, insertion, 1200);
  EXPECT_EQ(presses_to_the_end(loop), 1u);
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
  EXPECT_NEAR(loop.true_position(insertion) - start, 200, 4.0);
}

TEST_P(HomingOnThePlant, AHomedAxisIsNudgedNoFartherThanItsSoftLimits) {
  const Robot robot = neuro_with({{"home", "Home", {insertion}, {}, {}},
                                  {"out", "Out", {}, {{insertion, 400}}, {}},
                                  {"in", "In", {}, {{insertion, -1000}}, {}}});
  ClosedLoop loop(53, GetParam(), robot);
  loop.enable_all();
  loop.give(1, HomeTask{0, 3, {}});
  double farthest = 0;
  loop.watch([&] { farthest = std::max(farthest, loop.true_position(insertion)); });
  EXPECT_EQ(presses_to_the_end(loop), 7u) << "a homed axis is nudged as slowly as one that is not";
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
  EXPECT_NEAR(farthest, 400, 15.0);
  EXPECT_NEAR(loop.true_position(insertion), neuro().at_slot(insertion)->lowest_setpoint_counts(), 4.0);
  EXPECT_EQ(loop.refusals(), 0u);
}

TEST_P(HomingOnThePlant, AMoveGoesToItsPositionOnceTheAxisIsHomed) {
  const Robot robot =
      neuro_with({{"home", "Home", {insertion}, {}, {}}, {"park", "Park", {}, {}, {{insertion, 500}}}});
  ClosedLoop loop(59, GetParam(), robot);
  loop.enable_all();
  loop.give(1, HomeTask{0, 2, {}});
  EXPECT_EQ(presses_to_the_end(loop), 1u);
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
  EXPECT_NEAR(loop.state().axis[insertion].position_counts, 500, neuro().at_slot(insertion)->deadband_counts);
  loop.run(200);
  expect_nothing_driven(loop);
}

TEST_P(HomingOnThePlant, AMoveOfAnAxisThatIsNotHomedEndsIt) {
  const Robot robot = neuro_with({{"park", "Park", {}, {}, {{insertion, 500}}}});
  ClosedLoop loop(61, GetParam(), robot);
  loop.enable_all();
  loop.give(1, HomeTask{0, 1, {}});
  loop.pedal(true);
  EXPECT_EQ(loop.home().phase, TaskPhase::aborted);
  EXPECT_EQ(loop.home().reason, TaskReason::not_homed);
  expect_nothing_driven(loop);
}

TEST_P(HomingOnThePlant, AReplacedMoveGivesItsAxisToHoming) {
  ClosedLoop loop(67, GetParam());
  loop.enable_all();
  loop.pedal(true);
  loop.give(1, MoveTask{insertion, 100});
  loop.run(30);
  loop.give(2, HomeTask{0, 0, {insertion}});
  EXPECT_EQ(loop.move(insertion).phase, TaskPhase::aborted);
  EXPECT_EQ(loop.move(insertion).reason, TaskReason::axis_homing);
  ASSERT_TRUE(run_until(loop, [&] { return loop.home().phase == TaskPhase::done; }));
  EXPECT_TRUE(homed(loop, insertion));
}

TEST_P(HomingOnThePlant, TheSameSeedGivesTheSameBits) {
  const auto run = [] {
    auto loop = std::make_unique<ClosedLoop>(71, GetParam());
    loop->enable_all();
    loop->give(1, every_step);
    (void)presses_to_the_end(*loop);
    return loop;
  };
  const auto first = run();
  const auto second = run();
  EXPECT_EQ(first->home(), second->home());
  EXPECT_EQ(std::memcmp(&first->state(), &second->state(), sizeof(ilk_state_t)), 0);
}

TEST_P(HomingOnThePlant, ANudgeAfterHomingInTheSamePressGoesNoFartherThanItShould) {
  const Robot robot =
      neuro_with({{"home", "Home", {insertion}, {}, {}}, {"out", "Out", {}, {{insertion, 40}}, {}}});
  ClosedLoop loop(71, GetParam(), robot);
  loop.enable_all();
  loop.give(1, HomeTask{0, 2, {}});
  (void)presses_to_the_end(loop);
  EXPECT_EQ(loop.home().phase, TaskPhase::done);
  EXPECT_NEAR(loop.true_position(insertion), 40, 4.0);
}

INSTANTIATE_TEST_SUITE_P(Latency, HomingOnThePlant, testing::Values(0u, 2u, ILK_LINK_TICKS_AHEAD));

}  // namespace
}  // namespace interlock
