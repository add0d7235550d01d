// Mechanics that nobody has written down, measured, and what a robot's file is worth that has them.
#include "tuning/identification.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "plant/parameters_file.hpp"
#include "project_robots.hpp"
#include "robot/compile.hpp"
#include "robot/robot_file.hpp"
#include "tuning/gain_search.hpp"

namespace interlock {
namespace {

using test::neuro;
using test::prostate;

plant::Parameters shipped_plant(const Robot& robot) {
  return plant::load_parameters(INTERLOCK_PLANTS "/" + robot.name + ".toml", compile(robot).value()).value();
}

/** A motor of which the robot's file knows nothing. */
struct Hidden {
  double dead_zone;
  double full_speed_counts_per_s;
  std::uint32_t lag_us;
  double backlash_counts;
};

constexpr Hidden hidden_motors[] = {{0.04, 700, 8000, 3},  {0.08, 850, 5000, 1}, {0.12, 600, 8000, 2},
                                    {0.15, 500, 12000, 4}, {0.0, 1000, 5000, 1}, {0.15, 900, 7000, 1}};

plant::Parameters plant_with(const Robot& robot, const Axis& axis, const Hidden& hidden) {
  plant::Parameters plant = shipped_plant(robot);
  plant::AxisParameters& motor = plant.axis[axis.slot];
  motor.dead_zone_fraction = hidden.dead_zone;
  motor.full_speed_counts_per_s = hidden.full_speed_counts_per_s;
  motor.lag = plant::Microseconds(hidden.lag_us);
  motor.backlash_counts = hidden.backlash_counts;
  return plant;
}

/** Of another card, of a short range, and without a switch. */
std::vector<Axis> three_axes(const Robot& robot) {
  return {*robot.find("yaw"), *robot.find("pitch"), *robot.find("feet")};
}

RigResult<Identified> identified(const Robot& robot, const Axis& axis, const plant::Parameters& plant,
                                 std::uint64_t seed = 1) {
  return identify(robot, compile(robot).value(), plant, axis.name, seed);
}

/** The robot's file with these numbers, as it is read and as the kernel takes it. */
tl::expected<Robot, RobotError> changed(const Robot& robot, const Axis& axis,
                                        const std::vector<NumberChange>& changes) {
  const std::string file = INTERLOCK_ROBOTS "/" + robot.name + ".toml";
  std::ifstream input(file);
  const std::string text{std::istreambuf_iterator<char>(input), {}};
  std::vector<AxisNumber> numbers;
  for (const NumberChange& change : changes) {
    numbers.push_back(change.number);
  }
  return with_numbers(text, file, axis.name, numbers)
      .and_then([&](const std::string& edited) { return parse_robot(edited, file); })
      .and_then([](const Robot& parsed) {
        return compile(parsed).map([&](const ilk_config_t&) { return parsed; });
      });
}

double step_error_percent(const Robot& robot, const Axis& axis, const plant::Parameters& plant,
                          double cruise_counts_per_s) {
  const auto run =
      run_step(robot, compile(robot).value(), plant,
               {.axis = axis.name,
                .cruise_counts_per_s = cruise_counts_per_s,
                .full_speed_counts_per_s = robot.find(axis.name)->mechanics.full_speed_counts_per_s});
  EXPECT_TRUE(run) << axis.name << ": " << run.error();
  return run ? figures_of(*run).rms_velocity_error_percent : 1e9;
}

TEST(Identification, AFileThatFitsItsRobotStaysAsItIs) {
  for (const Robot& robot : {neuro(), prostate()}) {
    for (const Axis& axis : robot.axes) {
      const auto found = identified(robot, axis, shipped_plant(robot));
      ASSERT_TRUE(found) << axis.name << ": " << found.error();
      EXPECT_FALSE(found->homing_error) << axis.name;
      for (const NumberChange& change : changes_of(robot, axis, *found)) {
        ADD_FAILURE() << robot.name << ' ' << axis.name << ' ' << change.number.key << ": " << change.was
                      << " becomes " << change.number.value;
      }
    }
  }
}

TEST(Identification, AMotorThatNobodyDescribedIsMeasuredWithinTheStatedBounds) {
  const Robot robot = neuro();
  for (const Hidden& hidden : hidden_motors) {
    for (const Axis& axis : three_axes(robot)) {
      for (const std::uint64_t seed : {1, 2}) {
        SCOPED_TRACE(axis.name + ", dead zone " + std::to_string(hidden.dead_zone));
        const auto found = identified(robot, axis, plant_with(robot, axis, hidden), seed);
        ASSERT_TRUE(found) << found.error();
        EXPECT_NEAR(found->dead_zone_drive, hidden.dead_zone * axis.drive.max, 0.003 * axis.drive.max);
        EXPECT_NEAR(found->full_speed_counts_per_s, hidden.full_speed_counts_per_s,
                    0.005 * hidden.full_speed_counts_per_s);
        EXPECT_NEAR(found->lag_s, hidden.lag_us * 1e-6, 0.0015);
        EXPECT_NEAR(found->backlash_counts, hidden.backlash_counts, 0.75);
        EXPECT_EQ(found->noise_counts, 1u);
        EXPECT_LT(found->fit_percent, 0.1);
      }
    }
  }
}

TEST(Identification, TheFileThatComesOutOfItHomesAndFollowsAsOneWithTheTrueNumbers) {
  const Robot robot = neuro();
  for (const Hidden& hidden : hidden_motors) {
    for (const Axis& axis : three_axes(robot)) {
      SCOPED_TRACE(axis.name + ", dead zone " + std::to_string(hidden.dead_zone));
      const plant::Parameters plant = plant_with(robot, axis, hidden);
      const auto found = identified(robot, axis, plant);
      ASSERT_TRUE(found) << found.error();
      const auto file = changed(robot, axis, changes_of(robot, axis, *found));
      ASSERT_TRUE(file) << file.error().message();
      const Axis& is = *file->find(axis.name);

      Identified truth = *found;
      truth.dead_zone_drive = hidden.dead_zone * axis.drive.max;
      truth.full_speed_counts_per_s = hidden.full_speed_counts_per_s;
      truth.backlash_counts = hidden.backlash_counts;
      const auto true_file = changed(robot, axis, changes_of(robot, axis, truth));
      ASSERT_TRUE(true_file) << true_file.error().message();

      const double cruise = 0.6 * hidden.full_speed_counts_per_s;
      EXPECT_LE(step_error_percent(*file, is, plant, cruise),
                1.1 * step_error_percent(*true_file, *true_file->find(axis.name), plant, cruise));

      const auto again = identified(*file, is, plant, 2);
      ASSERT_TRUE(again) << again.error();
      EXPECT_FALSE(again->homing_error) << *again->homing_error;
    }
  }
}

/** Found from outside: play that took longer than a move was given was taken for none. */
TEST(Identification, MuchPlayOfASlowMotorIsMeasured) {
  const Robot robot = neuro();
  const Axis& feet = *robot.find("feet");
  const auto found = identified(robot, feet, plant_with(robot, feet, {0.015, 300, 5000, 10}));
  ASSERT_TRUE(found) << found.error();
  EXPECT_NEAR(found->backlash_counts, 10.0, 0.75);
}

/** Found from outside: neither a slider, whose range does not hold 0, nor a slow motor that coasts for long
 * came to a file that homes. */
TEST(Identification, AnAxisThatDoesNotHomeWithItsFileHomesWithTheOneThatComesOut) {
  const Robot robot = prostate();
  for (const auto& [name, hidden] : {std::pair{"back_left", Hidden{0.15, 40'000, 5000, 10}},
                                     {"insertion", Hidden{0.0945, 16'859, 16'500, 0}},
                                     {"front_right", Hidden{0.08, 30'000, 8000, 10}}}) {
    const Axis& axis = *robot.find(name);
    plant::Parameters plant = plant_with(robot, axis, hidden);
    const auto found = identified(robot, axis, plant);
    ASSERT_TRUE(found) << name << ": " << found.error();
    EXPECT_EQ(found->homing_error, "the axis faulted: STALL") << name;
    const auto file = changed(robot, axis, changes_of(robot, axis, *found));
    ASSERT_TRUE(file) << file.error().message();
    const auto again = identified(*file, *file->find(name), plant, 2);
    ASSERT_TRUE(again) << name << ": " << again.error();
    EXPECT_FALSE(again->homing_error) << name << ": " << *again->homing_error;
  }
}

TEST(Identification, ReadingsThatAreMissingDoNotChangeWhatIsMeasured) {
  const Robot robot = neuro();
  const ilk_config_t config = compile(robot).value();
  const Axis& axis = *robot.find("feet");
  const Hidden hidden{0.08, 850, 8000, 3};
  std::minstd_rand random(7);
  StepRig rig(config, plant_with(robot, axis, hidden), 1, axis.slot);
  ASSERT_TRUE(rig.make_ready());
  AxisMeasurement program(config.common.period_us);
  program.begin(config.axis[axis.slot], measuring_range(config.axis[axis.slot], axis.lowest_setpoint_counts(),
                                                        axis.highest_setpoint_counts()));
  MeasuringMove move;
  std::uint32_t move_tick = 0;
  std::uint32_t before = 0;
  while (program.state() == AxisMeasurement::State::measures) {
    move_tick = before <= 1 && rig.drive() > 1 ? rig.tick_count() : move_tick;
    before = rig.drive();
    if (random() % 4 == 0) {
      move = program.see({rig.tick_count(), rig.axis().position_counts, rig.drive(), move_tick});
    }
    rig.move(move.target_counts, move.drive);
    const auto ticked = rig.tick();
    ASSERT_TRUE(ticked) << ticked.error();
  }
  ASSERT_EQ(program.state(), AxisMeasurement::State::done);
  const MeasuredAxis& found = program.found();
  EXPECT_NEAR(found.dead_zone_drive, hidden.dead_zone * axis.drive.max, 0.003 * axis.drive.max);
  EXPECT_NEAR(found.full_speed_counts_per_s, hidden.full_speed_counts_per_s,
              0.006 * hidden.full_speed_counts_per_s);
  EXPECT_NEAR(found.lag_s, hidden.lag_us * 1e-6, 0.002);
  EXPECT_NEAR(found.backlash_counts, hidden.backlash_counts, 0.75);
  EXPECT_FALSE(found.coast_counts) << "no move was seen whole";
}

TEST(Identification, WhatCannotBeMeasuredIsSaid) {
  const Robot robot = neuro();
  EXPECT_EQ(identify(robot, compile(robot).value(), shipped_plant(robot), "elbow", 1).error(),
            "neuro has no axis \"elbow\"");
  const Axis& yaw = *robot.find("yaw");
  EXPECT_EQ(
      identified(robot, yaw, plant_with(robot, yaw, {0.6, 1000, 5000, 1})).error(),
      "the axis faulted: STALL, before the first move, with dead zones up to a fifth of drive.max as well: "
      "more than that no file may state. Look at what holds the axis, at its motor's supply and its encoder, "
      "and at drive.max");
  const Axis& feet = *robot.find("feet");
  EXPECT_EQ(
      identified(robot, feet, plant_with(robot, feet, {0.015, 200, 5000, 20})).error(),
      "feet stands at half of its largest drive for as long as its stall rule lets it: it moves nothing "
      "there, or has more play than its file says");
}

TEST(GainSearch, FindsGainsThatAreNoWorseThanThoseItBeganWith) {
  const Robot robot = neuro();
  const ilk_config_t config = compile(robot).value();
  const plant::Parameters plant = shipped_plant(robot);
  const StepOptions poor{.axis = "yaw",
                         .gains = {.position_per_s = 2.0, .velocity = 1.5, .integral_per_s = 0.5}};
  const auto found = search_gains(robot, config, plant, poor);
  ASSERT_TRUE(found) << found.error();
  EXPECT_LT(found->rms_velocity_error_percent, 0.8 * found->begun_with_percent);
  const auto shipped = search_gains(robot, config, plant, {.axis = "yaw"});
  ASSERT_TRUE(shipped) << shipped.error();
  EXPECT_LE(shipped->rms_velocity_error_percent, shipped->begun_with_percent);
  EXPECT_NEAR(found->rms_velocity_error_percent, shipped->rms_velocity_error_percent,
              0.2 * shipped->rms_velocity_error_percent);
}

TEST(Identification, OfALoadedAxisTheSlowerDirectionCountsForItsSlowestSpeeds) {
  for (const double load : {0.5, -0.5}) {
    SCOPED_TRACE(load);
    const Axis axis = *neuro().find("yaw");
    plant::Parameters plant = plant_with(neuro(), axis, {0.015, 1000, 5000, 4});
    plant.axis[axis.slot].load_fraction = load;
    const auto found = identified(neuro(), axis, plant);
    ASSERT_TRUE(found) << found.error();
    const auto robot = changed(neuro(), axis, changes_of(neuro(), axis, *found));
    ASSERT_TRUE(robot) << robot.error().message();
    const Axis is = *robot->find("yaw");
    const auto slower_at = [&](std::uint32_t drive) {
      return 500.0 * (drive - 0.015 * is.drive.max) / (0.985 * is.drive.max);
    };
    EXPECT_LE(is.homing->speed_counts_per_s, slower_at(is.homing->drive));
    EXPECT_LE(is.homing->slow_speed_counts_per_s, slower_at(is.homing->slow_drive));
    const auto again = identified(*robot, is, plant);
    ASSERT_TRUE(again) << again.error();
    EXPECT_FALSE(again->homing_error) << *again->homing_error;
  }
}

TEST(Identification, AResonanceThatNobodyDescribedIsMeasuredAndFollowedAsTheTrueOne) {
  const Robot robot = prostate();
  const Axis& rotation = *robot.find("rotation");
  for (const double hidden_hz : {-400.0, -200.0, -100.0, 150.0}) {
    SCOPED_TRACE(hidden_hz);
    plant::Parameters plant = shipped_plant(robot);
    plant.axis[rotation.slot].resonance_hz = hidden_hz;
    const auto found = identified(robot, rotation, plant);
    ASSERT_TRUE(found) << found.error();
    ASSERT_TRUE(believable(robot, "rotation", *found));
    std::vector<NumberChange> changes = changes_of(robot, rotation, *found);
    ASSERT_FALSE(changes.empty());
    EXPECT_EQ(changes.front().number.key, "drive.resonance_hz");
    EXPECT_NEAR(changes.front().number.value, hidden_hz, 5.0);
    const auto file = changed(robot, rotation, changes);
    ASSERT_TRUE(file) << file.error().message();
    changes.front().number.value = hidden_hz;
    const auto true_file = changed(robot, rotation, changes);
    ASSERT_TRUE(true_file) << true_file.error().message();

    const Axis& is = *file->find("rotation");
    const double cruise = is.motion->velocity_counts_per_s;
    const double error = step_error_percent(*file, is, plant, cruise);
    EXPECT_LE(error, 1.1 * step_error_percent(*true_file, *true_file->find("rotation"), plant, cruise));
    EXPECT_LT(error, 2.0);

    const auto again = identified(*file, is, plant, 2);
    ASSERT_TRUE(again) << again.error();
    for (const NumberChange& change : changes_of(*file, is, *again)) {
      EXPECT_NE(change.number.key, "drive.resonance_hz") << change.number.value;
    }
  }
}

TEST(Identification, OfAMotorThatChangesMeanwhileNoFileFollows) {
  const Axis axis = *prostate().find("rotation");
  plant::Parameters plant = shipped_plant(prostate());
  const auto steady = identified(prostate(), axis, plant);
  ASSERT_TRUE(steady) << steady.error();
  EXPECT_TRUE(believable(prostate(), "rotation", *steady));
  plant.axis[axis.slot].resonance_drift_hz = 400;
  plant.axis[axis.slot].heat_time_s = 10;
  const auto drifting = identified(prostate(), axis, plant);
  ASSERT_TRUE(drifting) << drifting.error();
  const auto refused = believable(prostate(), "rotation", *drifting);
  ASSERT_FALSE(refused) << drifting->fit_percent;
  EXPECT_NE(refused.error().message().find("off the published map"), std::string::npos);
}

}  // namespace
}  // namespace interlock
