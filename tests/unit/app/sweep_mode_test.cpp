#include <gtest/gtest.h>

#include <cmath>

#include "closed_loop.hpp"
#include "counted_allocations.hpp"
#include "modes/sweep/mode.hpp"
#include "proposals/checks.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::minute_ticks;
using test::prostate;

/** Slot of the prostate robot's needle rotation. */
constexpr std::uint32_t needle_turn = 0;

const ilk_axis_config_t& rotation_rules() {
  static const ilk_config_t config = test::config_of(prostate());
  return config.axis[needle_turn];
}

/** From the slowest allowed frequency to the fastest. */
SweepTask whole(std::uint32_t count, std::uint32_t dwell_ticks) {
  const FrequencyBand band = *frequency_band(*prostate().at_slot(needle_turn));
  const double step_hz = (band.highest_hz - band.lowest_hz) / (count - 1) - 0.01;  // rounding
  return {needle_turn, *frequency_steps(band.highest_hz, band.lowest_hz, step_hz, dwell_ticks)};
}

/** The fastest allowed frequency alone. */
SweepTask fastest(std::uint32_t dwell_ticks) {
  const double hz = frequency_band(*prostate().at_slot(needle_turn))->lowest_hz;
  return {needle_turn, *frequency_steps(hz, hz, 1.0, dwell_ticks)};
}

class SweepModeTest : public testing::TestWithParam<std::uint32_t> {
 protected:
  SweepModeTest() : loop_(19, GetParam(), prostate()) {
    for (const Axis& axis : prostate().axes) {
      loop_.request(ILK_REQUEST_ENABLE, axis.slot);
    }
    loop_.request(ILK_REQUEST_SET_HOME, needle_turn);
    loop_.pedal(true);
  }

  void run_to_end(std::uint32_t most_ticks) {
    for (std::uint32_t i = 0; i < most_ticks && is_open(loop_.sweep().phase); ++i) {
      loop_.tick();
    }
  }

  /** That moves the axis: a lease ends by a MOVE without amplitude. */
  [[nodiscard]] std::uint32_t drive() const {
    const ilk_command_t& command = loop_.outputs().command[needle_turn];
    return command.amplitude == 0 ? 0 : command.drive;
  }

  ClosedLoop loop_;
};

TEST_P(SweepModeTest, EachFrequencyIsHeldAndALowerOneTurnsFaster) {
  constexpr std::uint32_t count = 8;
  loop_.watch([&] {
    ASSERT_LE(drive(), rotation_rules().max_drive);
    ASSERT_TRUE(drive() == 0 || drive() >= prostate().at_slot(needle_turn)->drive.min) << drive();
  });
  loop_.give(1, whole(count, 600));
  run_to_end(minute_ticks);
  const TaskStatus status = loop_.sweep();
  ASSERT_EQ(status.phase, TaskPhase::done);
  EXPECT_EQ(status.reason, TaskReason::swept);
  EXPECT_EQ(status.step, count);
  for (std::uint32_t step = 1; step < count; ++step) {
    EXPECT_GT(loop_.sweep_speeds()[step], loop_.sweep_speeds()[step - 1]) << step;
  }
  EXPECT_EQ(loop_.refusals(), 0u);
  loop_.run(2 + GetParam());
  EXPECT_EQ(drive(), 0u);
}

TEST_P(SweepModeTest, TheMeasuredSpeedIsThatOfThePublishedMap) {
  loop_.give(1, fastest(1500));
  run_to_end(minute_ticks);
  ASSERT_EQ(loop_.sweep().phase, TaskPhase::done);
  // 138.166 rpm in this direction at that word, on a motor of 1666.7 counts a revolution.
  EXPECT_NEAR(loop_.sweep_speeds()[0], 138.166 / 60.0 * 1666.7, 4.0);
}

TEST_P(SweepModeTest, TheAxisTurnsRoundBeforeItsLimitsAndRestsBetween) {
  std::int32_t lowest = 0;
  std::int32_t highest = 0;
  std::uint32_t direction = 0;
  std::uint32_t turns = 0;
  std::uint32_t undriven = 0;
  std::uint32_t shortest_rest = minute_ticks;
  loop_.watch([&] {
    const std::int32_t position = loop_.state().axis[needle_turn].position_counts;
    lowest = std::min(lowest, position);
    highest = std::max(highest, position);
    const std::uint32_t now = loop_.outputs().command[needle_turn].direction;
    if (drive() == 0) {
      ++undriven;
      return;
    }
    if (direction != 0 && now != direction) {
      ++turns;
      shortest_rest = std::min(shortest_rest, undriven);
    }
    direction = now;
    undriven = 0;
  });
  loop_.give(1, fastest(15'000));
  run_to_end(minute_ticks);
  ASSERT_EQ(loop_.sweep().phase, TaskPhase::done);
  EXPECT_GE(turns, 3u);
  EXPECT_GE(shortest_rest, 50u);
  EXPECT_GE(lowest, rotation_rules().min_counts);
  EXPECT_LE(highest, rotation_rules().max_counts);
  EXPECT_LT(lowest, rotation_rules().min_counts / 2);
}

TEST_P(SweepModeTest, ReleasePausesAndTheNextPressGoesOnWithTheSameFrequency) {
  loop_.give(1, whole(6, 500));
  loop_.run(1500);
  ASSERT_EQ(loop_.sweep().phase, TaskPhase::executing);
  loop_.happen(plant::command::PressPedal{false});
  loop_.run(5);
  EXPECT_EQ(drive(), 0u);
  loop_.run(1000);
  EXPECT_EQ(loop_.sweep().phase, TaskPhase::paused);
  const std::uint32_t step = loop_.sweep().step;
  EXPECT_GE(step, 2u);
  EXPECT_LT(step, 5u);
  loop_.pedal(true);
  EXPECT_EQ(loop_.sweep().step, step);
  run_to_end(minute_ticks);
  EXPECT_EQ(loop_.sweep().phase, TaskPhase::done);
}

TEST_P(SweepModeTest, APauseThatLastsTooLongExpires) {
  loop_.give(1, whole(6, 500));
  loop_.run(100);
  loop_.pedal(false);
  loop_.run(minute_ticks + 10);
  EXPECT_EQ(loop_.sweep().phase, TaskPhase::expired);
  EXPECT_EQ(loop_.sweep().reason, TaskReason::waited_too_long);
}

TEST_P(SweepModeTest, ACancelStopsWithinTheLatencyOfTheLink) {
  loop_.give(1, whole(6, 500));
  loop_.run(700);
  ASSERT_GT(drive(), 0u);
  loop_.cancel(1);
  loop_.run(2 + GetParam());
  EXPECT_EQ(drive(), 0u);
  EXPECT_EQ(loop_.sweep().reason, TaskReason::cancelled);
}

TEST_P(SweepModeTest, ADisabledAxisEndsTheSweepWithItsReason) {
  loop_.give(1, whole(6, 500));
  loop_.run(700);
  loop_.request(ILK_REQUEST_DISABLE, needle_turn);
  const TaskStatus order = loop_.sweep();
  EXPECT_FALSE(is_open(order.phase));
  // A MOVE that is on its way when the axis is disabled comes back refused before the snapshot shows it.
  const bool refused = order.reason == TaskReason::kernel_refused && order.code == ILK_VERDICT_DISABLED;
  EXPECT_TRUE(refused || order.reason == TaskReason::axis_disabled);
}

TEST_P(SweepModeTest, TheKernelRefusesWhatIsFasterThanTheBandAndTheSweepEnds) {
  SweepTask order = fastest(500);
  order.steps.first_word -= frequency_map::word_step;
  loop_.give(1, order);
  run_to_end(1000);
  EXPECT_EQ(loop_.sweep().phase, TaskPhase::refused);
  EXPECT_EQ(loop_.sweep().code, static_cast<std::uint32_t>(ILK_VERDICT_DRIVE));
  EXPECT_EQ(drive(), 0u);
}

TEST_P(SweepModeTest, ATickAllocatesNothing) {
  loop_.give(1, whole(6, 500));
  loop_.run(700);
  SweepMode mode{RobotPlan(prostate(), loop_.config())};
  mode.take(test::task_of(1, whole(6, 500)), loop_.state().system.tick);
  ilk_snapshot_t snapshot{};
  snapshot.state = loop_.state();
  test::count_allocations_of(pthread_self());
  for (std::uint32_t i = 0; i < 100; ++i) {
    KernelRequests requests;
    ++snapshot.state.system.tick;
    mode.tick(snapshot, requests);
  }
  const std::uint32_t allocated = test::counted_allocations();
  test::count_allocations_of();
  EXPECT_EQ(allocated, 0u);
}

INSTANTIATE_TEST_SUITE_P(Latencies, SweepModeTest, testing::Values(2u, 10u));

}  // namespace
}  // namespace interlock
