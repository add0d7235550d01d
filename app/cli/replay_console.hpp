/**
 * @file
 * `interlock replay --console`: a recording in the console, in the kernel's place.
 */
#pragma once

#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>

#include "cli/exit_code.hpp"
#include "interlock/types.h"

namespace interlock::cli {

/** How a recording is shown. */
struct ReplayShow {
  std::string robot;         /**< name or file; empty: the one that compiles to the recorded configuration */
  std::uint16_t port = 8080; /**< 0: one that is free */
  double speed = 1.0;        /**< multiple of the recorded pace */
};

/**
 * Starts player and app, and runs until a signal or a failure. Both keep what they write in a private
 * directory, which is gone afterwards: the robot's own store, logs and audit trail learn nothing of it.
 *
 * @param config the recorded one
 * @return PRECONDITION when no robot file, or not the named one, compiles to `config`, or the port is busy.
 */
Result<void> show_in_console(const ReplayShow& show, const std::filesystem::path& recording,
                             const ilk_config_t& config, std::ostream& output);

}  // namespace interlock::cli
