#include "robot/robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interlock/kernel.h"
#include "robot/compile.hpp"

namespace interlock {
namespace {

using CountLimits = std::numeric_limits<std::int32_t>;

std::int32_t saturated(std::int64_t counts) {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(counts, CountLimits::min(), CountLimits::max()));
}

/** The part whose member has that value, or null. */
template <typename Part, typename Value, typename Member>
const Part* find_in(const std::vector<Part>& parts, const Value& value, Member Part::* member) {
  const auto found = std::ranges::find(parts, value, member);
  return found == parts.end() ? nullptr : &*found;
}

/** As the kernel computes it for the axis, homed at its switch if it has one. */
ilk_reach_t reach_of(const Axis& axis) {
  const ilk_axis_config_t rules = compile_axis(axis);
  ilk_axis_t homed{};
  homed.homed = axis.limit == ILK_LIMIT_NONE ? ILK_HOMED_BY_HAND : ILK_HOMED_BY_SWITCH;
  return ilk_reach(&rules, &homed);
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

bool Axis::reaches(double position) const {
  const std::optional<std::int32_t> counts = to_counts(position);
  return counts && *counts >= soft_limits.min_counts && *counts <= soft_limits.max_counts;
}

std::int32_t Axis::lowest_setpoint_counts() const { return saturated(reach_of(*this).low); }

std::int32_t Axis::highest_setpoint_counts() const { return saturated(reach_of(*this).high); }

std::optional<std::int32_t> Axis::take_up_counts(std::int32_t counts) const {
  const std::int64_t play = mechanics.tool_play_counts.value_or(0);
  // It may rest anywhere within its deadband, at both places.
  const std::int64_t below = counts - play - 2 * static_cast<std::int64_t>(deadband_counts) - 1;
  if (play == 0 || below < lowest_setpoint_counts()) {
    return std::nullopt;
  }
  return static_cast<std::int32_t>(below);
}

bool Axis::accepts_setpoint(std::int32_t counts) const {
  return lowest_setpoint_counts() <= counts && counts <= highest_setpoint_counts();
}

double SensorChannel::value(std::uint32_t reading) const {
  const auto at = [this](std::uint32_t counts) { return slope * counts + intercept; };
  return at(reading) - at(reference);
}

const Axis* Robot::find(std::string_view axis_name) const { return find_in(axes, axis_name, &Axis::name); }

const Axis* Robot::at_slot(std::uint32_t slot) const { return find_in(axes, slot, &Axis::slot); }

const Axis* Robot::with_role(std::string_view role) const {
  return role.empty() ? nullptr : find_in(axes, role, &Axis::role);
}

const Sensor* Robot::find_sensor(std::string_view sensor_name) const {
  return find_in(sensors, sensor_name, &Sensor::name);
}

const Sensor* Robot::sensor_at_slot(std::uint32_t slot) const {
  return find_in(sensors, slot, &Sensor::slot);
}

const HomeStep* Robot::find_home_step(std::string_view step_name) const {
  return find_in(home_steps, step_name, &HomeStep::name);
}

bool Robot::has_mode(std::string_view mode) const { return std::ranges::find(modes, mode) != modes.end(); }

}  // namespace interlock
