#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "closed_loop.hpp"
#include "counted_allocations.hpp"
#include "modes/path/mode.hpp"
#include "plant/parameters_file.hpp"
#include "trajectory/trajectory_csv.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::config_of;
using test::minute_ticks;
using test::neuro;
using test::prostate;

constexpr std::uint32_t lateral = 4;
constexpr std::uint32_t feet = 6;
constexpr std::uint32_t head = 7;

/** Every axis was declared homed where it starts, so that these are distances. */
const std::vector<AxisCounts> neuro_targets{
    {test::yaw, -600}, {test::rotation, 2500}, {test::pitch, -300}, {test::insertion, 900},
    {lateral, -1100},  {feet, -700},           {head, -2000}};

PathProgram program_of(std::vector<PathLeg> legs) { return PathProgram{std::move(legs)}; }

PathProgram move_of(const std::vector<AxisCounts>& targets, double minimum_duration_s = 0.0) {
  return program_of({MoveLeg{targets, minimum_duration_s, 0.0}});
}

void expect_done(const TaskStatus& status) {
  EXPECT_EQ(status.phase, TaskPhase::done)
      << "reason " << static_cast<int>(status.reason) << ", code " << status.code << ", slot " << status.slot
      << ", leg " << status.step;
}

void expect_at(const ClosedLoop& loop, const Robot& robot, const std::vector<AxisCounts>& targets) {
  for (const AxisCounts& target : targets) {
    const Axis& axis = *robot.at_slot(target.slot);
    EXPECT_LE(std::abs(loop.state().axis[target.slot].position_counts - target.counts),
              static_cast<std::int32_t>(axis.deadband_counts))
        << axis.name;
  }
}

/** Latency of the link in ticks: the real clock, and the farthest that a simulated kernel runs ahead. */
class PathModeOnThePlant : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PathModeOnThePlant, CoordinatedAxesArriveAtRestWithinTheirDeadbands) {
  ClosedLoop loop(5, GetParam());
  loop.make_all_ready();
  const PathProgram program = move_of(neuro_targets);
  expect_done(loop.carry_out(1, test::along(program), minute_ticks));
  loop.run(100);
  expect_at(loop, neuro(), neuro_targets);
  EXPECT_EQ(loop.refusals(), 0u);
  EXPECT_LE(loop.most_requests_in_a_tick(), ILK_REQUESTS_PER_TICK);
  for (const AxisCounts& target : neuro_targets) {
    EXPECT_EQ(loop.outputs().command[target.slot].drive, 0u);
  }
}

TEST_P(PathModeOnThePlant, NoAxisOvershootsBeyondDeadbandAndCoast) {
  ClosedLoop loop(7, GetParam());
  loop.make_all_ready();
  const PathProgram program = move_of(neuro_targets);
  loop.watch([&] {
    for (const AxisCounts& target : neuro_targets) {
      const std::int32_t direction = target.counts < 0 ? -1 : 1;
      const std::int32_t beyond =
          direction * (loop.state().axis[target.slot].position_counts - target.counts);
      const ilk_axis_config_t& rules = loop.config().axis[target.slot];
      ASSERT_LE(beyond, static_cast<std::int32_t>(rules.deadband_counts + rules.coast_counts));
    }
  });
  expect_done(loop.carry_out(1, test::along(program), minute_ticks));
}

TEST_P(PathModeOnThePlant, ReleasePausesAndTheNextPressGoesOn) {
  ClosedLoop loop(11, GetParam());
  loop.make_all_ready();
  const PathProgram program = move_of(neuro_targets);
  (void)loop.carry_out(1, test::along(program), 1000);
  ASSERT_EQ(loop.path().phase, TaskPhase::executing);
  loop.pedal(false);
  EXPECT_EQ(loop.path().phase, TaskPhase::paused);
  const std::int32_t paused_at = loop.state().axis[head].position_counts;
  loop.run(1000);
  EXPECT_NEAR(loop.state().axis[head].position_counts, paused_at, 1);
  loop.pedal(true);
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.path().phase); ++i) {
    loop.tick();
  }
  expect_done(loop.path());
  expect_at(loop, neuro(), neuro_targets);
  EXPECT_EQ(loop.refusals(), 0u);
}

/** The second leg needs a confirmation. */
PathProgram aligned_then_inserted() {
  MoveLeg insert{{{test::insertion, 900}}, 0.0, 0.0};
  insert.needs_confirmation = true;
  return program_of({MoveLeg{{{lateral, -400}}, 0.0, 0.0}, insert});
}

TEST_P(PathModeOnThePlant, WhatNeedsAConfirmationBeginsWithThePressAfterIt) {
  ClosedLoop loop(11, GetParam());
  loop.make_all_ready();
  loop.give(1, test::along(aligned_then_inserted()));
  const auto reach = [&](TaskPhase phase) {
    for (std::uint32_t i = 0; i < minute_ticks && loop.path().phase != phase; ++i) {
      loop.tick();
    }
    return loop.path().phase == phase;
  };
  ASSERT_TRUE(reach(TaskPhase::paused));
  EXPECT_EQ(loop.path().reason, TaskReason::unconfirmed);
  EXPECT_EQ(loop.path().step, 1u);
  const auto expect_rest = [&](const char* when) {
    const std::int32_t before = loop.state().axis[test::insertion].position_counts;
    loop.run(500);
    EXPECT_NEAR(loop.state().axis[test::insertion].position_counts, before, 1) << when;
  };
  expect_rest("under the press that aligned it");
  loop.pedal(false);
  loop.pedal(true);
  expect_rest("under another press");
  loop.confirm(2);
  expect_rest("another task was confirmed");
  loop.confirm(1);
  expect_rest("the pedal was held when it was confirmed");
  loop.pedal(false);
  loop.pedal(true);
  ASSERT_TRUE(reach(TaskPhase::done));
  expect_at(loop, neuro(), {{test::insertion, 900}, {lateral, -400}});
}

TEST_P(PathModeOnThePlant, NothingIsInsertedBesideWhatSomebodyLookedAt) {
  for (const auto& [pushed, counts] : {std::pair{lateral, 2}, {lateral, 15}, {test::insertion, 15}}) {
    ClosedLoop loop(11, GetParam());
    loop.make_all_ready();
    loop.give(1, test::along(aligned_then_inserted()));
    for (std::uint32_t i = 0; i < minute_ticks && loop.path().phase != TaskPhase::paused; ++i) {
      loop.tick();
    }
    loop.confirm(1);
    loop.pedal(false);
    const std::int32_t past_goal = pushed == lateral ? -400 - loop.state().axis[lateral].position_counts : 0;
    loop.happen(plant::command::PushAxis{pushed, past_goal + counts});
    loop.run(100);
    loop.pedal(true);
    for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.path().phase); ++i) {
      loop.tick();
    }
    if (counts == 2) {
      expect_done(loop.path());
    } else {
      EXPECT_EQ(loop.path().reason, TaskReason::moved_away);
      EXPECT_EQ(loop.path().slot, pushed);
      EXPECT_LT(loop.state().axis[test::insertion].position_counts, 100);
    }
  }
}

TEST_P(PathModeOnThePlant, ARestIsAsLongAsItSaysWhateverDisturbsTheAxis) {
  constexpr std::int32_t goal = -400;
  constexpr std::uint32_t rest_ticks = 10'000;
  ClosedLoop loop(11, GetParam());
  loop.make_all_ready();
  plant::command::ChangeParameters noisy{lateral, {}};
  noisy.value[plant::kAxisKnobCount - 1] = 0.02;
  loop.happen(noisy);
  const std::uint32_t begun = loop.state().system.tick;
  expect_done(loop.carry_out(1, test::along(move_of({{lateral, goal}})), minute_ticks));
  const std::uint32_t way = loop.path().tick - begun;

  loop.give(2, test::along(program_of({MoveLeg{{{lateral, goal + 200}}, 0.0, rest_ticks / 1000.0}})));
  loop.run(way + rest_ticks / 2);
  const std::uint32_t pushed = loop.state().system.tick;
  loop.happen(plant::command::PushAxis{lateral, goal + 202 - loop.state().axis[lateral].position_counts});
  loop.run(rest_ticks / 4);
  EXPECT_TRUE(is_open(loop.path().phase));
  loop.run(rest_ticks / 4);
  expect_done(loop.path());
  EXPECT_GT(loop.path().tick - pushed, rest_ticks / 4);
}

TEST_P(PathModeOnThePlant, NobodyConfirmsForTenMinutesAndItExpires) {
  ClosedLoop loop(11, GetParam());
  loop.make_all_ready();
  loop.give(1, test::along(aligned_then_inserted()));
  for (std::uint32_t i = 0; i < minute_ticks && loop.path().phase != TaskPhase::paused; ++i) {
    loop.tick();
  }
  loop.run(9 * minute_ticks);
  EXPECT_EQ(loop.path().reason, TaskReason::unconfirmed);
  loop.run(minute_ticks + 1);
  EXPECT_EQ(loop.path().phase, TaskPhase::expired);
  loop.confirm(1);
  EXPECT_EQ(loop.path().phase, TaskPhase::expired) << "too late";
}

TEST_P(PathModeOnThePlant, AJammedAxisStopsAllOthersAtOnce) {
  ClosedLoop loop(13, GetParam());
  loop.make_all_ready();
  const PathProgram program = move_of(neuro_targets);
  (void)loop.carry_out(1, test::along(program), 1000);
  loop.happen(plant::command::JamAxis{head, true});
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.path().phase); ++i) {
    loop.tick();
  }
  EXPECT_EQ(loop.path().phase, TaskPhase::aborted);
  EXPECT_EQ(loop.path().reason, TaskReason::axis_faulted);
  EXPECT_EQ(loop.path().code, static_cast<std::uint32_t>(ILK_FAULT_STALL));
  EXPECT_EQ(loop.path().slot, head);
  loop.run(2 + GetParam());
  for (const AxisCounts& target : neuro_targets) {
    EXPECT_EQ(loop.outputs().command[target.slot].drive, 0u);
  }
}

/** From then on the motor of `head` goes at that share of the speed that its robot file states. */
void weaken_head(ClosedLoop& loop, double share) {
  plant::command::ChangeParameters slow{head, {}};
  for (std::size_t knob = 0; knob < plant::kAxisKnobCount; ++knob) {
    if (plant::kAxisKnobs[knob].name == "full_speed_counts_per_s") {
      slow.value[knob] = share * neuro().at_slot(head)->mechanics.full_speed_counts_per_s;
    }
  }
  loop.happen(slow);
}

/** The most that any axis is away from its path, as a share of what its robot file allows. */
class Straying {
 public:
  explicit Straying(const ClosedLoop& loop) : loop_(loop) {}

  void look() {
    for (const AxisCounts& target : neuro_targets) {
      if (const auto setpoint = loop_.setpoint(target.slot)) {
        const double error = setpoint->position_counts - loop_.state().axis[target.slot].position_counts;
        const double allowed = neuro().at_slot(target.slot)->motion->following_error_counts;
        most_ = std::max(most_, std::abs(error) / allowed);
      }
    }
  }

  [[nodiscard]] double most() const { return most_; }

 private:
  const ClosedLoop& loop_;
  double most_ = 0.0;
};

/** Weak from the start, or from full motion on. */
TEST_P(PathModeOnThePlant, AnAxisTooSlowForItsPathSlowsAllDownAndAllStayOnIt) {
  for (const std::uint32_t after_ticks : {1u, 1000u}) {
    for (const double share : {0.5, 0.2, 0.1, 0.05}) {
      ClosedLoop loop(13, GetParam());
      loop.make_all_ready();
      const PathProgram program = move_of(neuro_targets);
      Straying straying(loop);
      loop.watch([&] { straying.look(); });
      (void)loop.carry_out(1, test::along(program), after_ticks);
      weaken_head(loop, share);
      for (std::uint32_t i = 0; i < 2 * minute_ticks && is_open(loop.path().phase); ++i) {
        loop.tick();
      }
      expect_done(loop.path());
      expect_at(loop, neuro(), neuro_targets);
      EXPECT_LT(straying.most(), 1.0) << share;
      EXPECT_GT(straying.most(), 0.2) << "nothing was too slow";
      EXPECT_EQ(loop.refusals(), 0u);
    }
  }
}

TEST_P(PathModeOnThePlant, WhatIsStrongEnoughIsNotSlowedDown) {
  std::array<std::uint32_t, 2> ticks{};
  for (const bool weak : {false, true}) {
    ClosedLoop loop(13, GetParam());
    loop.make_all_ready();
    weaken_head(loop, weak ? 0.9 : 1.0);
    (void)loop.carry_out(1, test::along(move_of(neuro_targets)), 1);
    while (is_open(loop.path().phase) && ticks[weak ? 1 : 0] < minute_ticks) {
      loop.tick();
      ++ticks[weak ? 1 : 0];
    }
    expect_done(loop.path());
  }
  EXPECT_NEAR(ticks[1], ticks[0], 0.03 * ticks[0]);
}

TEST_P(PathModeOnThePlant, AnAxisThatLeavesItsPathStopsAllOthersAtOnce) {
  Robot robot = neuro();
  for (Axis& axis : robot.axes) {
    axis.motion->following_error_counts = 8;  // so near that the path cannot wait in time
  }
  ClosedLoop loop(13, GetParam(), robot);
  loop.make_all_ready();
  const PathProgram program = move_of(neuro_targets);
  (void)loop.carry_out(1, test::along(program), 1000);
  loop.happen(plant::command::JamAxis{head, true});
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.path().phase); ++i) {
    loop.tick();
  }
  EXPECT_EQ(loop.path().phase, TaskPhase::aborted);
  EXPECT_EQ(loop.path().reason, TaskReason::off_path);
  EXPECT_EQ(loop.path().slot, head);
  loop.run(2 + GetParam());
  for (const AxisCounts& target : neuro_targets) {
    EXPECT_EQ(loop.outputs().command[target.slot].drive, 0u);
  }
}

TEST_P(PathModeOnThePlant, ATrajectoryIsFollowedInTimeFromWhereItBegins) {
  ClosedLoop loop(17, GetParam());
  loop.make_all_ready();
  const auto trajectory = read_trajectory(
      "time [s],yaw [rad],yaw [rad/s],insertion [mm]\n"
      "0,-0.1,0,2\n1,-0.3,-0.3,8\n2,-0.5,0,8\n3,-0.3,0,4\n",
      neuro());
  ASSERT_TRUE(trajectory) << trajectory.error().message();
  const PathProgram program = program_of({TimedLeg{*trajectory}});
  std::uint32_t executing_ticks = 0;
  loop.give(1, test::along(program));
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.path().phase); ++i) {
    loop.tick();
    executing_ticks += loop.path().phase == TaskPhase::executing ? 1u : 0u;
  }
  expect_done(loop.path());
  const auto yaw_end = *neuro().at_slot(test::yaw)->to_counts(-0.3);
  const auto insertion_end = *neuro().at_slot(test::insertion)->to_counts(4.0);
  expect_at(loop, neuro(), {{test::yaw, yaw_end}, {test::insertion, insertion_end}});
  EXPECT_GT(executing_ticks, 3000u);
  EXPECT_EQ(loop.refusals(), 0u);
}

TEST_P(PathModeOnThePlant, LegsFollowOneAnotherAndDwell) {
  ClosedLoop loop(19, GetParam());
  loop.make_all_ready();
  const PathProgram program = program_of({MoveLeg{{{test::insertion, 300}}, 0.0, 0.5},
                                          MoveLeg{{{test::yaw, -200}, {head, -400}}, 0.0, 0.0},
                                          MoveLeg{{{test::insertion, 100}}, 2.0, 0.0}});
  loop.give(1, test::along(program));
  std::array<std::uint32_t, 3> ticks_of_leg{};
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.path().phase); ++i) {
    loop.tick();
    ++ticks_of_leg[loop.path().step];
  }
  expect_done(loop.path());
  expect_at(loop, neuro(), {{test::insertion, 100}, {test::yaw, -200}, {head, -400}});
  EXPECT_GT(ticks_of_leg[0], 500u + 300u);
  EXPECT_GT(ticks_of_leg[2], 2000u);
}

TEST_P(PathModeOnThePlant, TheProstateRobotsSlidersMoveTogether) {
  Robot robot = prostate();
  robot.home_steps.clear();
  for (Axis& axis : robot.axes) {
    axis.soft_limits = {-200000, 200000};  // declared homed where they start, for this test alone
    axis.home_offset_counts = 0;
    axis.limit = ILK_LIMIT_NONE;
    axis.homing.reset();
  }
  const auto plant =
      plant::load_parameters(INTERLOCK_ROBOTS "/../plant/prostate.toml", config_of(prostate()));
  ASSERT_TRUE(plant) << plant.error();
  plant::Parameters centred = *plant;
  for (const Axis& axis : robot.axes) {
    centred.axis[axis.slot].start_counts = 0;
  }
  const std::vector<AxisCounts> targets{{0, 3000},  {1, 40000},  {2, 20000},
                                        {4, 25000}, {5, -15000}, {6, -30000}};
  ClosedLoop loop(23, GetParam(), robot, centred);
  loop.make_all_ready();
  const PathProgram program = move_of(targets);
  expect_done(loop.carry_out(1, test::along(program), minute_ticks));
  expect_at(loop, robot, targets);
  EXPECT_EQ(loop.refusals(), 0u);
}

/** Largest change of an axis' velocity setpoint from a tick to the next, from rest on, and back to it. */
class VelocitySteps {
 public:
  VelocitySteps(const ClosedLoop& loop, std::uint32_t slot) : loop_(loop), slot_(slot) {}

  void look() {
    const auto setpoint = loop_.setpoint(slot_);
    // A release takes the motor's power: what the setpoint was then has no bearing on what comes.
    if (const double now = setpoint ? setpoint->velocity_counts_per_s : 0.0; setpoint) {
      largest_ = std::max(largest_, std::abs(now - before_));
      before_ = now;
    } else {
      before_ = 0.0;
    }
  }

  [[nodiscard]] double largest() const { return largest_; }

 private:
  const ClosedLoop& loop_;
  std::uint32_t slot_;
  double before_ = 0.0;
  double largest_ = 0.0;
};

/** A motion that no planner makes: it would have to last for eleven days. */
TEST_P(PathModeOnThePlant, APlanThatFailsInMotionStopsTheAxesWithinTheirCoast) {
  ClosedLoop loop(53, GetParam());
  loop.make_all_ready();
  const PathProgram there = move_of(neuro_targets);
  const PathProgram nowhere = move_of(neuro_targets, 1e6);
  (void)loop.carry_out(1, test::along(there), 1500);
  std::array<double, ILK_SLOTS> before{};
  for (const AxisCounts& target : neuro_targets) {
    before[target.slot] = loop.true_position(target.slot);
  }
  const TaskStatus status = loop.carry_out(2, test::along(nowhere), 100);
  EXPECT_EQ(status.phase, TaskPhase::aborted);
  EXPECT_EQ(status.reason, TaskReason::no_path);
  loop.run(2 + GetParam());
  for (const AxisCounts& target : neuro_targets) {
    EXPECT_EQ(loop.outputs().command[target.slot].drive, 0u) << target.slot;
  }
  loop.run(500);
  for (const AxisCounts& target : neuro_targets) {
    const Axis& axis = *neuro().at_slot(target.slot);
    // What it goes until the MOVE is taken back, and then its coast.
    const double latency_s = 0.001 * (2 + GetParam());
    const double farthest =
        latency_s * axis.mechanics.full_speed_counts_per_s + axis.mechanics.coast_counts + 1;
    EXPECT_LE(std::abs(loop.true_position(target.slot) - before[target.slot]), farthest) << axis.name;
  }
  EXPECT_EQ(loop.refusals(), 0u);
}

/** Its rows go straight at 0.6 rad/s from the first moment on, which is 477 counts/s. */
TEST_P(PathModeOnThePlant, ATrajectoryThatBeginsInMotionIsBegunAtTheVelocityOfItsAxes) {
  ClosedLoop loop(31, GetParam());
  loop.make_all_ready();
  const auto trajectory =
      read_trajectory("time [s],yaw [rad],yaw [rad/s]\n0,-0.1,-0.6\n1,-0.7,-0.6\n2,-1.0,0\n", neuro());
  ASSERT_TRUE(trajectory) << trajectory.error().message();
  const PathProgram program = program_of({TimedLeg{*trajectory}});
  VelocitySteps steps(loop, test::yaw);
  loop.watch([&] { steps.look(); });
  (void)loop.carry_out(1, test::along(program), 1200);
  ASSERT_EQ(loop.path().phase, TaskPhase::executing);
  loop.pedal(false);
  loop.pedal(true);
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.path().phase); ++i) {
    loop.tick();
  }
  expect_done(loop.path());
  const double acceleration = neuro().at_slot(test::yaw)->motion->acceleration_counts_per_s2;
  EXPECT_LE(steps.largest(), 1.01 * acceleration * 0.001);
  EXPECT_EQ(loop.refusals(), 0u);
}

/** Yaw arrives at 0.6 rad/s, which is 477 counts/s, insertion along a straight line at 4 mm/s. */
TEST_P(PathModeOnThePlant, ATrajectoryThatEndsInMotionComesToRestAtItsLastRow) {
  ClosedLoop loop(59, GetParam());
  loop.make_all_ready();
  const auto trajectory = read_trajectory(
      "time [s],yaw [rad],yaw [rad/s],insertion [mm]\n0,-0.1,0,2\n1,-0.5,-0.6,6\n1.5,-0.8,-0.6,8\n", neuro());
  ASSERT_TRUE(trajectory) << trajectory.error().message();
  const PathProgram program = program_of({TimedLeg{*trajectory}});
  const std::int32_t yaw_end = *neuro().at_slot(test::yaw)->to_counts(-0.8);
  const std::int32_t insertion_end = *neuro().at_slot(test::insertion)->to_counts(8.0);
  const ilk_axis_config_t& rules = loop.config().axis[test::yaw];
  VelocitySteps steps(loop, test::yaw);
  std::int32_t farthest = 0;
  loop.watch([&] {
    steps.look();
    farthest = std::min(farthest, loop.state().axis[test::yaw].position_counts);
  });
  expect_done(loop.carry_out(1, test::along(program), minute_ticks));
  const double acceleration = neuro().at_slot(test::yaw)->motion->acceleration_counts_per_s2;
  EXPECT_LE(steps.largest(), 1.01 * acceleration * 0.001);
  EXPECT_GE(farthest, yaw_end - static_cast<std::int32_t>(rules.deadband_counts + rules.coast_counts));
  expect_at(loop, neuro(), {{test::yaw, yaw_end}, {test::insertion, insertion_end}});
  EXPECT_EQ(loop.refusals(), 0u);
}

/** The path before is ended by the one that follows, at some 600 counts/s. */
TEST_P(PathModeOnThePlant, APathThatIsApprovedUnderAHeldPedalWaitsForANewPressAndWhatItReplacesStops) {
  ClosedLoop loop(37, GetParam());
  loop.make_all_ready();
  (void)loop.carry_out(1, test::along(move_of({{test::yaw, -600}})), 600);
  ASSERT_EQ(loop.path().phase, TaskPhase::executing);
  loop.give_under_any_pedal(2, test::along(move_of({{test::yaw, -700}})));
  loop.run(500);
  EXPECT_EQ(loop.path().phase, TaskPhase::waiting);
  EXPECT_EQ(loop.path().reason, TaskReason::press_again);
  EXPECT_EQ(loop.outputs().command[test::yaw].drive, 0u);
  loop.pedal(false);
  EXPECT_EQ(loop.path().reason, TaskReason::none);
  loop.pedal(true);
  loop.run(minute_ticks);
  EXPECT_EQ(loop.path().phase, TaskPhase::done);
  expect_at(loop, neuro(), {{test::yaw, -700}});
}

INSTANTIATE_TEST_SUITE_P(Latency, PathModeOnThePlant, testing::Values(1u, 8u));

/** As when a hand pushes the axis while the pedal is pressed. */
TEST(PathMode, ALegBeginsAtTheVelocityThatItsAxesHave) {
  PathMode mode(RobotPlan(neuro(), config_of(neuro())));
  ilk_snapshot_t snapshot{};
  snapshot.state.system.mode = ILK_MODE_READY;
  ilk_axis_t& yaw = snapshot.state.axis[test::yaw];
  yaw.state = ILK_AXIS_ENABLED;
  yaw.homed = 1;
  const TaskReference task = test::task_of(1, test::along(move_of({{test::yaw, -700}})));
  mode.take(task, 0);
  for (std::uint32_t tick = 1; tick <= 200; ++tick) {
    snapshot.state.system.tick = tick;
    snapshot.state.system.mode = tick < 200 ? ILK_MODE_READY : ILK_MODE_MOTION;
    snapshot.state.system.consent = tick < 200 ? 0 : 1;
    yaw.position_counts = -static_cast<std::int32_t>(tick / 2);
    yaw.card_time_us = 1000 * tick;
    KernelRequests requests;
    mode.tick(snapshot, requests);
  }
  ASSERT_EQ(mode.status().phase, TaskPhase::executing);
  EXPECT_NEAR(mode.setpoint(test::yaw)->velocity_counts_per_s, -500.0, 60.0);
}

TEST(PathMode, ATickAllocatesNothing) {
  PathMode mode(RobotPlan(neuro(), config_of(neuro())));
  const PathProgram program =
      program_of({MoveLeg{neuro_targets, 0.0, 0.0}, MoveLeg{{{head, -100}}, 0.0, 0.0}});
  ilk_snapshot_t snapshot{};
  snapshot.state.system.mode = ILK_MODE_MOTION;
  for (const AxisCounts& target : neuro_targets) {
    snapshot.state.axis[target.slot].state = ILK_AXIS_ENABLED;
    snapshot.state.axis[target.slot].homed = 1;
  }
  const TaskReference task = test::task_of(1, test::along(program));
  test::count_allocations_of(pthread_self());
  mode.take(task, 0);
  for (std::uint32_t tick = 1; tick < 30; ++tick) {
    snapshot.state.system.tick = tick;
    KernelRequests requests;
    mode.tick(snapshot, requests);
  }
  const std::uint32_t allocations = test::counted_allocations();
  test::count_allocations_of();
  EXPECT_EQ(mode.status().phase, TaskPhase::executing);
  EXPECT_EQ(allocations, 0u);
}

TEST(PathMode, AnAxisThatIsNotHomedEndsThePathBeforeItMoves) {
  ClosedLoop loop(37, 1);
  loop.enable_all();
  loop.pedal(true);
  const PathProgram program = move_of(neuro_targets);
  const TaskStatus status = loop.carry_out(1, test::along(program), 100);
  EXPECT_EQ(status.phase, TaskPhase::aborted);
  EXPECT_EQ(status.reason, TaskReason::not_homed);
}

TEST(PathMode, ARobotWithoutRatesHasNoPath) {
  Robot robot = neuro();
  for (Axis& axis : robot.axes) {
    axis.motion.reset();
  }
  ClosedLoop loop(41, 1, robot);
  loop.make_all_ready();
  const PathProgram program = move_of(neuro_targets);
  const TaskStatus status = loop.carry_out(1, test::along(program), 100);
  EXPECT_EQ(status.phase, TaskPhase::aborted);
  EXPECT_EQ(status.reason, TaskReason::no_path);
  EXPECT_EQ(loop.state().axis[head].position_counts, 0);
}

TEST(PathMode, HomingAndMovesAndPathsDoNotShareAxes) {
  ClosedLoop loop(43, 1);
  loop.make_all_ready();
  const PathProgram program = move_of(neuro_targets);
  (void)loop.carry_out(1, test::along(program), 500);
  loop.give(2, MoveTask{test::yaw, -100});
  EXPECT_EQ(loop.move(test::yaw).reason, TaskReason::superseded);
  EXPECT_EQ(loop.path().phase, TaskPhase::executing);
  loop.give_under_any_pedal(3, HomeTask{0, 1, {}});
  EXPECT_EQ(loop.path().reason, TaskReason::axis_homing);
  loop.give_under_any_pedal(4, test::along(program));
  EXPECT_EQ(loop.home().reason, TaskReason::superseded);
}

TEST(PathMode, APathThatNobodyPressesThePedalForExpires) {
  ClosedLoop loop(47, 1);
  loop.make_all_ready();
  loop.pedal(false);
  const PathProgram program = move_of(neuro_targets);
  const TaskStatus status = loop.carry_out(1, test::along(program), minute_ticks + 10);
  EXPECT_EQ(status.phase, TaskPhase::expired);
}

}  // namespace
}  // namespace interlock
