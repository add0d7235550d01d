/**
 * @file
 * The robot that a command line names.
 */
#pragma once

#include <span>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/installation.hpp"
#include "robot/robot_file.hpp"

namespace interlock::cli {

/** Reads a robot by its name or its file. PRECONDITION when there is none, REFUSED when its file is not
 * sound. */
Result<Robot> named_robot(const std::string& robot, const Installation& installation,
                          std::span<const RobotSetting> settings = {});

}  // namespace interlock::cli
