#include "system/utc_time.hpp"

#include <array>
#include <cstdio>
#include <ctime>

namespace interlock {
namespace {

// Whole years that a count of nanoseconds in 64 bits holds.
constexpr int first_year = 1678;
constexpr int last_year = 2261;

}  // namespace

std::string iso_8601(UtcTime time) {
  const auto since_epoch = std::chrono::floor<std::chrono::milliseconds>(time.time_since_epoch());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since_epoch);
  const std::time_t calendar = seconds.count();
  std::tm utc{};
  ::gmtime_r(&calendar, &utc);
  std::array<char, 32> date{};
  std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  std::array<char, 8> fraction{};
  std::snprintf(fraction.data(), fraction.size(), ".%03dZ",
                static_cast<int>((since_epoch - seconds).count()));
  return std::string(date.data()) + fraction.data();
}

std::optional<UtcTime> parse_iso_8601(std::string_view text) {
  std::tm utc{};
  int milliseconds = 0;
  const std::string terminated(text);
  if (std::sscanf(terminated.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d.%3dZ", &utc.tm_year, &utc.tm_mon, &utc.tm_mday,
                  &utc.tm_hour, &utc.tm_min, &utc.tm_sec, &milliseconds) != 7 ||
      utc.tm_year < first_year || utc.tm_year > last_year) {
    return std::nullopt;
  }
  utc.tm_year -= 1900;
  utc.tm_mon -= 1;
  const UtcTime time =
      std::chrono::system_clock::from_time_t(::timegm(&utc)) + std::chrono::milliseconds(milliseconds);
  // Impossible dates, signs, spaces and missing digits are read all the same, but not written like that.
  return iso_8601(time) == text ? std::optional(time) : std::nullopt;
}

}  // namespace interlock
