/**
 * @file
 * Files that a command reads and leaves behind.
 */
#pragma once

#include <filesystem>
#include <string>

#include "cli/exit_code.hpp"

namespace interlock::cli {

/** Writes the text; nothing when `file` is empty. PRECONDITION when it cannot be written. */
Result<void> write_file(const std::filesystem::path& file, const std::string& text);

/** Writes the text of a robot's file, unless `model check` would refuse it; nothing when `file` is empty. */
Result<void> write_robot_file(const std::filesystem::path& file, const std::string& text);

/** What a file holds. PRECONDITION when it cannot be read or is larger than 64 MiB; `what` it should be. */
Result<std::string> text_of_file(const std::filesystem::path& file, const std::string& what);

/** Whether both names, neither of them empty, lead to one file. */
bool is_same_file(const std::filesystem::path& one, const std::filesystem::path& other);

}  // namespace interlock::cli
