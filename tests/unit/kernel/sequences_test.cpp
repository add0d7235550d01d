// The eleven sequences that broke edition 1 of the kernel from outside. Each must be harmless now.
#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;
constexpr uint32_t switched = slot::pwm_lower;

uint32_t ticks_until_homed(Bench& bench, uint32_t limit = 4000) {
  uint32_t ticks = 0;
  while (bench.axis_state(switched) == ILK_AXIS_HOMING && ticks < limit) {
    bench.tick();
    ++ticks;
  }
  return ticks;
}

TEST(P5_sequence, a_lost_reply_with_DISABLE_then_ENABLE_with_MOVE_cannot_hide_a_stall) {
  for (const uint32_t wait : {0u, 1u, 9u, 10u, 12u}) {
    Bench bench = motion_bench(axis);
    bench.motor[axis].frozen = true;
    uint32_t driven = 0;
    for (uint32_t round = 0; round < 2000 && bench.fault(axis) == ILK_FAULT_NONE; ++round) {
      bench.spoil(axis, FrameFault::missing, 1);
      bench.queue(disable(axis));
      bench.tick();
      bench.ticks(wait);
      bench.queue(enable(axis));
      bench.queue(move(axis, 60, 100, 1));
      bench.tick();
      driven += bench.driven(axis) ? 1 : 0;
    }
    EXPECT_LE(driven, 50u);
    EXPECT_EQ(bench.fault(axis), wait < 9 ? ILK_FAULT_NONE : ILK_FAULT_STALL) << "no rest, no ENABLE";
  }
}

TEST(P7_sequence, DISABLE_ENABLE_HOME_do_not_renew_the_bounds_of_homing) {
  for (const uint32_t wait : {0u, 12u}) {
    Bench bench = motion_bench(switched);
    bench.motor[switched].switch_at = -100000;
    uint32_t homing_ticks = 0;
    for (uint32_t tick = 0; tick < 20000 && bench.fault(switched) == ILK_FAULT_NONE; ++tick) {
      if (tick % (wait + 40) == 0) bench.queue(disable(switched));
      if (tick % (wait + 40) == wait) {
        bench.queue(enable(switched));
        bench.queue(home(switched));
      }
      bench.tick();
      homing_ticks += bench.axis_state(switched) == ILK_AXIS_HOMING ? 1 : 0;
    }
    EXPECT_EQ(bench.fault(switched), wait == 0 ? ILK_FAULT_NONE : ILK_FAULT_HOMING_TRAVEL)
        << "no rest, no ENABLE";
    EXPECT_LE(std::abs(bench.motor[switched].travelled), 2400);
    EXPECT_LE(homing_ticks, 3000u);
  }
}

TEST(P7_sequence, HOME_DISABLE_ENABLE_MOVE_does_not_renew_the_travel_of_an_axis_that_is_not_homed) {
  Bench bench = motion_bench(switched);
  uint32_t moved = 0;
  for (uint32_t round = 0; round < 60; ++round) {
    bench.ask(home(switched));
    bench.ask(disable(switched));
    bench.rest();
    bench.queue(enable(switched));
    for (uint32_t tick = 0; tick < 20; ++tick) {
      const int64_t before = bench.motor[switched].travelled;
      bench.queue(move(switched, bench.position(switched) + 10));
      bench.tick();
      moved += static_cast<uint32_t>(bench.motor[switched].travelled - before);
    }
  }
  EXPECT_GE(moved, 80u);
  EXPECT_LE(moved, 100u);
}

TEST(P17_sequence, one_frame_with_the_switch_triggered_far_from_it_is_no_reference) {
  Bench bench = motion_bench(switched);
  bench.motor[switched].switch_at = -400;
  bench.ask(home(switched));
  bench.ticks(50);
  bench.tick_with_switch(switched, true);
  ticks_until_homed(bench);
  EXPECT_TRUE(bench.homed(switched));
  EXPECT_EQ(bench.position(switched), -980);
  EXPECT_EQ(bench.motor[switched].travelled, -400);
}

TEST(P17_sequence, an_opening_bounce_at_the_start_is_not_taken_for_the_edge) {
  for (uint32_t pattern = 0; pattern < 12; ++pattern) {
    Bench bench = motion_bench(switched);
    bench.motor[switched].switch_at = 10;
    bench.ask(home(switched));
    while (bench.motor[switched].travelled <= 10 && bench.axis_state(switched) == ILK_AXIS_HOMING)
      bench.tick();
    for (uint32_t sample = 0; sample < 4; ++sample)
      bench.tick_with_switch(switched, ((pattern + 3) >> sample & 1u) != 0);
    ticks_until_homed(bench);
    EXPECT_TRUE(bench.homed(switched));
    EXPECT_EQ(bench.position(switched) + 980, bench.motor[switched].travelled - 10) << pattern;
  }
}

TEST(P17_sequence, the_first_homing_succeeds_from_either_stop_with_the_least_budget_that_is_valid) {
  ilk_config_t config = standard_config();
  config.axis[switched].home_travel_counts = 2244;
  config.axis[switched].home_timeout_ticks = 2521;
  seal(config);
  for (const int32_t switch_at : {30, -1990}) {
    Bench bench = motion_bench(switched, config);
    bench.motor[switched].switch_at = switch_at;
    bench.motor[switched].hysteresis = 2;
    bench.motor[switched].coast = 4;
    bench.ask(home(switched));
    ticks_until_homed(bench);
    EXPECT_EQ(bench.fault(switched), ILK_FAULT_NONE);
    EXPECT_TRUE(bench.homed(switched));
  }
}

TEST(P6_sequence, no_motion_beside_a_runaway_and_no_CLEAR_FAULT_or_ENABLE_while_it_moves) {
  Bench bench = faulted_bench(axis);
  bench.enable_axis(switched);
  bench.press();
  bench.motor[axis].creep = 3;
  bench.ticks(6);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
  EXPECT_FALSE(bench.powered());
  bench.pedal(false);
  bench.ticks(50);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(enable(axis)), ILK_VERDICT_MODE);
}

TEST(P5_sequence, a_frozen_encoder_at_full_drive_is_known_after_tens_of_milliseconds) {
  Bench bench = homed_bench(axis);
  bench.keep_moving(axis, 900, 30, 1000);
  bench.motor[axis].frozen = true;
  uint32_t driven = 0;
  while (bench.fault(axis) == ILK_FAULT_NONE && driven < 500) {
    bench.keep_moving(axis, 900, 1, 1000);
    driven += bench.driven(axis) ? 1 : 0;
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_LE(driven, 22u);
}

TEST(P13_sequence, a_configuration_that_is_valid_can_be_reset_and_moved) {
  ilk_config_t config = standard_config();
  config.common.app_timeout_ticks = 1;
  seal(config);
  EXPECT_EQ(ilk_config_validate(&config).error, uint32_t{ILK_CONFIG_ERROR_APP_TIMEOUT});
  config.common.app_timeout_ticks = 2;
  seal(config);
  Bench bench = motion_bench(axis, config);
  EXPECT_EQ(bench.ask(move(axis, 50)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

TEST(P17_sequence, a_counter_that_dithers_by_its_noise_can_be_homed) {
  for (const int32_t dither : {1, -1}) {
    Bench bench;
    bench.motor[switched].dither = dither;
    bench.motor[switched].switch_at = -50;
    bench.to_ready();
    bench.enable_axis(switched);
    bench.press();
    bench.ask(home(switched));
    ticks_until_homed(bench);
    EXPECT_TRUE(bench.homed(switched));
    EXPECT_LE(std::abs(bench.position(switched) + 980), 2);
    EXPECT_EQ(bench.fault(switched), ILK_FAULT_NONE);
  }
}

TEST(P17_sequence, a_card_that_restarts_near_zero_never_stays_homed) {
  for (const bool by_bit : {false, true}) {
    Bench bench;
    bench.motor[switched].raw_at_start = 4;
    bench.to_motion_homed(switched);
    bench.motor[switched].raw_at_start = 0;
    if (by_bit) {
      bench.card[switched].status = incoming::status_was_reset;
    } else {
      bench.card[switched].heartbeat = 0;
    }
    bench.tick();
    EXPECT_EQ(bench.fault(switched), ILK_FAULT_CARD_RESET);
    EXPECT_FALSE(bench.homed(switched));
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  }
}

TEST(P9_sequence, STOP_in_READY_takes_back_the_armed_pedal) {
  Bench bench = ready_bench();
  ASSERT_EQ(bench.system().pedal_armed, 1u);
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.system().pedal_armed, 0u);
  bench.pedal(true);
  bench.ticks(100);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

}  // namespace
}  // namespace interlock::kernel_test
