/**
 * @file
 * Messages of OpenIGTLink as words of a command line, and as lines.
 */
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "igtl/message.hpp"

namespace interlock::cli {

/** The message that "transform", "string", "point", "status" or "get" and its values mean. */
Result<igtl::Body> igtl_body(const std::string& type, const std::vector<std::string>& values);

/** `{"name", "type", ...}` with what the type holds; other types have their name alone. */
nlohmann::json igtl_json(const igtl::Message& message);

/** One line: name, type and content. */
std::string igtl_line(const igtl::Message& message);

}  // namespace interlock::cli
