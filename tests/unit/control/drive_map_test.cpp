#include "control/drive_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "control/frequency_map.hpp"

namespace interlock {
namespace {

constexpr double full_speed = 1000.0;

DriveMapRules linear_rules(ilk_card_t card = ILK_CARD_PWM) {
  return {.card = card,
          .motor_direction = true,
          .max_drive = 0xEFFF,
          .min_drive = 0xFFF,
          .dead_zone_drive = 920.0,
          .full_speed_counts_per_s = full_speed,
          .counts_per_revolution = 0.0};
}

/** The rotation of the prostate robot. */
DriveMapRules frequency_rules(bool motor_direction = false) {
  return {.card = ILK_CARD_HIGH_FREQUENCY,
          .motor_direction = motor_direction,
          .max_drive = 141'386,
          .min_drive = 3222,
          .dead_zone_drive = 0.0,
          .full_speed_counts_per_s = 0.0,
          .counts_per_revolution = 1666.74};
}

DriveMap map_of(const DriveMapRules& rules) { return DriveMap::create(rules).value(); }

class EveryCard : public testing::TestWithParam<DriveMapRules> {};

TEST_P(EveryCard, DriveGrowsWithTheSpeedInBothDirections) {
  const DriveMap map = map_of(GetParam());
  std::mt19937_64 generator(1);
  std::uniform_real_distribution speed(0.0, 6000.0);
  for (int trial = 0; trial < 20'000; ++trial) {
    const auto [slower, faster] = std::minmax({speed(generator), speed(generator)});
    ASSERT_LE(map.drive(slower), map.drive(faster));
    ASSERT_LE(map.drive(-slower), map.drive(-faster));
  }
}

TEST_P(EveryCard, IsNeverAboveItsBoundNorBelowWhatMovesTheAxis) {
  const DriveMap map = map_of(GetParam());
  std::mt19937_64 generator(2);
  std::uniform_real_distribution exponent(-12.0, 300.0);
  for (int trial = 0; trial < 20'000; ++trial) {
    const double speed = std::pow(10.0, exponent(generator)) * (trial % 2 == 0 ? 1 : -1);
    ASSERT_LE(map.drive(speed), GetParam().max_drive) << speed;
    ASSERT_GE(map.drive(speed), GetParam().min_drive) << speed;
  }
  EXPECT_EQ(map.drive(1e300), GetParam().max_drive) << "clamped, not masked";
}

TEST_P(EveryCard, NoSpeedAndWhatIsNoNumberIsZeroDrive) {
  const DriveMap map = map_of(GetParam());
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double none : {0.0, -0.0, std::nan(""), infinity, -infinity}) {
    EXPECT_EQ(map.drive(none), 0u) << none;
  }
  EXPECT_EQ(map.speed(0, 1), 0.0);
  EXPECT_EQ(map.speed(0, -1), 0.0);
}

TEST_P(EveryCard, SpeedToDriveAndBackIsTheSameSpeed) {
  const DriveMap map = map_of(GetParam());
  std::mt19937_64 generator(3);
  for (const int direction : {1, -1}) {
    const double slowest = std::abs(map.speed(GetParam().min_drive, direction));
    std::uniform_real_distribution speed(slowest, std::abs(map.speed(GetParam().max_drive, direction)));
    for (int trial = 0; trial < 10'000; ++trial) {
      const double desired = direction * speed(generator);
      ASSERT_NEAR(map.speed(map.drive(desired), direction), desired, 0.1);
    }
  }
}

TEST_P(EveryCard, DriveToSpeedAndBackIsTheSameDrive) {
  const DriveMap map = map_of(GetParam());
  std::mt19937_64 generator(4);
  std::uniform_int_distribution<std::uint32_t> any(GetParam().min_drive, GetParam().max_drive);
  for (int trial = 0; trial < 10'000; ++trial) {
    const std::uint32_t drive = any(generator);
    for (const int direction : {1, -1}) {
      ASSERT_NEAR(map.drive(map.speed(drive, direction)), drive, 1) << direction;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, EveryCard,
                         testing::Values(linear_rules(), linear_rules(ILK_CARD_NON_PWM),
                                         linear_rules(ILK_CARD_ANALOG), frequency_rules(),
                                         frequency_rules(true)));

TEST(DriveMap, OfALinearCardBeginsBeyondTheDeadZoneAndEndsAtTheLargestDrive) {
  const DriveMap map = map_of(linear_rules());
  EXPECT_EQ(map.drive(full_speed), 0xEFFFu);
  EXPECT_EQ(map.drive(-full_speed), 0xEFFFu);
  EXPECT_EQ(map.drive(full_speed / 2), 31180u);
  EXPECT_EQ(map.speed(920, 1), 0.0);
  EXPECT_EQ(map.full_speed(), full_speed);
}

TEST(DriveMap, OfAHighFrequencyCardTakesTheColumnOfTheDirection) {
  // The negative column is the slower one at 19 of the 23 points that move; there it needs the higher drive.
  for (const bool motor_direction : {false, true}) {
    const DriveMap map = map_of(frequency_rules(motor_direction));
    const int positive = motor_direction ? 1 : -1;
    EXPECT_NEAR(map.speed(141'386, positive) * positive, 141.386 / 60 * 1666.74, 1e-6);
    EXPECT_NEAR(map.speed(141'386, -positive) * -positive, 138.166 / 60 * 1666.74, 1e-6);
    EXPECT_LT(map.drive(positive * 2000.0), map.drive(-positive * 2000.0));
    EXPECT_NEAR(map.full_speed(), 138.166 / 60 * 1666.74, 1e-6);
  }
}

TEST(DriveMap, RefusesWhatIsNoMapByName) {
  const auto refused = [](auto change) {
    DriveMapRules rules = linear_rules();
    change(rules);
    const auto map = DriveMap::create(rules);
    return map ? std::string() : map.error().message();
  };
  EXPECT_EQ(refused([](DriveMapRules& rules) { rules.card = ILK_CARD_SENSOR; }), "card is out of range");
  EXPECT_EQ(refused([](DriveMapRules& rules) { rules.card = ILK_CARD_NONE; }), "card is out of range");
  EXPECT_EQ(refused([](DriveMapRules& rules) { rules.max_drive = 0; }), "largest drive is out of range");
  EXPECT_EQ(refused([](DriveMapRules& rules) { rules.min_drive = 0xF000; }),
            "smallest drive is out of range");
  EXPECT_EQ(refused([](DriveMapRules& rules) { rules.dead_zone_drive = -1; }), "dead zone is out of range");
  EXPECT_EQ(refused([](DriveMapRules& rules) { rules.full_speed_counts_per_s = std::nan(""); }),
            "full speed is not a finite number");
  EXPECT_EQ(refused([](DriveMapRules& rules) {
              rules.card = ILK_CARD_HIGH_FREQUENCY;
              rules.counts_per_revolution = 0;
            }),
            "counts per revolution is out of range");
}

/** Speed of a motor whose map is that of the drive, moved by so many hertz. */
double true_speed(const DriveMap& published, std::uint32_t drive, double above_hz) {
  const double word = frequency_map::word_of(drive) - above_hz * frequency_map::words_per_hz;
  return published.speed(frequency_map::drive_at(static_cast<std::uint32_t>(word)), 1);
}

/** Speed that is reached when one is wanted for five seconds, while the share of it is measured. */
double reached(DriveMap& map, double wanted_counts_per_s, double above_hz, double share = 1.0) {
  const DriveMap published = map_of(frequency_rules());
  double speed = 0.0;
  for (int tick = 0; tick < 5000; ++tick) {
    const std::uint32_t drive = map.drive(wanted_counts_per_s);
    speed = share * true_speed(published, drive, above_hz);
    map.follow(drive, speed, 0.001);
  }
  return speed;
}

TEST(FrequencyDrive, FollowsTheResonanceOfItsMotor) {
  for (const double above_hz : {-300.0, -100.0, 0.0, 100.0, 300.0}) {
    DriveMap map = map_of(frequency_rules());
    EXPECT_NEAR(reached(map, 1500.0, above_hz), 1500.0, 15.0) << above_hz;
    EXPECT_NEAR(true_speed(map_of(frequency_rules()), map.drive(800.0), above_hz), 800.0, 40.0)
        << "at another speed, too";
  }
}

TEST(FrequencyDrive, BeginsAtTheResonanceThatItsFileStates) {
  for (const double stated_hz : {-300.0, -200.0, 200.0}) {
    DriveMapRules rules = frequency_rules();
    rules.resonance_hz = stated_hz;
    DriveMap map = map_of(rules);
    EXPECT_NEAR(true_speed(map_of(frequency_rules()), map.drive(1500.0), stated_hz), 1500.0, 15.0)
        << stated_hz;
    EXPECT_NEAR(map.speed(map.drive(1500.0), 1), 1500.0, 15.0) << stated_hz;
    EXPECT_EQ(map.full_speed() > map_of(frequency_rules()).full_speed(), stated_hz > 0) << stated_hz;
    EXPECT_NEAR(reached(map, 1500.0, stated_hz - 100.0), 1500.0, 15.0) << "and follows it from there";
  }
}

TEST(FrequencyDrive, TakesNoAxisThatIsHeldForAnotherResonance) {
  DriveMap map = map_of(frequency_rules());
  const std::uint32_t before = map.drive(1500.0);
  reached(map, 1500.0, 0.0, 0.1);
  EXPECT_EQ(map.drive(1500.0), before);
  reached(map, 1500.0, 0.0, 0.0);
  EXPECT_EQ(map.drive(1500.0), before);
}

TEST(FrequencyDrive, OtherCardsFollowNothing) {
  DriveMap map = map_of(linear_rules());
  const std::uint32_t before = map.drive(500.0);
  for (int tick = 0; tick < 1000; ++tick) {
    map.follow(before, 250.0, 0.001);
  }
  EXPECT_EQ(map.drive(500.0), before);
}

}  // namespace
}  // namespace interlock
