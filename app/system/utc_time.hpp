/**
 * @file
 * Times of day as the interfaces show them and the store keeps them.
 */
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace interlock {

using UtcTime = std::chrono::system_clock::time_point;

/** ISO 8601 in UTC with milliseconds: "2024-05-01T12:34:56.789Z". */
std::string iso_8601(UtcTime time);

/** The time that `iso_8601` wrote; nothing for any other text, or a year beyond 1678 to 2261. */
std::optional<UtcTime> parse_iso_8601(std::string_view text);

}  // namespace interlock
