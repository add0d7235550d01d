/**
 * @file
 * `interlock tune`: a step of one axis on the simulated hardware, as figures, table and plot. docs/tuning.md
 * describes command and figures.
 */
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/installation.hpp"
#include "tuning/step_run.hpp"

namespace interlock::cli {

struct TuneOptions {
  std::string robot; /**< name of a robot, or its file */
  StepOptions step;
  std::filesystem::path plant; /**< parameters of the simulated hardware; empty: those of the robot */
  std::filesystem::path csv;   /**< where the table goes; empty: nowhere */
  std::filesystem::path svg;   /**< where the plot goes; empty: nowhere */
};

/**
 * Writes table and plot, then answers with one line of JSON.
 *
 * @return REFUSED for an axis, a move or gains that the robot cannot follow, and when a fault ended the motion;
 * PRECONDITION when a file cannot be read or written.
 */
Result<void> tune(const TuneOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
