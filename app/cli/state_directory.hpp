/**
 * @file
 * Where a robot keeps its state.
 */
#pragma once

#include <filesystem>
#include <string>

#include "cli/exit_code.hpp"

namespace interlock::cli {

/** `given` if it is not empty, else the robot's directory under $XDG_STATE_HOME/interlock. */
Result<std::filesystem::path> state_directory(const std::filesystem::path& given,
                                              const std::string& robot_name);

}  // namespace interlock::cli
