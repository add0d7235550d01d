#include "motion/setpoint_range.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "closed_loop.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::neuro_config;

constexpr std::uint32_t slot = test::insertion;

const ilk_axis_config_t& rules() { return neuro_config().axis[slot]; }

/** The range is right when the kernel accepts its ends and refuses what lies one count beyond, or beyond the
 * noise that an axis that is not homed keeps off. */
void expect_kernel_agrees(ClosedLoop& loop) {
  const bool homed = loop.state().axis[slot].homed != 0;
  const std::int32_t beyond = 1 + (homed ? 0 : 2 * static_cast<std::int32_t>(rules().noise_counts));
  const SetpointRange range = setpoint_range(rules(), loop.state().axis[slot], loop.state().system.mode);
  EXPECT_EQ(loop.verdict_of_move(slot, range.lowest_counts, 1), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(loop.verdict_of_move(slot, range.highest_counts, 1), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(loop.verdict_of_move(slot, range.lowest_counts - beyond, 1), ILK_VERDICT_RANGE);
  EXPECT_EQ(loop.verdict_of_move(slot, range.highest_counts + beyond, 1), ILK_VERDICT_RANGE);
}

void expect_kernel_agrees_on_drive(ClosedLoop& loop) {
  const std::uint32_t bound = drive_bound(rules(), loop.state().axis[slot]);
  const std::int32_t here =
      setpoint_range(rules(), loop.state().axis[slot], loop.state().system.mode).lowest_counts;
  EXPECT_EQ(loop.verdict_of_move(slot, here, bound), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(loop.verdict_of_move(slot, here, bound + 1), ILK_VERDICT_DRIVE);
}

TEST(SetpointRange, OfAHomedAxisIsTheKernels) {
  ClosedLoop loop(1, 0);
  loop.make_ready(slot);
  expect_kernel_agrees(loop);
  expect_kernel_agrees_on_drive(loop);
}

TEST(SetpointRange, OfAnAxisThatIsNotHomedIsTheKernels) {
  ClosedLoop loop(2, 0);
  loop.request(ILK_REQUEST_ENABLE, slot);
  loop.pedal(true);
  expect_kernel_agrees(loop);
  expect_kernel_agrees_on_drive(loop);
}

TEST(SetpointRange, FollowsWhereThePedalWasPressed) {
  ClosedLoop loop(3, 0);
  loop.request(ILK_REQUEST_ENABLE, slot);
  loop.pedal(true);
  ASSERT_EQ(loop.carry_out(1, MoveTask{slot, 60}, 5000).phase, TaskPhase::done);
  expect_kernel_agrees(loop);
  loop.pedal(false);
  const std::int32_t position = loop.state().axis[slot].position_counts;
  const SetpointRange before = setpoint_range(rules(), loop.state().axis[slot], loop.state().system.mode);
  EXPECT_EQ(before.highest_counts - position, position - before.lowest_counts);
  loop.pedal(true);
  EXPECT_EQ(setpoint_range(rules(), loop.state().axis[slot], loop.state().system.mode), before);
  expect_kernel_agrees(loop);
}

TEST(SetpointRange, SaturatesAtTheEndsOfTheCounter) {
  ilk_axis_t axis{};
  axis.position_counts = std::numeric_limits<std::int32_t>::max();
  const SetpointRange range = setpoint_range(rules(), axis, ILK_MODE_READY);
  EXPECT_EQ(range.highest_counts, std::numeric_limits<std::int32_t>::max());
  EXPECT_LT(range.lowest_counts, range.highest_counts);
}

}  // namespace
}  // namespace interlock
