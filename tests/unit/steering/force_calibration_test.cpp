/** @file From the converter's counts to newtons, and the zeroing action. */
#include "steering/force_calibration.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "not_numbers.hpp"
#include "pressing_hand.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;
using experiment::hand_channel;
using experiment::needle_channel;

TEST(ForceCalibration, agrees_with_the_published_line_less_its_reference) {
  for (const SensorChannel& channel : {hand_channel(), needle_channel()}) {
    const ForceCalibration calibration = ForceCalibration::create(channel, 1.0).value();
    for (std::uint32_t reading = 0; reading <= 4095; reading += 5) {
      ASSERT_NEAR(*calibration.force_n(reading), channel.value(reading), 1e-9);
    }
    EXPECT_EQ(*calibration.force_n(channel.reference), 0.0);
  }
}

TEST(ForceCalibration, takes_the_unit_that_it_is_told) {
  const ForceCalibration calibration = ForceCalibration::create(hand_channel(), 100.0).value();
  EXPECT_NEAR(*calibration.force_n(2970), 9.024779072786, 1e-9);
  const ForceCalibration turned = ForceCalibration::create(hand_channel(), -100.0).value();
  EXPECT_NEAR(*turned.force_n(2970), -9.024779072786, 1e-9);
}

TEST(ForceCalibration, zeroes_at_the_mean_of_what_it_reads) {
  const ForceCalibration calibration = ForceCalibration::create(needle_channel(), 100.0).value();
  std::vector<std::uint32_t> readings;
  for (std::uint32_t number = 0; number < 100; ++number) {
    readings.push_back(1800 + number % 3);
  }
  readings.push_back(1801);
  const ForceCalibration zeroed = calibration.zeroed(readings, {}).value();
  EXPECT_NEAR(zeroed.zero_counts(), 1801.0, 0.02);
  EXPECT_NEAR(*zeroed.force_n(1801), 0.0, 1e-3);
  EXPECT_NEAR(*zeroed.force_n(1701) - *zeroed.force_n(1801), 0.9024779072786, 1e-9);
}

TEST(ForceCalibration, does_not_zero_a_hand_a_load_or_too_little) {
  const ForceCalibration calibration = ForceCalibration::create(needle_channel(), 100.0).value();
  EXPECT_EQ(calibration.zeroed({}, {.least_readings = 0}).error().quantity, "zeroing_readings");
  EXPECT_EQ(calibration.zeroed(std::vector<std::uint32_t>(99, 1780), {}).error().quantity,
            "zeroing_readings");
  std::vector<std::uint32_t> hand(100, 1780);
  hand[50] = 1830;
  EXPECT_EQ(calibration.zeroed(hand, {}).error().quantity, "zeroing_spread_n");
  EXPECT_EQ(calibration.zeroed(std::vector<std::uint32_t>(100, 1080), {}).error().quantity,
            "zeroing_distance_n");
  EXPECT_EQ(calibration.zeroed(std::vector<std::uint32_t>(100, 70'000), {}).error().quantity,
            "force_reading_counts");
}

TEST(ForceCalibration, does_not_creep_by_zeroing_again_and_again) {
  ForceCalibration calibration = ForceCalibration::create(needle_channel(), 100.0).value();
  std::uint32_t reading = 1780;
  while (const auto next = calibration.zeroed(std::vector<std::uint32_t>(100, reading), {})) {
    calibration = *next;
    reading += 100;
  }
  EXPECT_LE(std::abs(calibration.zero_counts() - 1780) * 0.0090248, 5.0);
}

TEST(ForceCalibration, answers_nonsense_with_an_error) {
  for (const double value : not_numbers) {
    EXPECT_EQ(ForceCalibration::create(hand_channel(), value).error().code, Code::not_finite);
    SensorChannel channel = hand_channel();
    channel.slope = value;
    EXPECT_EQ(ForceCalibration::create(channel, 100.0).error().code, Code::not_finite);
  }
  EXPECT_EQ(ForceCalibration::create(hand_channel(), 0.0).error().code, Code::out_of_range);
  EXPECT_EQ(ForceCalibration::create(hand_channel(), 1.0)->force_n(65536).error().code, Code::out_of_range);
}

}  // namespace
}  // namespace interlock::test
