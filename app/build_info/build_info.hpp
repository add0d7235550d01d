/**
 * @file
 * Which Interlock this is.
 */
#pragma once

#include <string_view>

namespace interlock {

/** Version of the project, such as "0.1.0". */
std::string_view version();

/** Commit from which this was built, "-dirty" appended for changed files; "unknown" outside of a git tree. */
std::string_view commit();

}  // namespace interlock
