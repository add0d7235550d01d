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
  bool judge = false;         /**< have the monitors judge each tick */
  bool console = false;       /**< show it in the console, until a signal */
  ReplayShow show;            /**< how */
};

/**
 * Says "identical", or names the first bit that comes out differently; if asked, names the first tick that
 * breaks a property, or says by how many monitors how many ticks were judged; then, if asked, shows in the
 * console what is identical.
 *
 * @return REFUSED for a difference, a broken property, a damaged file, or one of another release; PRECONDITION when a file cannot
 * be read or written.
 */
Result<void> replay(const ReplayOptions& options, std::ostream& output);

}  // namespace interlock::cli
