#include <gtest/gtest.h>

#include <cstring>

#include "bench.hpp"

namespace interlock::plant::test {
namespace {

TEST(PlantRecord, HoldsEveryExchangeAsItWasOnTheWire) {
  Bench bench(exact_parameters());
  bench.run(10);
  bench.drive(kNonPwm, Sense::kIncreasing, 100'000);
  bench.schedule(command::PressPedal{true});
  bench.run(30);
  bench.stop(kNonPwm);
  bench.run(1);
  const Record& record = bench.plant.record();
  ASSERT_EQ(record.end() - record.begin(), 41u);
  EXPECT_EQ(record[9].drive[kNonPwm], 0u);
  EXPECT_EQ(record[9].pedal_no_closed, false);
  const RecordEntry& driven = record[39];
  EXPECT_EQ(driven.tick, 39u);
  EXPECT_EQ(driven.kernel_tick, 40u);
  EXPECT_EQ(driven.drive[kNonPwm], 0x40000000u + 100'000) << "increasing with motor direction 0";
  EXPECT_TRUE(driven.amplifier[kNonPwm]);
  EXPECT_FALSE(driven.amplifier[kPwm]);
  EXPECT_TRUE(driven.pedal_no_closed);
  EXPECT_FALSE(driven.pedal_nc_closed);
  EXPECT_TRUE(driven.estop_loop_closed);
  EXPECT_LT(static_cast<std::int32_t>(driven.counter[kNonPwm]), -15);
  EXPECT_EQ(record[40].drive[kNonPwm], 0u);
  EXPECT_FALSE(record[40].amplifier[kNonPwm]);
}

TEST(PlantRecord, DriveIsZeroOnlyWhenEveryDriveWordIs) {
  for (const std::size_t word : {2u, 3u, 4u, 5u, 6u, 14u}) {
    Bench bench(exact_parameters());
    bench.exchange.frame[kPwm][word] = 1;
    bench.run(1);
    EXPECT_EQ(bench.plant.record()[0].drive[kPwm], 1u) << "word " << word;
  }
}

TEST(PlantRecord, KeepsAtLeastTheLastTwoMinutes) {
  Bench bench(exact_parameters());
  bench.run(140'000);
  const Record& record = bench.plant.record();
  EXPECT_GE(record.end() - record.begin(), 120'000u);
  EXPECT_EQ(record[record.begin()].tick, record.begin());
  EXPECT_EQ(record.find(100'000), 100'000u);
  EXPECT_EQ(record.find(0), record.begin());
  EXPECT_EQ(record.find(140'000), record.end());
}

TEST(PlantRecord, EventsGiveTheTickInWhichTheyWereRead) {
  Bench bench(default_parameters(sample_robot()));
  const Record& record = bench.plant.record();
  EXPECT_FALSE(record.newest(Event::kPedalPressed));
  bench.schedule(command::PressPedal{true}, 10);
  bench.schedule(command::PressPedal{false}, 60);
  bench.schedule(command::PullEstop{true}, 80);
  bench.schedule(command::PullEstop{false}, 90);
  bench.run(30);
  bench.drive(kPwm, Sense::kDecreasing, 50'000);
  bench.run(20);
  bench.stop(kPwm);
  bench.run(50);
  EXPECT_GE(record.newest(Event::kPedalPressed), 11u) << "the second contact follows by a millisecond";
  EXPECT_LE(record.newest(Event::kPedalPressed), 14u) << "the first one bounces for three";
  EXPECT_EQ(record.newest(Event::kPedalReleased), 60u);
  EXPECT_EQ(record.newest(Event::kEstopPulled), 80u);
  EXPECT_EQ(record.newest(Event::kEstopReleased), 90u);
  EXPECT_EQ(record.newest(Event::kLastNonzeroDrive), 49u);
  EXPECT_EQ(record.newest(Event::kAmplifiersOff), 50u);
  EXPECT_FALSE(record.newest(Event::kKernelSilent));
}

TEST(PlantRecord, SilentKernelAndItsAmplifiersAreNotedWithinFiveMilliseconds) {
  Bench bench(exact_parameters());
  bench.drive(kPwm, Sense::kDecreasing, 50'000);
  bench.drive(kNonPwm, Sense::kDecreasing, 50'000);
  bench.run(100);
  bench.plant.advance(Microseconds{50'000});
  EXPECT_EQ(bench.plant.record().newest(Event::kKernelSilent), 99u);
  EXPECT_EQ(bench.plant.record().newest(Event::kAmplifiersOff), 104u);
}

TEST(PlantSchedule, CommandsActAtTheirTickInTheOrderOfArrival) {
  Bench bench(exact_parameters());
  bench.schedule(command::JumpCounter{kPwm, 5}, 20);
  bench.schedule(command::ResetCard{kPwm}, 20);
  bench.schedule(command::JumpCounter{kPwm, 3}, 20);
  bench.schedule(command::JumpCounter{kPwm, 100}, 10);
  bench.run(10);
  EXPECT_EQ(bench.counter(kPwm), 0);
  bench.run(1);
  EXPECT_EQ(bench.counter(kPwm), 100);
  bench.run(10);
  EXPECT_EQ(bench.counter(kPwm), 3);
}

TEST(PlantSchedule, RefusedCommandNamesItsReasonAndChangesNothing) {
  Bench refusing(default_parameters(sample_robot()));
  Bench untouched(default_parameters(sample_robot()));
  refusing.run(5);
  untouched.run(5);
  const auto reason = [&refusing](const command::Command& command, std::optional<std::uint64_t> at = {}) {
    const auto tick = refusing.plant.schedule(command, at);
    return tick ? std::string("accepted") : tick.error();
  };
  EXPECT_EQ(reason(command::JamAxis{kEmpty, true}), "slot 8 has no card");
  EXPECT_EQ(reason(command::JamAxis{kSensor, true}), "slot 9 has a sensor card, no axis");
  EXPECT_EQ(reason(command::ResetCard{10}), "slot 10 has no card");
  EXPECT_EQ(reason(command::SpoilFrames{kEmpty, FrameFault::kDrop, 1}), "slot 8 has no card");
  EXPECT_EQ(reason(command::StickSwitch{kNonPwm, true}), "slot 2 has an axis without a limit switch");
  EXPECT_EQ(reason(command::PullEstop{true}, 4), "'at' 4 is past; the plant is at tick 5");
  refusing.run(100);
  untouched.run(100);
  EXPECT_EQ(std::memcmp(&refusing.reply, &untouched.reply, sizeof refusing.reply), 0);
}

TEST(PlantSchedule, IsBounded) {
  Bench bench(exact_parameters());
  for (std::size_t n = 0; n < Schedule::kCapacity; ++n) {
    bench.schedule(command::PullEstop{true}, 10);
  }
  EXPECT_FALSE(bench.plant.schedule(command::PullEstop{true}, 10));
  bench.run(11);
  EXPECT_TRUE(bench.plant.schedule(command::PullEstop{true}));
}

}  // namespace
}  // namespace interlock::plant::test
