#include "proposals/utc_time.hpp"

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

}  // namespace
}  // namespace interlock
