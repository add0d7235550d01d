#include "robot/compile.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <optional>
#include <system_error>

#include "interlock/kernel.h"
#include "robot/catalog.hpp"

namespace interlock {
namespace {

constexpr std::size_t config_words = sizeof(ilk_config_t) / sizeof(std::uint32_t);
using ConfigWords = std::array<std::uint32_t, config_words>;

ilk_axis_config_t compile_axis(const Axis& axis) {
  const Homing homing = axis.homing.value_or(Homing{});
  ilk_axis_config_t out{};
  out.card = axis.card;
  out.required = axis.required ? 1 : 0;
  out.motor_direction = axis.motor_direction;
  out.direction_correction = axis.direction_correction;
  out.limit_side = axis.limit;
  out.min_counts = axis.soft_limits.min_counts;
  out.max_counts = axis.soft_limits.max_counts;
  out.home_offset_counts = axis.home_offset_counts;
  out.coast_counts = axis.mechanics.coast_counts;
  out.backlash_counts = axis.mechanics.backlash_counts;
  out.noise_counts = axis.mechanics.noise_counts;
  out.deadband_counts = axis.deadband_counts;
  out.max_drive = axis.drive.max;
  out.unhomed_max_drive = axis.drive.unhomed_max;
  out.max_amplitude = axis.drive.max_amplitude;
  out.unhomed_travel_counts = axis.unhomed_travel_counts;
  out.home_drive = homing.drive;
  out.home_amplitude = homing.amplitude;
  out.home_travel_counts = homing.travel_counts;
  out.home_backoff_counts = homing.backoff_counts;
  out.home_timeout_ticks = homing.timeout_ticks;
  out.home_rest_ticks = homing.rest_ticks;
  out.home_speed_counts_per_s = homing.speed_counts_per_s;
  out.stall_ticks = axis.stall.driven_ticks;
  out.stall_min_counts = axis.stall.min_counts;
  out.reverse_counts = axis.runaway.reverse_counts;
  out.drift_counts = axis.runaway.drift_counts;
  out.settle_ticks = axis.mechanics.settle_ticks;
  out.max_delta_counts = axis.mechanics.max_delta_counts;
  return out;
}

/** Where in the file a rule of the kernel is kept, inside of the axis' table when it is about an axis, and
 * how. */
struct Rule {
  ilk_config_error_t error;
  std::string_view key;
  std::string_view expected;
};

/** Rules that a robot can break; all others are kept by how it is read and compiled. */
constexpr std::array rules{
    Rule{ILK_CONFIG_ERROR_PERIOD, "period_us", "125 to 2000 us"},
    Rule{ILK_CONFIG_ERROR_PEDAL_CHANNELS, "pedal.channels", "1 or 2"},
    Rule{ILK_CONFIG_ERROR_APP_TIMEOUT, "loop.app_timeout_ms", "1 to 150 ms"},
    Rule{ILK_CONFIG_ERROR_LEASE, "loop.lease_max_ms", "1 to 150 ms"},
    Rule{ILK_CONFIG_ERROR_PEDAL_DEBOUNCE, "pedal.debounce_ms", "1 to 50 ms"},
    Rule{ILK_CONFIG_ERROR_PEDAL_DISAGREE, "pedal.disagree_ms", "1 to 50 ms"},
    Rule{ILK_CONFIG_ERROR_BAD_FRAMES, "loop.bad_frame_limit", "1 to 5"},
    Rule{ILK_CONFIG_ERROR_OVERRUNS, "loop.overrun_limit", "1 to 10"},
    Rule{ILK_CONFIG_ERROR_NO_AXIS, "axis", "at least one axis"},
    Rule{ILK_CONFIG_ERROR_CARD, "card", "a type of card that drives a motor"},
    Rule{ILK_CONFIG_ERROR_FLAG, "motor_direction", "0 or 1, as for direction_correction"},
    Rule{ILK_CONFIG_ERROR_LIMIT_SIDE, "limit", "none, lower or upper"},
    Rule{ILK_CONFIG_ERROR_SOFT_LIMITS, "soft_limits", "min_counts below max_counts, both within +-2^30"},
    Rule{ILK_CONFIG_ERROR_HOME_OFFSET, "home_offset_counts",
         "a position from soft_limits.min_counts to max_counts"},
    Rule{ILK_CONFIG_ERROR_COAST, "mechanics.coast_counts", "at least 1, and less than half of the range"},
    Rule{ILK_CONFIG_ERROR_DEADBAND, "deadband_counts", "at least 1, and less than half of the range"},
    Rule{ILK_CONFIG_ERROR_MAX_DRIVE, "drive.max",
         "1 to the largest drive of the card: 2147483647 (pwm, analog-input), 1073741823 (non-pwm), 397785 "
         "(high-frequency)"},
    Rule{ILK_CONFIG_ERROR_UNHOMED_DRIVE, "drive.unhomed_max", "1 to a tenth of drive.max"},
    Rule{ILK_CONFIG_ERROR_AMPLITUDE, "drive.max_amplitude", "1 to 255, and not less than homing.amplitude"},
    Rule{ILK_CONFIG_ERROR_UNHOMED_TRAVEL, "unhomed_travel_counts",
         "more than mechanics.coast_counts, at most a tenth of the range"},
    Rule{ILK_CONFIG_ERROR_HOME_DRIVE, "homing.drive", "1 to drive.unhomed_max"},
    Rule{ILK_CONFIG_ERROR_HOME_TRAVEL, "homing.travel_counts",
         "the range and mechanics.coast_counts at least, twice the range at most"},
    Rule{ILK_CONFIG_ERROR_HOME_BACKOFF, "homing.backoff_counts", "1 to a tenth of the range"},
    Rule{ILK_CONFIG_ERROR_HOME_REST, "homing.rest_ms", "1 ms to homing.timeout_ms"},
    Rule{ILK_CONFIG_ERROR_HOME_TIMEOUT, "homing.timeout_ms",
         "time for back-off, travel and rest at homing.speed_counts_per_s, at most 600000 ms"},
    Rule{ILK_CONFIG_ERROR_STALL, "stall",
         "driven_ms from 1 to 500; min_counts above mechanics.noise_counts, at most a tenth of the range"},
    Rule{ILK_CONFIG_ERROR_REVERSE, "runaway.reverse_counts",
         "the sum of coast, backlash and noise at least, a tenth of the range at most"},
    Rule{ILK_CONFIG_ERROR_DRIFT, "runaway.drift_counts",
         "the sum of coast, backlash and noise at least, a tenth of the range at most"},
    Rule{ILK_CONFIG_ERROR_SETTLE, "mechanics.settle_ms", "1 to 1000 ms"},
    Rule{ILK_CONFIG_ERROR_MAX_DELTA, "mechanics.max_delta_counts", "1 to half of the range"},
};

RobotError error_at(const Origin& origin, std::string key, std::string problem, std::string expected) {
  const auto line = origin.line_of_key.find(key);
  return {origin.file, line == origin.line_of_key.end() ? 0 : line->second, std::move(key),
          std::move(problem), std::move(expected)};
}

RobotError rule_broken(const Robot& robot, ilk_config_verdict_t verdict) {
  const catalog::Entry& entry = catalog::entry(catalog::Family::config_error, verdict.error);
  const auto found = std::ranges::find(rules, verdict.error, &Rule::error);
  const Rule rule = found == rules.end() ? Rule{} : *found;
  const Axis* const axis = robot.at_slot(verdict.slot);
  const std::string table = axis ? "axis." + axis->name + '.' : "";
  const std::string_view meaning = entry.meaning.substr(0, entry.meaning.find_last_not_of('.') + 1);
  return error_at(robot.origin, table + std::string(rule.key), std::string(meaning),
                  std::string(rule.expected) + " (the kernel's rule " + std::string(entry.name) + ')');
}

/** The first card in a slot that does not exist, or of a type that nobody can drive. */
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

/** The first step of homing whose travel leaves the range of its axis; the kernel knows nothing of steps. */
std::optional<RobotError> step_out_of_range(const Robot& robot) {
  const auto outside = [&robot](const HomeStep& step, std::string_view kind, const AxisCounts& travel,
                                std::int64_t lowest, std::int64_t highest) -> std::optional<RobotError> {
    if (lowest <= travel.counts && travel.counts <= highest) {
      return std::nullopt;
    }
    return error_at(
        robot.origin,
        "home_step." + step.name + '.' + std::string(kind) + '.' + robot.at_slot(travel.slot)->name,
        std::to_string(travel.counts) + " counts lead out of the range of the axis",
        "counts from " + std::to_string(lowest) + " to " + std::to_string(highest));
  };
  for (const HomeStep& step : robot.home_steps) {
    for (const AxisCounts& nudge : step.nudge) {
      const SoftLimits& limits = robot.at_slot(nudge.slot)->soft_limits;
      const std::int64_t range = std::int64_t{limits.max_counts} - limits.min_counts;
      if (auto error = outside(step, "nudge", nudge, -range, range)) {
        return error;
      }
    }
    for (const AxisCounts& move : step.move) {
      const Axis& axis = *robot.at_slot(move.slot);
      if (auto error =
              outside(step, "move", move, axis.lowest_setpoint_counts(), axis.highest_setpoint_counts())) {
        return error;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

tl::expected<ilk_config_t, RobotError> compile(const Robot& robot) {
  ilk_config_t config{};
  config.version = ILK_CONFIG_VERSION;
  config.size_bytes = sizeof(ilk_config_t);
  config.period_us = robot.period_us;
  config.pedal_channels = robot.pedal.channels;
  config.app_timeout_ticks = robot.loop.app_timeout_ticks;
  config.lease_max_ticks = robot.loop.lease_max_ticks;
  config.pedal_debounce_ticks = robot.pedal.debounce_ticks;
  config.pedal_disagree_ticks = robot.pedal.disagree_ticks;
  config.bad_frame_limit = robot.loop.bad_frame_limit;
  config.overrun_limit = robot.loop.overrun_limit;
  if (auto error = card_out_of_place(robot)) {
    return tl::unexpected(std::move(*error));
  }
  for (const Axis& axis : robot.axes) {
    config.axis[axis.slot] = compile_axis(axis);
  }
  for (const Sensor& sensor : robot.sensors) {
    config.axis[sensor.slot].card = ILK_CARD_SENSOR;
    config.axis[sensor.slot].required = sensor.required ? 1 : 0;
  }
  config.crc = ilk_config_crc(&config);

  const ilk_config_verdict_t verdict = ilk_config_validate(&config);
  if (verdict.error != ILK_CONFIG_ERROR_NONE) {
    return tl::unexpected(rule_broken(robot, verdict));
  }
  if (auto error = step_out_of_range(robot)) {
    return tl::unexpected(std::move(*error));
  }
  return config;
}

ConfigBytes encode(const ilk_config_t& config) {
  ConfigBytes bytes{};
  std::size_t at = 0;
  for (const std::uint32_t word : std::bit_cast<ConfigWords>(config)) {
    for (int shift = 0; shift < 32; shift += 8) {
      bytes[at++] = static_cast<std::uint8_t>(word >> shift);
    }
  }
  return bytes;
}

ilk_config_t decode(const ConfigBytes& bytes) {
  ConfigWords words{};
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    words[at / 4] |= std::uint32_t{bytes[at]} << (8 * (at % 4));
  }
  return std::bit_cast<ilk_config_t>(words);
}

std::string config_hash(const ilk_config_t& config) {
  std::array<char, 9> digits{};
  std::snprintf(digits.data(), digits.size(), "%08x", config.crc);
  return digits.data();
}

tl::expected<void, std::string> write_config(const ilk_config_t& config, const std::filesystem::path& file) {
  const ConfigBytes bytes = encode(config);
  std::filesystem::path beside = file;
  beside += ".new";
  {
    std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize{bytes.size()});
    stream.close();
    if (!stream) {
      return tl::unexpected(beside.string() +
                            " cannot be written: " + std::generic_category().message(errno));
    }
  }
  std::error_code error;
  std::filesystem::rename(beside, file, error);
  if (error) {
    std::filesystem::remove(beside, error);
    return tl::unexpected(file.string() + " cannot be written: " + error.message());
  }
  return {};
}

}  // namespace interlock
