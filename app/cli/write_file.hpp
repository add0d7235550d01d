/**
 * @file
 * Files that a command leaves behind.
 */
#pragma once

#include <filesystem>
#include <string>

#include "cli/exit_code.hpp"

namespace interlock::cli {

/** Writes the text; nothing when `file` is empty. PRECONDITION when it cannot be written. */
Result<void> write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace interlock::cli
