#include <gtest/gtest.h>

#include <cmath>

#include "bench.hpp"

namespace interlock::plant::test {
namespace {

constexpr std::size_t kMotors[] = {kPwm, kNonPwm, kLower, kAnalog};

TEST(PlantAxis, DeadZoneMovesNothing) {
  Bench bench(exact_parameters());
  const double start = bench.position(kNonPwm);
  bench.drive(kNonPwm, Sense::kIncreasing, static_cast<std::uint32_t>(0.015 * kMaxDrive));
  bench.run(2000);
  EXPECT_EQ(bench.position(kNonPwm), start);
  bench.drive(kNonPwm, Sense::kIncreasing, static_cast<std::uint32_t>(0.02 * kMaxDrive));
  bench.run(2000);
  EXPECT_GT(bench.position(kNonPwm), start + 2);
}

TEST(PlantAxis, FullDriveMovesOneCountATick) {
  for (const std::size_t slot : kMotors) {
    Bench bench(exact_parameters());
    bench.drive(slot, Sense::kDecreasing, kMaxDrive);
    bench.run(50);
    const double before = bench.position(slot);
    bench.run(100);
    EXPECT_NEAR(bench.position(slot) - before, -100, 0.01) << "slot " << slot;
  }
}

TEST(PlantAxis, EveryCardHonoursMotorDirection) {
  for (const std::uint32_t motor_direction : {0u, 1u}) {
    ilk_config_t robot = sample_robot();
    for (const std::size_t slot : {kPwm, kNonPwm, kLower, kAnalog, kHighFrequency}) {
      robot.axis[slot].motor_direction = motor_direction;
      Bench bench(exact_parameters(), 7, robot);
      const double start = bench.position(slot);
      const std::uint32_t drive = slot == kHighFrequency ? 1196612456u - 15 * 4063228u : kMaxDrive;
      bench.drive(slot, Sense::kIncreasing, drive);
      bench.run(100);
      EXPECT_GT(bench.position(slot), start + 10) << "slot " << slot;
      bench.drive(slot, Sense::kDecreasing, drive);
      bench.run(250);
      EXPECT_LT(bench.position(slot), start - 10) << "slot " << slot;
    }
  }
}

TEST(PlantAxis, CounterRunsAgainstThePositionWithDirectionCorrection) {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.drive(kAnalog, Sense::kIncreasing, kMaxDrive);
  bench.run(101);
  EXPECT_LT(bench.counter(kNonPwm), -80) << "direction_correction 1";
  EXPECT_GT(bench.counter(kAnalog), 80) << "direction_correction 0";
}

TEST(PlantAxis, CoastsAtLeastThreeCountsAndNeverBeyondCoastCounts) {
  const ilk_config_t robot = sample_robot();
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Bench bench(default_parameters(robot), seed);
    bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
    bench.run(200 + static_cast<std::uint32_t>(seed));
    // The last reading that still allows drive; its drive is on the wire one tick later.
    const std::int32_t allowed = bench.counter(kNonPwm);
    bench.run(1);
    const double amplifier_off = bench.position(kNonPwm);
    bench.stop(kNonPwm);
    bench.run(200);
    EXPECT_GE(bench.position(kNonPwm) - amplifier_off, 3);
    EXPECT_LE(std::abs(bench.counter(kNonPwm) - allowed), static_cast<int>(robot.axis[kNonPwm].coast_counts));
  }
}

TEST(PlantAxis, ComesToRest) {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(100);
  bench.stop(kNonPwm);
  bench.run(100);
  const double rest = bench.position(kNonPwm);
  EXPECT_EQ(bench.plant.station(kNonPwm)->axis->speed_counts_per_s(), 0);
  bench.run(1000);
  EXPECT_EQ(bench.position(kNonPwm), rest);
}

TEST(PlantAxis, CoastDoesNotDependOnTheStepOfTime) {
  Plant coarse(sample_robot(), exact_parameters(), 1);
  Plant fine(sample_robot(), exact_parameters(), 1);
  for (Plant* plant : {&coarse, &fine}) {
    ASSERT_TRUE(plant->schedule(command::RunAway{kNonPwm, 1.0}));
    plant->advance(Microseconds{10'000});
    ASSERT_TRUE(plant->schedule(command::RunAway{kNonPwm, 0.0}));
  }
  for (int n = 0; n < 100; ++n) {
    coarse.advance(Microseconds{1000});
    for (int part = 0; part < 10; ++part) {
      fine.advance(Microseconds{100});
    }
  }
  EXPECT_NEAR(coarse.station(kNonPwm)->position_counts(), fine.station(kNonPwm)->position_counts(), 0.01);
}

TEST(PlantAxis, BacklashIsLostWhenTheDirectionChanges) {
  Parameters parameters = exact_parameters();
  parameters.axis[kNonPwm].backlash_counts = 10;
  Bench with(parameters);
  Bench without(exact_parameters());
  for (Bench* bench : {&with, &without}) {
    bench->drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
    bench->run(300);
    bench->stop(kNonPwm);
    bench->run(100);
  }
  const double with_peak = with.position(kNonPwm);
  const double without_peak = without.position(kNonPwm);
  for (Bench* bench : {&with, &without}) {
    bench->drive(kNonPwm, Sense::kDecreasing, kMaxDrive);
    bench->run(300);
  }
  EXPECT_NEAR((without_peak - without.position(kNonPwm)) - (with_peak - with.position(kNonPwm)), 10, 1e-6);
}

TEST(PlantAxis, TheToolIsWhereTheEncoderIsAfterMotionUpAndThePlayBeyondItAfterMotionDown) {
  Parameters parameters = exact_parameters();
  parameters.axis[kNonPwm].tool_play_counts = 20;
  Bench bench(parameters);
  Bench without(exact_parameters());
  const Axis& axis = *bench.plant.station(kNonPwm)->axis;
  const auto drive = [&](Sense sense, std::uint32_t ticks) {
    for (Bench* each : {&bench, &without}) {
      each->drive(kNonPwm, sense, kMaxDrive);
      each->run(ticks);
    }
    EXPECT_EQ(bench.counter(kNonPwm), without.counter(kNonPwm)) << "the encoder sees nothing of it";
  };
  drive(Sense::kIncreasing, 300);
  EXPECT_EQ(axis.tool_counts(), axis.position_counts());
  const double peak = axis.tool_counts();
  drive(Sense::kDecreasing, 20);
  EXPECT_LT(axis.position_counts(), peak - 5);
  EXPECT_GE(axis.tool_counts(), peak) << "the play is taken up";
  drive(Sense::kDecreasing, 100);
  EXPECT_EQ(axis.tool_counts(), axis.position_counts() + 20);
}

/** Ways that the axis goes in the second after the first, to larger positions and to smaller ones. */
std::pair<double, double> ways(const Parameters& parameters, std::size_t slot, std::uint32_t drive,
                               std::uint32_t first_ticks) {
  std::pair<double, double> way;
  for (const Sense sense : {Sense::kIncreasing, Sense::kDecreasing}) {
    Bench bench(parameters);
    bench.drive(slot, sense, drive);
    bench.run(first_ticks);
    const double from = bench.position(slot);
    bench.run(1000);
    (sense == Sense::kIncreasing ? way.first : way.second) = std::abs(bench.position(slot) - from);
  }
  return way;
}

TEST(PlantAxis, ALoadSlowsTheWayUpAndHelpsTheWayDown) {
  Parameters parameters = exact_parameters();
  const auto without = ways(parameters, kNonPwm, kMaxDrive, 100);
  parameters.axis[kNonPwm].load_fraction = 0.2;
  const auto with = ways(parameters, kNonPwm, kMaxDrive, 100);
  EXPECT_NEAR(with.first, 0.8 * without.first, 1e-6);
  EXPECT_NEAR(with.second, 1.2 * without.second, 1e-6);
}

TEST(PlantAxis, AMotorLosesSpeedAsItWarmsAndHasItAgainOnceItIsCold) {
  Parameters parameters = exact_parameters();
  parameters.axis[kNonPwm].heat_droop_fraction = 0.3;
  parameters.axis[kNonPwm].heat_time_s = 0.5;
  Bench bench(parameters);
  const auto speed = [&] { return bench.plant.station(kNonPwm)->axis->speed_counts_per_s(); };
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(50);
  EXPECT_GT(speed(), 950.0) << "cold";
  bench.run(5000);
  EXPECT_NEAR(speed(), 700.0, 1.0) << "warm";
  bench.stop(kNonPwm);
  bench.run(5000);
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(50);
  EXPECT_GT(speed(), 950.0) << "cold again";
}

TEST(PlantAxis, AResonanceThatFallsWithWarmthMakesTheSameFrequencySlower) {
  Parameters parameters = exact_parameters();
  constexpr std::uint32_t kWord = 1196612456u - 15 * 4063228u;
  const auto published = ways(parameters, kHighFrequency, kWord, 100);
  constexpr double kPointHz = 4063228.0 / 22009.0;
  parameters.axis[kHighFrequency].resonance_hz = kPointHz;
  const auto above = ways(parameters, kHighFrequency, kWord, 100);
  EXPECT_NEAR(above.first / published.first, 58.997 / 45.548, 1e-3) << "a point further on the map";
  parameters.axis[kHighFrequency].resonance_drift_hz = kPointHz;
  parameters.axis[kHighFrequency].heat_time_s = 0.1;
  const auto warm = ways(parameters, kHighFrequency, kWord, 2000);
  EXPECT_NEAR(warm.first / published.first, 1.0, 1e-3);
  EXPECT_NEAR(warm.second / published.second, 1.0, 1e-3);
}

/** A command that changes the one parameter of that name. */
command::ChangeParameters change(std::size_t slot, std::string_view name, double value) {
  command::ChangeParameters wish{slot, {}};
  for (std::size_t knob = 0; knob < kAxisKnobCount; ++knob) {
    if (kAxisKnobs[knob].name == name) {
      wish.value[knob] = value;
    }
  }
  return wish;
}

/** How far an axis comes after its drive ended at full speed. */
double coast(Bench& bench) {
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(500);
  const double amplifier_off = bench.position(kNonPwm);
  bench.stop(kNonPwm);
  bench.run(500);
  return bench.position(kNonPwm) - amplifier_off;
}

TEST(PlantAxis, AChangedLagChangesTheCoastAndIsRestored) {
  Bench bench(exact_parameters());
  const double before = coast(bench);
  bench.schedule(change(kNonPwm, "lag_ms", 30));
  bench.run(1);
  const AxisParameters& now = bench.plant.station(kNonPwm)->axis->parameters();
  EXPECT_EQ(now.lag, Microseconds{30'000});
  EXPECT_DOUBLE_EQ(coast_counts(now), 30);
  EXPECT_NEAR(coast(bench) - before, 25, 0.5) << "25 ms more at a count a millisecond";
  bench.schedule(command::RestoreParameters{kNonPwm});
  bench.run(1);
  EXPECT_EQ(now, bench.plant.station(kNonPwm)->axis->file_parameters());
  EXPECT_NEAR(coast(bench), before, 0.5);
}

TEST(PlantAxis, AChangedDeadZoneAndSpeedActOnTheNextDrive) {
  Bench bench(exact_parameters());
  const std::uint32_t half = kMaxDrive / 2;
  bench.schedule(change(kNonPwm, "dead_zone_fraction", 0.6));
  bench.drive(kNonPwm, Sense::kIncreasing, half);
  const double start = bench.position(kNonPwm);
  bench.run(300);
  EXPECT_EQ(bench.position(kNonPwm), start);
  bench.schedule(command::RestoreParameters{kNonPwm});
  bench.schedule(change(kNonPwm, "full_speed_counts_per_s", 250));
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(100);
  const double before = bench.position(kNonPwm);
  bench.run(100);
  EXPECT_NEAR(bench.position(kNonPwm) - before, 25, 0.01);
}

TEST(PlantAxis, ChangedNoiseIsReadAndOtherAxesKeepTheirs) {
  Bench bench(exact_parameters());
  bench.schedule(change(kNonPwm, "noise_counts", 7));
  bench.schedule(change(kNonPwm, "noise_chance", 1));
  bench.run(3);
  EXPECT_EQ(bench.counter(kNonPwm), 7);
  EXPECT_EQ(bench.counter(kAnalog), 0);
}

TEST(PlantAxis, EndStopsHoldTheAxisALittleBeyondItsLimits) {
  Bench bench(exact_parameters());
  bench.drive(kPwm, Sense::kIncreasing, kMaxDrive);
  bench.drive(kLower, Sense::kDecreasing, kMaxDrive);
  bench.run(1000);
  EXPECT_EQ(bench.position(kPwm), 8 + 60);
  EXPECT_EQ(bench.position(kLower), 0 - 60);
}

TEST(PlantAxis, JammedAxisStandsStillWhateverIsDriven) {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(50);
  bench.schedule(command::JamAxis{kNonPwm, true});
  bench.run(1);
  const double jammed_at = bench.position(kNonPwm);
  bench.run(200);
  EXPECT_EQ(bench.position(kNonPwm), jammed_at);
  bench.schedule(command::JamAxis{kNonPwm, false});
  bench.run(50);
  EXPECT_GT(bench.position(kNonPwm), jammed_at + 20);
}

TEST(PlantAxis, PushMovesTheAxisByHandOverAHundredTicks) {
  Bench bench(exact_parameters());
  bench.schedule(command::PushAxis{kNonPwm, -40});
  bench.run(50);
  EXPECT_NEAR(bench.position(kNonPwm), -20, 1e-6);
  bench.run(200);
  EXPECT_NEAR(bench.position(kNonPwm), -40, 1e-6);
}

TEST(PlantAxis, RunawayMovesWithoutDriveUntilItIsEnded) {
  Bench bench(exact_parameters());
  bench.schedule(command::RunAway{kNonPwm, 2.5});
  bench.run(100);
  EXPECT_NEAR(bench.position(kNonPwm), 250, 1e-6);
  bench.schedule(command::RunAway{kNonPwm, 0});
  bench.run(200);
  const double rest = bench.position(kNonPwm);
  bench.run(200);
  EXPECT_EQ(bench.position(kNonPwm), rest);
}

TEST(PlantAxis, ReversedMotorRunsAgainstItsCommand) {
  Bench bench(exact_parameters());
  bench.schedule(command::ReverseMotor{kNonPwm, true});
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(100);
  EXPECT_LT(bench.position(kNonPwm), -80);
}

TEST(PlantAxis, HighFrequencySpeedFollowsThePublishedMap) {
  constexpr std::uint32_t kSlowest = 1196612456u;
  constexpr std::uint32_t kStep = 4063228u;
  EXPECT_EQ(published_speed_rpm(kSlowest, false), 0);
  EXPECT_EQ(published_speed_rpm(kSlowest + 1, false), 0);
  EXPECT_EQ(published_speed_rpm(0, false), 0);
  EXPECT_DOUBLE_EQ(published_speed_rpm(kSlowest - 10 * kStep, false), 11.445);
  EXPECT_DOUBLE_EQ(published_speed_rpm(kSlowest - 10 * kStep, true), 10.636);
  EXPECT_DOUBLE_EQ(published_speed_rpm(kSlowest - 23 * kStep, false), 397.785);
  EXPECT_DOUBLE_EQ(published_speed_rpm(kSlowest - 30 * kStep, true), 391.709);
  EXPECT_NEAR(published_speed_rpm(kSlowest - 20 * kStep - kStep / 2, false), (188.106 + 247.388) / 2, 1e-6);
}

TEST(PlantAxis, HighFrequencyMotorNeedsTwoEqualWavesOfOppositeTables) {
  for (const std::size_t word : {2u, 3u, 4u, 5u}) {
    Bench bench(exact_parameters());
    bench.drive(kHighFrequency, Sense::kIncreasing, 1196612456u - 15 * 4063228u);
    bench.exchange.frame[kHighFrequency][word] ^= word % 2 == 0 ? 1u << 24 : 1u;
    bench.run(100);
    EXPECT_EQ(bench.position(kHighFrequency), 0) << "word " << word;
  }
}

TEST(PlantAxis, HighFrequencySpeedGrowsWithTheAmplitude) {
  Bench bench(exact_parameters());
  bench.drive(kHighFrequency, Sense::kIncreasing, 1196612456u - 20 * 4063228u);
  bench.run(50);
  const double start = bench.position(kHighFrequency);
  bench.run(100);
  const double full = bench.position(kHighFrequency) - start;
  EXPECT_NEAR(full, 188.106 / 60 * (5000.0 / 3) / 10, 0.01);
  for (const std::size_t word : {2u, 4u}) {
    bench.exchange.frame[kHighFrequency][word] -= 100;
  }
  bench.run(50);
  const double half_start = bench.position(kHighFrequency);
  bench.run(100);
  EXPECT_NEAR(bench.position(kHighFrequency) - half_start, full / 2, 0.01);
}

TEST(PlantAxis, MotorWithoutItsAmplifierDoesNotMove) {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.exchange.frame[kNonPwm][14] = 0;
  bench.run(100);
  EXPECT_EQ(bench.position(kNonPwm), 0);
}

TEST(PlantAxis, NonPwmMotorNeedsTheEnableBitOfItsWord) {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.exchange.frame[kNonPwm][3] &= ~0x40000000u;
  bench.run(100);
  EXPECT_EQ(bench.position(kNonPwm), 0);
}

}  // namespace
}  // namespace interlock::plant::test
