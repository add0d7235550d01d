/** @file The robot file that the tests read, and ways to break it. */
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "robot/robot_file.hpp"

namespace interlock::test {

inline const std::string neuro_file = INTERLOCK_ROBOTS "/neuro.toml";

inline std::string neuro_text() {
  std::ostringstream text;
  text << std::ifstream(neuro_file).rdbuf();
  return text.str();
}

/** The neuro robot's file with the first occurrence of `from` replaced. */
inline std::string neuro_with(std::string_view from, std::string_view to) {
  std::string text = neuro_text();
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    throw std::invalid_argument("neuro.toml has no \"" + std::string(from) + '"');
  }
  return text.replace(at, from.size(), to);
}

/** Line of the first occurrence of `what`, from 1. */
inline std::uint32_t line_of(std::string_view text, std::string_view what) {
  const std::string_view before = text.substr(0, text.find(what));
  std::uint32_t line = 1;
  for (const char letter : before) {
    line += letter == '\n' ? 1 : 0;
  }
  return line;
}

inline Robot neuro() { return load_robot(neuro_file).value(); }

}  // namespace interlock::test
