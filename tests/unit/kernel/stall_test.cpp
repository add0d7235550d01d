// Stall: driven ticks without progress add up until progress; nothing else clears them.
#include <gtest/gtest.h>

#include <functional>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;
constexpr uint32_t stall_ticks = 50;

Bench jammed_bench(const ilk_config_t& config = standard_config()) {
  Bench bench(config);
  bench.to_motion();
  bench.enable_axis(axis);
  bench.motor[axis].frozen = true;
  return bench;
}

/// Sends what `request` says before each tick until the axis faults; counts the driven ticks.
uint32_t driven_until_fault(Bench& bench, const std::function<ilk_request_t(uint32_t)>& request,
                            uint32_t limit = 5000) {
  uint32_t driven = 0;
  for (uint32_t tick = 0; tick < limit && bench.fault(axis) == ILK_FAULT_NONE; ++tick) {
    bench.queue(request(tick));
    bench.tick();
    driven += bench.driven(axis) ? 1 : 0;
  }
  return driven;
}

uint32_t driven_until_fault(Bench& bench, int32_t target) {
  return driven_until_fault(bench, [target](uint32_t) { return move(axis, target); });
}

TEST(P5_stall, faults_after_exactly_its_driven_ticks_without_progress) {
  for (const int32_t target : {80, -80}) {
    Bench bench = jammed_bench();
    EXPECT_EQ(driven_until_fault(bench, target), stall_ticks);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_FAULTED);
    EXPECT_EQ(bench.axis(axis).fault_value, 0);
    EXPECT_EQ(bench.axis(axis).fault_tick, bench.now());
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    EXPECT_TRUE(bench.wire_is_zero());
  }
}

TEST(P5_stall, keeps_the_axis_undriven_until_cleared_and_enabled) {
  Bench bench = jammed_bench();
  driven_until_fault(bench, 80);
  bench.motor[axis].frozen = false;
  bench.press();
  bench.keep_moving(axis, 80, 20);
  EXPECT_TRUE(bench.wire_is_zero());
  bench.release();
  ASSERT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  bench.press();
  bench.keep_moving(axis, 80, 20);
  EXPECT_TRUE(bench.wire_is_zero());
  bench.enable_axis(axis);
  bench.keep_moving(axis, 80, 20);
  EXPECT_TRUE(bench.driven(axis));
  bench.keep_moving(axis, 80, 200);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE) << "the count began anew";
}

TEST(P5_stall, progress_in_the_first_frame_after_a_rest_counts_at_once) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 1);
  bench.motor[axis].travelled += 2;
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks) << "not a frame later";
}

TEST(P5_stall, progress_of_its_minimum_clears) {
  Bench bench = jammed_bench();
  for (int round = 0; round < 10; ++round) {
    bench.keep_moving(axis, 80, stall_ticks - 2);
    bench.motor[axis].travelled += 2;
    bench.keep_moving(axis, 80, 1);
    ASSERT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  }
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks - 1) << "the tick that saw the progress counts anew";
}

TEST(P5_stall, progress_may_come_in_single_counts) {
  Bench bench = jammed_bench();
  for (int round = 0; round < 20; ++round) {
    bench.motor[axis].travelled += 1;
    bench.keep_moving(axis, 80, 20);
    ASSERT_EQ(bench.fault(axis), ILK_FAULT_NONE) << round;
  }
}

TEST(P5_stall, progress_below_its_minimum_does_not_clear) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 20);
  bench.motor[axis].travelled += 1;
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks - 20);
  EXPECT_EQ(bench.axis(axis).fault_value, 1);
}

TEST(P5_stall, undriven_ticks_pause_the_count) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 20);
  bench.ticks(20);
  bench.spoil(axis, FrameFault::missing, 2);
  bench.ticks(500);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks - 20 - 19) << "the last lease drove 19 ticks more";
}

TEST(P5_stall, a_new_MOVE_does_not_clear) {
  Bench bench = jammed_bench();
  EXPECT_EQ(
      driven_until_fault(bench, [](uint32_t tick) { return move(axis, 10 + static_cast<int32_t>(tick)); }),
      stall_ticks);
}

TEST(P5_stall, a_change_of_direction_does_not_clear) {
  Bench bench = jammed_bench();
  EXPECT_EQ(driven_until_fault(bench, [](uint32_t tick) { return move(axis, tick % 2 == 0 ? 80 : -80); }),
            stall_ticks);
}

TEST(P5_stall, a_lease_that_ran_out_does_not_clear) {
  Bench bench = jammed_bench();
  uint32_t driven = 0;
  for (int round = 0; round < 500 && bench.fault(axis) == ILK_FAULT_NONE; ++round) {
    bench.queue(move(axis, 80, 100, 1));
    bench.tick();
    driven += bench.driven(axis) ? 1 : 0;
    bench.ticks(3);
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_EQ(driven, stall_ticks);
}

TEST(P5_stall, idle_time_does_not_clear) {
  Bench bench = jammed_bench();
  for (uint32_t held = 0; held < stall_ticks - 1; ++held) bench.ask(move(axis, 80, 100, 1));
  bench.ticks(2000);
  EXPECT_EQ(driven_until_fault(bench, 80), 1u);
}

TEST(P5_stall, noise_does_not_clear) {
  Bench bench = jammed_bench();
  const uint32_t driven = driven_until_fault(bench, [&bench](uint32_t tick) {
    bench.motor[axis].travelled = tick % 2;
    return move(axis, 80);
  });
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_EQ(driven, stall_ticks);
}

TEST(P5_stall, reverse_motion_does_not_clear) {
  Bench bench = jammed_bench();
  const uint32_t driven = driven_until_fault(bench, [&bench](uint32_t tick) {
    bench.motor[axis].travelled -= tick % 5 == 0 ? 1 : 0;
    return move(axis, 80);
  });
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_EQ(driven, stall_ticks);
}

TEST(P5_stall, motion_back_to_where_it_was_is_no_progress) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 5);
  bench.motor[axis].travelled -= 5;
  bench.keep_moving(axis, 80, 5);
  bench.motor[axis].travelled += 6;
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks - 10);
}

TEST(P5_stall, drive_dropped_just_before_the_limit_does_not_clear) {
  Bench bench = jammed_bench();
  EXPECT_EQ(
      driven_until_fault(bench, [](uint32_t tick) { return move(axis, 80, tick % 50 == 49 ? 0 : 100); }),
      stall_ticks);
}

TEST(P5_stall, a_hostile_app_that_drops_drive_every_499_ticks_stalls_at_500_driven) {
  ilk_config_t config = standard_config();
  config.axis[axis].stall_ticks = 500;
  seal(config);
  Bench bench = jammed_bench(config);
  EXPECT_EQ(
      driven_until_fault(bench, [](uint32_t tick) { return move(axis, 80, tick % 500 == 499 ? 0 : 100); }),
      500u);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
}

TEST(P5_stall, pedal_release_and_press_do_not_clear) {
  Bench bench = jammed_bench();
  uint32_t driven = 0;
  for (int round = 0; round < 20 && bench.fault(axis) == ILK_FAULT_NONE; ++round) {
    for (int held = 0; held < 10 && bench.fault(axis) == ILK_FAULT_NONE; ++held) {
      bench.keep_moving(axis, 80, 1);
      driven += bench.driven(axis) ? 1 : 0;
    }
    if (bench.fault(axis) == ILK_FAULT_NONE) bench.press();
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_EQ(driven, stall_ticks);
}

TEST(P5_stall, DISABLE_and_ENABLE_do_not_clear) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 30);
  bench.ask(disable(axis));
  bench.enable_axis(axis);
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks - 30);
}

TEST(P5_stall, a_lock_and_RESET_do_not_clear) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 30);
  bench.estop_loop_closed = 0;
  bench.tick();
  bench.estop_loop_closed = 1;
  bench.to_ready();
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks - 30);
}

TEST(P5_stall, SET_HOME_and_RESTORE_are_no_progress) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 30);
  bench.release();
  bench.tick();
  ASSERT_EQ(bench.ask(restore(axis, 500)), ILK_VERDICT_ACCEPTED);
  ASSERT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_ACCEPTED);
  bench.press();
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks - 30);
}

TEST(P5_stall, arrival_at_a_steady_setpoint_clears) {
  Bench bench = jammed_bench();
  for (uint32_t held = 0; held < stall_ticks - 1; ++held) bench.ask(move(axis, 3, 100));
  bench.motor[axis].travelled += 1;
  bench.ask(move(axis, 3));
  ASSERT_EQ(bench.gate(axis), ILK_GATE_SETPOINT);
  bench.ticks(30);
  EXPECT_EQ(driven_until_fault(bench, 60), stall_ticks);
}

TEST(P5_stall, arrival_because_the_setpoint_was_moved_to_the_axis_does_not_clear) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, stall_ticks - 1);
  bench.keep_moving(axis, 0, 10);
  ASSERT_EQ(bench.gate(axis), ILK_GATE_SETPOINT);
  EXPECT_EQ(driven_until_fault(bench, 80), 1u);
}

TEST(P5_stall, arrival_at_a_setpoint_that_changed_on_the_way_does_not_clear) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 4, 20);
  bench.keep_moving(axis, 3, 20);
  bench.motor[axis].travelled += 1;
  bench.keep_moving(axis, 3, 5);
  ASSERT_EQ(bench.gate(axis), ILK_GATE_SETPOINT);
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks - 40);
}

TEST(P5_stall, an_axis_that_moves_slowly_but_enough_does_not_stall) {
  Bench bench = jammed_bench();
  for (uint32_t tick = 0; tick < 900; ++tick) {
    bench.motor[axis].travelled += tick % 20 == 19 ? 1 : 0;
    bench.keep_moving(axis, 80, 1);
    ASSERT_EQ(bench.fault(axis), ILK_FAULT_NONE) << tick;
  }
}

TEST(P5_stall, axes_count_apart) {
  Bench bench = jammed_bench();
  bench.enable_axis(slot::pwm_lower);
  for (uint32_t tick = 0; tick < stall_ticks; ++tick) {
    bench.queue(move(slot::pwm_lower, 80));
    bench.keep_moving(axis, 80, 1);
  }
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_EQ(bench.fault(slot::pwm_lower), ILK_FAULT_NONE);
  EXPECT_EQ(bench.position(slot::pwm_lower), 50);
}

}  // namespace
}  // namespace interlock::kernel_test
