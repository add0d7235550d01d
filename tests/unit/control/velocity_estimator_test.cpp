#include "control/velocity_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace interlock {
namespace {

constexpr VelocityRules velocity_rules{.window_us = 20'000, .fastest_counts_per_s = 8000, .noise_counts = 1};

/** A clock that wraps soon after the start. */
constexpr std::uint32_t before_wrap = std::numeric_limits<std::uint32_t>::max() - 5'000;

std::int32_t counts_at(double counts_per_s, std::uint32_t elapsed_us) {
  return static_cast<std::int32_t>(std::floor(counts_per_s * elapsed_us * 1e-6));
}

/** An estimator that saw an axis at an even speed for some milliseconds, by a clock that wraps meanwhile. */
VelocityEstimator moving_estimator(double counts_per_s, std::uint32_t milliseconds) {
  VelocityEstimator estimator(velocity_rules);
  for (std::uint32_t n = 0; n <= milliseconds; ++n) {
    estimator.add(counts_at(counts_per_s, n * 1000), before_wrap + n * 1000);
  }
  return estimator;
}

TEST(VelocityEstimator, OfWholeCountsIsExactAcrossTheWrapOfTheClock) {
  for (const double speed : {3000.0, -2000.0, 0.0}) {
    const auto estimate = moving_estimator(speed, 40).estimate();
    ASSERT_TRUE(estimate);
    EXPECT_NEAR(estimate->counts_per_s, speed, 1e-9);
    EXPECT_NEAR(estimate->age_s, 0.010, 1e-12) << "half of the window";
  }
}

TEST(VelocityEstimator, OfTheThesisSpeedIsWithinThreePercentWhereTwoReadingsAreNoUseAtAll) {
  VelocityEstimator estimator(velocity_rules);
  double worst = 0.0;
  double worst_difference = 0.0;
  std::int32_t before = 0;
  for (std::uint32_t n = 0; n < 5000; ++n) {
    const std::int32_t now = counts_at(833.0, n * 1000);
    estimator.add(now, n * 1000);
    if (n >= 20) {
      worst = std::max(worst, std::abs(estimator.estimate().value().counts_per_s - 833.0));
      worst_difference = std::max(worst_difference, std::abs((now - before) * 1000.0 - 833.0));
    }
    before = now;
  }
  EXPECT_LT(worst, 0.03 * 833.0);
  EXPECT_GT(worst_difference, 0.9 * 833.0);
}

/** Of many passes at an even speed, each from anywhere between two counts. */
double deviation_at(double counts_per_s) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> start(0.0, 1.0);
  constexpr int passes = 2000;
  double sum = 0.0;
  for (int pass = 0; pass < passes; ++pass) {
    VelocityEstimator estimator(velocity_rules);
    const double from = start(random);
    for (std::uint32_t n = 0; n <= 20; ++n) {
      const double position = from + counts_per_s * n * 1e-3;
      estimator.add(static_cast<std::int32_t>(std::floor(position)), n * 1000);
    }
    sum += std::pow(estimator.estimate()->counts_per_s - counts_per_s, 2);
  }
  return std::sqrt(sum / passes);
}

TEST(VelocityEstimator, HasTheDeviationsThatItsHeaderStates) {
  for (double speed = 5.0; speed < 1000.0; speed *= 1.1) {
    const double stated = speed < 100.0 ? 29.0 : 15.0;
    EXPECT_LE(deviation_at(speed), stated) << speed;
  }
  EXPECT_NEAR(deviation_at(30.0), 28.6, 0.5);
}

TEST(VelocityEstimator, SaysNothingUntilHalfAWindowIsCovered) {
  EXPECT_FALSE(VelocityEstimator(velocity_rules).estimate());
  EXPECT_FALSE(moving_estimator(1000, 0).estimate());
  EXPECT_FALSE(moving_estimator(1000, 9).estimate());
  EXPECT_TRUE(moving_estimator(1000, 10).estimate());
}

TEST(VelocityEstimator, FollowsTimestampsAndNotTheNumberOfReadings) {
  std::mt19937_64 generator(5);
  std::uniform_int_distribution<std::uint32_t> late(500, 3000);
  VelocityEstimator estimator(velocity_rules);
  std::uint32_t elapsed_us = 0;
  for (int n = 0; n < 200; ++n) {
    estimator.add(counts_at(2500.0, elapsed_us), before_wrap + elapsed_us);
    elapsed_us += late(generator);
  }
  EXPECT_NEAR(estimator.estimate().value().counts_per_s, 2500.0, 60.0);
}

TEST(VelocityEstimator, LeavesOutRepeatedAndLateReadings) {
  VelocityEstimator estimator = moving_estimator(1000, 30);
  const auto before = estimator.estimate();
  estimator.add(30, before_wrap + 30'000);
  estimator.add(7, before_wrap + 30'000);
  estimator.add(29, before_wrap + 29'000);
  estimator.add(10, before_wrap + 10'000);
  EXPECT_EQ(estimator.estimate(), before);
}

TEST(VelocityEstimator, BeginsAnewAfterAJumpAGapOrARestartedClock) {
  for (const auto& [position, time_us] :
       {std::pair{30 + 500, before_wrap + 31'000}, std::pair{30 - 500, before_wrap + 31'000},
        std::pair{31, before_wrap + 51'000}, std::pair{31, before_wrap + 9'999},
        std::pair{31, before_wrap + 30'000 + (1u << 31)}}) {
    VelocityEstimator estimator = moving_estimator(1000, 30);
    estimator.add(position, time_us);
    EXPECT_FALSE(estimator.estimate()) << position << " at " << time_us;
    for (std::uint32_t n = 1; n <= 20; ++n) {
      estimator.add(position - static_cast<std::int32_t>(n), time_us + n * 1000);
    }
    EXPECT_NEAR(estimator.estimate().value().counts_per_s, -1000.0, 1e-9);
  }
}

TEST(VelocityEstimator, ForgetsWhatItSawAtAReset) {
  VelocityEstimator estimator = moving_estimator(1000, 30);
  estimator.reset();
  EXPECT_FALSE(estimator.estimate());
}

TEST(VelocityEstimator, IsFiniteAndNotFasterThanItsBoundForAnyReadings) {
  std::mt19937_64 generator(7);
  std::uniform_int_distribution<std::uint32_t> word;
  std::uniform_int_distribution<std::uint32_t> near(0, 6000);
  for (const double fastest : {8000.0, 0.0, std::nan(""), 1e300}) {
    VelocityEstimator estimator({.window_us = 20'000, .fastest_counts_per_s = fastest, .noise_counts = 1});
    std::uint32_t time_us = 0;
    std::int32_t position = 0;
    for (int n = 0; n < 20'000; ++n) {
      const bool wild = n % 50 == 0;
      time_us = wild ? word(generator) : time_us + near(generator) - 1000;
      position = wild ? static_cast<std::int32_t>(word(generator))
                      : static_cast<std::int32_t>(static_cast<std::uint32_t>(position) + near(generator) % 5);
      estimator.add(position, time_us);
      if (const auto estimate = estimator.estimate()) {
        ASSERT_TRUE(std::isfinite(estimate->counts_per_s));
        ASSERT_GE(estimate->age_s, 0.0);
        ASSERT_LE(estimate->age_s, 0.020);
        if (fastest == 8000.0) {
          ASSERT_LE(std::abs(estimate->counts_per_s), fastest + 1e6);
        }
      }
    }
  }
}

}  // namespace
}  // namespace interlock
