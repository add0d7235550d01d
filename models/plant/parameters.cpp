#include "plant/parameters.hpp"

#include <algorithm>
#include <cmath>

namespace interlock::plant {
namespace {

constexpr double kMicrosecondsPerMs = 1000;

/** A knob of a member that the file has in the same unit. */
template <double AxisParameters::* Member>
constexpr AxisKnob knob(std::string_view name, Range range) {
  return {name, range, false, [](const AxisParameters& axis) { return axis.*Member; },
          [](AxisParameters& axis, double value) { axis.*Member = value; }};
}

}  // namespace

const std::array<AxisKnob, kAxisKnobCount> kAxisKnobs{{
    knob<&AxisParameters::dead_zone_fraction>("dead_zone_fraction", {0, 0.9}),
    knob<&AxisParameters::full_speed_counts_per_s>("full_speed_counts_per_s", {1, 1e6}),
    {"lag_ms",
     {0.1, 1000},
     false,
     [](const AxisParameters& axis) { return static_cast<double>(axis.lag.count()) / kMicrosecondsPerMs; },
     [](AxisParameters& axis, double value) {
       axis.lag = Microseconds(static_cast<std::uint64_t>(std::llround(value * kMicrosecondsPerMs)));
     }},
    knob<&AxisParameters::backlash_counts>("backlash_counts", {0, 1000}),
    knob<&AxisParameters::tool_play_counts>("tool_play_counts", {0, 1000}),
    knob<&AxisParameters::load_fraction>("load_fraction", {-0.9, 0.9}),
    knob<&AxisParameters::heat_droop_fraction>("heat_droop_fraction", {0, 0.9}),
    knob<&AxisParameters::heat_time_s>("heat_time_s", {0.1, 1e5}),
    knob<&AxisParameters::resonance_hz>("resonance_hz", {-5000, 5000}),
    knob<&AxisParameters::resonance_drift_hz>("resonance_drift_hz", {0, 5000}),
    {"noise_counts",
     {0, 100},
     true,
     [](const AxisParameters& axis) { return static_cast<double>(axis.noise_counts); },
     [](AxisParameters& axis, double value) { axis.noise_counts = static_cast<std::uint32_t>(value); }},
    knob<&AxisParameters::noise_chance>("noise_chance", {0, 1}),
}};

double coast_counts(const AxisParameters& axis) {
  return axis.full_speed_counts_per_s * static_cast<double>(axis.lag.count()) * 1e-6;
}

double position_from_switch(const ilk_axis_config_t& axis, double counts) {
  return axis.home_offset_counts + (axis.limit_side == ILK_LIMIT_UPPER ? -counts : counts);
}

Parameters default_parameters(const ilk_config_t& robot) {
  Parameters parameters;
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    const ilk_axis_config_t& axis = robot.axis[slot];
    parameters.sensor[slot].name = "sensor " + std::to_string(slot);
    if (!drives_motor(axis.card)) {
      continue;
    }
    const double lower = axis.min_counts;
    const double upper = axis.max_counts;
    parameters.axis[slot].name = "axis " + std::to_string(slot);
    parameters.axis[slot].start_counts =
        axis.limit_side == ILK_LIMIT_NONE ? std::clamp(0.0, lower, upper)
                                          : position_from_switch(axis, std::min(300.0, (upper - lower) / 3));
  }
  return parameters;
}

}  // namespace interlock::plant
