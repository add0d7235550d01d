/**
 * @file
 * Reads a robot file (models/robots/NAME.toml).
 *
 * The file is the one source of everything that is particular to a robot. Every key is required unless it is
 * said to be optional, and a key that is not known is refused, so that a slip of the pen cannot pass for a
 * default.
 */
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "robot/robot.hpp"
#include "robot/robot_error.hpp"

namespace interlock {

/**
 * Reads and checks a robot file: TOML, keys, types, names, slots, times.
 *
 * Whether the numbers are safe is the kernel's word; see `compile`.
 */
tl::expected<Robot, RobotError> load_robot(const std::filesystem::path& file);

/** As `load_robot`, from text; `file` names it in errors. */
tl::expected<Robot, RobotError> parse_robot(std::string_view text, std::string file);

}  // namespace interlock
