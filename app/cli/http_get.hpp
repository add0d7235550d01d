/**
 * @file
 * One HTTP request to an app on this machine.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "cli/exit_code.hpp"

namespace interlock::cli {

struct HttpAnswer {
  unsigned status;
  std::string body;
};

/** GET http://127.0.0.1:port/target. Connecting, asking and reading together take at most `timeout`. */
Result<HttpAnswer> http_get(std::uint16_t port, const std::string& target, std::chrono::seconds timeout);

}  // namespace interlock::cli
