/**
 * @file
 * Ports for the app to listen on.
 */
#pragma once

#include <cstdint>

#include "cli/exit_code.hpp"

namespace interlock::cli {

/** The port of 127.0.0.1 if it can be listened on, a free one for 0. It is free again afterwards, for the
 * app. */
Result<std::uint16_t> free_port(std::uint16_t port);

}  // namespace interlock::cli
