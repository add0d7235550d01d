#include <optional>

#include "chart/time_chart.hpp"
#include "tuning/step_run.hpp"

namespace interlock {
namespace {

constexpr const char* blue = "#0b62a4";
constexpr const char* red = "#d1495b";
constexpr const char* grey = "#9aa5b1";

template <typename Value>
ChartSeries series(const StepRun& run, const char* name, const char* colour, Value value) {
  ChartSeries made{name, colour, {}};
  made.values.reserve(run.rows.size());
  for (const StepRow& row : run.rows) {
    made.values.emplace_back(value(row));
  }
  return made;
}

}  // namespace

std::string step_svg(const StepRun& run, const std::string& title) {
  TimeChart chart{title, {}, {}};
  for (const StepRow& row : run.rows) {
    chart.times_s.push_back(row.time_s);
  }
  chart.panels = {
      {"position [counts]",
       {series(run, "measured", blue, [](const StepRow& row) { return row.position_counts; }),
        series(run, "setpoint", red, [](const StepRow& row) { return row.setpoint.position_counts; })}},
      {"velocity [counts/s]",
       {series(run, "estimated", grey,
               [](const StepRow& row) { return row.estimated_velocity_counts_per_s; }),
        series(run, "true", blue, [](const StepRow& row) { return row.true_velocity_counts_per_s; }),
        series(run, "setpoint", red, [](const StepRow& row) { return row.setpoint.velocity_counts_per_s; })}},
      {"control output [drive]", {series(run, "drive", blue, [](const StepRow& row) { return row.drive; })}}};
  return svg_of(chart);
}

}  // namespace interlock
