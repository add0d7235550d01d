#include "closed_loop.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::minute_ticks;
using test::neuro;
using test::neuro_config;

/** Latency of the link in ticks: the real clock, and the farthest that a simulated kernel runs ahead. */
class ManualModeOnThePlant : public testing::TestWithParam<std::uint32_t> {};

TEST_P(ManualModeOnThePlant, EveryAxisArrivesWithinItsDeadbandAndRests) {
  std::mt19937 random(GetParam());
  for (const Axis& axis : neuro().axes) {
    SCOPED_TRACE(axis.name);
    ClosedLoop loop(random(), GetParam());
    loop.make_ready(axis.slot);
    ASSERT_EQ(loop.state().system.mode, static_cast<std::uint32_t>(ILK_MODE_MOTION));
    std::uniform_int_distribution<std::int32_t> anywhere(axis.lowest_setpoint_counts(),
                                                         axis.highest_setpoint_counts());
    for (std::uint32_t proposal = 1; proposal <= 5; ++proposal) {
      const std::int32_t target = anywhere(random);
      const TaskStatus end = loop.carry_out(proposal, MoveTask{axis.slot, target}, minute_ticks);
      ASSERT_EQ(end.phase, TaskPhase::done)
          << "to " << target << ", reason " << static_cast<int>(end.reason) << ", code " << end.code;
      const std::int32_t position = loop.state().axis[axis.slot].position_counts;
      EXPECT_LE(std::abs(position - target), static_cast<std::int32_t>(axis.deadband_counts));
      loop.run(100);
      EXPECT_EQ(loop.outputs().command[axis.slot].drive, 0u);
    }
    EXPECT_EQ(loop.state().system.requests_refused, 0u);
  }
}

TEST_P(ManualModeOnThePlant, AnAxisThatIsNotHomedArrivesWithinItsUnhomedBounds) {
  const Axis& axis = *neuro().at_slot(test::insertion);
  const ilk_axis_config_t& rules = neuro_config().axis[test::insertion];
  ClosedLoop loop(7, GetParam());
  loop.request(ILK_REQUEST_ENABLE, axis.slot);
  loop.pedal(true);
  const std::int32_t reach =
      setpoint_range(rules, loop.state().axis[axis.slot], loop.state().system.mode).highest_counts;
  loop.give(1, MoveTask{axis.slot, reach});
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop.move(axis.slot).phase); ++i) {
    loop.run(1);
    ASSERT_LE(loop.outputs().command[axis.slot].drive, rules.unhomed_max_drive);
  }
  EXPECT_EQ(loop.move(axis.slot).phase, TaskPhase::done);
  EXPECT_EQ(loop.state().system.requests_refused, 0u);
}

TEST_P(ManualModeOnThePlant, ReleasePausesAndTheNextPressGoesOn) {
  const Axis& axis = *neuro().at_slot(test::insertion);
  ClosedLoop loop(11, GetParam());
  loop.make_ready(axis.slot);
  (void)loop.carry_out(1, MoveTask{axis.slot, 1500}, 300);
  loop.pedal(false);
  EXPECT_EQ(loop.move(axis.slot).phase, TaskPhase::paused);
  const std::int32_t paused_at = loop.state().axis[axis.slot].position_counts;
  loop.run(1000);
  EXPECT_NEAR(loop.state().axis[axis.slot].position_counts, paused_at, 1);
  loop.pedal(true);
  loop.run(5000);
  EXPECT_EQ(loop.move(axis.slot).phase, TaskPhase::done);
  EXPECT_NEAR(loop.state().axis[axis.slot].position_counts, 1500, axis.deadband_counts);
}

TEST_P(ManualModeOnThePlant, CancellingStopsTheAxisWithoutWaitingForItsLease) {
  const Axis& axis = *neuro().at_slot(test::insertion);
  ClosedLoop loop(13, GetParam());
  loop.make_ready(axis.slot);
  (void)loop.carry_out(1, MoveTask{axis.slot, 1500}, 300);
  ASSERT_GT(loop.outputs().command[axis.slot].drive, 0u);
  loop.cancel(1);
  loop.run(3 + GetParam());
  EXPECT_EQ(loop.outputs().command[axis.slot].drive, 0u);
}

TEST_P(ManualModeOnThePlant, SevenAxesAtOnceStayWithinTheRequestsOfATick) {
  ClosedLoop loop(17, GetParam());
  for (const Axis& axis : neuro().axes) {
    loop.request(ILK_REQUEST_ENABLE, axis.slot);
  }
  loop.pedal(true);
  for (const Axis& axis : neuro().axes) {
    const SetpointRange range =
        setpoint_range(loop.config().axis[axis.slot], loop.state().axis[axis.slot], loop.state().system.mode);
    const bool down = axis.limit == ILK_LIMIT_UPPER;
    loop.give(axis.slot + 1, MoveTask{axis.slot, down ? range.lowest_counts : range.highest_counts});
  }
  loop.run(minute_ticks / 2);
  for (const Axis& axis : neuro().axes) {
    EXPECT_EQ(loop.move(axis.slot).phase, TaskPhase::done) << axis.name;
  }
  EXPECT_LE(loop.most_requests_in_a_tick(), static_cast<std::uint32_t>(ILK_REQUESTS_PER_TICK));
  EXPECT_EQ(loop.state().system.requests_refused, 0u);
}

INSTANTIATE_TEST_SUITE_P(Latency, ManualModeOnThePlant, testing::Values(0u, 2u, ILK_LINK_TICKS_AHEAD));

}  // namespace
}  // namespace interlock
