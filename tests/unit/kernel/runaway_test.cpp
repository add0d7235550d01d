// Runaway: reverse, drift and jump, and what must not be mistaken for them. Position from the counter.
#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;
constexpr uint32_t settle_ticks = 10;

Bench enabled_bench(uint32_t slot = axis) {
  Bench bench;
  bench.to_motion();
  bench.enable_axis(slot);
  return bench;
}

class P6_runaway : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Every_axis, P6_runaway, testing::Range(0u, slot::axes),
                         testing::PrintToStringParamName());

TEST_P(P6_runaway, reverse_motion_beyond_its_limit_faults_when_it_is_seen) {
  const uint32_t slot = GetParam();
  for (const int32_t way : {1, -1}) {
    Bench bench = enabled_bench(slot);
    bench.motor[slot].reversed = true;
    bench.keep_moving(slot, way * 80, 21);
    ASSERT_EQ(bench.position(slot), -way * 20);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    bench.keep_moving(slot, way * 80, 1);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_REVERSE);
    EXPECT_EQ(std::abs(bench.axis(slot).fault_value), 21);
    EXPECT_EQ(bench.axis(slot).fault_tick, bench.now());
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    EXPECT_TRUE(bench.wire_is_zero());
  }
}

TEST_P(P6_runaway, drift_of_an_enabled_axis_beyond_its_limit_faults_when_it_is_seen) {
  const uint32_t slot = GetParam();
  for (const int32_t way : {1, -1}) {
    Bench bench = enabled_bench(slot);
    bench.ticks(settle_ticks + 1);
    bench.motor[slot].creep = way;
    bench.ticks(20);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    bench.tick();
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_DRIFT);
    EXPECT_EQ(std::abs(bench.axis(slot).fault_value), 21);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  }
}

TEST_P(P6_runaway, a_jump_beyond_its_limit_faults_when_it_is_seen_and_loses_the_reference) {
  const uint32_t slot = GetParam();
  for (const int32_t way : {1, -1}) {
    Bench bench;
    bench.to_motion_homed(slot);
    bench.motor[slot].travelled += way * 8;
    bench.tick();
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    bench.motor[slot].travelled += way * 9;
    bench.tick();
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_JUMP);
    EXPECT_EQ(std::abs(bench.axis(slot).fault_value), 9);
    EXPECT_EQ(bench.axis(slot).homed, 0u);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  }
}

TEST_P(P6_runaway, motion_in_the_commanded_direction_is_none) {
  const uint32_t slot = GetParam();
  Bench bench;
  bench.to_motion_homed(slot);
  bench.motor[slot].speed = 5;
  for (const int32_t target : {400, -400, 0}) {
    bench.keep_moving(slot, target, 200, 1000);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    EXPECT_LE(std::abs(bench.position(slot) - target), 2);
  }
}

TEST(P6_reverse, is_measured_from_the_farthest_reading) {
  Bench bench = enabled_bench();
  bench.keep_moving(axis, 80, 31);
  ASSERT_EQ(bench.position(axis), 30);
  bench.motor[axis].reversed = true;
  bench.keep_moving(axis, 80, 20);
  EXPECT_EQ(bench.position(axis), 10);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.keep_moving(axis, 80, 1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_REVERSE);
}

TEST(P6_reverse, a_change_of_direction_starts_a_new_mark) {
  Bench bench = enabled_bench();
  bench.keep_moving(axis, 80, 61);
  bench.keep_moving(axis, -80, 60);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  EXPECT_EQ(bench.position(axis), 2);
}

TEST(P6_reverse, coast_after_a_change_of_direction_is_tolerated) {
  Bench bench;
  bench.motor[axis].speed = 2;
  bench.to_motion_homed(axis);
  for (int round = 0; round < 20; ++round) {
    bench.keep_moving(axis, 300, 10, 1000);
    bench.motor[axis].travelled += 6;
    bench.keep_moving(axis, -300, 10, 1000);
    bench.motor[axis].travelled -= 6;
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
}

TEST(P6_reverse, a_lost_frame_does_not_hide_it) {
  Bench bench = enabled_bench();
  bench.ask(move(axis, 80, 100, 20));
  bench.motor[axis].frozen = true;
  bench.motor[axis].creep = -7;
  bench.spoil(axis, FrameFault::missing, 2);
  bench.ticks(2);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_REVERSE);
  EXPECT_EQ(std::abs(bench.axis(axis).fault_value), 21);
}

TEST(P6_reverse, motion_between_valid_frames_is_judged_by_the_direction_driven_then) {
  Bench bench = enabled_bench();
  bench.ask(move(axis, 80, 100, 20));
  bench.motor[axis].frozen = true;
  bench.motor[axis].creep = -7;
  bench.spoil(axis, FrameFault::missing, 2);
  bench.queue(move(axis, -80, 100, 20));
  bench.ticks(3);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_REVERSE) << "a change of wish while blind does not excuse it";
}

TEST(P6_reverse, reports_the_counts_against_the_command) {
  for (const int32_t way : {1, -1}) {
    Bench bench = enabled_bench();
    bench.motor[axis].reversed = true;
    bench.keep_moving(axis, way * 80, 22);
    EXPECT_EQ(bench.axis(axis).fault_value, 21);
  }
}

TEST(P6_reverse, in_the_commanded_direction_while_blind_is_none) {
  Bench bench = enabled_bench();
  bench.ask(move(axis, 80, 100, 20));
  bench.motor[axis].frozen = true;
  bench.motor[axis].creep = 7;
  bench.spoil(axis, FrameFault::missing, 2);
  bench.queue(move(axis, -80, 100, 20));
  bench.ticks(3);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
}

TEST(P6_drift, is_measured_in_READY_too) {
  Bench bench;
  bench.to_ready();
  bench.enable_axis(axis);
  bench.ticks(settle_ticks + 1);
  bench.motor[axis].creep = 1;
  bench.ticks(21);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
}

TEST(P6_drift, is_measured_at_the_setpoint_too) {
  Bench bench = enabled_bench();
  bench.keep_moving(axis, 0, settle_ticks + 2);
  bench.motor[axis].frozen = true;
  for (int count = 0; count < 22; ++count) {
    bench.motor[axis].travelled += 1;
    bench.queue(move(axis, 0, 0));
    bench.tick();
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
}

TEST(P6_drift, motion_while_settling_is_none) {
  Bench bench = enabled_bench();
  bench.queue(move(axis, 80, 100, 1));
  bench.tick();
  bench.motor[axis].creep = 3;
  bench.ticks(settle_ticks - 1);
  bench.motor[axis].creep = 0;
  bench.ticks(100);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  ASSERT_GT(bench.position(axis), 25);
  bench.motor[axis].creep = 1;
  bench.ticks(20);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
}

TEST(P6_drift, runs_again_after_settling_from_the_last_driven_tick) {
  Bench bench = enabled_bench();
  bench.queue(move(axis, 80, 100, 1));
  bench.tick();
  bench.ticks(settle_ticks + 1);
  bench.motor[axis].creep = -1;
  bench.ticks(21);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
}

TEST(P6_drift, missed_frames_do_not_put_off_the_watch) {
  Bench bench = enabled_bench();
  ASSERT_EQ(bench.ask(move(axis, 80, 100, 1)), ILK_VERDICT_ACCEPTED);
  const auto every_third_frame = [&bench](uint32_t rounds) {
    for (uint32_t round = 0; round < rounds; ++round) {
      bench.spoil(axis, FrameFault::missing, 2);
      bench.ticks(3);
    }
  };
  every_third_frame(4);
  bench.motor[axis].creep = 1;
  every_third_frame(6);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  every_third_frame(1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
  EXPECT_EQ(bench.axis(axis).fault_value, 21);
}

TEST(P6_drift, what_the_drive_did_is_none_though_the_frame_comes_after_settling) {
  ilk_config_t config = standard_config();
  config.axis[axis].settle_ticks = 1;
  seal(config);
  Bench bench(config);
  bench.to_motion();
  bench.enable_axis(axis);
  ASSERT_EQ(bench.ask(move(axis, 80, 100, 1)), ILK_VERDICT_ACCEPTED);
  bench.motor[axis].frozen = true;
  bench.motor[axis].creep = 7;
  bench.spoil(axis, FrameFault::missing, 2);
  bench.ticks(3);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.motor[axis].creep = 0;
  bench.tick();
  bench.motor[axis].travelled += 8;
  bench.ticks(1);
  bench.motor[axis].travelled += 8;
  bench.ticks(1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.motor[axis].travelled += 5;
  bench.ticks(1);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT) << "it is measured from where that frame found the axis";
}

TEST(P6_drift, noise_and_small_motion_are_none) {
  Bench bench = enabled_bench();
  for (int tick = 0; tick < 500; ++tick) {
    bench.motor[axis].travelled = tick % 20;
    bench.tick();
    if (tick % 20 == 19) {
      bench.motor[axis].creep = 0;
      for (int back = 0; back < 4; ++back) {
        bench.motor[axis].travelled -= 5;
        bench.tick();
      }
    }
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
}

TEST(P6_drift, a_disabled_axis_may_be_moved_by_hand_and_is_followed) {
  Bench bench;
  bench.to_ready();
  bench.push(axis, 500);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  EXPECT_EQ(bench.position(axis), 500);
  bench.enable_axis(axis);
  bench.ticks(100);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE) << "what was moved by hand before ENABLE is not drift";
  bench.ask(disable(axis));
  bench.push(axis, -700);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  EXPECT_EQ(bench.position(axis), -200);
}

TEST(P6_drift, SET_HOME_and_RESTORE_do_not_look_like_motion) {
  Bench bench;
  bench.to_ready();
  bench.push(axis, 300);
  bench.enable_axis(axis);
  bench.ticks(20);
  ASSERT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_ACCEPTED);
  bench.ticks(20);
  ASSERT_EQ(bench.ask(restore(axis, -900)), ILK_VERDICT_ACCEPTED);
  bench.ticks(20);
  bench.press();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.keep_moving(axis, -850, 20);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  EXPECT_EQ(bench.position(axis), -881);
}

TEST(P6_drift, SET_HOME_does_not_forgive_what_drifted_before) {
  Bench bench;
  bench.to_ready();
  bench.enable_axis(axis);
  bench.ticks(20);
  bench.push(axis, 15);
  bench.tick();
  ASSERT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_ACCEPTED);
  bench.push(axis, 6);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_DRIFT);
}

TEST(P6_jump, is_scaled_by_the_ticks_since_the_last_valid_frame) {
  for (const uint32_t bad : {1u, 2u}) {
    const auto reach = static_cast<int32_t>(8 * (bad + 1));
    for (const int32_t extra : {0, 1}) {
      Bench bench;
      bench.to_ready();
      bench.spoil(axis, FrameFault::missing, bad);
      bench.ticks(bad);
      bench.motor[axis].travelled += reach + extra;
      bench.tick();
      EXPECT_EQ(bench.fault(axis), extra == 0 ? ILK_FAULT_NONE : ILK_FAULT_JUMP);
      EXPECT_EQ(bench.position(axis), reach + extra);
    }
  }
}

TEST(P6_jump, of_half_the_counter_is_seen) {
  for (const uint32_t distance : {0x80000000u, 0x7FFFFFFFu, 0x80000001u}) {
    Bench bench;
    bench.to_ready();
    bench.motor[axis].raw_at_start += distance;
    bench.tick();
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP) << distance;
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

TEST(P6_jump, the_first_fault_is_kept) {
  Bench bench;
  bench.to_ready();
  bench.motor[axis].travelled += 50;
  bench.tick();
  const uint32_t first_tick = bench.axis(axis).fault_tick;
  bench.motor[axis].travelled += 500;
  bench.tick();
  bench.spoil(axis, FrameFault::missing, 5);
  bench.ticks(10);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
  EXPECT_EQ(bench.axis(axis).fault_value, 50);
  EXPECT_EQ(bench.axis(axis).fault_tick, first_tick);
}

TEST(P8_latch, an_axis_fault_is_left_only_by_CLEAR_FAULT) {
  Bench bench;
  bench.to_ready();
  bench.motor[axis].travelled += 50;
  bench.tick();
  for (const ilk_request_t& request :
       {enable(axis), disable(axis), set_home(axis), restore(axis, 0), stop(), move(axis, 0), home(axis)}) {
    bench.ask(request);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_FAULTED);
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
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_DISABLED);
}

class Counter_wrap : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Raw, Counter_wrap, testing::Values(0u, 10u, 0xFFFFFFF0u, 0x7FFFFFF0u, 0x80000010u),
                         testing::PrintToStringParamName());

TEST_P(Counter_wrap, is_no_motion_and_marks_hold_across_it) {
  for (const uint32_t slot : {slot::pwm_free, slot::corrected_lower}) {
    Bench bench;
    bench.motor[slot].raw_at_start = GetParam();
    bench.to_motion();
    bench.enable_axis(slot);
    bench.keep_moving(slot, 60, 70);
    EXPECT_EQ(bench.position(slot), 58);
    bench.keep_moving(slot, -60, 130);
    EXPECT_EQ(bench.position(slot), -58);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
    bench.motor[slot].reversed = true;
    bench.keep_moving(slot, 60, 40);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_REVERSE);
    EXPECT_EQ(std::abs(bench.axis(slot).fault_value), 21);
  }
}

TEST(P15_total, a_position_saturates_instead_of_wrapping) {
  ilk_config_t config = standard_config();
  ilk_axis_config_t& wide = config.axis[axis];
  wide.min_counts = -(1 << 30);
  wide.max_counts = 1 << 30;
  wide.max_delta_counts = 1u << 30;
  seal(config);
  for (const int32_t way : {1, -1}) {
    Bench bench(config);
    bench.to_ready();
    for (int stride = 0; stride < 6; ++stride) {
      bench.motor[axis].travelled += way * (int64_t{1} << 30);
      bench.tick();
      EXPECT_GT(int64_t{bench.position(axis)} * way, 0) << stride;
    }
    EXPECT_EQ(bench.position(axis), way > 0 ? INT32_MAX : INT32_MIN);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  }
}

TEST(P15_total, the_reach_of_a_blind_axis_saturates_instead_of_wrapping) {
  ilk_config_t config = standard_config();
  config.bad_frame_limit = 5;
  config.axis[axis].min_counts = -(1 << 30);
  config.axis[axis].max_counts = 1 << 30;
  config.axis[axis].max_delta_counts = 1u << 30;
  seal(config);
  Bench bench(config);
  bench.to_ready();
  bench.spoil(axis, FrameFault::missing, 4);
  bench.ticks(4);
  bench.motor[axis].raw_at_start += 0x80000000u;
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE) << "five ticks reach farther than any counter difference";
}

}  // namespace
}  // namespace interlock::kernel_test
