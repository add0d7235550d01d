// Runaway: reverse, drift, jump, and a FAULTED axis that moves; position, rest, and the order of faults.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;
constexpr uint32_t rest_ticks = 10;

class P6_runaway : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Every_axis, P6_runaway, testing::Range(0u, slot::axes),
                         testing::PrintToStringParamName());

TEST_P(P6_runaway, reverse_motion_beyond_its_limit_faults_when_it_is_seen) {
  const uint32_t slot = GetParam();
  for (const int32_t way : {1, -1}) {
    Bench bench = motion_bench(slot);
    bench.motor[slot].reversed = true;
    bench.keep_moving(slot, way * 60, 21);
    ASSERT_EQ(bench.position(slot), -way * 20);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    bench.keep_moving(slot, way * 50, 1);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_REVERSE);
    EXPECT_EQ(bench.axis(slot).fault_value, 21);
    EXPECT_EQ(bench.axis(slot).fault_tick, bench.now());
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    EXPECT_TRUE(bench.wire_is_zero());
  }
}

TEST_P(P6_runaway, drift_beyond_its_limit_faults_an_axis_that_is_not_driven_and_keeps_homed) {
  const uint32_t slot = GetParam();
  for (const int32_t way : {1, -1}) {
    Bench bench = homed_bench(slot);
    bench.motor[slot].creep = way;
    bench.ticks(20);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    bench.tick();
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_DRIFT);
    EXPECT_EQ(bench.axis(slot).fault_value, way * 21);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    EXPECT_TRUE(bench.homed(slot));
  }
}

TEST_P(P6_runaway, a_jump_beyond_its_limit_faults_and_drops_the_reference) {
  const uint32_t slot = GetParam();
  for (const int32_t way : {1, -1}) {
    Bench bench = homed_bench(slot);
    bench.motor[slot].travelled += way * 8;
    bench.tick();
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    bench.motor[slot].travelled += way * 9;
    bench.tick();
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_JUMP);
    EXPECT_EQ(bench.axis(slot).fault_value, way * 9);
    EXPECT_FALSE(bench.homed(slot));
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  }
}

TEST_P(P6_runaway, a_faulted_axis_that_moves_on_locks_and_takes_power) {
  const uint32_t slot = GetParam();
  for (const int32_t way : {1, -1}) {
    Bench bench = faulted_bench(slot);
    bench.motor[slot].creep = 2 * way;
    bench.ticks(10);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    bench.tick();
    EXPECT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
    EXPECT_EQ(bench.system().cause_value, slot);
    EXPECT_FALSE(bench.powered());
  }
}

TEST_P(P6_runaway, motion_in_the_commanded_direction_is_none) {
  const uint32_t slot = GetParam();
  Bench bench = homed_bench(slot);
  bench.motor[slot].speed = 5;
  for (const int32_t target : {400, -400, 0}) {
    bench.keep_moving(slot, target, 200, 1000);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    EXPECT_LE(std::abs(bench.position(slot) - target), 2);
  }
}

// --- Reverse

TEST(P6_reverse, is_measured_from_the_farthest_reading) {
  Bench bench = homed_bench(axis);
  bench.keep_moving(axis, 80, 31);
  ASSERT_EQ(bench.position(axis), 30);
  bench.motor[axis].reversed = true;
  bench.keep_moving(axis, 80, 20);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.keep_moving(axis, 80, 1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_REVERSE);
  EXPECT_FALSE(bench.homed(axis));
}

TEST(P6_reverse, a_change_of_direction_starts_a_new_mark_and_coast_after_it_is_tolerated) {
  Bench bench = homed_bench(axis);
  bench.motor[axis].speed = 2;
  for (int round = 0; round < 20; ++round) {
    for (const int32_t way : {1, -1}) {
      bench.keep_moving(axis, way * 300, 20, 1000);
      bench.motor[axis].travelled += way * 6;
    }
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
}

TEST(P6_reverse,
     and_drift_while_blind_are_judged_by_the_first_frame_after_and_a_change_of_wish_excuses_nothing) {
  struct Case {
    int32_t creep;
    ilk_fault_t fault;
  };
  for (const auto& [creep, fault] : {Case{-7, ILK_FAULT_REVERSE}, Case{-6, ILK_FAULT_NONE},
                                     Case{6, ILK_FAULT_NONE}, Case{7, ILK_FAULT_DRIFT}}) {
    Bench bench = motion_bench(axis);
    bench.ask(move(axis, 80));
    bench.motor[axis].frozen = true;
    bench.motor[axis].creep = creep;
    bench.spoil(axis, FrameFault::missing, 2);
    bench.queue(move(axis, -80));
    bench.ticks(3);
    EXPECT_EQ(bench.fault(axis), fault) << creep;
  }
}

// --- Drift

TEST(P6_drift, is_judged_in_READY_too) {
  Bench bench = ready_bench();
  bench.enable_axis(axis);
  bench.push(axis, 20);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.push(axis, 1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
}

TEST(P6_drift, is_measured_from_the_reading_of_the_last_driven_tick) {
  for (const int32_t extra : {0, 1}) {
    Bench bench = motion_bench(axis);
    bench.keep_moving(axis, 80, 20);
    bench.ticks(19);
    ASSERT_TRUE(bench.driven(axis));
    const int32_t mark = bench.position(axis);
    bench.motor[axis].frozen = true;
    bench.motor[axis].creep = 5;
    bench.ticks(4);
    EXPECT_EQ(bench.position(axis), mark + 20);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE) << "this far it may coast";
    bench.motor[axis].creep = extra;
    bench.tick();
    EXPECT_EQ(bench.fault(axis), extra == 1 ? ILK_FAULT_DRIFT : ILK_FAULT_NONE);
  }
}

TEST(P6_drift, a_disabled_axis_may_be_moved_by_hand_in_READY_and_LOCKED_and_is_followed) {
  Bench bench = ready_bench();
  bench.push(axis, 500);
  bench.estop_loop_closed = 0;
  bench.push(axis, 300);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  EXPECT_EQ(bench.position(axis), 800);
  bench.estop_loop_closed = 1;
  bench.to_ready();
  bench.enable_axis(axis);
  bench.ticks(100);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE) << "what was moved by hand before ENABLE is not drift";
  bench.ask(disable(axis));
  bench.push(axis, -700);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  EXPECT_EQ(bench.position(axis), 100);
}

TEST(P6_drift, of_a_DISABLED_axis_in_MOTION_faults_it) {
  Bench bench = motion_bench(slot::pwm_lower);
  bench.motor[axis].creep = 1;
  bench.keep_moving(slot::pwm_lower, 60, 20);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  bench.keep_moving(slot::pwm_lower, 60, 1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P6_drift, of_an_axis_that_was_DISABLED_in_READY_is_measured_from_its_last_reading_there) {
  ilk_config_t config = standard_config();
  config.common.pedal_debounce_ticks = 2;
  seal(config);
  Bench bench(config);
  bench.to_ready();
  bench.enable_axis(axis);
  bench.arm();
  bench.push(axis, 15);
  ASSERT_EQ(bench.ask(disable(axis)), ILK_VERDICT_ACCEPTED);
  bench.spoil(axis, FrameFault::missing, 2);
  bench.pedal(true);
  bench.ticks(2);
  ASSERT_EQ(bench.mode(), ILK_MODE_MOTION) << "the axis was not read since DISABLE";
  bench.push(axis, 20);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.push(axis, 1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
}

TEST(P6_drift, is_seen_however_many_deadlines_were_missed_since_the_drive) {
  Bench bench = motion_bench(axis);
  bench.keep_moving(axis, 60, 3);
  ASSERT_TRUE(bench.driven(axis));
  bench.spoil(axis, FrameFault::missing, 1);
  bench.tick();
  bench.motor[axis].travelled += 30;
  bench.deadlines_missed = UINT32_MAX - 1;
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
}

TEST(P6_drift, SET_HOME_and_RESTORE_neither_look_like_motion_nor_forgive_it) {
  Bench bench = ready_bench();
  bench.push(axis, 300);
  bench.rest();
  bench.enable_axis(axis);
  bench.push(axis, 15);
  bench.rest();
  ASSERT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_ACCEPTED);
  ASSERT_EQ(bench.ask(restore(axis, -900)), ILK_VERDICT_ACCEPTED);
  bench.ticks(20);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.push(axis, 6);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
  EXPECT_EQ(bench.axis(axis).fault_value, 21);
}

// --- Jump

TEST(P6_jump, is_scaled_by_the_periods_since_the_last_valid_frame_missed_deadlines_included) {
  for (const uint32_t bad : {0u, 1u, 2u}) {
    for (const uint32_t missed : {0u, 1u, 5u}) {
      const auto reach = static_cast<int32_t>(8 * (1 + bad + missed));
      for (const int32_t extra : {0, 1}) {
        Bench bench = ready_bench();
        bench.spoil(axis, FrameFault::missing, bad);
        bench.ticks(bad);
        bench.motor[axis].travelled += reach + extra;
        bench.deadlines_missed = missed;
        bench.tick();
        EXPECT_EQ(bench.fault(axis), extra == 0 ? ILK_FAULT_NONE : ILK_FAULT_JUMP);
        EXPECT_EQ(bench.position(axis), reach + extra);
      }
    }
  }
}

TEST(P6_jump, the_periods_of_one_gap_do_not_count_for_the_next) {
  Bench bench = ready_bench();
  bench.deadlines_missed = 1;
  bench.tick();
  bench.deadlines_missed = 0;
  bench.motor[axis].travelled += 9;
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
}

TEST(P6_jump, of_half_the_counter_is_seen_whichever_way_the_axis_is_driven) {
  for (const uint32_t distance : {0x80000000u, 0x7FFFFFFFu, 0x80000001u}) {
    for (const int32_t target : {50, -50}) {
      Bench bench = motion_bench(axis);
      bench.ask(move(axis, target));
      bench.motor[axis].raw_at_start += distance;
      bench.tick();
      EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP) << distance;
      EXPECT_TRUE(bench.wire_is_zero());
    }
  }
}

TEST(P6_jump, the_first_reading_is_none) {
  for (const uint32_t raw : {0u, 0x80000000u, 0xFFFFFFFFu}) {
    Bench bench;
    bench.motor[axis].raw_at_start = raw;
    bench.ticks(3);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
    EXPECT_EQ(bench.position(axis), 0);
  }
}

// --- RUNAWAY of a FAULTED axis

TEST(P6_runaway_lock, RESET_is_refused_until_the_axis_rests_and_its_mark_is_then_where_it_stands) {
  Bench bench = faulted_bench(axis);
  bench.motor[axis].creep = 2;
  bench.ticks(11);
  ASSERT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
  bench.ticks(40);
  bench.motor[axis].creep = 0;
  for (uint32_t still = 1; still < rest_ticks - 1; ++still)
    EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  bench.push(axis, 20);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.push(axis, 1);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
}

TEST(P6_runaway_lock, ends_with_a_lost_card_and_not_with_single_bad_frames) {
  Bench bench = faulted_bench(axis);
  bench.motor[axis].creep = 2;
  bench.ticks(11);
  bench.spoil(axis, FrameFault::missing, 2);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
  bench.spoil(axis, FrameFault::missing, 3);
  bench.ticks(2);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.ticks(11);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY) << "the mark is taken anew at the first frame";
  bench.tick();
  EXPECT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
}

TEST(P6_runaway_lock, a_jump_or_a_reset_card_of_a_faulted_axis_is_no_new_fault_and_moves_every_mark) {
  for (const bool reset_card : {false, true}) {
    Bench bench = faulted_bench(axis);
    bench.press();
    bench.motor[axis].travelled += 500;
    if (reset_card) bench.card[axis].heartbeat = 5;
    bench.ticks(2);
    EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
    EXPECT_EQ(bench.axis(axis).unhomed_travel_counts, 0u);
  }
}

TEST(P6_runaway_lock, a_faulted_axis_that_jumps_on_is_run_away_however_fast_it_is) {
  for (const int32_t way : {1, -1}) {
    for (const bool reset_card : {false, true}) {
      Bench bench = motion_bench(axis);
      bench.release();
      bench.motor[axis].travelled += way * 500;
      bench.tick();
      EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
      EXPECT_EQ(bench.mode(), ILK_MODE_READY) << "one jump alone may be a counter that slipped";
      bench.motor[axis].travelled += way * (reset_card ? 1 : 500);
      if (reset_card) bench.card[axis].heartbeat = 5;
      bench.tick();
      EXPECT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
      EXPECT_FALSE(bench.powered());
      EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
      bench.rest();
      EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
    }
  }
}

TEST(P6_runaway_lock, an_axis_run_away_that_jumps_back_is_still_run_away) {
  for (const int32_t way : {1, -1}) {
    Bench bench = motion_bench(axis);
    bench.release();
    for (const int32_t counts : {500, 500, -500}) {
      bench.motor[axis].travelled += way * counts;
      bench.tick();
    }
    EXPECT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
    EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
    bench.rest();
    EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  }
}

TEST(P6_runaway_lock, a_wrong_reading_that_is_taken_back_is_a_jump_and_no_runaway) {
  for (const int32_t way : {1, -1}) {
    Bench bench = motion_bench(axis);
    bench.motor[axis].travelled += way * 500;
    bench.tick();
    bench.motor[axis].travelled -= way * 500;
    bench.ticks(50);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  }
}

TEST(P6_runaway_lock, a_faulted_axis_that_creeps_within_the_noise_of_its_rest_is_found_by_how_far_it_came) {
  Bench bench = faulted_bench(axis);
  for (int32_t counts = 0; counts < 20; ++counts) {
    bench.motor[axis].travelled += 1;
    bench.ticks(12);
    ASSERT_EQ(bench.mode(), ILK_MODE_READY) << counts;
  }
  bench.motor[axis].travelled += 1;
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_CAUSE_PRESENT) << "at rest, and run away";
  EXPECT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
}

TEST(P6_runaway_lock, the_mark_is_the_reading_of_the_fault_and_a_coast_of_drift_counts_is_none) {
  for (const int32_t extra : {0, 1}) {
    Bench bench = motion_bench(axis);
    bench.motor[axis].reversed = true;
    bench.keep_moving(axis, 60, 22);
    ASSERT_EQ(bench.fault(axis), ILK_FAULT_REVERSE);
    bench.motor[axis].frozen = true;
    bench.push(axis, -(20 + extra));
    EXPECT_EQ(bench.mode(), extra == 0 ? ILK_MODE_READY : ILK_MODE_LOCKED);
  }
}

TEST(P6_runaway_lock, ends_MOTION_of_the_other_axes) {
  Bench bench = faulted_bench(axis);
  bench.enable_axis(slot::pwm_lower);
  bench.press();
  bench.motor[axis].creep = 2;
  bench.keep_moving(slot::pwm_lower, 60, 10);
  EXPECT_TRUE(bench.driven(slot::pwm_lower));
  bench.keep_moving(slot::pwm_lower, 60, 1);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
  EXPECT_TRUE(bench.wire_is_zero());
}

// --- Rest

TEST(Rest, is_rest_ticks_in_which_no_two_readings_differ_by_more_than_noise) {
  for (const int32_t dither : {1, 2}) {
    Bench bench = ready_bench();
    bench.motor[axis].dither = dither;
    bench.ticks(30);
    EXPECT_EQ(bench.ask(set_home(axis)), dither == 1 ? ILK_VERDICT_ACCEPTED : ILK_VERDICT_BUSY);
  }
}

TEST(Rest, noise_is_peak_to_peak_so_that_a_creep_of_less_a_tick_is_no_rest) {
  Bench bench = ready_bench();
  for (int round = 0; round < 20; ++round) {
    bench.motor[axis].travelled += 1;
    bench.ticks(3);
    EXPECT_EQ(bench.ask(set_home(axis)), round == 0 ? ILK_VERDICT_ACCEPTED : ILK_VERDICT_BUSY) << round;
  }
}

TEST(Rest, ends_with_drive_and_with_a_frame_that_is_not_valid) {
  Bench bench = motion_bench(axis);
  bench.motor[axis].frozen = true;
  bench.ask(move(axis, 50, 100, 1));
  ASSERT_TRUE(bench.driven(axis));
  bench.pedal(false);
  for (uint32_t still = 1; still < rest_ticks; ++still)
    EXPECT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_BUSY);
  EXPECT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_ACCEPTED);
  bench.spoil(axis, FrameFault::missing, 1);
  bench.tick();
  for (uint32_t still = 1; still < rest_ticks; ++still)
    EXPECT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_BUSY);
  EXPECT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_ACCEPTED);
}

// --- Faults

TEST(P8_latch, the_first_fault_of_an_axis_is_kept_until_CLEAR_FAULT_and_left_by_nothing_else) {
  Bench bench = faulted_bench(axis);
  const uint32_t first_tick = bench.axis(axis).fault_tick;
  bench.motor[axis].travelled += 500;
  bench.tick();
  bench.spoil(axis, FrameFault::missing, 5);
  bench.ticks(10);
  for (const ilk_request_t& request :
       {enable(axis), disable(axis), set_home(axis), restore(axis, 0), stop(), move(axis, 0), home(axis)}) {
    bench.ask(request);
  }
  bench.press();
  bench.release();
  bench.estop_loop_closed = 0;
  bench.tick();
  bench.estop_loop_closed = 1;
  bench.to_ready();
  bench.ticks(1000);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_FAULTED);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
  EXPECT_EQ(bench.axis(axis).fault_value, 100);
  EXPECT_EQ(bench.axis(axis).fault_tick, first_tick);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_DISABLED);
}

TEST(P8_latch, a_later_fault_of_a_FAULTED_axis_still_drops_homed) {
  Bench bench = homed_bench(axis);
  bench.motor[axis].creep = 1;
  bench.ticks(21);
  ASSERT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
  bench.motor[axis].creep = 0;
  EXPECT_TRUE(bench.homed(axis));
  bench.motor[axis].travelled += 9;
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
  EXPECT_FALSE(bench.homed(axis));
}

TEST(Order_of_faults, CARD_before_STALL) {
  ilk_config_t config = standard_config();
  config.common.bad_frame_limit = 1;
  seal(config);
  Bench bench = motion_bench(axis, config);
  bench.motor[axis].frozen = true;
  bench.keep_moving(axis, 80, 50);
  bench.spoil(axis, FrameFault::missing, 1);
  bench.keep_moving(axis, 80, 1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD);
}

TEST(Order_of_faults, CARD_RESET_before_JUMP) {
  Bench bench = ready_bench();
  bench.motor[axis].travelled += 100;
  bench.card[axis].heartbeat = 5;
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD_RESET);
}

TEST(Order_of_faults, JUMP_before_REVERSE_and_before_DRIFT) {
  for (const bool driven : {false, true}) {
    Bench bench = motion_bench(axis);
    if (driven) bench.ask(move(axis, 50));
    bench.motor[axis].travelled -= 100;
    bench.tick();
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
  }
}

TEST(Order_of_faults, REVERSE_before_STALL) {
  Bench bench = motion_bench(axis);
  bench.motor[axis].frozen = true;
  bench.keep_moving(axis, 80, 47);
  bench.motor[axis].creep = -7;
  bench.keep_moving(axis, 60, 3);
  ASSERT_EQ(bench.fault(axis), ILK_FAULT_REVERSE);
  Bench later = motion_bench(axis);
  later.motor[axis].frozen = true;
  later.keep_moving(axis, 80, 48);
  later.motor[axis].creep = -7;
  later.keep_moving(axis, 60, 3);
  EXPECT_EQ(later.fault(axis), ILK_FAULT_REVERSE) << "in the tick in which the stall is due";
}

// --- Counter

class Counter_wrap : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Raw, Counter_wrap, testing::Values(0u, 10u, 0xFFFFFFF0u, 0x7FFFFFF0u, 0x80000010u),
                         testing::PrintToStringParamName());

TEST_P(Counter_wrap, is_no_motion_and_marks_hold_across_it) {
  for (const uint32_t slot : {slot::pwm_free, slot::corrected_lower}) {
    Bench bench;
    bench.motor[slot].raw_at_start = GetParam();
    bench.to_motion_homed(slot);
    bench.keep_moving(slot, 60, 70);
    EXPECT_EQ(bench.position(slot), 58);
    bench.keep_moving(slot, -60, 130);
    EXPECT_EQ(bench.position(slot), -58);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    bench.motor[slot].reversed = true;
    bench.keep_moving(slot, 60, 40);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_REVERSE);
    EXPECT_EQ(bench.axis(slot).fault_value, 21);
  }
}

ilk_config_t wide_config() {
  ilk_config_t config = standard_config();
  config.common.bad_frame_limit = 5;
  config.axis[axis].min_counts = -(1 << 30);
  config.axis[axis].max_counts = 1 << 30;
  config.axis[axis].max_delta_counts = 1u << 30;
  seal(config);
  return config;
}

TEST(P15_total, a_position_saturates_instead_of_wrapping) {
  for (const int32_t way : {1, -1}) {
    Bench bench = ready_bench(wide_config());
    for (int stride = 0; stride < 6; ++stride) {
      bench.motor[axis].travelled += way * (int64_t{1} << 30);
      bench.tick();
      EXPECT_GT(int64_t{bench.position(axis)} * way, 0) << stride;
    }
    EXPECT_EQ(bench.position(axis), way > 0 ? INT32_MAX : INT32_MIN);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  }
}

TEST(P15_total, half_the_counter_from_a_mark_has_an_opposite_too) {
  Bench bench = motion_bench(axis, wide_config());
  bench.motor[axis].frozen = true;
  bench.ask(move(axis, -50));
  ASSERT_EQ(bench.driven_direction(axis), ILK_DIRECTION_DECREASING);
  for (int stride = 0; stride < 2; ++stride) {
    bench.motor[axis].travelled += int64_t{1} << 30;
    bench.tick();
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_REVERSE);
}

TEST(P15_total, the_reach_of_a_blind_axis_saturates_instead_of_wrapping) {
  Bench bench = ready_bench(wide_config());
  bench.spoil(axis, FrameFault::missing, 4);
  bench.ticks(4);
  bench.motor[axis].raw_at_start += 0x80000000u;
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE) << "five ticks reach farther than any counter difference";
}

}  // namespace
}  // namespace interlock::kernel_test
