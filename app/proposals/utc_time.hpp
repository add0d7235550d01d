/**
 * @file
 * Times of day as the interfaces show them.
 */
#pragma once

#include <chrono>
#include <string>

namespace interlock {

using UtcTime = std::chrono::system_clock::time_point;

/** ISO 8601 in UTC with milliseconds: "2024-05-01T12:34:56.789Z". */
std::string iso_8601(UtcTime time);

}  // namespace interlock
