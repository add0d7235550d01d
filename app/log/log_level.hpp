/**
 * @file
 * How much a line of the log matters.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace interlock {

enum class LogLevel : std::uint8_t { debug, info, warning, error, critical };

/** As the interface spells them, in the order of `LogLevel`. */
constexpr std::array<std::string_view, 5> log_level_names{"debug", "info", "warning", "error", "critical"};

/** As options and lines spell it. */
constexpr std::string_view name_of(LogLevel level) noexcept {
  return log_level_names[static_cast<std::size_t>(level)];
}

/** The level of that name; nothing when there is none. */
constexpr std::optional<LogLevel> log_level(std::string_view name) noexcept {
  for (std::size_t i = 0; i < log_level_names.size(); ++i) {
    if (log_level_names[i] == name) {
      return static_cast<LogLevel>(i);
    }
  }
  return std::nullopt;
}

}  // namespace interlock
