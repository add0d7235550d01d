#include "recorder/full_rate.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "recorded_run.hpp"

namespace interlock::recorder {
namespace {

using recorder_test::KnownTick;
using recorder_test::RecordedRun;

constexpr std::uint32_t slot = 2;

class FullRate : public testing::Test {
 protected:
  /** So many ticks of the random world, each of which is known. */
  void run(std::uint32_t ticks) {
    run_.run(ticks, [this](const KnownTick& tick) { known_[tick.picture.state.system.tick] = tick; });
  }

  [[nodiscard]] std::vector<AxisTick> read(const AxisSpan& span) const {
    return full_rate(run_.ring(), span);
  }

  RecordedRun run_{7, 2};
  std::map<std::uint32_t, KnownTick> known_;
};

TEST_F(FullRate, EachTickIsAsTheKernelKnewIt) {
  run(1500);
  constexpr std::uint32_t sensor = 5;
  const std::vector<AxisTick> ticks = read({slot, 1, std::nullopt, sensor});
  ASSERT_EQ(ticks.size(), 1000U);
  EXPECT_EQ(ticks.back().tick, 1500U);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ASSERT_EQ(ticks[i].tick, 501 + i);
    const KnownTick& was = known_.at(ticks[i].tick);
    const ilk_axis_t& axis = was.picture.state.axis[slot];
    const ilk_command_t& command = was.picture.out.command[slot];
    const auto drive = static_cast<std::int32_t>(command.drive);
    EXPECT_EQ(ticks[i].begun_ns, was.begun_ns);
    EXPECT_EQ(ticks[i].position_counts,
              axis.card_valid != 0 ? std::optional(axis.position_counts) : std::nullopt);
    EXPECT_EQ(ticks[i].setpoint_counts,
              axis.state == ILK_AXIS_MOVING ? std::optional(axis.setpoint_counts) : std::nullopt);
    EXPECT_EQ(ticks[i].card_time_us, axis.card_time_us);
    const auto& frame = was.picture.inputs.frame[sensor];
    EXPECT_EQ(ticks[i].analog, was.picture.state.axis[sensor].card_valid != 0
                                   ? std::optional(AnalogWords{frame[7], frame[8]})
                                   : std::nullopt);
    EXPECT_EQ(ticks[i].drive, command.direction == ILK_DIRECTION_DECREASING ? -drive : drive);
  }
}

TEST_F(FullRate, ASensorCardThatWasNotAskedForIsNotRead) {
  run(10);
  for (const AxisTick& tick : read({slot, 1, std::nullopt, std::nullopt})) {
    EXPECT_EQ(tick.analog, std::nullopt);
  }
}

TEST_F(FullRate, EndsAtTheTickThatIsAskedFor) {
  run(1900);
  const std::vector<AxisTick> ticks = read({slot, 1, 1200, std::nullopt});
  ASSERT_EQ(ticks.size(), 1000U);
  EXPECT_EQ(ticks.front().tick, 201U);
  EXPECT_EQ(ticks.back().tick, 1200U);
}

TEST_F(FullRate, OfARunThatIsShorterThereAreAllTicks) {
  run(300);
  const std::vector<AxisTick> ticks = read({slot, 10, std::nullopt, std::nullopt});
  ASSERT_EQ(ticks.size(), 300U);
  EXPECT_EQ(ticks.front().tick, 1U);
}

TEST_F(FullRate, WhatWasOverwrittenIsLeftOut) {
  run_.run(10);
  EXPECT_EQ(read({slot, 1, 5, std::nullopt}).size(), 5U);
  run_.run(24'000);
  EXPECT_TRUE(read({slot, 1, 5, std::nullopt}).empty());
  EXPECT_FALSE(read({slot, 1, std::nullopt, std::nullopt}).empty());
}

}  // namespace
}  // namespace interlock::recorder
