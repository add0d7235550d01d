/**
 * @file
 * Numbers of a robot file in its text: what is measured on a robot comes into its file without a change of
 * anything else, comments included.
 */
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "robot/robot_error.hpp"

namespace interlock {

/** A number of a robot's file. */
struct AxisNumber {
  std::string key; /**< dotted, from the axis on: "drive.dead_zone"; without an axis, from the file on:
                      "kinematics.home_rcm_mm[2]" */
  double value = 0.0;
  std::string after = {}; /**< key of the same table behind which a number that is not there yet is written,
                             as that one is: dotted, on a line of its own or within a table of one line;
                             empty: it must be there */
};

/**
 * The text with these numbers of that axis, or of the whole file when `axis` is empty. Where the text has a
 * whole number, the new one is written without a fraction.
 *
 * @param file names the text in the error, which is about a text that is no TOML, an axis that it does not
 * have, or a key that has no number there.
 */
tl::expected<std::string, RobotError> with_numbers(std::string_view text, std::string file,
                                                   std::string_view axis,
                                                   std::span<const AxisNumber> numbers);

}  // namespace interlock
