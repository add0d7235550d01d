#include "robot/compile.hpp"

#include <bit>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "interlock/kernel.h"
#include "robot/robot_rules.hpp"

namespace interlock {
namespace {

constexpr std::size_t config_words = sizeof(ilk_config_t) / sizeof(std::uint32_t);
using ConfigWords = std::array<std::uint32_t, config_words>;

}  // namespace

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
  out.dead_zone_drive = axis.drive.dead_zone;
  out.max_drive = axis.drive.max;
  out.unhomed_max_drive = axis.drive.unhomed_max;
  out.max_amplitude = axis.drive.max_amplitude;
  out.unhomed_travel_counts = axis.unhomed_travel_counts;
  out.home_drive = homing.drive;
  out.home_amplitude = homing.amplitude;
  out.home_travel_counts = homing.travel_counts;
  out.home_slow_drive = homing.slow_drive;
  out.home_clear_counts = homing.clear_counts;
  out.home_tolerance_counts = homing.tolerance_counts;
  out.switch_hysteresis_counts = homing.hysteresis_counts;
  out.home_timeout_ticks = homing.timeout_ticks;
  out.home_slow_speed_counts_per_s = homing.slow_speed_counts_per_s;
  out.home_speed_counts_per_s = homing.speed_counts_per_s;
  out.stall_ticks = axis.stall.driven_ticks;
  out.stall_effort_ticks = axis.stall.effort_ticks;
  out.stall_min_counts = axis.stall.min_counts;
  out.reverse_counts = axis.runaway.reverse_counts;
  out.drift_counts = axis.runaway.drift_counts;
  out.rest_ticks = axis.mechanics.rest_ticks;
  out.full_speed_counts_per_s = axis.mechanics.full_speed_counts_per_s;
  out.max_delta_counts = axis.mechanics.max_delta_counts;
  return out;
}

tl::expected<ilk_config_t, RobotError> compile(const Robot& robot) {
  ilk_config_t config{};
  config.common.version = ILK_CONFIG_VERSION;
  config.common.size_bytes = sizeof(ilk_config_t);
  config.common.period_us = robot.period_us;
  config.common.pedal_channels = robot.pedal.channels;
  config.common.app_timeout_ticks = robot.loop.app_timeout_ticks;
  config.common.lease_max_ticks = robot.loop.lease_max_ticks;
  config.common.pedal_debounce_ticks = robot.pedal.debounce_ticks;
  config.common.pedal_disagree_ticks = robot.pedal.disagree_ticks;
  config.common.power_up_ticks = robot.loop.power_up_ticks;
  config.common.switch_debounce_ticks = robot.loop.switch_debounce_ticks;
  config.common.bad_frame_limit = robot.loop.bad_frame_limit;
  config.common.overrun_limit = robot.loop.overrun_limit;
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
    return tl::unexpected(kernel_rule_broken(robot, verdict));
  }
  if (auto error = app_rule_broken(robot)) {
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
  std::error_code error;
  {
    std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize{bytes.size()});
    stream.close();
    if (!stream) {
      const std::string reason = std::generic_category().message(errno);
      std::filesystem::remove(beside, error);
      return tl::unexpected(beside.string() + " cannot be written: " + reason);
    }
  }
  std::filesystem::rename(beside, file, error);
  if (error) {
    std::filesystem::remove(beside, error);
    return tl::unexpected(file.string() + " cannot be written: " + error.message());
  }
  return {};
}

}  // namespace interlock
