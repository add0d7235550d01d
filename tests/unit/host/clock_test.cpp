#include "clock.h"

#include <gtest/gtest.h>

namespace {

constexpr uint64_t kStart = 5'000'000'000;
constexpr uint64_t kPeriod = 1'000'000;

ilk_ticker_t ticker(ilk_clock_t clock, double speed = 1.0) {
  ilk_ticker_t made{};
  ilk_ticker_init(&made, clock, 1000, speed, kStart);
  return made;
}

TEST(RealClock, DeadlinesAreExactlyOnePeriodApartHoweverTheTicksWake) {
  ilk_ticker_t clock = ticker(ILK_CLOCK_REAL);
  for (uint64_t n = 1; n < 100; ++n) {
    const uint64_t deadline = ilk_ticker_next(&clock, true, kStart);
    EXPECT_EQ(deadline, kStart + n * kPeriod);
    EXPECT_EQ(ilk_ticker_begin(&clock, deadline + n * 7), n * 7);
  }
}

TEST(RealClock, LateTickKeepsThePhaseAndSkipsWhatPassed) {
  ilk_ticker_t clock = ticker(ILK_CLOCK_REAL);
  ASSERT_EQ(ilk_ticker_next(&clock, true, kStart), kStart + kPeriod);
  EXPECT_EQ(ilk_ticker_begin(&clock, kStart + kPeriod * 7 / 2), kPeriod * 5 / 2);
  EXPECT_EQ(ilk_ticker_next(&clock, true, kStart), kStart + 4 * kPeriod);
}

TEST(RealClock, EarlyWakeIsNotLate) {
  ilk_ticker_t clock = ticker(ILK_CLOCK_REAL);
  (void)ilk_ticker_next(&clock, true, kStart);
  EXPECT_EQ(ilk_ticker_begin(&clock, kStart), 0u);
}

TEST(RealClock, IgnoresSpeed) {
  ilk_ticker_t clock = ticker(ILK_CLOCK_REAL, 10.0);
  EXPECT_EQ(ilk_ticker_next(&clock, true, kStart), kStart + kPeriod);
}

TEST(SimulatedClock, IsPacedAtItsSpeed) {
  ilk_ticker_t fast = ticker(ILK_CLOCK_SIM, 10.0);
  EXPECT_EQ(ilk_ticker_next(&fast, true, kStart), kStart + kPeriod / 10);
  ilk_ticker_t slow = ticker(ILK_CLOCK_SIM, 0.5);
  EXPECT_EQ(ilk_ticker_next(&slow, true, kStart), kStart + kPeriod * 2);
}

TEST(SimulatedClock, IsNeverLateAndNeverHurriesToCatchUp) {
  ilk_ticker_t clock = ticker(ILK_CLOCK_SIM);
  const uint64_t much_later = kStart + 50 * kPeriod;
  EXPECT_EQ(ilk_ticker_next(&clock, true, much_later), much_later);
  EXPECT_EQ(clock.waited_ns, 49 * kPeriod);
  EXPECT_EQ(ilk_ticker_begin(&clock, much_later + 9 * kPeriod), 0u);
  EXPECT_EQ(ilk_ticker_next(&clock, true, much_later), much_later + kPeriod);
  EXPECT_EQ(clock.waited_ns, 0u);
}

TEST(SimulatedClock, WaitsOfThePacedClockAddUpToWhatItLagsBehindTheWall) {
  ilk_ticker_t clock = ticker(ILK_CLOCK_SIM);
  uint64_t now = kStart;
  uint64_t waited = 0;
  for (uint64_t n = 0; n < 100; ++n) {
    now = ilk_ticker_next(&clock, true, now) + n % 7 * kPeriod / 2;
    waited += clock.waited_ns;
  }
  EXPECT_EQ(clock.deadline_ns, kStart + 100 * kPeriod + waited);
}

TEST(SimulatedClock, WithoutAPaceNothingIsLate) {
  ilk_ticker_t clock = ticker(ILK_CLOCK_SIM, 0.0);
  (void)ilk_ticker_next(&clock, true, kStart + 50 * kPeriod);
  EXPECT_EQ(clock.waited_ns, 0u);
}

TEST(SimulatedClock, SpeedZeroNeverWaitsWhilePlantAndAppKeepUp) {
  ilk_ticker_t clock = ticker(ILK_CLOCK_SIM, 0.0);
  for (uint64_t n = 0; n < 10; ++n) {
    EXPECT_EQ(ilk_ticker_next(&clock, true, kStart + n), kStart + n);
  }
}

TEST(SimulatedClock, OutOfStepWithPlantOrAppNoFasterThanRealTime) {
  ilk_ticker_t unpaced = ticker(ILK_CLOCK_SIM, 0.0);
  EXPECT_EQ(ilk_ticker_next(&unpaced, false, kStart), kStart + kPeriod);
  ilk_ticker_t slow = ticker(ILK_CLOCK_SIM, 0.5);
  EXPECT_EQ(ilk_ticker_next(&slow, false, kStart), kStart + 2 * kPeriod);
}

}  // namespace
