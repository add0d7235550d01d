#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::plant::test {
namespace {

Parameters bouncing_parameters() {
  Parameters parameters = exact_parameters();
  parameters.pedal = PedalParameters{};
  parameters.estop = EstopParameters{};
  parameters.axis[kPwm].switch_bounce = Microseconds{20'000};
  return parameters;
}

bool reads_pressed(const Bench& bench) {
  return bench.reply.pedal_no_closed == 1 && bench.reply.pedal_nc_closed == 0;
}

TEST(PlantPedal, OpeningContactMovesFirst) {
  Parameters parameters = exact_parameters();
  parameters.pedal.lag = Microseconds{3000};
  Bench bench(parameters);
  bench.run(1);
  EXPECT_EQ(bench.reply.pedal_no_closed, 0u);
  EXPECT_EQ(bench.reply.pedal_nc_closed, 1u);
  bench.schedule(command::PressPedal{true});
  bench.run(1);
  EXPECT_EQ(bench.reply.pedal_nc_closed, 0u);
  EXPECT_EQ(bench.reply.pedal_no_closed, 0u);
  bench.run(3);
  EXPECT_TRUE(reads_pressed(bench));
  bench.schedule(command::PressPedal{false});
  bench.run(1);
  EXPECT_EQ(bench.reply.pedal_no_closed, 0u);
  EXPECT_EQ(bench.reply.pedal_nc_closed, 0u);
  bench.run(3);
  EXPECT_EQ(bench.reply.pedal_nc_closed, 1u);
}

TEST(PlantPedal, ReleaseReadsReleasedInItsVeryTickWhateverTheSeed) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Bench bench(bouncing_parameters(), seed);
    bench.schedule(command::PressPedal{true}, 5);
    bench.schedule(command::PressPedal{false}, 50);
    bench.run(50);
    ASSERT_TRUE(reads_pressed(bench));
    bench.run(1);
    ASSERT_FALSE(reads_pressed(bench)) << "seed " << seed;
  }
}

TEST(PlantPedal, ContactsBounceThenSettle) {
  int changes = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Parameters parameters = bouncing_parameters();
    parameters.pedal.bounce = Microseconds{8000};
    Bench bench(parameters, seed);
    bench.schedule(command::PressPedal{true});
    std::uint32_t last = 0;
    for (int n = 0; n < 12; ++n) {
      bench.run(1);
      changes += bench.reply.pedal_no_closed != last ? 1 : 0;
      last = bench.reply.pedal_no_closed;
    }
    for (int n = 0; n < 50; ++n) {
      bench.run(1);
      ASSERT_TRUE(reads_pressed(bench)) << "seed " << seed;
    }
  }
  EXPECT_GT(changes, 40) << "more than the one change of each press";
}

TEST(PlantPedal, StuckContactReadsAsToldUntilItIsFreed) {
  Bench bench(exact_parameters());
  bench.schedule(command::PressPedal{true});
  bench.schedule(command::StickPedalContact{true, true});
  bench.run(5);
  bench.schedule(command::PressPedal{false});
  bench.run(5);
  EXPECT_EQ(bench.reply.pedal_no_closed, 1u);
  EXPECT_EQ(bench.reply.pedal_nc_closed, 1u);
  bench.schedule(command::StickPedalContact{true, std::nullopt});
  bench.run(1);
  EXPECT_EQ(bench.reply.pedal_no_closed, 0u);
}

TEST(PlantEstop, LoopOpensInTheTickOfThePullAndClosesOnRelease) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Bench bench(bouncing_parameters(), seed);
    bench.run(3);
    EXPECT_EQ(bench.reply.estop_loop_closed, 1u);
    bench.schedule(command::PullEstop{true});
    bench.run(1);
    EXPECT_EQ(bench.reply.estop_loop_closed, 0u);
    bench.run(10);
    EXPECT_EQ(bench.reply.estop_loop_closed, 0u);
    bench.schedule(command::PullEstop{false});
    bench.run(10);
    EXPECT_EQ(bench.reply.estop_loop_closed, 1u);
  }
}

TEST(PlantSwitch, TriggersAtItsEdgeAndOpensAfterItsHysteresis) {
  Bench bench(exact_parameters());
  bench.drive(kLower, Sense::kDecreasing, kMaxDrive / 10);
  bench.run(1);
  while (!bench.switch_triggered(kLower)) {
    ASSERT_GT(bench.position(kLower), -2);
    bench.run(1);
  }
  EXPECT_LE(bench.position(kLower), 0.1);
  bench.stop(kLower);
  bench.run(100);
  bench.drive(kLower, Sense::kIncreasing, kMaxDrive / 10);
  while (bench.switch_triggered(kLower)) {
    ASSERT_LT(bench.position(kLower), 5);
    bench.run(1);
  }
  EXPECT_GT(bench.position(kLower), 3);
}

TEST(PlantSwitch, EdgeIsAtTheHomeOffset) {
  ilk_config_t robot = sample_robot();
  robot.axis[kPwm].home_offset_counts = -200;
  Bench bench(exact_parameters(), 7, robot);
  bench.drive(kPwm, Sense::kIncreasing, kMaxDrive / 10);
  bench.run(1);
  while (!bench.switch_triggered(kPwm)) {
    bench.run(1);
    ASSERT_LT(bench.position(kPwm), -198);
  }
  EXPECT_NEAR(bench.position(kPwm), -200, 0.3);
}

TEST(PlantSwitch, BouncesAfterAnEdge) {
  Bench bench(bouncing_parameters());
  bench.drive(kPwm, Sense::kIncreasing, kMaxDrive);
  int changes = 0;
  bool last = false;
  for (int n = 0; n < 330; ++n) {
    bench.run(1);
    changes += bench.switch_triggered(kPwm) != last ? 1 : 0;
    last = bench.switch_triggered(kPwm);
  }
  EXPECT_GT(changes, 3);
  EXPECT_TRUE(last);
}

TEST(PlantSwitch, StuckSwitchReadsAsTold) {
  Bench bench(exact_parameters());
  bench.schedule(command::StickSwitch{kPwm, true});
  bench.run(1);
  EXPECT_TRUE(bench.switch_triggered(kPwm));
  bench.schedule(command::StickSwitch{kPwm, false});
  bench.drive(kPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(400);
  EXPECT_GT(bench.position(kPwm), 0);
  EXPECT_FALSE(bench.switch_triggered(kPwm));
}

TEST(PlantSwitch, AxisWithoutSwitchReadsOpen) {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kDecreasing, kMaxDrive);
  for (int n = 0; n < 100; ++n) {
    bench.run(1);
    ASSERT_FALSE(bench.switch_triggered(kNonPwm));
  }
}

TEST(PlantLamps, ShowWhatTheKernelCommandedLast) {
  Bench bench(exact_parameters());
  bench.exchange.lamp[ILK_LAMP_STALL] = ILK_COLOUR_PURPLE;
  bench.run(1);
  EXPECT_EQ(bench.plant.lamps()[ILK_LAMP_STALL], ILK_COLOUR_PURPLE);
  EXPECT_EQ(bench.plant.lamps()[ILK_LAMP_PEDAL], ILK_COLOUR_OFF);
}

}  // namespace
}  // namespace interlock::plant::test
