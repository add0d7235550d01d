#include "system/utc_time.hpp"

#include <gtest/gtest.h>

namespace interlock {
namespace {

using std::chrono::milliseconds;

TEST(UtcTime, HasMillisecondsAndZone) {
  EXPECT_EQ(iso_8601(UtcTime(milliseconds(1714566896789))), "2024-05-01T12:34:56.789Z");
}

TEST(UtcTime, CutsFractionsOfAMillisecond) {
  EXPECT_EQ(iso_8601(UtcTime(std::chrono::microseconds(999))), "1970-01-01T00:00:00.000Z");
}

TEST(UtcTime, HoldsBeforeTheEpoch) {
  EXPECT_EQ(iso_8601(UtcTime(milliseconds(-1))), "1969-12-31T23:59:59.999Z");
}

TEST(UtcTime, ReadsWhatItWrites) {
  for (const std::int64_t time : {0LL, 1714566896789LL, -1LL, 7258118399999LL}) {
    EXPECT_EQ(parse_iso_8601(iso_8601(UtcTime(milliseconds(time)))), UtcTime(milliseconds(time)));
  }
}

TEST(UtcTime, ReadsNothingElse) {
  for (const char* const text :
       {"", "2024-05-01", "2024-05-01T12:34:56Z", "2024-05-01T12:34:56.789", "2024-05-01T12:34:56.789Z ",
        "2024-05-01 12:34:56.789Z", "2024-02-30T12:34:56.789Z", "2024-05-01T24:00:00.000Z",
        "+024-05-01T12:34:56.789Z", "2024-05-01T12:34:56.7Z", "9999-12-31T23:59:59.999Z"}) {
    EXPECT_EQ(parse_iso_8601(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace interlock
