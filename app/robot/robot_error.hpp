/**
 * @file
 * What is wrong with a robot, and where.
 */
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace interlock {

/** The first thing wrong with a robot file. Empty `key`: the file as a whole. Line 0: no particular line. */
struct RobotError {
  std::string file;
  std::uint32_t line = 0;
  std::string key;         /**< dotted path: "axis.yaw.drive.max" */
  std::string problem;     /**< what was found */
  std::string expected;    /**< what belongs there instead */
  bool is_missing = false; /**< there is no file of that name, or it may not be read */

  /** One line for people: "neuro.toml:41: axis.yaw.drive.max: -3 is out of range; expected ...". */
  [[nodiscard]] std::string message() const;

  bool operator==(const RobotError&) const = default;
};

/** Where a key stands, and what is given there, as people read it: "7 is given". */
struct KeyPlace {
  std::uint32_t line = 0;
  std::string given = "nothing is given";

  bool operator==(const KeyPlace&) const = default;
};

/** Where the robot was written down, so that later findings can name the place. */
struct Origin {
  std::string file;
  std::map<std::string, KeyPlace, std::less<>> keys; /**< by dotted path: "axis.yaw.drive.max" */

  /** Of a key that was left out, the line of its table. */
  [[nodiscard]] KeyPlace place_of(std::string_view key) const;

  bool operator==(const Origin&) const = default;
};

}  // namespace interlock
