// Homing: back off, seek, rest; what bounds it, what ends it, and that nothing else references an axis.
#include <gtest/gtest.h>

#include <string>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_lower;
constexpr int32_t offset = -980;
constexpr uint32_t rest_ticks = 20;
constexpr uint32_t timeout_ticks = 3000;

Bench enabled_bench(uint32_t slot = axis) {
  Bench bench;
  bench.to_motion();
  bench.enable_axis(slot);
  return bench;
}

Bench homing_bench(int32_t switch_at) {
  Bench bench = enabled_bench();
  bench.motor[axis].switch_at = switch_at;
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  return bench;
}

ilk_homing_phase_t phase(const Bench& bench, uint32_t slot = axis) {
  return static_cast<ilk_homing_phase_t>(bench.axis(slot).homing_phase);
}

uint32_t tick_while_homing(Bench& bench, uint32_t limit, uint32_t slot = axis) {
  uint32_t ticks = 0;
  for (; ticks < limit && bench.axis_state(slot) == ILK_AXIS_HOMING; ++ticks) bench.tick();
  return ticks;
}

class Homing : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Every_switch, Homing,
                         testing::Values(slot::pwm_lower, slot::non_pwm_upper, slot::non_pwm_inverted,
                                         slot::analog_upper, slot::high_frequency, slot::corrected_lower,
                                         slot::corrected_upper),
                         testing::PrintToStringParamName());

TEST_P(Homing, references_the_axis_at_the_edge_of_its_switch) {
  const uint32_t slot = GetParam();
  Bench bench = enabled_bench(slot);
  const ilk_axis_config_t& config = bench.config().axis[slot];
  const int32_t way = config.limit_side == ILK_LIMIT_UPPER ? 1 : -1;
  bench.motor[slot].switch_at = way * 30;
  bench.motor[slot].coast = 6;
  ASSERT_EQ(bench.ask(home(slot)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.out().command[slot].drive, config.home_drive);
  EXPECT_EQ(bench.out().command[slot].amplitude, config.home_amplitude);
  EXPECT_EQ(phase(bench, slot), ILK_HOMING_SEEK);

  bench.ticks(29);
  EXPECT_TRUE(bench.driven(slot));
  bench.tick();
  EXPECT_FALSE(bench.driven(slot));
  EXPECT_EQ(phase(bench, slot), ILK_HOMING_REST);
  EXPECT_EQ(bench.position(slot), config.home_offset_counts);
  EXPECT_FALSE(bench.homed(slot)) << "not before the counter rests";

  tick_while_homing(bench, 100, slot);
  EXPECT_EQ(bench.axis_state(slot), ILK_AXIS_ENABLED);
  EXPECT_TRUE(bench.homed(slot));
  EXPECT_EQ(bench.position(slot), config.home_offset_counts + way * 6);
  EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
  EXPECT_EQ(phase(bench, slot), ILK_HOMING_NONE);
}

TEST_P(Homing, backs_off_first_when_it_starts_on_the_switch) {
  const uint32_t slot = GetParam();
  Bench bench = enabled_bench(slot);
  const ilk_axis_config_t& config = bench.config().axis[slot];
  const int32_t way = config.limit_side == ILK_LIMIT_UPPER ? 1 : -1;
  bench.motor[slot].switch_at = -way * 15;
  ASSERT_EQ(bench.ask(home(slot)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(phase(bench, slot), ILK_HOMING_BACK_OFF);
  EXPECT_EQ(bench.driven_direction(slot), way > 0 ? ILK_DIRECTION_DECREASING : ILK_DIRECTION_INCREASING);
  bench.ticks(16);
  EXPECT_EQ(phase(bench, slot), ILK_HOMING_SEEK);
  EXPECT_EQ(bench.driven_direction(slot), way > 0 ? ILK_DIRECTION_INCREASING : ILK_DIRECTION_DECREASING);
  bench.tick();
  EXPECT_EQ(phase(bench, slot), ILK_HOMING_REST);
  EXPECT_EQ(bench.position(slot), config.home_offset_counts);
  tick_while_homing(bench, 100, slot);
  EXPECT_TRUE(bench.homed(slot));
}

TEST(Homing_rest, needs_the_counter_unchanged_for_its_ticks) {
  Bench bench = homing_bench(-10);
  bench.ticks(10);
  ASSERT_EQ(phase(bench), ILK_HOMING_REST);
  bench.ticks(rest_ticks - 2);
  EXPECT_FALSE(bench.homed(axis));
  bench.motor[axis].travelled += 1;
  bench.ticks(rest_ticks - 1);
  EXPECT_FALSE(bench.homed(axis));
  bench.ticks(2);
  EXPECT_TRUE(bench.homed(axis));
}

TEST(Homing_rest, a_bad_frame_is_no_rest) {
  Bench bench = homing_bench(-10);
  bench.ticks(10);
  ASSERT_EQ(phase(bench), ILK_HOMING_REST);
  for (int round = 0; round < 30; ++round) {
    bench.spoil(axis, FrameFault::missing, 2);
    bench.ticks(3);
    if (round < 6) {
      EXPECT_FALSE(bench.homed(axis)) << round;
    }
  }
}

TEST(Homing_rest, does_not_end_while_the_counter_is_noisy) {
  Bench bench = homing_bench(-10);
  bench.ticks(10);
  uint32_t ticks = 10;
  while (bench.axis_state(axis) == ILK_AXIS_HOMING && ticks < timeout_ticks + 10) {
    bench.motor[axis].travelled += ticks % 2 == 0 ? 1 : -1;
    bench.tick();
    ++ticks;
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_HOMING_TIMEOUT);
  EXPECT_EQ(bench.axis(axis).fault_value, ILK_HOMING_REST);
  EXPECT_FALSE(bench.homed(axis));
}

TEST(Homing_bounds, seeking_beyond_its_travel_faults) {
  Bench bench = enabled_bench();
  ASSERT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  bench.ticks(2100);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_HOMING);
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_HOMING_TRAVEL);
  EXPECT_EQ(std::abs(bench.axis(axis).fault_value), 2101);
  EXPECT_FALSE(bench.homed(axis));
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Homing_bounds, backing_off_beyond_its_travel_faults) {
  Bench bench = enabled_bench();
  bench.motor[axis].switch_stuck = true;
  ASSERT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  bench.ticks(100);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_HOMING);
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_HOMING_TRAVEL);
  EXPECT_EQ(std::abs(bench.axis(axis).fault_value), 101);
}

TEST(Homing_bounds, taking_longer_than_its_time_faults) {
  Bench bench = enabled_bench();
  ASSERT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  uint32_t ticks = 1;
  for (; bench.axis_state(axis) == ILK_AXIS_HOMING && ticks < 2 * timeout_ticks; ++ticks) {
    bench.motor[axis].frozen = ticks % 4 != 0;
    bench.tick();
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_HOMING_TIMEOUT);
  EXPECT_EQ(bench.axis(axis).fault_value, ILK_HOMING_SEEK);
  EXPECT_NEAR(ticks, timeout_ticks, 1);
  EXPECT_FALSE(bench.homed(axis));
}

TEST(Homing_bounds, are_not_those_of_an_unhomed_move) {
  Bench bench = homing_bench(-500);
  bench.ticks(400);
  EXPECT_TRUE(bench.driven(axis));
  bench.ticks(150);
  EXPECT_TRUE(bench.homed(axis));
}

TEST(P7_bounds, homing_drives_at_most_at_the_unhomed_bound) {
  Bench bench = homing_bench(-500);
  for (int tick = 0; tick < 400; ++tick) {
    bench.tick();
    ASSERT_EQ(bench.out().command[axis].drive, 50u);
  }
}

TEST(P3_hard_limit, homing_stops_in_the_tick_that_sees_the_switch) {
  Bench bench = homing_bench(-25);
  bench.ticks(24);
  EXPECT_TRUE(bench.driven(axis));
  bench.tick();
  EXPECT_EQ(bench.axis(axis).switch_triggered, 1u);
  EXPECT_FALSE(bench.driven(axis));
  bench.ticks(rest_ticks);
  EXPECT_FALSE(bench.driven(axis));
}

TEST(Homing_disturbed, a_single_bad_frame_is_not_taken_for_the_switch) {
  for (const FrameFault fault : {FrameFault::missing, FrameFault::wrong_checksum, FrameFault::repeated}) {
    Bench bench = homing_bench(-40);
    bench.ticks(10);
    bench.spoil(axis, fault, 1);
    bench.tick();
    EXPECT_FALSE(bench.driven(axis));
    EXPECT_EQ(phase(bench), ILK_HOMING_SEEK);
    bench.tick();
    EXPECT_TRUE(bench.driven(axis));
    tick_while_homing(bench, 100);
    EXPECT_TRUE(bench.homed(axis));
    EXPECT_EQ(bench.motor[axis].travelled, -40);
    EXPECT_EQ(bench.position(axis), offset);
  }
}

TEST(Homing_disturbed, a_bad_frame_in_the_tick_of_HOME_does_not_reference_the_axis) {
  Bench bench = enabled_bench();
  bench.motor[axis].switch_at = -40;
  bench.spoil(axis, FrameFault::missing, 1);
  ASSERT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  EXPECT_FALSE(bench.driven(axis));
  tick_while_homing(bench, 200);
  EXPECT_TRUE(bench.homed(axis));
  EXPECT_EQ(bench.position(axis), offset);
  EXPECT_EQ(bench.motor[axis].travelled, -40);
}

TEST(Homing_disturbed, a_switch_triggered_from_the_start_is_not_the_edge) {
  Bench bench = enabled_bench();
  bench.motor[axis].switch_stuck = true;
  bench.ask(home(axis));
  bench.ticks(50);
  EXPECT_NE(bench.position(axis), offset);
  EXPECT_FALSE(bench.homed(axis));
}

TEST(Homing_disturbed, pedal_release_ends_it_and_the_next_press_does_not_resume) {
  Bench bench = homing_bench(-60);
  bench.ticks(20);
  bench.release();
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_ENABLED);
  EXPECT_FALSE(bench.homed(axis));
  EXPECT_EQ(phase(bench), ILK_HOMING_NONE);
  bench.press();
  bench.ticks(60);
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_FALSE(bench.homed(axis));
  ASSERT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  tick_while_homing(bench, 200);
  EXPECT_TRUE(bench.homed(axis));
  EXPECT_EQ(bench.position(axis), offset);
}

TEST(Homing_disturbed, a_release_during_rest_leaves_the_axis_not_homed) {
  Bench bench = homing_bench(-10);
  bench.ticks(15);
  ASSERT_EQ(phase(bench), ILK_HOMING_REST);
  bench.release();
  bench.ticks(100);
  EXPECT_FALSE(bench.homed(axis));
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE) << "setting the reference is not motion";
}

TEST(Homing_disturbed, a_jammed_axis_stalls) {
  Bench bench = homing_bench(-60);
  bench.motor[axis].frozen = true;
  const uint32_t ticks = tick_while_homing(bench, 200);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_EQ(ticks, 50u);
  EXPECT_FALSE(bench.homed(axis));
}

TEST(Homing_disturbed, a_motor_wired_the_wrong_way_faults) {
  Bench bench = homing_bench(-60);
  bench.motor[axis].reversed = true;
  tick_while_homing(bench, 200);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_REVERSE);
  EXPECT_EQ(bench.position(axis), 21);
}

TEST(Homing_group, one_failure_ends_homing_of_all) {
  Bench bench = enabled_bench();
  bench.enable_axis(slot::non_pwm_upper);
  bench.enable_axis(slot::pwm_free);
  bench.motor[slot::non_pwm_upper].frozen = true;
  bench.queue(home(axis));
  bench.queue(home(slot::non_pwm_upper));
  bench.ticks(50);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_HOMING);
  bench.tick();
  EXPECT_EQ(bench.fault(slot::non_pwm_upper), ILK_FAULT_STALL);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_ENABLED);
  EXPECT_FALSE(bench.homed(axis));
  EXPECT_EQ(phase(bench), ILK_HOMING_NONE);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Homing_group, all_axes_home_together) {
  Bench bench;
  bench.to_motion();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    const uint32_t side = bench.config().axis[slot].limit_side;
    if (side == ILK_LIMIT_NONE) continue;
    bench.enable_axis(slot);
    const auto distance = static_cast<int32_t>(20 + 7 * slot);
    bench.motor[slot].switch_at = side == ILK_LIMIT_UPPER ? distance : -distance;
    bench.queue(home(slot));
  }
  bench.ticks(120);
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    EXPECT_EQ(bench.axis(slot).homed, slot == slot::pwm_free ? 0u : 1u) << slot;
  }
}

TEST(Homing_result, opens_the_full_range) {
  Bench bench = homing_bench(-10);
  tick_while_homing(bench, 100);
  EXPECT_EQ(bench.ask(move(axis, 900, 1000)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

TEST(Homing_result, ends_a_running_move) {
  Bench bench;
  bench.to_motion_homed(axis);
  bench.ask(move(axis, 500, 1000));
  bench.motor[axis].switch_at = -5;
  ASSERT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_DECREASING);
  EXPECT_EQ(bench.out().command[axis].drive, 50u);
  tick_while_homing(bench, 200);
  EXPECT_TRUE(bench.homed(axis));
  bench.ticks(30);
  EXPECT_FALSE(bench.driven(axis)) << "the move from before is not resumed";
}

}  // namespace
}  // namespace interlock::kernel_test
