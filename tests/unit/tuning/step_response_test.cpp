#include <gmock/gmock.h>

#include <cmath>

#include "interlock/link.h"
#include "plant/parameters_file.hpp"
#include "project_robots.hpp"
#include "robot/compile.hpp"
#include "tuning/step_run.hpp"

namespace interlock {
namespace {

using test::neuro;
using test::prostate;

plant::Parameters plant_of(const Robot& robot) {
  return plant::load_parameters(INTERLOCK_PLANTS "/" + robot.name + ".toml", compile(robot).value()).value();
}

RigResult<StepRun> run(const Robot& robot, const StepOptions& options) {
  return run_step(robot, compile(robot).value(), plant_of(robot), options);
}

/** The move of the thesis; the axis' range allows it towards smaller positions. */
StepOptions thesis_move(std::uint64_t seed) {
  return {.axis = "yaw", .move_counts = -600, .cruise_counts_per_s = 833.0, .seed = seed};
}

TEST(StepResponse, YawFollowsTheTrapezoidOfTheThesisWithinFivePercentOfCruise) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto step = run(neuro(), thesis_move(seed));
    ASSERT_TRUE(step) << step.error();
    const StepFigures figures = figures_of(*step);
    EXPECT_EQ(step->peak_counts_per_s, 833.0);
    EXPECT_LE(figures.rms_velocity_error_percent, 5.0) << seed;
    EXPECT_LE(std::abs(figures.final_error_counts), 1) << seed;
    const Axis& yaw = *neuro().find("yaw");
    EXPECT_LE(figures.overshoot_counts, yaw.deadband_counts + yaw.mechanics.coast_counts) << seed;
    EXPECT_TRUE(figures.settle_ms) << seed;
  }
}

TEST(StepResponse, EveryAxisOfBothRobotsArrivesWithinItsDeadband) {
  for (const Robot* robot : {&neuro(), &prostate()}) {
    for (const Axis& axis : robot->axes) {
      SCOPED_TRACE(axis.name);
      const auto step = run(*robot, {.axis = axis.name});
      ASSERT_TRUE(step) << step.error();
      const StepFigures figures = figures_of(*step);
      EXPECT_LE(std::abs(figures.final_error_counts), static_cast<std::int32_t>(axis.deadband_counts));
      EXPECT_LE(figures.overshoot_counts, axis.deadband_counts + axis.mechanics.coast_counts);
    }
  }
}

TEST(StepResponse, DriveStaysWithinItsBoundsAndEndsAtZero) {
  for (const std::int32_t move : {-600, -37, -8}) {
    const auto step = run(neuro(), {.axis = "yaw", .move_counts = move});
    ASSERT_TRUE(step) << step.error();
    for (const StepRow& row : step->rows) {
      EXPECT_LE(row.drive, neuro().find("yaw")->drive.max);
    }
    EXPECT_EQ(step->rows.back().drive, 0u);
  }
}

TEST(StepResponse, TheIntegralMakesUpForAWrongFullSpeed) {
  StepOptions wrong = thesis_move(1);
  wrong.cruise_counts_per_s = 600.0;
  for (const double full_speed : {750.0, 1300.0}) {
    wrong.full_speed_counts_per_s = full_speed;
    const auto step = run(neuro(), wrong);
    ASSERT_TRUE(step) << step.error();
    const StepFigures with = figures_of(*step);
    StepOptions open_loop = wrong;
    open_loop.gains = {.position_per_s = 0.0, .velocity = 0.0, .integral_per_s = 0.0};
    const auto without = run(neuro(), open_loop);
    ASSERT_TRUE(without) << without.error();
    EXPECT_LE(with.rms_velocity_error_percent, 0.5 * figures_of(*without).rms_velocity_error_percent);
    EXPECT_LE(std::abs(with.final_error_counts), 1);
  }
}

TEST(StepResponse, ALinkThatIsLateStillBringsTheAxisToItsTarget) {
  double before = 0.0;
  for (const std::uint32_t late_ticks : {2u, ILK_LINK_TICKS_AHEAD}) {
    StepOptions late = thesis_move(1);
    late.late_ticks = late_ticks;
    const auto step = run(neuro(), late);
    ASSERT_TRUE(step) << step.error();
    const StepFigures figures = figures_of(*step);
    EXPECT_LE(figures.rms_velocity_error_percent, 5.0) << late_ticks;
    EXPECT_GT(figures.rms_velocity_error_percent, before) << "it does come late";
    EXPECT_LE(std::abs(figures.final_error_counts), 1) << late_ticks;
    before = figures.rms_velocity_error_percent;
  }
}

TEST(StepResponse, RotationReachesItsSpeedByThePublishedMapAlone) {
  const AskedGains none{.position_per_s = 0.0, .velocity = 0.0, .integral_per_s = 0.0};
  for (const std::int32_t move : {4000, -4000}) {
    const auto step = run(
        prostate(), {.axis = "rotation", .move_counts = move, .cruise_counts_per_s = 2000.0, .gains = none});
    ASSERT_TRUE(step) << step.error();
    double fastest = 0.0;
    for (const StepRow& row : step->rows) {
      fastest = std::max(fastest, std::abs(row.true_velocity_counts_per_s));
    }
    // The feed-forward of the acceleration may go beyond for as long as the lead is too long.
    const StepRow& middle = step->rows[static_cast<std::size_t>(step->duration_s / 2 / step->period_s)];
    EXPECT_NEAR(std::abs(middle.true_velocity_counts_per_s), 2000.0, 2.0);
    EXPECT_LE(fastest, 1.05 * 2000.0);
  }
}

TEST(StepResponse, TheSameSeedGivesTheSameRun) {
  const auto one = run(neuro(), thesis_move(4));
  const auto two = run(neuro(), thesis_move(4));
  ASSERT_TRUE(one && two);
  ASSERT_EQ(one->rows.size(), two->rows.size());
  for (std::size_t n = 0; n < one->rows.size(); ++n) {
    ASSERT_EQ(one->rows[n].position_counts, two->rows[n].position_counts);
    ASSERT_EQ(one->rows[n].drive, two->rows[n].drive);
  }
}

TEST(StepResponse, WhatCannotBeRunIsRefusedByName) {
  EXPECT_EQ(run(neuro(), {.axis = "elbow"}).error(), "neuro has no axis \"elbow\"");
  EXPECT_THAT(run(neuro(), {.axis = "yaw", .move_counts = 600}).error(),
              testing::EndsWith("yaw reaches -1210 to -7"));
  EXPECT_THAT(run(neuro(), {.axis = "yaw", .cruise_counts_per_s = std::nan("")}).error(),
              testing::HasSubstr("cruise_velocity"));
  EXPECT_THAT(run(neuro(), {.axis = "yaw", .cruise_counts_per_s = 1e-3}).error(),
              testing::EndsWith("s; expected at most 600"));
  EXPECT_EQ(run(neuro(), {.axis = "yaw", .gains = {.position_per_s = -1.0}}).error(),
            "position gain is out of range");
}

TEST(StepResponse, AFaultOfTheAxisEndsTheRunAndSaysWhen) {
  plant::Parameters stuck = plant_of(neuro());
  stuck.axis[neuro().find("feet")->slot].dead_zone_fraction = 0.9;
  const auto faulted = run_step(neuro(), compile(neuro()).value(), stuck,
                                {.axis = "feet",
                                 .cruise_counts_per_s = 20.0,
                                 .gains = {.position_per_s = 0.0, .velocity = 0.0, .integral_per_s = 0.0}});
  ASSERT_FALSE(faulted);
  EXPECT_THAT(faulted.error(), testing::StartsWith("the axis faulted: STALL, "));
}

}  // namespace
}  // namespace interlock
