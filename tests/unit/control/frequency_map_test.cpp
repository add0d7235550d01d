#include "control/frequency_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace interlock::frequency_map {
namespace {

constexpr int trials = 20'000;

TEST(FrequencyMap, HasThePublishedPointsInBothDirections) {
  const struct {
    std::uint32_t point;
    double positive;
    double negative;
  } published[] = {{0, 0.0, 0.0},        {1, 0.029, 0.054},      {7, 1.459, 3.222},     {10, 11.445, 10.636},
                   {15, 45.548, 45.333}, {19, 141.386, 138.166}, {23, 397.785, 391.709}};
  for (const auto& [point, positive, negative] : published) {
    const std::uint32_t word = slowest_word - point * word_step;
    EXPECT_EQ(rpm_at(word, Wave::positive), positive);
    EXPECT_EQ(rpm_at(word, Wave::negative), negative);
    EXPECT_EQ(word_for(positive, Wave::positive), word);
    EXPECT_EQ(word_for(negative, Wave::negative), word);
  }
  EXPECT_EQ(fastest_word, 1103158212u);
}

TEST(FrequencyMap, StartAndMaximumVelocityOfThePublishedTableAreItsWords) {
  EXPECT_EQ(word_for(3.222, Wave::negative), 0x45A0DB84u);
  EXPECT_EQ(word_for(141.386, Wave::positive), 0x42B8DBB4u);
}

TEST(FrequencyMap, ALowerWordIsFaster) {
  std::mt19937_64 generator(1);
  std::uniform_int_distribution<std::uint32_t> word(fastest_word, slowest_word);
  for (int trial = 0; trial < trials; ++trial) {
    const auto [lower, higher] = std::minmax({word(generator), word(generator)});
    for (const Wave wave : {Wave::positive, Wave::negative}) {
      ASSERT_GE(rpm_at(lower, wave), rpm_at(higher, wave));
    }
    ASSERT_GE(drive_at(lower), drive_at(higher));
  }
}

TEST(FrequencyMap, SpeedToWordAndBackIsTheNextWordOnTheSlowerSide) {
  std::mt19937_64 generator(2);
  std::uniform_real_distribution speed(0.0, 391.0);
  for (int trial = 0; trial < trials; ++trial) {
    const double rpm = trial % 2 == 0 ? speed(generator) : speed(generator) / 100;
    for (const Wave wave : {Wave::positive, Wave::negative}) {
      const std::uint32_t word = word_for(rpm, wave);
      ASSERT_LE(rpm_at(word, wave), rpm + 1e-9) << rpm;
      ASSERT_GT(rpm_at(word - 2, wave), rpm) << rpm;
    }
  }
}

TEST(FrequencyMap, WordToSpeedAndBackIsTheSameWordOrItsNeighbour) {
  std::mt19937_64 generator(3);
  std::uniform_int_distribution<std::uint32_t> any(fastest_word, slowest_word);
  for (int trial = 0; trial < trials; ++trial) {
    const std::uint32_t word = any(generator);
    for (const Wave wave : {Wave::positive, Wave::negative}) {
      const std::uint32_t again = word_for(rpm_at(word, wave), wave);
      ASSERT_GE(again + 1, word);
      ASSERT_LE(again, word + 1);
    }
  }
}

TEST(FrequencyMap, WhatIsBeyondTheMapIsItsEndAndWhatIsNoNumberIsRest) {
  EXPECT_EQ(word_for(1e9, Wave::positive), fastest_word);
  EXPECT_EQ(word_for(std::numeric_limits<double>::infinity(), Wave::negative), fastest_word);
  EXPECT_EQ(word_for(391.8, Wave::negative), fastest_word);
  for (const double rpm : {0.0, -3.0, std::nan(""), -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(word_for(rpm, Wave::positive), slowest_word);
  }
  EXPECT_EQ(rpm_at(0, Wave::positive), 397.785);
  EXPECT_EQ(rpm_at(0xFFFFFFFFu, Wave::positive), 0.0);
}

TEST(FrequencyMap, ADriveIsPackedAsTheWordThatItWasMadeFor) {
  std::mt19937_64 generator(4);
  std::uniform_int_distribution<std::uint32_t> any(fastest_word, slowest_word);
  for (int trial = 0; trial < trials; ++trial) {
    const std::uint32_t word = any(generator);
    const std::uint32_t drive = drive_at(word);
    ASSERT_GE(word_of(drive), word) << "never faster than asked";
    ASSERT_LE(word_of(drive + 1), word) << "the next drive would be";
  }
  EXPECT_EQ(drive_at(fastest_word), 397785u);
  EXPECT_EQ(drive_at(slowest_word), 0u);
}

}  // namespace
}  // namespace interlock::frequency_map
