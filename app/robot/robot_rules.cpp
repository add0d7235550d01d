#include "robot/robot_rules.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "kinematics/kinematics.hpp"
#include "robot/catalog.hpp"
#include "robot/table_reader.hpp"

namespace interlock {
namespace {

/** Where in the file a rule of the kernel is kept, inside of the axis' table when it is about an axis, and
 * how. */
struct Rule {
  ilk_config_error_t error;
  std::string_view key;
  std::string_view expected;
  bool (*breaks)(const Axis& axis) = nullptr; /**< tells places of one rule apart; the last has none */
};

bool homes_at_no_speed(const Axis& axis) {
  return axis.homing && (axis.homing->slow_speed_counts_per_s == 0 ||
                         axis.homing->slow_speed_counts_per_s > axis.homing->speed_counts_per_s);
}

bool has_much_backlash(const Axis& axis) {
  const std::int64_t range = std::int64_t{axis.soft_limits.max_counts} - axis.soft_limits.min_counts;
  return axis.mechanics.backlash_counts > range / 10;
}

bool has_wide_dead_zone(const Axis& axis) { return axis.drive.dead_zone > axis.drive.max / 5; }

/** Rules that a robot can break; all others are kept by how it is read and compiled. */
constexpr std::array rules{
    Rule{ILK_CONFIG_ERROR_PERIOD, "period_us", "125 to 2000 us"},
    Rule{ILK_CONFIG_ERROR_PEDAL_CHANNELS, "pedal.channels", "1 or 2"},
    Rule{ILK_CONFIG_ERROR_APP_TIMEOUT, "loop.app_timeout_ms", "two ticks to 150 ms"},
    Rule{ILK_CONFIG_ERROR_LEASE, "loop.lease_max_ms", "two ticks to 150 ms"},
    Rule{ILK_CONFIG_ERROR_POWER_UP, "loop.power_up_ms", "1 to 5000 ms"},
    Rule{ILK_CONFIG_ERROR_SWITCH_DEBOUNCE, "loop.switch_debounce_ms", "two ticks to 20 ms"},
    Rule{ILK_CONFIG_ERROR_PEDAL_DEBOUNCE, "pedal.debounce_ms", "1 to 50 ms"},
    Rule{ILK_CONFIG_ERROR_PEDAL_DISAGREE, "pedal.disagree_ms", "1 to 50 ms"},
    Rule{ILK_CONFIG_ERROR_BAD_FRAMES, "loop.bad_frame_limit", "1 to 5"},
    Rule{ILK_CONFIG_ERROR_OVERRUNS, "loop.overrun_limit", "1 to 10"},
    Rule{ILK_CONFIG_ERROR_NO_AXIS, "axis", "at least one axis"},
    Rule{ILK_CONFIG_ERROR_CARD, "card", "a type of card that drives a motor"},
    Rule{ILK_CONFIG_ERROR_FLAG, "motor_direction", "0 or 1, as for direction_correction"},
    Rule{ILK_CONFIG_ERROR_LIMIT_SIDE, "limit", "none, lower or upper"},
    Rule{ILK_CONFIG_ERROR_SOFT_LIMITS, "soft_limits", "min_counts below max_counts"},
    Rule{ILK_CONFIG_ERROR_HOME_OFFSET, "home_offset_counts",
         "a position from soft_limits.min_counts to max_counts; from a switch, farther from the other limit "
         "than homing.tolerance_counts, homing.hysteresis_counts, coast and deadband together"},
    Rule{ILK_CONFIG_ERROR_COAST, "mechanics.coast_counts",
         "what the axis travels in two ticks at mechanics.full_speed_counts_per_s at least, and less than "
         "half of the range"},
    Rule{ILK_CONFIG_ERROR_NOISE, "mechanics.backlash_counts", "a tenth of the range at most",
         has_much_backlash},
    Rule{ILK_CONFIG_ERROR_NOISE, "mechanics.noise_counts", "a tenth of the range at most"},
    Rule{ILK_CONFIG_ERROR_DEADBAND, "deadband_counts", "at least 1, and less than half of the range"},
    Rule{ILK_CONFIG_ERROR_MAX_DRIVE, "drive.max",
         "1 to the largest drive of the card: 2147483647 (pwm, analog-input), 1073741823 (non-pwm), 397785 "
         "(high-frequency)"},
    Rule{ILK_CONFIG_ERROR_UNHOMED_DRIVE, "drive.dead_zone", "at most a fifth of drive.max",
         has_wide_dead_zone},
    Rule{ILK_CONFIG_ERROR_UNHOMED_DRIVE, "drive.unhomed_max",
         "more than drive.dead_zone, at most a tenth of the way from there to drive.max"},
    Rule{ILK_CONFIG_ERROR_AMPLITUDE, "drive.max_amplitude", "1 to 255, and not less than homing.amplitude"},
    Rule{ILK_CONFIG_ERROR_UNHOMED_TRAVEL, "unhomed_travel_counts",
         "more than mechanics.coast_counts, at most a tenth of the range"},
    Rule{ILK_CONFIG_ERROR_SPEED, "homing.slow_speed_counts_per_s", "1 to homing.speed_counts_per_s",
         homes_at_no_speed},
    Rule{ILK_CONFIG_ERROR_SPEED, "mechanics.full_speed_counts_per_s",
         "homing.speed_counts_per_s to 100000000, and not 0"},
    Rule{ILK_CONFIG_ERROR_HOME_DRIVE, "homing.drive", "more than drive.dead_zone, at most drive.unhomed_max"},
    Rule{ILK_CONFIG_ERROR_HOME_SLOW, "homing.slow_drive", "more than drive.dead_zone, at most homing.drive"},
    Rule{ILK_CONFIG_ERROR_HOME_TRAVEL, "homing.travel_counts",
         "the range, and twice a back-off and the way back, with coast, at least; four times the range at "
         "most"},
    Rule{ILK_CONFIG_ERROR_HOME_CLEAR, "homing.clear_counts",
         "more than the sum of homing.tolerance_counts, homing.hysteresis_counts and mechanics.coast_counts, "
         "more than that of stall.min_counts, backlash and noise, and at most a tenth of the range"},
    Rule{ILK_CONFIG_ERROR_HOME_TOLERANCE, "homing.tolerance_counts",
         "what homing travels in loop.switch_debounce_ms and two ticks, and twice the noise, at least; a "
         "tenth of the range at most"},
    Rule{ILK_CONFIG_ERROR_HYSTERESIS, "homing.hysteresis_counts", "a tenth of the range at most"},
    Rule{ILK_CONFIG_ERROR_HOME_TIMEOUT, "homing.timeout_ms",
         "time for the way of homing at homing.speed_counts_per_s, for the second approach at "
         "homing.slow_speed_counts_per_s and for rest, at most 600000 ms"},
    Rule{ILK_CONFIG_ERROR_REST, "mechanics.rest_ms",
         "more than two ticks, loop.switch_debounce_ms at least, 1000 ms at most"},
    Rule{ILK_CONFIG_ERROR_STALL, "stall",
         "driven_ms of at most 500 ms, in which the slowest drive makes min_counts, backlash and noise three "
         "ticks before its end, and full speed five times the coast beside them; min_counts above "
         "mechanics.noise_counts, at most a tenth of the range"},
    Rule{ILK_CONFIG_ERROR_STALL_EFFORT, "stall.effort_ms",
         "time for five times the coast, backlash and noise at full speed, at most 200 ms; left out when the "
         "axis is too slow for that"},
    Rule{ILK_CONFIG_ERROR_REVERSE, "runaway.reverse_counts",
         "the sum of coast, backlash and noise at least, a tenth of the range at most"},
    Rule{ILK_CONFIG_ERROR_DRIFT, "runaway.drift_counts",
         "the sum of coast, backlash and noise at least, a tenth of the range at most"},
    Rule{ILK_CONFIG_ERROR_MAX_DELTA, "mechanics.max_delta_counts",
         "what the axis travels in a tick at full speed and the noise at least, half of the range at most"},
};

RobotError error_at(const Origin& origin, std::string key, std::string problem, std::string expected) {
  const std::uint32_t line = origin.place_of(key).line;
  return {origin.file, line, std::move(key), std::move(problem), std::move(expected)};
}

RobotError travel_refused(const Robot& robot, const std::string& path, const AxisCounts& travel,
                          std::int64_t lowest, std::int64_t highest) {
  return error_at(robot.origin, path + robot.at_slot(travel.slot)->name,
                  std::to_string(travel.counts) + " counts lead out of the range of the axis",
                  "counts from " + std::to_string(lowest) + " to " + std::to_string(highest));
}

/** The first setpoint that the kernel would not accept from the homed axis. */
std::optional<RobotError> setpoint_out_of_range(const Robot& robot, const std::string& path,
                                                const std::vector<AxisCounts>& setpoints) {
  for (const AxisCounts& setpoint : setpoints) {
    const Axis& axis = *robot.at_slot(setpoint.slot);
    if (!axis.accepts_setpoint(setpoint.counts)) {
      return travel_refused(robot, path, setpoint, axis.lowest_setpoint_counts(),
                            axis.highest_setpoint_counts());
    }
  }
  return std::nullopt;
}

/** The first axis that goes where its joint means nothing, or cannot go where its joint does. */
std::optional<RobotError> joint_out_of_range(const Robot& robot) {
  for (const Joint& joint : robot.kinematics ? robot.kinematics->joints() : std::span<const Joint>()) {
    const Axis& axis = *robot.with_role(joint.role);
    const std::string unit(unit_name(axis.unit));
    const std::string soft_limits = "axis." + axis.name + ".soft_limits";
    const double lowest = axis.to_unit(axis.soft_limits.min_counts);
    const double highest = axis.to_unit(axis.soft_limits.max_counts);
    const std::string range = text_of(lowest) + " to " + text_of(highest) + ' ' + unit;
    if (lowest < -joint.limit || highest > joint.limit) {
      return error_at(robot.origin, soft_limits, "they lead from " + range,
                      "positions within " + text_of(joint.limit) + ' ' + unit + ", for which " +
                          robot.family + " has poses");
    }
    if (joint.given_limits &&
        !(axis.reaches(joint.given_limits->first) && axis.reaches(joint.given_limits->second))) {
      return error_at(robot.origin, "kinematics.joint." + std::string(joint.role) + ".limits_" + unit,
                      text_of(joint.given_limits->first) + " to " + text_of(joint.given_limits->second) +
                          " is given, beyond the axis' soft limits",
                      "limits within " + range);
    }
  }
  return std::nullopt;
}

/** The skin, when the needle does not reach it. */
std::optional<RobotError> entry_out_of_reach(const Robot& robot) {
  const Axis* const insertion = robot.biopsy ? robot.with_role("insertion") : nullptr;
  if (insertion != nullptr && !insertion->reaches(robot.biopsy->entry_mm)) {
    return error_at(robot.origin, "biopsy.entry_mm",
                    text_of(robot.biopsy->entry_mm) + " is given, which the needle does not reach",
                    "an insertion within the soft limits of \"" + insertion->name + '"');
  }
  return std::nullopt;
}

/** The first distance from a path that an axis has at rest, by its deadband and noise, or never has. */
std::optional<RobotError> following_error_without_effect(const Robot& robot) {
  for (const Axis& axis : robot.axes) {
    const std::int64_t least = std::int64_t{axis.deadband_counts} + axis.mechanics.noise_counts;
    const std::int64_t range = std::int64_t{axis.soft_limits.max_counts} - axis.soft_limits.min_counts;
    const std::int64_t given = axis.motion ? axis.motion->following_error_counts : range;
    if (given <= least || given > range) {
      return error_at(robot.origin, "axis." + axis.name + ".motion.following_error_counts",
                      std::to_string(given) + " is given, which an axis has at rest or never",
                      "more than deadband_counts and mechanics.noise_counts together (" +
                          std::to_string(least) + "), at most the range (" + std::to_string(range) + ')');
    }
  }
  return std::nullopt;
}

/** The first travel of homing, or setpoint of draping, that leaves the range of its axis. */
std::optional<RobotError> step_out_of_range(const Robot& robot) {
  for (const HomeStep& step : robot.home_steps) {
    for (const AxisCounts& nudge : step.nudge) {
      const SoftLimits& limits = robot.at_slot(nudge.slot)->soft_limits;
      const std::int64_t range = std::int64_t{limits.max_counts} - limits.min_counts;
      if (nudge.counts < -range || nudge.counts > range) {
        return travel_refused(robot, "home_step." + step.name + ".nudge.", nudge, -range, range);
      }
    }
    if (auto error = setpoint_out_of_range(robot, "home_step." + step.name + ".move.", step.move)) {
      return error;
    }
  }
  return setpoint_out_of_range(robot, "draping.", robot.draping);
}

}  // namespace

RobotError kernel_rule_broken(const Robot& robot, ilk_config_verdict_t verdict) {
  const catalog::Entry& entry = catalog::entry(catalog::Family::config_error, verdict.error);
  const Axis* const axis = robot.at_slot(verdict.slot);
  const auto found = std::ranges::find_if(rules, [&](const Rule& rule) {
    return rule.error == verdict.error && (rule.breaks == nullptr || (axis != nullptr && rule.breaks(*axis)));
  });
  const Rule rule = found == rules.end() ? Rule{} : *found;
  const std::string key = (axis ? "axis." + axis->name + '.' : "") + std::string(rule.key);
  const std::string_view meaning = entry.meaning.substr(0, entry.meaning.find_last_not_of('.') + 1);
  return error_at(robot.origin, key, robot.origin.place_of(key).given + ": " + std::string(meaning),
                  std::string(rule.expected) + " (the kernel's rule " + std::string(entry.name) + ')');
}

std::optional<RobotError> card_out_of_place(const Robot& robot) {
  const auto beyond = [&robot](const std::string& path, std::uint32_t slot) -> std::optional<RobotError> {
    if (slot < ILK_SLOTS) {
      return std::nullopt;
    }
    return error_at(robot.origin, path + ".slot", "there is no slot " + std::to_string(slot),
                    "a slot below " + std::to_string(ILK_SLOTS));
  };
  for (const Axis& axis : robot.axes) {
    if (auto error = beyond("axis." + axis.name, axis.slot)) {
      return error;
    }
    if (axis.card == ILK_CARD_NONE) {
      return error_at(robot.origin, "axis." + axis.name + ".card",
                      "the kernel cannot drive a card of unspecified type",
                      "the type of the card: \"pwm\", \"non-pwm\", \"analog-input\" or \"high-frequency\"");
    }
  }
  for (const Sensor& sensor : robot.sensors) {
    if (auto error = beyond("sensor." + sensor.name, sensor.slot)) {
      return error;
    }
  }
  return std::nullopt;
}

std::optional<RobotError> app_rule_broken(const Robot& robot) {
  for (const auto rule :
       {joint_out_of_range, entry_out_of_reach, following_error_without_effect, step_out_of_range}) {
    if (auto error = rule(robot)) {
      return error;
    }
  }
  return std::nullopt;
}

}  // namespace interlock
