#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "bench.hpp"

namespace interlock::plant::test {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kAdc2 = 1;
constexpr std::size_t kAdc3 = 2;

Parameters with_force_sensor(std::uint32_t noise_counts) {
  Parameters parameters = exact_parameters();
  parameters.sensor[kSensor].input[kAdc2] =
      AnalogParameters{.zero_counts = 1970, .noise_counts = noise_counts};
  parameters.sensor[kSensor].input[kAdc3] =
      AnalogParameters{.zero_counts = 1780, .noise_counts = noise_counts};
  return parameters;
}

/** ADC 1 in bits 31..16 of word 7 and ADC 2 in 15..0, ADC 3 and 4 in word 8: spec/frames.md. */
std::uint32_t adc(const Bench& bench, std::size_t input) {
  return bench.word(kSensor, 7 + input / 2) >> (input % 2 == 0 ? 16 : 0) & 0xFFFFu;
}

TEST(PlantForceSensor, ReadsItsZeroWithoutForceAndNothingWhereNothingIsConnected) {
  Bench bench(with_force_sensor(0));
  bench.run(3);
  EXPECT_TRUE(bench.sound(kSensor));
  EXPECT_EQ(bench.word(kSensor, 7), 1970u);
  EXPECT_EQ(bench.word(kSensor, 8), 1780u << 16);
}

TEST(PlantForceSensor, NoiseIsSeededAndStaysWithinItsCounts) {
  Bench bench(with_force_sensor(3));
  Bench same_seed(with_force_sensor(3));
  std::set<std::uint32_t> readings;
  for (int n = 0; n < 1000; ++n) {
    bench.run(1);
    same_seed.run(1);
    ASSERT_EQ(adc(bench, kAdc2), adc(same_seed, kAdc2));
    readings.insert(adc(bench, kAdc2));
  }
  EXPECT_EQ(readings, (std::set<std::uint32_t>{1967, 1968, 1969, 1970, 1971, 1972, 1973}));
}

TEST(PlantForceSensor, ForceAddsToItsInputAloneAndClearEndsIt) {
  Bench bench(with_force_sensor(0));
  bench.schedule(command::PressSensor{kSensor, kAdc3, -500});
  bench.run(1);
  EXPECT_EQ(adc(bench, kAdc2), 1970u);
  EXPECT_EQ(adc(bench, kAdc3), 1280u);
  bench.schedule(command::Clear{});
  bench.run(1);
  EXPECT_EQ(adc(bench, kAdc3), 1780u);
}

TEST(PlantForceSensor, ConverterSaturatesAtBothEnds) {
  Bench bench(with_force_sensor(0));
  bench.schedule(command::PressSensor{kSensor, kAdc2, command::kMostForceCounts});
  bench.schedule(command::PressSensor{kSensor, kAdc3, -command::kMostForceCounts});
  bench.run(1);
  EXPECT_EQ(adc(bench, kAdc2), 0xFFFFu);
  EXPECT_EQ(adc(bench, kAdc3), 0u);
}

TEST(PlantForceSensor, ForceWhereThereIsNoSensorIsRefused) {
  const Bench bench(with_force_sensor(0));
  EXPECT_THAT(bench.plant.refusal(command::PressSensor{kEmpty, kAdc2, 1}).value(), HasSubstr("no card"));
  EXPECT_THAT(bench.plant.refusal(command::PressSensor{kPwm, kAdc2, 1}).value(), HasSubstr("motor card"));
  EXPECT_THAT(bench.plant.refusal(command::PressSensor{kSensor, 0, 1}).value(), HasSubstr("ADC 1"));
}

}  // namespace
}  // namespace interlock::plant::test
