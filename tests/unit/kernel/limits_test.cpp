// Hard limits, soft limits with a motor that coasts, and the bounds of an axis that is not homed.
#include <gtest/gtest.h>

#include "bench.hpp"
#include "dice.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;
constexpr uint32_t switched = slot::pwm_lower;

ilk_direction_t towards(const Bench& bench, uint32_t slot) {
  return bench.config().axis[slot].limit_side == ILK_LIMIT_UPPER ? ILK_DIRECTION_INCREASING
                                                                 : ILK_DIRECTION_DECREASING;
}

int32_t outward(const Bench& bench, uint32_t slot, int32_t counts) {
  return towards(bench, slot) == ILK_DIRECTION_INCREASING ? counts : -counts;
}

/// MOTION; the axis homed at its switch and is enabled.
Bench switch_homed_bench(uint32_t slot) {
  Bench bench = motion_bench(slot);
  bench.motor[slot].switch_at = outward(bench, slot, 40);
  bench.ask(home(slot));
  bench.ticks(300);
  EXPECT_EQ(bench.axis(slot).homed, uint32_t{ILK_HOMED_BY_SWITCH});
  return bench;
}

class P3_hard_limit : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Every_switch, P3_hard_limit,
                         testing::Values(slot::pwm_lower, slot::non_pwm_upper, slot::non_pwm_inverted,
                                         slot::analog_upper, slot::high_frequency, slot::corrected_lower,
                                         slot::corrected_upper),
                         testing::PrintToStringParamName());

TEST_P(P3_hard_limit, a_single_reading_stops_drive_towards_it_and_allows_drive_away) {
  const uint32_t slot = GetParam();
  for (const bool is_homed : {false, true}) {
    Bench bench = is_homed ? homed_bench(slot) : motion_bench(slot);
    bench.queue(move(slot, outward(bench, slot, 50)));
    bench.tick();
    EXPECT_EQ(bench.driven_direction(slot), towards(bench, slot));
    bench.tick_with_switch(slot, true);
    EXPECT_FALSE(bench.driven(slot));
    EXPECT_EQ(bench.gate(slot), ILK_GATE_HARD_LIMIT);
    EXPECT_EQ(bench.axis(slot).switch_triggered, 1u);
    bench.tick();
    EXPECT_TRUE(bench.driven(slot));
    bench.queue(move(slot, outward(bench, slot, -50)));
    bench.tick_with_switch(slot, true);
    EXPECT_TRUE(bench.driven(slot));
    EXPECT_NE(bench.driven_direction(slot), towards(bench, slot));
  }
}

TEST_P(P3_hard_limit, a_switch_that_reads_triggered_takes_setpoints_towards_it_out_of_range) {
  const uint32_t slot = GetParam();
  for (const bool is_homed : {false, true}) {
    Bench bench = is_homed ? homed_bench(slot) : motion_bench(slot);
    bench.motor[slot].switch_stuck = true;
    bench.ticks(3);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 50))), ILK_VERDICT_RANGE);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 1))), ILK_VERDICT_RANGE);
    EXPECT_EQ(bench.ask(move(slot, 0)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, -50))), ILK_VERDICT_ACCEPTED);
    EXPECT_TRUE(bench.driven(slot));
  }
}

TEST(P3_hard_limit_read, a_switch_not_read_validly_counts_as_triggered_and_no_switch_reads_none) {
  Bench bench = motion_bench(axis);
  bench.motor[axis].switch_stuck = true;
  bench.spoil(switched, FrameFault::wrong_checksum, 1);
  bench.tick();
  EXPECT_EQ(bench.axis(switched).switch_triggered, 1u);
  bench.tick();
  EXPECT_EQ(bench.axis(switched).switch_triggered, 0u);
  EXPECT_EQ(bench.axis(axis).switch_triggered, 0u);
  for (const int32_t target : {50, -50}) {
    EXPECT_EQ(bench.ask(move(axis, target)), ILK_VERDICT_ACCEPTED);
    EXPECT_TRUE(bench.driven(axis));
  }
}

// --- Soft limits

TEST(P4_soft_limit, a_coasting_axis_never_leaves_its_range) {
  Dice dice(4);
  for (const uint32_t slot : {axis, slot::corrected_lower, slot::non_pwm_inverted}) {
    for (const int32_t speed : {1, 2, 3, 5}) {
      Bench bench;
      bench.motor[slot].speed = speed;
      bench.motor[slot].coast = 10 - speed;
      bench.to_motion_homed(slot, 800);
      for (int leg = 0; leg < 60; ++leg) {
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
    Bench bench = homed_bench(axis, side * 1040);
    ASSERT_EQ(bench.position(axis), side * 1040);
    EXPECT_EQ(bench.ask(move(axis, side * 1100)), ILK_VERDICT_RANGE);
    EXPECT_EQ(bench.ask(move(axis, side * 990)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.driven_direction(axis), side > 0 ? ILK_DIRECTION_DECREASING : ILK_DIRECTION_INCREASING);
    bench.keep_moving(axis, side * 990, 60, 1000);
    EXPECT_LE(std::abs(bench.position(axis) - side * 990), 2);
  }
}

TEST(P4_soft_limit, on_the_side_of_the_switch_lies_where_the_switch_is_sure_to_be_open) {
  for (const uint32_t slot :
       {slot::pwm_lower, slot::non_pwm_upper, slot::corrected_lower, slot::corrected_upper}) {
    Bench bench = switch_homed_bench(slot);
    bench.keep_moving(slot, outward(bench, slot, 900), 120, 1000);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 970))), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 971))), ILK_VERDICT_RANGE);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, -990))), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, -991))), ILK_VERDICT_RANGE);
    bench.release();
    bench.rest();
    bench.reference(slot);
    bench.press();
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 990))), ILK_VERDICT_ACCEPTED) << "homed by hand";
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 991))), ILK_VERDICT_RANGE);
  }
}

TEST(P4_soft_limit, on_the_side_of_the_switch_stays_the_limit_where_that_lies_farther_in) {
  for (const uint32_t slot : {slot::pwm_lower, slot::non_pwm_upper}) {
    ilk_config_t config = standard_config();
    config.axis[slot].home_offset_counts = config.axis[slot].limit_side == ILK_LIMIT_UPPER ? 1000 : -1000;
    seal(config);
    Bench bench = motion_bench(slot, config);
    bench.motor[slot].switch_at = outward(bench, slot, 40);
    bench.ask(home(slot));
    bench.ticks(300);
    ASSERT_TRUE(bench.homed(slot));
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, -900), 1000)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.ask(disable(slot)), ILK_VERDICT_ACCEPTED);
    bench.rest();
    bench.enable_axis(slot);
    bench.keep_moving(slot, 0, 1200, 1000);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 990))), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.ask(move(slot, outward(bench, slot, 991))), ILK_VERDICT_RANGE);
  }
}

TEST(P4_soft_limit, is_held_by_the_gate_itself_and_not_by_the_setpoint_alone) {
  for (const int32_t side : {1, -1}) {
    Bench bench = homed_bench(axis, side * 500);
    bench.watched = false;
    bench.ask(move(axis, side * 900, 1000));
    EXPECT_TRUE(bench.driven(axis));
    ilk_axis_config_t& config = bench.damage_config().axis[axis];
    int32_t& limit = side > 0 ? config.max_counts : config.min_counts;
    limit = side * 511;
    bench.tick();
    ASSERT_EQ(bench.position(axis), side * 501);
    EXPECT_EQ(bench.gate(axis), ILK_GATE_SOFT_LIMIT);
    EXPECT_FALSE(bench.driven(axis));
    limit = side * 512;
    bench.tick();
    EXPECT_TRUE(bench.driven(axis));
  }
}

TEST(P4_soft_limit, does_not_bind_an_axis_that_is_not_homed) {
  Bench bench = ready_bench();
  bench.push(axis, 1200);
  bench.rest();
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(bench.ask(move(axis, 1250)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

TEST(P4_soft_limit, RESTORE_cannot_move_the_range_of_a_homed_axis_nor_grant_travel_or_drive) {
  Bench bench = ready_bench();
  bench.reference(axis);
  ASSERT_EQ(bench.ask(restore(axis, 500)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(bench.ask(move(axis, 591)), ILK_VERDICT_RANGE);
  EXPECT_EQ(bench.ask(move(axis, 590, 101)), ILK_VERDICT_DRIVE);
  EXPECT_EQ(bench.ask(move(axis, 590)), ILK_VERDICT_ACCEPTED);
}

// --- Not homed: the travel of one press

TEST(P7_bounds, unhomed_travel_is_the_path_of_the_press_there_and_back) {
  Bench bench = motion_bench(axis);
  bench.keep_moving(axis, 40, 60);
  const auto travelled = static_cast<int32_t>(bench.axis(axis).unhomed_travel_counts);
  EXPECT_EQ(travelled, 38);
  const int32_t here = bench.position(axis);
  const int32_t left = 90 - travelled;
  bench.motor[axis].frozen = true;
  for (const int32_t way : {1, -1}) {
    EXPECT_EQ(bench.ask(move(axis, here + way * (left + 1))), ILK_VERDICT_RANGE);
    EXPECT_EQ(bench.ask(move(axis, here + way * left)), ILK_VERDICT_ACCEPTED);
  }
  bench.motor[axis].frozen = false;
  bench.keep_moving(axis, here - 50, 60);
  const uint32_t spent = bench.axis(axis).unhomed_travel_counts;
  EXPECT_GE(spent, 86u);
  EXPECT_EQ(bench.ask(move(axis, here)), ILK_VERDICT_RANGE) << "the way back is travel, too";
}

TEST(P7_bounds,
     unhomed_travel_with_a_coasting_motor_ends_within_its_bound_and_is_renewed_by_the_press_alone) {
  for (const int32_t side : {1, -1}) {
    Bench bench;
    bench.motor[axis].speed = 3;
    bench.motor[axis].coast = 7;
    bench.to_ready();
    bench.enable_axis(axis);
    bench.press();
    int32_t target = side * 90;
    for (int round = 0; round < 300; ++round) {
      if (round % 50 == 10) bench.queue(disable(axis));
      if (round % 50 == 30) bench.queue(enable(axis));
      bench.queue(move(axis, target));
      bench.queue(move(axis, bench.position(axis) + side * 5));
      bench.tick();
      ASSERT_LE(std::abs(bench.position(axis)), 100);
    }
    EXPECT_GE(std::abs(bench.position(axis)), 85);
    const int32_t first = bench.position(axis);
    bench.release();
    bench.press();
    target = first + side * 90;
    EXPECT_EQ(bench.ask(move(axis, target)), ILK_VERDICT_ACCEPTED);
    bench.keep_moving(axis, target, 100);
    EXPECT_LE(std::abs(bench.position(axis) - first), 100);
  }
}

TEST(P7_bounds, a_press_counts_travel_from_its_last_reading_even_when_no_frame_came_since_the_press_before) {
  ilk_config_t config = standard_config();
  config.common.pedal_debounce_ticks = 1;
  config.common.bad_frame_limit = 5;
  seal(config);
  Bench bench = motion_bench(axis, config);
  bench.motor[axis].travelled += 1;
  bench.tick();
  bench.spoil(axis, FrameFault::missing, 3);
  bench.pedal(false);
  bench.ticks(2);
  bench.pedal(true);
  bench.tick();
  ASSERT_EQ(bench.mode(), ILK_MODE_MOTION);
  bench.motor[axis].travelled += 1;
  bench.tick();
  EXPECT_EQ(bench.axis(axis).unhomed_travel_counts, 0u) << "a count, which is noise";
}

TEST(P7_bounds, unhomed_travel_ends_drive_by_the_gate_itself) {
  Bench bench = motion_bench(axis);
  bench.motor[axis].speed = 4;
  bench.keep_moving(axis, 90, 22);
  ASSERT_EQ(bench.position(axis), 84);
  bench.ask(move(axis, 90));
  ASSERT_EQ(bench.position(axis), 88);
  EXPECT_EQ(bench.axis(axis).unhomed_travel_counts, 88u);
  bench.motor[axis].travelled -= 2;
  bench.ask(move(axis, 89));
  EXPECT_EQ(bench.axis(axis).unhomed_travel_counts, 90u);
  EXPECT_EQ(bench.gate(axis), ILK_GATE_UNHOMED_TRAVEL);
  EXPECT_FALSE(bench.driven(axis));
}

TEST(P7_bounds, unhomed_travel_is_counted_undriven_and_disabled_too_but_noise_is_none) {
  Bench bench = motion_bench(axis);
  bench.motor[axis].dither = 1;
  bench.ticks(100);
  EXPECT_LE(bench.axis(axis).unhomed_travel_counts, 1u);
  bench.motor[axis].dither = 0;
  bench.push(axis, 10);
  bench.ask(disable(axis));
  bench.push(axis, 8);
  EXPECT_NEAR(bench.axis(axis).unhomed_travel_counts, 18, 1);
}

TEST(P7_bounds, what_homing_travels_is_its_own_until_the_next_driven_MOVE) {
  Bench bench = motion_bench(switched);
  bench.motor[switched].switch_at = -5000;
  bench.ask(home(switched));
  bench.ticks(203);
  bench.ask(disable(switched));
  bench.push(switched, -8);
  EXPECT_EQ(bench.axis(switched).unhomed_travel_counts, 0u);
  const uint32_t homing = bench.axis(switched).homing_travel_counts;
  EXPECT_GE(homing, 206u);
  bench.rest();
  bench.enable_axis(switched);
  bench.keep_moving(switched, bench.position(switched) + 50, 40);
  EXPECT_GE(bench.axis(switched).unhomed_travel_counts, 36u);
  EXPECT_LE(bench.axis(switched).homing_travel_counts, homing + 1);
}

TEST(P7_bounds, a_homed_axis_spends_no_travel_and_motion_outside_of_MOTION_is_none) {
  Bench bench = homed_bench(axis);
  bench.keep_moving(axis, 300, 200, 1000);
  EXPECT_EQ(bench.axis(axis).unhomed_travel_counts, 0u);
  bench.release();
  bench.ask(disable(axis));
  bench.rest();
  EXPECT_EQ(bench.ask(restore(axis, 0)), ILK_VERDICT_ACCEPTED);
  bench.push(axis, 50);
  EXPECT_EQ(bench.axis(axis).unhomed_travel_counts, 0u);
}

TEST(P7_bounds, what_a_homed_axis_travelled_is_not_charged_to_its_homing) {
  Bench bench = homed_bench(switched);
  bench.keep_moving(switched, 300, 200, 1000);
  bench.ask(home(switched));
  bench.ticks(3);
  EXPECT_EQ(bench.axis(switched).homing_travel_counts, 0u);
}

TEST(P7_bounds, drive_never_exceeds_its_bound_whatever_was_accepted_before) {
  Bench bench = homed_bench(axis);
  bench.watched = false;
  for (const uint32_t drive : {1u, 500u, 1000u}) {
    bench.ask(move(axis, 500, drive));
    EXPECT_EQ(bench.out().command[axis].drive, drive);
  }
  bench.damage_config().axis[axis].max_drive = 999;
  bench.tick();
  EXPECT_FALSE(bench.driven(axis));
  EXPECT_EQ(bench.gate(axis), ILK_GATE_DRIVE);
}

}  // namespace
}  // namespace interlock::kernel_test
