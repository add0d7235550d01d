/**
 * @file
 * `interlock model check` and `interlock model compile`.
 */
#pragma once

#include <filesystem>
#include <ostream>

#include "cli/exit_code.hpp"
#include "interlock/types.h"
#include "robot/robot.hpp"

namespace interlock::cli {

/** A robot and the configuration that the kernel accepted. */
struct CompiledRobot {
  Robot robot;
  ilk_config_t config;
};

/** Reads and compiles a robot file. */
Result<CompiledRobot> load_and_compile(const std::filesystem::path& file);

/** Says whether the robot file is sound, and what the robot consists of; `json`: in one JSON object. */
Result<void> check_model(const std::filesystem::path& file, bool json, std::ostream& output);

/** Writes the configuration to `config_file`, by default NAME.ilkc in the working directory. */
Result<void> compile_model(const std::filesystem::path& file, const std::filesystem::path& config_file,
                           std::ostream& output);

/** Writes the configuration to a file. */
Result<void> save_config(const ilk_config_t& config, const std::filesystem::path& file);

}  // namespace interlock::cli
