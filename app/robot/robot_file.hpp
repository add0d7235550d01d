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
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "kinematics/family.hpp"
#include "robot/robot.hpp"
#include "robot/robot_error.hpp"

namespace interlock {

/** A number or a point in place of what the file says in [kinematics] or [probe]. */
struct RobotSetting {
  std::string key;
  std::vector<double> numbers;
};

/**
 * Reads and checks a robot file: TOML, keys, types, names, slots, times.
 *
 * Whether the numbers are safe is the kernel's word; see `compile`.
 */
tl::expected<Robot, RobotError> load_robot(const std::filesystem::path& file,
                                           std::span<const RobotSetting> settings = {});

/** As `load_robot`, from text; `file` names it in errors, and `families` are those that it may name. */
tl::expected<Robot, RobotError> parse_robot(
    std::string_view text, std::string file,
    std::span<const KinematicsFamily> families = kinematics_families(),
    std::span<const RobotSetting> settings = {});

}  // namespace interlock
