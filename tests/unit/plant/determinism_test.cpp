#include <gtest/gtest.h>

#include <boost/crc.hpp>

#include "bench.hpp"

namespace interlock::plant::test {
namespace {

/** Digest of all answers of a run with drives, hands and faults that `script_seed` chose. */
std::uint32_t digest(std::uint64_t plant_seed, std::uint64_t script_seed) {
  Random script(script_seed, 0);
  Bench bench(default_parameters(sample_robot()), plant_seed);
  boost::crc_32_type crc;
  for (int n = 0; n < 300; ++n) {
    bench.drive(kNonPwm, script.coin() ? Sense::kIncreasing : Sense::kDecreasing, script.below(kMaxDrive));
    bench.drive(kPwm, Sense::kIncreasing, script.below(kMaxDrive));
    bench.schedule(command::PressPedal{script.coin()});
    bench.schedule(command::SpoilFrames{std::nullopt, FrameFault::kCorrupt, 1 + script.below(3)});
    for (int tick = 0; tick < 10; ++tick) {
      bench.run(1);
      crc.process_bytes(&bench.reply, sizeof bench.reply);
    }
  }
  return crc.checksum();
}

TEST(PlantDeterminism, SameSeedGivesTheSameBits) { EXPECT_EQ(digest(1, 5), digest(1, 5)); }

TEST(PlantDeterminism, OtherSeedDiffers) { EXPECT_NE(digest(1, 5), digest(2, 5)); }

TEST(PlantDeterminism, FaultOfOneCardDoesNotDisturbTheNoiseOfAnother) {
  Parameters parameters = exact_parameters();
  parameters.axis[kPwm].noise_counts = 1;
  parameters.axis[kPwm].noise_chance = 0.3;
  Bench calm(parameters, 3);
  Bench disturbed(parameters, 3);
  disturbed.schedule(command::SpoilFrames{kNonPwm, FrameFault::kCorrupt, 200});
  for (int n = 0; n < 500; ++n) {
    calm.run(1);
    disturbed.run(1);
    ASSERT_EQ(calm.counter(kPwm), disturbed.counter(kPwm));
  }
}

TEST(PlantDeterminism, RandomNumbersAreTheSameEverywhere) {
  Random random(1, 2);
  std::uint32_t folded = 0;
  for (int n = 0; n < 1000; ++n) {
    folded = folded * 31 + random.below(1000) + (random.coin() ? 1 : 0) + (random.chance(0.25) ? 2 : 0);
  }
  EXPECT_EQ(folded, 2455085372u);
}

}  // namespace
}  // namespace interlock::plant::test
