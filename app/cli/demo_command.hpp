/**
 * @file
 * `interlock demo`: the thesis' targeting workflow on the simulated hardware, unattended. docs/demo.md tells
 * what it shows.
 */
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/installation.hpp"
#include "demo/targeting_demo.hpp"

namespace interlock::cli {

struct DemoCommandOptions {
  std::string robot; /**< name of a robot, or its file */
  DemoOptions demo;
  std::filesystem::path csv;  /**< where the trials go; empty: nowhere */
  std::filesystem::path plot; /**< folder for the motions of the first round; empty: none */
  bool json = false;          /**< answer for programs */
};

/**
 * Runs the demonstration and tells each target's desired and reached position and error beside the thesis'.
 *
 * @return REFUSED when the robot cannot be simulated or its motion ended; PRECONDITION when a file cannot be read or
 * written.
 */
Result<void> demo(const DemoCommandOptions& options, const Installation& installation, std::ostream& output,
                  std::ostream& progress);

}  // namespace interlock::cli
