#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "bench.hpp"

namespace interlock::plant::test {
namespace {

constexpr std::uint32_t kStatusAmplifier = 1;
constexpr std::uint32_t kStatusWatchdog = 2;
constexpr std::uint32_t kStatusBadFrame = 4;
constexpr std::uint32_t kStatusReset = 8;

Bench moving_bench() {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(50);
  return bench;
}

bool amplifier_on(const Bench& bench, std::size_t slot) {
  return bench.plant.station(slot)->card.amplifier_on();
}

TEST(PlantCard, EveryCardAnswersSoundFramesAndEmptySlotsNothing) {
  Bench bench(exact_parameters());
  bench.run(1);
  EXPECT_EQ(bench.reply.frames_received,
            1u << kPwm | 1u << kNonPwm | 1u << kLower | 1u << kAnalog | 1u << kHighFrequency | 1u << kSensor);
  for (const std::size_t slot : {kPwm, kNonPwm, kLower, kAnalog, kHighFrequency, kSensor}) {
    EXPECT_TRUE(bench.sound(slot)) << "slot " << slot;
  }
  EXPECT_EQ(bench.word(kEmpty, 0), 0u);
}

TEST(PlantCard, AnswerWasLatchedBeforeTheFrameOfTheSameTransaction) {
  Bench bench(exact_parameters());
  bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
  bench.run(1);
  EXPECT_EQ(bench.word(kNonPwm, 11), 0u) << "nothing was heard before the first frame";
  EXPECT_EQ(bench.word(kNonPwm, 12) & kStatusAmplifier, 0u);
  bench.run(1);
  EXPECT_EQ(bench.word(kNonPwm, 11), 1u) << "tick of the frame before";
  EXPECT_EQ(bench.word(kNonPwm, 12) & kStatusAmplifier, kStatusAmplifier);
}

TEST(PlantCard, HeartbeatAndTimestampCountTransactionsAndMicroseconds) {
  Bench bench(exact_parameters());
  bench.run(10);
  const std::uint32_t heartbeat = bench.word(kSensor, 9);
  const std::uint32_t time_us = bench.word(kSensor, 10);
  bench.run(1);
  EXPECT_EQ(bench.word(kSensor, 9), heartbeat + 1);
  EXPECT_EQ(bench.word(kSensor, 10), time_us + 1000);
}

TEST(PlantCard, WatchdogDropsTheAmplifierAfterFiveMillisecondsOfSilence) {
  Bench bench = moving_bench();
  const Microseconds silent_since = bench.plant.time() - bench.plant.period();
  bench.plant.advance(silent_since + Microseconds{4999} - bench.plant.time());
  EXPECT_TRUE(amplifier_on(bench, kNonPwm));
  bench.plant.advance(Microseconds{1});
  EXPECT_FALSE(amplifier_on(bench, kNonPwm));
  bench.run(1);
  EXPECT_EQ(bench.word(kNonPwm, 12) & (kStatusWatchdog | kStatusAmplifier), kStatusWatchdog);
  bench.run(1);
  EXPECT_EQ(bench.word(kNonPwm, 12) & (kStatusWatchdog | kStatusAmplifier), kStatusAmplifier)
      << "driven again by the next frame";
}

TEST(PlantCard, WatchdogActsAtItsMomentWithinALongStepOfTime) {
  Bench in_one_step = moving_bench();
  Bench in_small_steps = moving_bench();
  in_one_step.plant.advance(Microseconds{1'000'000});
  for (int n = 0; n < 10'000; ++n) {
    in_small_steps.plant.advance(Microseconds{100});
  }
  EXPECT_NEAR(in_one_step.position(kNonPwm), in_small_steps.position(kNonPwm), 0.05);
}

TEST(PlantCard, RepeatedFrameOfTheKernelDoesNotFeedTheWatchdog) {
  Bench bench = moving_bench();
  for (int n = 0; n < 4; ++n) {
    bench.plant.tick(bench.exchange);
  }
  EXPECT_FALSE(amplifier_on(bench, kNonPwm));
}

TEST(PlantCard, DamagedFrameOfTheKernelIsIgnoredAndReported) {
  for (std::size_t word = 0; word < ILK_FRAME_WORDS; ++word) {
    Bench bench(exact_parameters());
    bench.run(2);
    bench.drive(kNonPwm, Sense::kIncreasing, kMaxDrive);
    bench.run(1);
    bench.exchange.frame[kNonPwm][13] += 1;
    bench.exchange.frame[kNonPwm][ILK_FRAME_WORDS - 1] -= 1;
    bench.exchange.frame[kNonPwm][word] ^= 0x10u;
    bench.plant.tick(bench.exchange);
    bench.run(1);
    EXPECT_EQ(bench.word(kNonPwm, 12) & kStatusBadFrame, kStatusBadFrame) << "word " << word;
    EXPECT_EQ(bench.word(kNonPwm, 11), bench.kernel_tick - 2) << "echo of the frame before, word " << word;
    bench.run(1);
    EXPECT_EQ(bench.word(kNonPwm, 12) & kStatusBadFrame, 0u) << "word " << word;
  }
}

TEST(PlantCard, CorruptFrameFailsItsChecksumForTheGivenCount) {
  Bench bench(exact_parameters());
  bench.run(5);
  bench.schedule(command::SpoilFrames{kNonPwm, FrameFault::kCorrupt, 300});
  for (int n = 0; n < 300; ++n) {
    bench.run(1);
    EXPECT_TRUE(bench.answered(kNonPwm));
    EXPECT_FALSE(bench.sound(kNonPwm));
    EXPECT_TRUE(bench.sound(kPwm));
  }
  bench.run(1);
  EXPECT_TRUE(bench.sound(kNonPwm));
}

TEST(PlantCard, DroppedFrameDoesNotArrive) {
  Bench bench(exact_parameters());
  bench.run(5);
  const std::uint32_t heartbeat = bench.word(kNonPwm, 9);
  bench.schedule(command::SpoilFrames{kNonPwm, FrameFault::kDrop, 1});
  bench.run(1);
  EXPECT_FALSE(bench.answered(kNonPwm));
  bench.run(1);
  EXPECT_TRUE(bench.answered(kNonPwm));
  EXPECT_EQ(bench.word(kNonPwm, 9), heartbeat + 2);
}

TEST(PlantCard, RepeatedFrameIsTheLastOneAgain) {
  Bench bench(exact_parameters());
  bench.run(5);
  const ilk_sim_reply_t before = bench.reply;
  bench.schedule(command::SpoilFrames{kNonPwm, FrameFault::kRepeat, 2});
  for (int n = 0; n < 2; ++n) {
    bench.run(1);
    EXPECT_EQ(std::memcmp(bench.reply.frame[kNonPwm], before.frame[kNonPwm], sizeof before.frame[0]), 0);
  }
  bench.run(1);
  EXPECT_EQ(bench.word(kNonPwm, 9), before.frame[kNonPwm][9] + 3);
}

TEST(PlantCard, DelayedFrameIsOneTransactionLate) {
  Bench bench(exact_parameters());
  bench.run(5);
  const std::uint32_t heartbeat = bench.word(kNonPwm, 9);
  bench.schedule(command::SpoilFrames{kNonPwm, FrameFault::kDelay, 3});
  for (std::uint32_t late = 0; late < 3; ++late) {
    bench.run(1);
    EXPECT_EQ(bench.word(kNonPwm, 9), heartbeat + late);
    EXPECT_EQ(bench.word(kNonPwm, 11), bench.kernel_tick - 3) << "echo of the frame before the last";
  }
  bench.run(1);
  EXPECT_EQ(bench.word(kNonPwm, 9), heartbeat + 4);
}

TEST(PlantCard, DeafCardAnswersButDropsItsAmplifier) {
  Bench bench = moving_bench();
  const std::uint32_t heard = bench.kernel_tick - 1;
  bench.schedule(command::SpoilFrames{kNonPwm, FrameFault::kDeaf, 10});
  bench.run(10);
  EXPECT_TRUE(bench.sound(kNonPwm));
  EXPECT_EQ(bench.word(kNonPwm, 11), heard);
  EXPECT_FALSE(amplifier_on(bench, kNonPwm));
  bench.run(1);
  EXPECT_TRUE(amplifier_on(bench, kNonPwm));
}

TEST(PlantCard, FaultOfAllFramesReachesEveryCard) {
  Bench bench(exact_parameters());
  bench.run(1);
  bench.schedule(command::SpoilFrames{std::nullopt, FrameFault::kDrop, 1});
  bench.run(1);
  EXPECT_EQ(bench.reply.frames_received, 0u);
}

TEST(PlantCard, ResetRestartsCounterHeartbeatAndAmplifier) {
  Bench bench = moving_bench();
  ASSERT_NE(bench.counter(kNonPwm), 0);
  bench.schedule(command::ResetCard{kNonPwm});
  bench.run(1);
  EXPECT_EQ(bench.counter(kNonPwm), 0);
  EXPECT_EQ(bench.word(kNonPwm, 9), 0u);
  EXPECT_EQ(bench.word(kNonPwm, 11), 0u);
  EXPECT_EQ(bench.word(kNonPwm, 12), kStatusReset);
  const double position = bench.position(kNonPwm);
  bench.run(10);
  EXPECT_GT(bench.position(kNonPwm), position) << "the mechanics go on";
}

TEST(PlantCard, UnpluggedCardIsSilentAndRestartsWhenPlugged) {
  Bench bench = moving_bench();
  bench.schedule(command::PowerCard{kNonPwm, false});
  bench.run(1);
  EXPECT_FALSE(bench.answered(kNonPwm));
  EXPECT_FALSE(amplifier_on(bench, kNonPwm));
  bench.run(100);
  bench.schedule(command::PowerCard{kNonPwm, true});
  bench.run(1);
  EXPECT_TRUE(bench.sound(kNonPwm));
  EXPECT_EQ(bench.word(kNonPwm, 9), 0u);
  EXPECT_EQ(bench.word(kNonPwm, 12), kStatusReset);
}

TEST(PlantCard, FailedTransactionReachesNoCardButInputsAreRead) {
  Bench bench(exact_parameters());
  bench.schedule(command::PressPedal{true});
  bench.run(5);
  const std::uint32_t heartbeat = bench.word(kPwm, 9);
  bench.schedule(command::FailTransactions{2});
  bench.run(2);
  EXPECT_EQ(bench.reply.frames_received, 0u);
  EXPECT_EQ(bench.reply.pedal_no_closed, 1u);
  bench.run(1);
  EXPECT_EQ(bench.word(kPwm, 9), heartbeat + 1);
}

TEST(PlantCard, JumpAddsCountsAtOnce) {
  Bench bench(exact_parameters());
  bench.run(2);
  const std::int32_t before = bench.counter(kPwm);
  bench.schedule(command::JumpCounter{kPwm, -5000});
  bench.run(1);
  EXPECT_EQ(bench.counter(kPwm), before - 5000);
}

TEST(PlantCard, CounterWrapsAtItsEnd) {
  Bench bench(exact_parameters());
  for (int n = 0; n < 2148; ++n) {
    bench.schedule(command::JumpCounter{kAnalog, 1'000'000});
  }
  bench.run(1);
  EXPECT_EQ(bench.word(kAnalog, 3), 2'148'000'000u);
  EXPECT_LT(bench.counter(kAnalog), 0);
}

TEST(PlantCard, StuckEncoderLosesWhatMovedMeanwhile) {
  Bench bench = moving_bench();
  bench.schedule(command::StickEncoder{kNonPwm, true});
  bench.run(1);
  const std::int32_t frozen = bench.counter(kNonPwm);
  bench.run(100);
  EXPECT_EQ(bench.counter(kNonPwm), frozen);
  bench.schedule(command::StickEncoder{kNonPwm, false});
  bench.run(1);
  EXPECT_EQ(bench.counter(kNonPwm), frozen);
  bench.run(100);
  EXPECT_NEAR(bench.counter(kNonPwm), frozen - 100, 1);
}

TEST(PlantCard, CounterIsQuantisedAndNoiseStaysWithinItsCounts) {
  Parameters parameters = exact_parameters();
  parameters.axis[kNonPwm].noise_counts = 1;
  parameters.axis[kNonPwm].noise_chance = 0.1;
  Bench bench(parameters);
  std::set<std::int32_t> readings;
  int flips = 0;
  for (int n = 0; n < 5000; ++n) {
    bench.run(1);
    readings.insert(bench.counter(kNonPwm));
    flips += bench.counter(kNonPwm) != 0 ? 1 : 0;
  }
  EXPECT_EQ(readings, (std::set<std::int32_t>{0, 1}));
  EXPECT_NEAR(flips, 500, 100);
}

TEST(PlantCard, ClearEndsEveryFaultButNotPedalAndEstop) {
  Bench bench(exact_parameters());
  bench.schedule(command::PressPedal{true});
  bench.schedule(command::PullEstop{true});
  bench.schedule(command::JamAxis{kPwm, true});
  bench.schedule(command::RunAway{kLower, 1});
  bench.schedule(command::ReverseMotor{kNonPwm, true});
  bench.schedule(command::StickEncoder{kAnalog, true});
  bench.schedule(command::StickSwitch{kPwm, true});
  bench.schedule(command::StickPedalContact{true, false});
  bench.schedule(command::SpoilFrames{std::nullopt, FrameFault::kCorrupt, 1000});
  bench.schedule(command::SpoilFrames{std::nullopt, FrameFault::kDeaf, 1000});
  bench.schedule(command::PowerCard{kSensor, false});
  bench.run(10);
  bench.schedule(command::FailTransactions{1000});
  bench.run(1);
  bench.schedule(command::Clear{});
  bench.run(2);
  EXPECT_TRUE(bench.sound(kSensor));
  EXPECT_TRUE(bench.sound(kPwm));
  EXPECT_EQ(bench.word(kPwm, 11), bench.kernel_tick - 2);
  EXPECT_FALSE(bench.switch_triggered(kPwm));
  EXPECT_EQ(bench.reply.pedal_no_closed, 1u);
  EXPECT_EQ(bench.reply.estop_loop_closed, 0u);
  const auto& axis = *bench.plant.station(kPwm)->axis;
  EXPECT_FALSE(axis.is_jammed() || axis.is_reversed());
  EXPECT_FALSE(bench.plant.station(kLower)->axis->runaway_counts_per_s());
  EXPECT_FALSE(bench.plant.station(kAnalog)->card.encoder()->is_stuck());
}

}  // namespace
}  // namespace interlock::plant::test
