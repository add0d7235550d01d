#include <gmock/gmock.h>

#include <algorithm>

#include "tuning/step_run.hpp"

namespace interlock {
namespace {

StepRun short_run(std::size_t rows) {
  StepRun run{.axis = "yaw",
              .from_counts = 0,
              .target_counts = -600,
              .deadband_counts = 1,
              .max_drive = 100,
              .period_s = 0.001,
              .peak_counts_per_s = 1000.0,
              .duration_s = 1.0,
              .rows = {}};
  for (std::size_t n = 0; n < rows; ++n) {
    StepRow row;
    row.time_s = static_cast<double>(n) * run.period_s;
    row.position_counts = -static_cast<std::int32_t>(n);
    row.setpoint = {-1.5 * static_cast<double>(n) - 1, -1500.25, 0.0};
    row.true_velocity_counts_per_s = -1499.5;
    row.drive = 42;
    if (n > 0) {
      row.estimated_velocity_counts_per_s = -1498.0;
    }
    run.rows.push_back(row);
  }
  return run;
}

TEST(StepCsv, HasAHeaderAndARowForEachTick) {
  EXPECT_EQ(
      step_csv(short_run(2)),
      "time_s,position_counts,setpoint_counts,velocity_counts_per_s,setpoint_velocity_counts_per_s,drive,"
      "estimated_velocity_counts_per_s\n"
      "0.000000,0,-1.000,-1499.500,-1500.250,42,\n"
      "0.001000,-1,-2.500,-1499.500,-1500.250,42,-1498.000\n");
}

TEST(StepSvg, ShowsThreePanelsWithTheirUnits) {
  const std::string svg = step_svg(short_run(100), "Yaw");
  for (const char* const label :
       {"position [counts]", "velocity [counts/s]", "control output [drive]", "time [s]", "estimated"}) {
    EXPECT_THAT(svg, testing::HasSubstr(label));
  }
  EXPECT_THAT(svg, testing::Not(testing::HasSubstr("nan")));
  EXPECT_THAT(svg, testing::Not(testing::HasSubstr("inf")));
}

TEST(StepSvg, TakesAnyTitleAsText) {
  EXPECT_THAT(step_svg(short_run(2), "a<b> & c"), testing::HasSubstr(">a&lt;b&gt; &amp; c<"));
}

TEST(StepSvg, DrawsNoMorePointsThanASheetCanShow) {
  const std::string svg = step_svg(short_run(100'000), "long");
  EXPECT_LT(svg.size(), 200'000u);
}

TEST(StepSvg, AnAxisThatNeverMovesHasAPicture) {
  StepRun still = short_run(1);
  still.rows[0] = StepRow{};
  const std::string svg = step_svg(still, "still");
  EXPECT_THAT(svg, testing::Not(testing::HasSubstr("nan")));
  EXPECT_EQ(std::count(svg.begin(), svg.end(), '<'), std::count(svg.begin(), svg.end(), '>'));
}

}  // namespace
}  // namespace interlock
