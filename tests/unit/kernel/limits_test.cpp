// Hard limits, soft limits with a motor that coasts, and the bounds of an axis that is not homed.
#include <gtest/gtest.h>

#include "bench.hpp"
#include "dice.hpp"

namespace interlock::kernel_test {
namespace {

ilk_direction_t towards(const Bench& bench, uint32_t slot) {
  return bench.config().axis[slot].limit_side == ILK_LIMIT_UPPER ? ILK_DIRECTION_INCREASING
                                                                 : ILK_DIRECTION_DECREASING;
}

int32_t outward(const Bench& bench, uint32_t slot, int32_t counts) {
  return towards(bench, slot) == ILK_DIRECTION_INCREASING ? counts : -counts;
}

Bench enabled_bench(uint32_t slot) {
  Bench bench;
  bench.to_motion();
  bench.enable_axis(slot);
  return bench;
}

class P3_hard_limit : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Every_switch, P3_hard_limit,
                         testing::Values(slot::pwm_lower, slot::non_pwm_upper, slot::non_pwm_inverted,
                                         slot::analog_upper, slot::high_frequency, slot::corrected_lower,
                                         slot::corrected_upper),
                         testing::PrintToStringParamName());

TEST_P(P3_hard_limit, blocks_drive_towards_the_switch_and_allows_drive_away) {
  const uint32_t slot = GetParam();
  Bench bench = enabled_bench(slot);
  bench.motor[slot].switch_stuck = true;
  EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 50))), ILK_VERDICT_ACCEPTED);
  EXPECT_FALSE(bench.driven(slot));
  EXPECT_EQ(bench.gate(slot), ILK_GATE_HARD_LIMIT);
  EXPECT_EQ(bench.axis(slot).switch_triggered, 1u);
  bench.ask(move(slot, outward(bench, slot, -50)));
  EXPECT_TRUE(bench.driven(slot));
  EXPECT_NE(bench.driven_direction(slot), towards(bench, slot));
}

TEST_P(P3_hard_limit, stops_a_running_move_in_the_tick_that_sees_the_switch) {
  const uint32_t slot = GetParam();
  Bench bench = enabled_bench(slot);
  bench.motor[slot].switch_at = outward(bench, slot, 20);
  bench.keep_moving(slot, outward(bench, slot, 60), 20);
  EXPECT_TRUE(bench.driven(slot));
  bench.keep_moving(slot, outward(bench, slot, 60), 1);
  EXPECT_EQ(bench.axis(slot).switch_triggered, 1u);
  EXPECT_FALSE(bench.driven(slot));
  bench.keep_moving(slot, outward(bench, slot, 60), 60);
  EXPECT_EQ(bench.position(slot), outward(bench, slot, 20));
  EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE)
      << "an axis held by its switch is not driven, so it cannot stall";
}

TEST_P(P3_hard_limit, holds_for_a_homed_axis_inside_its_soft_limits) {
  const uint32_t slot = GetParam();
  Bench bench;
  bench.to_motion_homed(slot);
  bench.motor[slot].switch_stuck = true;
  bench.ask(move(slot, outward(bench, slot, 500), 1000));
  EXPECT_FALSE(bench.driven(slot));
}

TEST(P3_hard_limit, a_switch_not_read_validly_counts_as_triggered) {
  Bench bench = enabled_bench(slot::pwm_lower);
  EXPECT_EQ(bench.axis(slot::pwm_lower).switch_triggered, 0u);
  bench.spoil(slot::pwm_lower, FrameFault::wrong_checksum, 1);
  bench.tick();
  EXPECT_EQ(bench.axis(slot::pwm_lower).switch_triggered, 1u);
  bench.tick();
  EXPECT_EQ(bench.axis(slot::pwm_lower).switch_triggered, 0u);
}

TEST(P3_hard_limit, an_axis_without_a_switch_reads_none) {
  Bench bench = enabled_bench(slot::pwm_free);
  bench.motor[slot::pwm_free].switch_stuck = true;
  bench.tick();
  EXPECT_EQ(bench.axis(slot::pwm_free).switch_triggered, 0u);
  bench.ask(move(slot::pwm_free, 50));
  EXPECT_TRUE(bench.driven(slot::pwm_free));
  bench.ask(move(slot::pwm_free, -50));
  EXPECT_TRUE(bench.driven(slot::pwm_free));
}

TEST(P4_soft_limit, a_coasting_axis_never_leaves_its_range) {
  Dice dice(4);
  for (const uint32_t slot : {slot::pwm_free, slot::corrected_lower, slot::non_pwm_inverted}) {
    for (const int32_t speed : {1, 2, 3, 5}) {
      Bench bench;
      bench.motor[slot].speed = speed;
      bench.motor[slot].coast = 10 - speed;
      bench.to_motion_homed(slot, 800);
      for (int leg = 0; leg < 200; ++leg) {
        const int32_t target = leg % 3 == 0 ? 990 : dice.between(691, 990);
        const uint32_t duration = dice.below(60);
        for (uint32_t step = 0; step < duration; ++step) {
          bench.queue(move(slot, target, 1000, 1 + dice.below(20)));
          bench.tick();
          ASSERT_LE(bench.position(slot), 1000);
          ASSERT_EQ(bench.mode(), ILK_MODE_MOTION);
        }
        bench.ticks(dice.below(30));
        ASSERT_LE(bench.position(slot), 1000);
      }
    }
  }
}

TEST(P4_soft_limit, beyond_a_limit_drive_is_allowed_inward_only) {
  for (const int32_t side : {1, -1}) {
    Bench bench;
    bench.to_motion_homed(slot::pwm_free, side * 1040);
    ASSERT_EQ(bench.position(slot::pwm_free), side * 1040);
    EXPECT_EQ(bench.ask(move(slot::pwm_free, side * 1100)), ILK_VERDICT_RANGE);
    EXPECT_EQ(bench.ask(move(slot::pwm_free, side * 995)), ILK_VERDICT_RANGE);
    EXPECT_EQ(bench.ask(move(slot::pwm_free, side * 990)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.driven_direction(slot::pwm_free),
              side > 0 ? ILK_DIRECTION_DECREASING : ILK_DIRECTION_INCREASING);
    bench.keep_moving(slot::pwm_free, side * 990, 60, 1000);
    EXPECT_LE(std::abs(bench.position(slot::pwm_free) - side * 990), 2);
  }
}

TEST(P4_soft_limit, is_held_by_the_gate_itself_and_not_by_the_setpoint_alone) {
  for (const int32_t side : {1, -1}) {
    Bench bench;
    bench.to_motion_homed(slot::pwm_free, side * 500);
    bench.watched = false;
    bench.ask(move(slot::pwm_free, side * 900, 1000));
    EXPECT_TRUE(bench.driven(slot::pwm_free));
    int32_t& limit = side > 0 ? bench.damage_config().axis[slot::pwm_free].max_counts
                              : bench.damage_config().axis[slot::pwm_free].min_counts;
    limit = side * 511;
    bench.tick();
    ASSERT_EQ(bench.position(slot::pwm_free), side * 501);
    EXPECT_FALSE(bench.driven(slot::pwm_free));
    EXPECT_EQ(bench.gate(slot::pwm_free), ILK_GATE_SOFT_LIMIT);
    limit = side * 512;
    bench.tick();
    EXPECT_TRUE(bench.driven(slot::pwm_free));
  }
}

TEST(P4_soft_limit, does_not_bind_an_axis_that_is_not_homed) {
  Bench bench;
  bench.to_ready();
  bench.push(slot::pwm_free, 1200);
  bench.enable_axis(slot::pwm_free);
  bench.press();
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 1250)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(slot::pwm_free));
}

TEST(P7_bounds, unhomed_travel_is_bounded_for_each_press_with_a_coasting_motor) {
  for (const int32_t side : {1, -1}) {
    Bench bench;
    bench.motor[slot::pwm_free].speed = 3;
    bench.motor[slot::pwm_free].coast = 7;
    bench.to_motion();
    bench.enable_axis(slot::pwm_free);
    bench.keep_moving(slot::pwm_free, side * 90, 200);
    EXPECT_EQ(bench.ask(move(slot::pwm_free, side * 91)), ILK_VERDICT_RANGE);
    bench.press();
    const int32_t first = bench.position(slot::pwm_free);
    EXPECT_LE(std::abs(first), 100);
    EXPECT_GE(std::abs(first), 80);
    EXPECT_EQ(bench.ask(move(slot::pwm_free, first + side * 90)), ILK_VERDICT_ACCEPTED);
    bench.keep_moving(slot::pwm_free, first + side * 90, 200);
    EXPECT_LE(std::abs(bench.position(slot::pwm_free) - first), 100);
  }
}

TEST(P7_bounds, unhomed_drive_ends_at_the_travel_bound_by_the_gate_itself) {
  for (const int32_t side : {1, -1}) {
    Bench bench = enabled_bench(slot::pwm_free);
    bench.watched = false;
    bench.ask(move(slot::pwm_free, side * 90));
    uint32_t& travel = bench.damage_config().axis[slot::pwm_free].unhomed_travel_counts;
    travel = 11;
    bench.tick();
    ASSERT_EQ(bench.position(slot::pwm_free), side);
    EXPECT_FALSE(bench.driven(slot::pwm_free));
    EXPECT_EQ(bench.gate(slot::pwm_free), ILK_GATE_UNHOMED_TRAVEL);
    travel = 12;
    bench.tick();
    EXPECT_TRUE(bench.driven(slot::pwm_free));
  }
}

TEST(P7_bounds, unhomed_travel_used_up_allows_the_way_back) {
  Bench bench = enabled_bench(slot::pwm_free);
  bench.keep_moving(slot::pwm_free, 90, 120);
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 0)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.driven_direction(slot::pwm_free), ILK_DIRECTION_DECREASING);
}

TEST(P4_soft_limit, RESTORE_cannot_move_the_range_of_a_homed_axis) {
  Bench bench;
  bench.to_ready();
  ASSERT_EQ(bench.ask(set_home(slot::pwm_free)), ILK_VERDICT_ACCEPTED);
  bench.push(slot::pwm_free, 900);
  bench.tick();
  ASSERT_EQ(bench.ask(restore(slot::pwm_free, -900)), ILK_VERDICT_ACCEPTED);
  EXPECT_FALSE(bench.homed(slot::pwm_free));
  bench.enable_axis(slot::pwm_free);
  bench.press();
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 900)), ILK_VERDICT_RANGE);
}

TEST(P7_bounds, RESTORE_does_not_grant_travel_or_drive) {
  Bench bench;
  bench.to_ready();
  EXPECT_EQ(bench.ask(restore(slot::pwm_free, 500)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(slot::pwm_free);
  bench.press();
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 591)), ILK_VERDICT_RANGE);
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 590, 101)), ILK_VERDICT_DRIVE);
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 590)), ILK_VERDICT_ACCEPTED);
}

TEST(P7_bounds, drive_never_exceeds_its_bound_whatever_was_accepted_before) {
  Bench bench;
  bench.to_motion_homed(slot::pwm_free);
  bench.watched = false;
  bench.ask(move(slot::pwm_free, 500, 1000));
  bench.damage_config().axis[slot::pwm_free].max_drive = 999;
  bench.tick();
  EXPECT_FALSE(bench.driven(slot::pwm_free));
  EXPECT_EQ(bench.gate(slot::pwm_free), ILK_GATE_DRIVE);
}

TEST(P7_bounds, the_wire_carries_the_drive_that_was_accepted) {
  Bench bench;
  bench.to_motion_homed(slot::pwm_free);
  for (const uint32_t drive : {1u, 2u, 500u, 999u, 1000u}) {
    bench.ask(move(slot::pwm_free, 500, drive));
    EXPECT_EQ(bench.out().command[slot::pwm_free].drive, drive);
    EXPECT_EQ(bench.out().frame[slot::pwm_free][3], 0x80000000u + drive);
  }
}

}  // namespace
}  // namespace interlock::kernel_test
