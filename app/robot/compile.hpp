/**
 * @file
 * Turns a robot into the kernel's binary configuration, and back from its bytes.
 */
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "interlock/types.h"
#include "robot/robot.hpp"
#include "robot/robot_error.hpp"

namespace interlock {

/** Bytes of a compiled configuration file (`*.ilkc`): the words of `ilk_config_t`, least significant byte
 * first. */
using ConfigBytes = std::array<std::uint8_t, sizeof(ilk_config_t)>;

/**
 * The kernel's configuration of this robot, sealed with its CRC-32. Equal robots give equal bits.
 *
 * The kernel's own `ilk_config_validate` judges it; the error is the text of the rule that it breaks, at the
 * axis.
 */
tl::expected<ilk_config_t, RobotError> compile(const Robot& robot);

/** What the kernel is told of one axis. */
ilk_axis_config_t compile_axis(const Axis& axis);

/** The configuration as it stands in a file. */
ConfigBytes encode(const ilk_config_t& config);

/** The configuration that stands in a file. Whether it is valid is `ilk_config_validate`'s word. */
ilk_config_t decode(const ConfigBytes& bytes);

/** Eight hex digits of the configuration's CRC-32, by which people tell configurations apart. */
std::string config_hash(const ilk_config_t& config);

/**
 * Writes the configuration to a file, whole or not at all: beside it first, then renamed over it.
 *
 * The error says what the system refused.
 */
tl::expected<void, std::string> write_config(const ilk_config_t& config, const std::filesystem::path& file);

}  // namespace interlock
