/**
 * @file
 * `interlock status`: the system at a glance.
 */
#pragma once

#include <cstdint>
#include <ostream>
#include <string>

#include "cli/exit_code.hpp"

namespace interlock::cli {

struct StatusOptions {
  std::uint16_t port = 8080;
  bool json = false; /**< the app's answer as it came */
};

/** Asks the app on this machine and writes a table for people, or JSON, to `output`. */
Result<void> show_status(const StatusOptions& options, std::ostream& output);

/** The table of a `Status` of spec/openapi.yaml. */
Result<std::string> status_table(const std::string& body);

}  // namespace interlock::cli
