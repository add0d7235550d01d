#include "motion_record.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "chart/time_chart.hpp"

namespace interlock {
namespace {

constexpr const char* measured_colour = "#0b62a4";
constexpr const char* desired_colour = "#d1495b";

/** A sample in the unit of its axis. */
struct UnitSample {
  double position;
  double velocity;
  std::optional<double> desired_position;
  std::optional<double> desired_velocity;
  std::optional<double> error_counts;
};

UnitSample in_units(const AxisSample& sample, double counts_per_unit) {
  UnitSample converted{sample.position_counts / counts_per_unit,
                       sample.velocity_counts_per_s / counts_per_unit, std::nullopt, std::nullopt,
                       std::nullopt};
  if (sample.setpoint) {
    converted.desired_position = sample.setpoint->position_counts / counts_per_unit;
    converted.desired_velocity = sample.setpoint->velocity_counts_per_s / counts_per_unit;
    converted.error_counts = sample.setpoint->position_counts - sample.position_counts;
  }
  return converted;
}

std::string number(double value) {
  std::array<char, 32> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string number_or_nothing(const std::optional<double>& value) {
  return value ? number(*value) : std::string();
}

}  // namespace

bool MotionRecord::moved(std::size_t axis) const {
  return std::ranges::any_of(axes[axis],
                             [](const AxisSample& sample) { return sample.setpoint.has_value(); });
}

std::string motion_csv(const MotionRecord& record, std::size_t axis, const Axis& described) {
  std::string text = "time_s,position,setpoint,velocity,setpoint_velocity,error_counts,drive\n";
  for (std::size_t row = 0; row < record.times_s.size(); ++row) {
    const AxisSample& sample = record.axes[axis][row];
    const UnitSample shown = in_units(sample, described.counts_per_unit);
    text += number(record.times_s[row]) + ',' + number(shown.position) + ',' +
            number_or_nothing(shown.desired_position) + ',' + number(shown.velocity) + ',' +
            number_or_nothing(shown.desired_velocity) + ',' + number_or_nothing(shown.error_counts) + ',' +
            std::to_string(sample.drive) + '\n';
  }
  return text;
}

std::string motion_svg(const MotionRecord& record, std::size_t axis, const Axis& described,
                       const std::string& title) {
  const std::string unit(unit_name(described.unit));
  ChartSeries position{"measured", measured_colour, {}};
  ChartSeries desired_position{"setpoint", desired_colour, {}};
  ChartSeries velocity{"true", measured_colour, {}};
  ChartSeries desired_velocity{"setpoint", desired_colour, {}};
  ChartSeries error{"setpoint - measured", measured_colour, {}};
  for (const AxisSample& sample : record.axes[axis]) {
    const UnitSample shown = in_units(sample, described.counts_per_unit);
    position.values.emplace_back(shown.position);
    desired_position.values.push_back(shown.desired_position);
    velocity.values.emplace_back(shown.velocity);
    desired_velocity.values.push_back(shown.desired_velocity);
    error.values.push_back(shown.error_counts);
  }
  return svg_of({title,
                 record.times_s,
                 {{"position [" + unit + "]", {std::move(position), std::move(desired_position)}},
                  {"velocity [" + unit + "/s]", {std::move(velocity), std::move(desired_velocity)}},
                  {"error [counts]", {std::move(error)}}}});
}

}  // namespace interlock
