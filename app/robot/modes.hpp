/**
 * @file
 * The ways of moving a robot, by name.
 *
 * Which there are, the folders below app/modes say, each in its `modes.txt`; the build collects them.
 */
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace interlock {

/** What a robot may be asked to do. The name is as files and the interface spell it, and stays valid. */
struct RobotMode {
  std::string_view name;

  /** Each axis to its own setpoint. */
  static const RobotMode manual;
  /** The steps of homing. */
  static const RobotMode home;
  /** Several axes to their setpoints, arriving together. */
  static const RobotMode coordinated;

  /** Whether it moves the robot as a whole: neither axis by axis nor to its home. */
  [[nodiscard]] constexpr bool moves_the_whole() const noexcept { return *this != manual && *this != home; }

  constexpr bool operator==(const RobotMode&) const = default;
};

inline constexpr RobotMode RobotMode::manual{"manual"};
inline constexpr RobotMode RobotMode::home{"home"};
inline constexpr RobotMode RobotMode::coordinated{"coordinated"};

/** A mode that the app has. */
struct KnownMode {
  RobotMode mode;
  bool needs_rates = false; /**< its axes move together, so that each of them needs rates */
};

/** All of them. */
std::span<const KnownMode> known_modes();

/** The mode of that name, where there is one. */
std::optional<KnownMode> mode_of(std::string_view name);

/** All names, for messages. */
std::string mode_names();

}  // namespace interlock
