#include "robot/robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace interlock {
namespace {

using CountLimits = std::numeric_limits<std::int32_t>;

std::int32_t saturated(std::int64_t counts) {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(counts, CountLimits::min(), CountLimits::max()));
}

}  // namespace

std::string_view unit_name(Unit unit) {
  switch (unit) {
    case Unit::mm:
      return "mm";
    case Unit::rad:
      return "rad";
  }
  return "unknown";
}

std::string_view motor_name(Motor motor) {
  switch (motor) {
    case Motor::unspecified:
      return "unspecified";
    case Motor::shinsei:
      return "shinsei";
    case Motor::piezo:
      return "piezo";
    case Motor::dti:
      return "dti";
  }
  return "unknown";
}

double Axis::to_unit(std::int32_t counts) const { return counts / counts_per_unit; }

std::optional<std::int32_t> Axis::to_counts(double position) const {
  const double counts = std::round(position * counts_per_unit);
  if (!(counts >= CountLimits::min() && counts <= CountLimits::max())) {
    return std::nullopt;
  }
  return static_cast<std::int32_t>(counts);
}

std::int32_t Axis::lowest_setpoint_counts() const {
  return saturated(std::int64_t{soft_limits.min_counts} + mechanics.coast_counts);
}

std::int32_t Axis::highest_setpoint_counts() const {
  return saturated(std::int64_t{soft_limits.max_counts} - mechanics.coast_counts);
}

const Axis* Robot::find(std::string_view axis_name) const {
  const auto found = std::ranges::find(axes, axis_name, &Axis::name);
  return found == axes.end() ? nullptr : &*found;
}

const Axis* Robot::at_slot(std::uint32_t slot) const {
  const auto found = std::ranges::find(axes, slot, &Axis::slot);
  return found == axes.end() ? nullptr : &*found;
}

}  // namespace interlock
