#include <gtest/gtest.h>

#include "tuning/step_run.hpp"

namespace interlock {
namespace {

/** A run of ten ticks, two of them after the profile, whose axis does exactly what it should. */
StepRun perfect() {
  StepRun run{.axis = "yaw",
              .from_counts = 0,
              .target_counts = -8,
              .deadband_counts = 1,
              .max_drive = 100,
              .period_s = 0.001,
              .peak_counts_per_s = 1000.0,
              .duration_s = 0.0075,
              .rows = {}};
  for (int n = 0; n < 10; ++n) {
    StepRow row;
    row.time_s = n * run.period_s;
    row.position_counts = std::max(-n, -8);
    row.true_position_counts = row.position_counts;
    row.setpoint = {static_cast<double>(row.position_counts), n < 8 ? -1000.0 : 0.0, 0.0};
    row.true_velocity_counts_per_s = row.setpoint.velocity_counts_per_s;
    run.rows.push_back(row);
  }
  return run;
}

TEST(StepFigures, OfAPerfectRunAreZero) {
  const StepFigures figures = figures_of(perfect());
  EXPECT_EQ(figures.rms_velocity_error_percent, 0.0);
  EXPECT_EQ(figures.largest_position_error_counts, 0.0);
  EXPECT_EQ(figures.final_error_counts, 0);
  EXPECT_EQ(figures.overshoot_counts, 0.0);
  EXPECT_EQ(figures.settle_ms, 0.0);
}

TEST(StepFigures, CountTheTrueVelocityOverTheProfileAlone) {
  StepRun run = perfect();
  for (std::size_t n = 0; n < 8; ++n) {
    run.rows[n].true_velocity_counts_per_s += n % 2 == 0 ? 30.0 : -30.0;
  }
  run.rows[9].true_velocity_counts_per_s = 500.0;
  EXPECT_NEAR(figures_of(run).rms_velocity_error_percent, 3.0, 1e-12);
}

TEST(StepFigures, MeasureOvershootInTheDirectionOfTheMove) {
  StepRun run = perfect();
  run.rows[8].true_position_counts = -10.5;
  run.rows[2].true_position_counts = 3.0;
  const StepFigures figures = figures_of(run);
  EXPECT_EQ(figures.overshoot_counts, 2.5);
  EXPECT_EQ(figures.largest_position_error_counts, 5.0);
}

TEST(StepFigures, SettleWhenEveryLaterCountIsWithinTheDeadband) {
  StepRun run = perfect();
  run.rows[8].true_position_counts = -9.5;
  run.rows[9].true_position_counts = -8.5;
  EXPECT_NEAR(figures_of(run).settle_ms.value(), 9.0 - 7.5, 1e-9);
  run.rows[9].true_position_counts = -9.5;
  run.rows[9].position_counts = -10;
  const StepFigures never = figures_of(run);
  EXPECT_FALSE(never.settle_ms);
  EXPECT_EQ(never.final_error_counts, -2);
}

}  // namespace
}  // namespace interlock
