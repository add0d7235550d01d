/**
 * @file
 * Passwords from people and from scripts.
 */
#pragma once

#include <string>

#include "cli/exit_code.hpp"
#include "store/password.hpp"

namespace interlock::cli {

/** Asks at the terminal, without echo, twice. Refused: no terminal, two different answers, interrupted. */
Result<Password> ask_for_new_password(const std::string& user);

/** The first line of the standard input. */
Result<Password> read_password();

}  // namespace interlock::cli
