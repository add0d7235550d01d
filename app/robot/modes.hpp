/**
 * @file
 * The ways of moving a robot, by name.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace interlock {

/** What a robot may be asked to do. */
enum class RobotMode : std::uint8_t {
  manual,             /**< each axis to its own setpoint */
  home,               /**< the steps of homing */
  coordinated,        /**< several axes to their setpoints, arriving together */
  trajectory,         /**< along a loaded trajectory, in time */
  draping,            /**< to the setpoints in which the robot is draped */
  ablation,           /**< the probe through a list of angles and depths, with rest at each */
  cooperative_biopsy, /**< the needle, pushed by the surgeon's hand and turned towards its target */
  frequency_sweep     /**< a high-frequency axis through a list of frequencies */
};

namespace detail {

/** A mode as files and programs spell it. */
struct NamedMode {
  RobotMode mode;
  std::string_view name;
};

inline constexpr std::array<NamedMode, 8> named_modes{{{RobotMode::manual, "manual"},
                                                       {RobotMode::home, "home"},
                                                       {RobotMode::coordinated, "coordinated"},
                                                       {RobotMode::trajectory, "trajectory"},
                                                       {RobotMode::draping, "draping"},
                                                       {RobotMode::ablation, "ablation"},
                                                       {RobotMode::cooperative_biopsy, "cooperative_biopsy"},
                                                       {RobotMode::frequency_sweep, "frequency_sweep"}}};

}  // namespace detail

/** As files and the interface spell it. */
constexpr std::string_view mode_name(RobotMode mode) noexcept {
  return detail::named_modes[static_cast<std::size_t>(mode)].name;
}

/** The mode of that name. */
constexpr std::optional<RobotMode> mode_of(std::string_view name) noexcept {
  for (const detail::NamedMode& each : detail::named_modes) {
    if (each.name == name) {
      return each.mode;
    }
  }
  return std::nullopt;
}

/** Whether its axes move together, so that each of them needs rates. */
constexpr bool moves_along_paths(RobotMode mode) noexcept {
  return mode > RobotMode::home && mode != RobotMode::frequency_sweep;
}

/** All names, for messages. */
inline std::string mode_names() {
  std::string names;
  for (const detail::NamedMode& each : detail::named_modes) {
    names += (names.empty() ? "" : ", ") + std::string(each.name);
  }
  return names;
}

}  // namespace interlock
