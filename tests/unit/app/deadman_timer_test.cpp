#include "motion/deadman_timer.hpp"

#include <gtest/gtest.h>

namespace interlock {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

constexpr std::chrono::steady_clock::time_point held_since{};
constexpr std::uint32_t start_tick = UINT32_MAX - 100;

Moment by_the_wall(milliseconds passed) { return {held_since + passed, start_tick + 1'000'000, 0}; }

Moment simulated(std::uint32_t ticks, milliseconds passed) {
  return {held_since + passed, start_tick + ticks, 1000};
}

TEST(DeadmanTimer, IsNeverOverdueUnlessHeld) {
  DeadmanTimer lease(milliseconds(500));
  EXPECT_FALSE(lease.overdue(by_the_wall(hours(1))));
  lease.hold(by_the_wall(milliseconds(0)));
  lease.release();
  EXPECT_FALSE(lease.overdue(by_the_wall(hours(1))));
}

TEST(DeadmanTimer, IsOverdueAfterItsPatienceByTheWallsTime) {
  DeadmanTimer lease(milliseconds(500));
  lease.hold(by_the_wall(milliseconds(0)));
  EXPECT_FALSE(lease.overdue(by_the_wall(milliseconds(499))));
  EXPECT_TRUE(lease.overdue(by_the_wall(milliseconds(500))));
}

TEST(DeadmanTimer, CountsTicksInTheSimulatedClockAndAcrossTheirWrap) {
  DeadmanTimer lease(milliseconds(500));
  lease.hold(simulated(0, milliseconds(0)));
  EXPECT_FALSE(lease.overdue(simulated(499, hours(1))));
  EXPECT_TRUE(lease.overdue(simulated(500, milliseconds(0))));
}

TEST(DeadmanTimer, RenewalStartsThePatienceAnew) {
  DeadmanTimer lease(milliseconds(500));
  lease.hold(by_the_wall(milliseconds(0)));
  lease.hold(by_the_wall(milliseconds(400)));
  EXPECT_FALSE(lease.overdue(by_the_wall(milliseconds(800))));
}

TEST(DeadmanTimer, GoesByTheWallsTimeOnceTheSimulatedClockIsLost) {
  DeadmanTimer lease(milliseconds(500));
  lease.hold(simulated(0, milliseconds(0)));
  EXPECT_TRUE(lease.overdue(by_the_wall(milliseconds(500))));
}

}  // namespace
}  // namespace interlock
