#include "motion/time_scaling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace interlock {
namespace {

/** Ways from some that are too short for rise and fall to some in which both are nothing. */
TimeScaling drawn(std::mt19937_64& random, double& way_s, double peak = 1.0) {
  std::uniform_real_distribution<double> exponent(-4.0, 1.5);
  std::uniform_int_distribution<int> none(0, 3);
  const auto draw = [&] { return std::pow(10.0, exponent(random)); };
  way_s = draw();
  return {way_s, peak, none(random) == 0 ? 0.0 : draw(), none(random) == 0 ? 0.0 : draw()};
}

TEST(TimeScaling, PassesTheWholeWayForwardsAndNoFasterThanTheClock) {
  std::mt19937_64 random(61);
  for (int trial = 0; trial < 2000; ++trial) {
    double way_s = 0.0;
    const TimeScaling pace = drawn(random, way_s);
    ASSERT_EQ(pace.passed_s(pace.duration_s()), way_s);
    ASSERT_GE(pace.duration_s(), way_s);
    double before = 0.0;
    for (int step = 1; step <= 50; ++step) {
      const double time_s = pace.duration_s() * step / 50;
      const double passed = pace.passed_s(time_s);
      ASSERT_GE(passed, before - 1e-12);
      ASSERT_LE(passed - before, pace.duration_s() / 50 + 1e-9);
      before = passed;
    }
  }
}

TEST(TimeScaling, PaceIsWhatPassesInASecond) {
  std::mt19937_64 random(67);
  for (int trial = 0; trial < 2000; ++trial) {
    double way_s = 0.0;
    const double peak = trial % 2 == 0 ? 1.0 : 0.95;
    const TimeScaling pace = drawn(random, way_s, peak);
    const double step = pace.duration_s() * 1e-5;
    std::uniform_real_distribution<double> when(2 * step, pace.duration_s() - 2 * step);
    const double time_s = when(random);
    const double passed = (pace.passed_s(time_s + step) - pace.passed_s(time_s - step)) / (2 * step);
    ASSERT_NEAR(pace.pace(time_s), passed, 1e-3);
    ASSERT_GE(pace.pace(time_s), 0.0);
    ASSERT_LE(pace.pace(time_s), peak + 1e-12);
  }
}

TEST(TimeScaling, ItsSlopeIsWhatThePaceGains) {
  const TimeScaling pace(3.0, 0.98, 0.5, 0.25);
  constexpr double step = 1e-6;
  for (double time_s = 0.001; time_s < pace.duration_s() - 0.001; time_s += 0.0073) {
    const double gained = (pace.pace(time_s + step) - pace.pace(time_s - step)) / (2 * step);
    ASSERT_NEAR(pace.pace_per_s(time_s), gained, 1e-4) << time_s;
  }
}

// At worst every rate of the trajectory is at its largest, with any sign, in every moment of the change.
TEST(TimeScaling, AnAxisKeepsItsAccelerationAndJerkWhereverItsTrajectoryIsBegun) {
  const RateLimits limits{600.0, 6000.0, 120000.0};
  std::mt19937_64 random(71);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int trial = 0; trial < 500; ++trial) {
    const RateLimits top{limits.velocity * share(random), limits.acceleration * share(random),
                         limits.jerk * share(random)};
    const double peak = trial % 2 == 0 ? 1.0 : 0.95;
    const double change_s = TimeScaling::change_s(top, limits, peak);
    for (const double way_s : {0.01, change_s, 10.0}) {
      const TimeScaling scaling(way_s, peak, change_s, change_s);
      const double step = change_s / 500;
      for (double time_s = step; time_s < 2 * change_s && time_s < scaling.duration_s() - step;
           time_s += step) {
        const double pace = scaling.pace(time_s);
        const double slope = scaling.pace_per_s(time_s);
        const double bend = (scaling.pace_per_s(time_s + step / 10) - slope) / (step / 10);
        ASSERT_LE(top.acceleration * pace * pace + top.velocity * std::abs(slope),
                  limits.acceleration * (1 + 1e-9));
        const double jerk = top.jerk * pace * pace * pace + 3 * top.acceleration * pace * std::abs(slope) +
                            top.velocity * std::abs(bend);
        // One leap of the second derivative lies within a step, half a rise from each of its ends.
        ASSERT_LE(jerk, limits.jerk * (1 + 1e-3));
      }
    }
  }
}

TEST(TimeScaling, NothingIsLeftForAChangeWhereTheTrajectoryTakesAllOfALimit) {
  const RateLimits limits{600.0, 6000.0, 120000.0};
  EXPECT_EQ(TimeScaling::change_s({1.0, 6000.0, 1.0}, limits, 1.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(TimeScaling::change_s({1.0, 1.0, 120001.0}, limits, 1.0),
            std::numeric_limits<double>::infinity());
  EXPECT_LT(TimeScaling::change_s(limits, limits, 0.95), 5.0);
}

/** Of 100,000 random paths one was taken up so, and its first tick gained more than the limit. */
TEST(TimeScaling, AStateFromWhichTheFirstTickGainsMoreThanTheLimitsIsNoRest) {
  const RateLimits limits{600.0, 6000.0, 120000.0};
  const auto is_rest = [&](double velocity, double acceleration) {
    return TimeScaling::is_rest({0.0, velocity, acceleration},
                                {0.0, velocity + acceleration * TimeScaling::tick_s, acceleration}, limits);
  };
  EXPECT_TRUE(is_rest(-5.95, 0.0));
  EXPECT_TRUE(is_rest(0.0, 120.0));
  EXPECT_FALSE(is_rest(-5.95, -101.0));
  EXPECT_FALSE(is_rest(6.05, -101.0)) << "the state itself is none";
  EXPECT_FALSE(TimeScaling::is_rest({0.0, 0.0, 100.0}, {0.0, 0.1, 130.0}, limits));
}

TEST(TimeScaling, EndsAtRest) {
  const TimeScaling pace(2.0, 1.0, 0.1, 0.2);
  EXPECT_DOUBLE_EQ(pace.duration_s(), 2.15);
  EXPECT_NEAR(pace.pace(pace.duration_s() - 1e-6), 0.0, 1e-9);
  EXPECT_EQ(pace.pace(pace.duration_s()), 0.0);
  EXPECT_EQ(pace.pace_per_s(pace.duration_s()), 0.0);
  EXPECT_EQ(pace.passed_s(1e9), 2.0);
  EXPECT_EQ(TimeScaling(2.0, 1.0, 0.0, 0.0).duration_s(), 2.0);
  EXPECT_EQ(TimeScaling().passed_s(0.0), 0.0);
}

}  // namespace
}  // namespace interlock
