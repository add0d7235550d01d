/**
 * @file
 * What is wrong with a robot, and where.
 */
#pragma once

#include <cstdint>
#include <string>

namespace interlock {

/** The first thing wrong with a robot file. Empty `key`: the file as a whole. Line 0: no particular line. */
struct RobotError {
  std::string file;
  std::uint32_t line = 0;
  std::string key;      /**< dotted path: "axis.yaw.drive.max" */
  std::string problem;  /**< what was found */
  std::string expected; /**< what belongs there instead */

  /** One line for people: "neuro.toml:41: axis.yaw.drive.max: -3 is out of range; expected ...". */
  [[nodiscard]] std::string message() const;

  bool operator==(const RobotError&) const = default;
};

}  // namespace interlock
