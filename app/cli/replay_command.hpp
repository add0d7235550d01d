/**
 * @file
 * `interlock replay`: runs the kernel core again on a recording.
 */
#pragma once

#include <filesystem>
#include <ostream>

#include "cli/exit_code.hpp"
#include "cli/replay_console.hpp"

namespace interlock::cli {

struct ReplayOptions {
  std::filesystem::path file;
  std::filesystem::path csv;  /**< a row a tick; empty: none */
  std::filesystem::path plot; /**< positions, drives and mode as SVG; empty: none */
  bool model = false;         /**< ask the TLA+ model whether it accepts the run, too */
  bool console = false;       /**< show it in the console, until a signal */
  ReplayShow show;            /**< how */
};

/**
 * Says "identical", or names the first bit that comes out differently; then, if asked, what the model says,
 * and shows in the console what is identical.
 *
 * @return REFUSED for a difference, a tick that the model rejects, a damaged file, or one of another release;
 * PRECONDITION when a file cannot be read or written, or the model's checker is not there.
 */
Result<void> replay(const ReplayOptions& options, std::ostream& output);

}  // namespace interlock::cli
