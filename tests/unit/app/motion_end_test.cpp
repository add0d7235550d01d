// Where motions end, and what motors do to them that start only well above nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>

#include "closed_loop.hpp"
#include "motion/rest_aim.hpp"
#include "proposals/programs.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::config_of;
using test::minute_ticks;
using test::neuro;
using test::prostate;

/** The robot on a bench: no axis is linked to another, none has a switch, each stands in the middle of its
 * range. */
Robot on_a_bench(Robot robot) {
  robot.home_steps.clear();
  robot.kinematics.reset();
  for (Axis& axis : robot.axes) {
    const std::int32_t half = (axis.soft_limits.max_counts - axis.soft_limits.min_counts) / 2;
    axis.soft_limits = {-half, half};
    axis.home_offset_counts = 0;
    axis.limit = ILK_LIMIT_NONE;
    axis.homing.reset();
  }
  return robot;
}

/** With motors that stand still up to that share of the largest drive, as its file then says. What a motor
 * does that is driven by frequency is in the published map. */
Robot with_dead_zone(Robot robot, double share) {
  for (Axis& axis : robot.axes) {
    if (axis.card == ILK_CARD_HIGH_FREQUENCY) {
      continue;
    }
    const DriveBounds old = axis.drive;
    axis.drive.dead_zone = static_cast<std::uint32_t>(std::lround(share * axis.drive.max));
    axis.drive.min = 0;
    const auto as_fast = [&](std::uint32_t drive) {
      return axis.drive.dead_zone +
             static_cast<std::uint32_t>(std::uint64_t{drive - old.dead_zone} *
                                        (old.max - axis.drive.dead_zone) / (old.max - old.dead_zone));
    };
    axis.drive.unhomed_max = as_fast(old.unhomed_max);
    if (axis.homing) {
      axis.homing->drive = as_fast(axis.homing->drive);
      axis.homing->slow_drive = as_fast(axis.homing->slow_drive);
    }
  }
  return robot;
}

/** Motors that are as the robot's file says. */
plant::Parameters plant_of(const Robot& robot) {
  plant::Parameters plant = plant::default_parameters(config_of(robot));
  for (const Axis& axis : robot.axes) {
    plant::AxisParameters& motor = plant.axis[axis.slot];
    motor.dead_zone_fraction = static_cast<double>(axis.drive.dead_zone) / axis.drive.max;
    motor.full_speed_counts_per_s = axis.mechanics.full_speed_counts_per_s;
    motor.backlash_counts = axis.mechanics.backlash_counts;
  }
  return plant;
}

/** In the middle of its deadband: half of it beside the target at most, either way. One reading in a thousand
 * is a count off: the middle one of three counts. */
void expect_in_the_middle(ClosedLoop& loop, const Axis& axis, std::int32_t target) {
  std::array<std::int32_t, 3> readings{};
  for (std::int32_t& reading : readings) {
    reading = loop.state().axis[axis.slot].position_counts;
    loop.tick();
  }
  std::ranges::sort(readings);
  const std::int32_t error = readings[1] - target;
  EXPECT_LE(2 * std::abs(error), static_cast<std::int32_t>(axis.deadband_counts))
      << axis.name << " rests " << error << " counts beside " << target;
}

/** To and fro, each axis by itself and all together. */
void go_to_and_fro(ClosedLoop& loop, const Robot& robot) {
  std::uint32_t task = 1;
  for (const std::int32_t percent : {-20, 20, -28, -10, 15, -5, 0}) {
    MoveLeg leg;
    for (const Axis& axis : robot.axes) {
      const std::int32_t range = axis.highest_setpoint_counts() - axis.lowest_setpoint_counts();
      leg.targets.push_back({axis.slot, range * percent / 100});
      const std::int32_t middle = (loop.state().axis[axis.slot].position_counts + range * percent / 100) / 2;
      const TaskStatus moved = loop.carry_out(++task, MoveTask{axis.slot, middle}, minute_ticks);
      ASSERT_EQ(moved.phase, TaskPhase::done) << axis.name;
      expect_in_the_middle(loop, axis, middle);
    }
    const PathProgram program{{leg}};
    ASSERT_EQ(loop.carry_out(++task, test::along(program), minute_ticks).phase, TaskPhase::done);
    for (const AxisCounts& target : leg.targets) {
      expect_in_the_middle(loop, *robot.at_slot(target.slot), target.counts);
    }
  }
  EXPECT_EQ(loop.refusals(), 0u);
}

TEST(MotionEnd, AnAxisComesToRestInTheMiddleOfItsDeadbandWhateverTheDeadZoneOfItsMotor) {
  for (const double share : {0.015, 0.05, 0.1, 0.15}) {
    for (const Robot& shipped : {neuro(), prostate()}) {
      SCOPED_TRACE(shipped.name + ", dead zone " + std::to_string(share));
      const Robot robot = with_dead_zone(on_a_bench(shipped), share);
      ClosedLoop loop(5, 1, robot, plant_of(robot));
      loop.make_all_ready();
      ASSERT_NO_FATAL_FAILURE(go_to_and_fro(loop, robot));
    }
  }
}

TEST(MotionEnd, AnAxisFindsItsSwitchWhateverTheDeadZoneOfItsMotor) {
  for (const double share : {0.015, 0.05, 0.1, 0.15}) {
    const Robot robot = with_dead_zone(neuro(), share);
    for (const Axis& axis : robot.axes) {
      if (axis.homing) {
        SCOPED_TRACE(axis.name + ", dead zone " + std::to_string(share));
        ClosedLoop loop(5, 1, robot, plant_of(robot));
        ASSERT_NO_THROW(loop.make_ready(axis.slot));
        EXPECT_EQ(loop.state().axis[axis.slot].homed, ILK_HOMED_BY_SWITCH);
      }
    }
  }
}

/** A fifth of the readings is a count off. */
TEST(MotionEnd, AnEncoderThatDithersChangesNothing) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Robot robot = on_a_bench(neuro());
    plant::Parameters plant = plant_of(robot);
    for (plant::AxisParameters& axis : plant.axis) {
      axis.noise_counts = 1;
      axis.noise_chance = 0.2;
    }
    ClosedLoop loop(seed, 1, robot, plant);
    loop.make_all_ready();
    std::uint32_t task = 1;
    for (const std::int32_t percent : {-20, 20, -5}) {
      MoveLeg leg;
      for (const Axis& axis : robot.axes) {
        const std::int32_t range = axis.highest_setpoint_counts() - axis.lowest_setpoint_counts();
        leg.targets.push_back({axis.slot, range * percent / 100});
      }
      const PathProgram program{{leg}};
      ASSERT_EQ(loop.carry_out(++task, test::along(program), minute_ticks).phase, TaskPhase::done) << seed;
      for (const AxisCounts& target : leg.targets) {
        const auto error = loop.state().axis[target.slot].position_counts - target.counts;
        EXPECT_LE(std::abs(error), 1) << robot.at_slot(target.slot)->name;
      }
    }
    EXPECT_EQ(loop.refusals(), 0u);
  }
}

TEST(MotionEnd, HomingWithAnEncoderThatDithersChangesNothing) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const Axis& axis : neuro().axes) {
      plant::Parameters plant = plant::default_parameters(config_of(neuro()));
      for (plant::AxisParameters& each : plant.axis) {
        each.noise_counts = 1;
        each.noise_chance = 0.2;
      }
      ClosedLoop loop(seed, 1, neuro(), plant);
      ASSERT_NO_THROW(loop.make_ready(axis.slot)) << axis.name << " seed " << seed;
      const double offset = loop.true_position(axis.slot) - loop.state().axis[axis.slot].position_counts;
      if (axis.limit != ILK_LIMIT_NONE) {
        EXPECT_LE(std::abs(offset), 2.0) << axis.name;
      }
    }
  }
}

/** How far the tools are from the targets at most, after each of three motions of the insertion, or of all
 * other axes. */
double farthest_tool(const Robot& robot, const plant::Parameters& plant, bool of_insertion,
                     const std::function<PathProgram(PathProgram)>& made) {
  ClosedLoop loop(5, 1, robot, plant);
  loop.make_all_ready();
  double farthest = 0.0;
  std::uint32_t task = 1;
  for (const std::int32_t percent : {-20, 20, -5}) {
    MoveLeg leg;
    for (const Axis& axis : robot.axes) {
      const std::int32_t range = axis.highest_setpoint_counts() - axis.lowest_setpoint_counts();
      if ((axis.slot == test::insertion) == of_insertion) {
        leg.targets.push_back({axis.slot, range * percent / 100});
      }
    }
    EXPECT_EQ(loop.carry_out(++task, test::along(made({{leg}})), 2 * minute_ticks).phase, TaskPhase::done);
    for (const AxisCounts& target : leg.targets) {
      const double home = loop.true_position(target.slot) - loop.state().axis[target.slot].position_counts;
      farthest = std::max(farthest, std::abs(loop.true_tool(target.slot) - home - target.counts));
    }
  }
  EXPECT_EQ(loop.refusals(), 0u);
  return farthest;
}

TEST(MotionEnd, AToolWithPlayIsWhereItShouldBeOnceItsAxisCameFromBelow) {
  Robot robot = on_a_bench(neuro());
  plant::Parameters plant = plant_of(robot);
  for (Axis& axis : robot.axes) {
    axis.mechanics.tool_play_counts = 20;
    plant.axis[axis.slot].tool_play_counts = 20;
  }
  for (const bool of_insertion : {false, true}) {
    const auto from_below = [&](PathProgram program) {
      return arriving_from_below(robot, std::move(program), of_insertion);
    };
    EXPECT_LE(farthest_tool(robot, plant, of_insertion, from_below), 2.0);
    EXPECT_GE(farthest_tool(robot, plant, of_insertion, [](PathProgram program) { return program; }), 18.0)
        << "the play shows when nothing is done about it";
  }
}

/** Somebody lifts the foot on the last counts, moves the axes on by hand, and the foot presses again. */
TEST(MotionEnd, AToolWithPlayIsWhereItShouldBeAlthoughItsAxisWasPushedInAPause) {
  Robot robot = on_a_bench(neuro());
  plant::Parameters plant = plant_of(robot);
  for (Axis& axis : robot.axes) {
    axis.mechanics.tool_play_counts = 20;
    plant.axis[axis.slot].tool_play_counts = 20;
  }
  const std::vector<AxisCounts> targets{{0, -300}, {2, -100}, {4, -400}};
  const PathProgram program = arriving_from_below(robot, {{MoveLeg{targets, 0.0, 0.0}}});
  ASSERT_EQ(program.legs.size(), 2u);
  ClosedLoop loop(5, 1, robot, plant);
  loop.make_all_ready();
  loop.give(2, test::along(program));
  const auto left = [&](const AxisCounts& target) {
    return target.counts - loop.state().axis[target.slot].position_counts;
  };
  for (std::uint32_t i = 0; i < minute_ticks && (loop.path().step == 0 || left(targets[0]) > 15); ++i) {
    loop.tick();
  }
  ASSERT_EQ(loop.path().step, 1u);
  loop.pedal(false);
  loop.run(500);
  for (const AxisCounts& target : targets) {
    loop.happen(plant::command::PushAxis{target.slot, 17});
  }
  loop.run(500);
  loop.pedal(true);
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.path().phase); ++i) {
    loop.tick();
  }
  ASSERT_EQ(loop.path().phase, TaskPhase::done);
  for (const AxisCounts& target : targets) {
    const double home = loop.true_position(target.slot) - loop.state().axis[target.slot].position_counts;
    EXPECT_LE(std::abs(loop.true_tool(target.slot) - home - target.counts), 2.0) << target.slot;
  }
}

TEST(MotionEnd, AxesGoTogetherToWhereThePlayOfSomeIsTakenUpAndTheInsertionGoesLast) {
  Robot robot = neuro();
  std::ranges::find(robot.axes, "yaw", &Axis::name)->mechanics.tool_play_counts = 4;
  const MoveLeg leg{{{0, -300}, {2, 100}, {test::insertion, 500}}, 0.0, 0.0};
  const PathProgram program = arriving_from_below(robot, {{leg}});
  ASSERT_EQ(program.legs.size(), 2u);
  const std::vector<AxisCounts> below{{0, -307}, {2, 100}};
  EXPECT_EQ(std::get<MoveLeg>(program.legs[0]).targets, below);
  EXPECT_TRUE(std::get<MoveLeg>(program.legs[0]).takes_up_play);
  EXPECT_EQ(std::get<MoveLeg>(program.legs[1]).targets, leg.targets);
}

TEST(MotionEnd, NothingGoesAsideForTheSakeOfPlayWhileTheProbeIsInserted) {
  Robot robot = neuro();
  for (Axis& axis : robot.axes) {
    axis.mechanics.tool_play_counts = 20;
  }
  const MoveLeg leg{{{0, -300}, {test::rotation, 100}, {test::insertion, 500}}, 0.0, 0.0};
  const PathProgram program = arriving_from_below(robot, {{leg}}, true);
  ASSERT_EQ(program.legs.size(), 2u);
  std::vector<std::uint32_t> slots;
  for (const AxisCounts& target : std::get<MoveLeg>(program.legs[0]).targets) {
    slots.push_back(target.slot);
  }
  EXPECT_EQ(slots, (std::vector<std::uint32_t>{test::rotation, test::insertion}));
  EXPECT_EQ(std::get<MoveLeg>(program.legs[1]).targets, leg.targets);
}

TEST(MotionEnd, OnlyALegThatMayComeFromAboveGoesBelowFirst) {
  Robot robot = neuro();
  Axis& yaw = *std::ranges::find(robot.axes, "yaw", &Axis::name);
  const auto to = [&](std::int32_t counts, bool confirmed) {
    return MoveLeg{{{yaw.slot, counts}}, 0.0, 0.0, confirmed};
  };
  const auto legs_of = [&](PathProgram program) {
    std::vector<std::pair<std::int32_t, bool>> legs;
    for (const PathLeg& leg : arriving_from_below(robot, std::move(program)).legs) {
      const auto& move = std::get<MoveLeg>(leg);
      legs.emplace_back(move.targets.front().counts, move.needs_confirmation);
    }
    return legs;
  };
  const PathProgram there{{to(-300, true), to(-200, false), to(-250, false)}};
  using Legs = std::vector<std::pair<std::int32_t, bool>>;
  EXPECT_EQ(legs_of(there), (Legs{{-300, true}, {-200, false}, {-250, false}})) << "nobody measured a play";
  yaw.mechanics.tool_play_counts = 4;
  EXPECT_EQ(legs_of(there), (Legs{{-307, true}, {-300, false}, {-200, false}, {-257, false}, {-250, false}}));
  yaw.mechanics.tool_play_counts = 10000;
  EXPECT_EQ(legs_of(there), (Legs{{-300, true}, {-200, false}, {-250, false}})) << "there is no room for it";
}

TEST(MotionEnd, TheEndsOfTheRangeAreReachedToo) {
  const Robot robot = on_a_bench(neuro());
  ClosedLoop loop(5, 1, robot, plant_of(robot));
  loop.make_all_ready();
  std::uint32_t task = 1;
  for (const Axis& axis : robot.axes) {
    for (const std::int32_t end : {axis.lowest_setpoint_counts(), axis.highest_setpoint_counts()}) {
      const TaskStatus moved = loop.carry_out(++task, MoveTask{axis.slot, end}, minute_ticks);
      EXPECT_EQ(moved.phase, TaskPhase::done) << axis.name;
    }
  }
  EXPECT_EQ(loop.refusals(), 0u);
}

AxisPlan plan_with(std::uint32_t deadband_counts, double slowest_counts_per_s, double lead_s) {
  AxisPlan plan;
  plan.rules.deadband_counts = deadband_counts;
  plan.control.drive = {.card = ILK_CARD_PWM,
                        .max_drive = 1000,
                        .min_drive = 100,
                        .full_speed_counts_per_s = slowest_counts_per_s * 10};
  plan.control.piv.lead_s = lead_s;
  return plan;
}

TEST(RestAim, LiesBeyondTheTargetByTheDeadbandLessTheCoast) {
  RestAim aim(plan_with(20, 600.0, 0.01));
  EXPECT_EQ(aim.setpoint(1000, 0), 1014);
  EXPECT_EQ(aim.setpoint(1000, 990), 1014) << "from where it came";
  EXPECT_EQ(aim.setpoint(1000, 1010), 1014);
  EXPECT_EQ(aim.setpoint(1000, 1021), 986) << "it went past, and comes back";
  EXPECT_EQ(aim.setpoint(-1000, 1000), -1014);
}

TEST(RestAim, IsNeverShortOfTheTargetAndNowhereElseThanWhereAnAxisIsThatHasNotToMove) {
  RestAim far(plan_with(2, 5000.0, 0.01));
  EXPECT_EQ(far.setpoint(100, 0), 100) << "it coasts farther than the deadband";
  RestAim near(plan_with(2, 10.0, 0.01));
  EXPECT_EQ(near.setpoint(100, 100), 100);
  EXPECT_EQ(near.setpoint(100, 99), 102) << "a path may be so slow that its target is never far";
  EXPECT_EQ(near.setpoint(100, 101), 102) << "noise turns it nowhere";
  EXPECT_EQ(RestAim().setpoint(7, 0), 7);
  EXPECT_EQ(near.setpoint(INT32_MAX, 0), INT32_MAX);
}

}  // namespace
}  // namespace interlock
