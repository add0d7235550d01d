// MOVE, its lease, its direction and its deadband; the gates that say why an axis stands.
#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;

Bench enabled_bench() {
  Bench bench;
  bench.to_motion();
  bench.enable_axis(axis);
  return bench;
}

TEST(P1_gate, a_lease_drives_for_exactly_its_ticks_and_ends) {
  for (const uint32_t lease : {1u, 2u, 7u, 20u}) {
    Bench bench = enabled_bench();
    bench.queue(move(axis, 90, 100, lease));
    for (uint32_t held = 0; held < lease; ++held) {
      bench.tick();
      EXPECT_TRUE(bench.driven(axis)) << held;
      EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_MOVING);
    }
    bench.tick();
    EXPECT_FALSE(bench.driven(axis));
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_ENABLED);
    EXPECT_EQ(bench.gate(axis), ILK_GATE_LEASE);
  }
}

TEST(P1_gate, a_lease_runs_on_while_the_axis_is_not_driven) {
  Bench bench = enabled_bench();
  bench.queue(move(axis, 90, 100, 5));
  bench.tick();
  bench.spoil(axis, FrameFault::missing, 2);
  bench.ticks(4);
  EXPECT_TRUE(bench.driven(axis));
  bench.tick();
  EXPECT_FALSE(bench.driven(axis));
}

TEST(P1_gate, a_renewed_lease_starts_anew) {
  Bench bench = enabled_bench();
  bench.ask(move(axis, 90, 100, 5));
  bench.ticks(3);
  bench.ask(move(axis, 90, 100, 5));
  bench.ticks(4);
  EXPECT_TRUE(bench.driven(axis));
  bench.tick();
  EXPECT_FALSE(bench.driven(axis));
}

TEST(P1_gate, without_a_MOVE_an_enabled_axis_is_not_driven) {
  Bench bench = enabled_bench();
  for (int idle = 0; idle < 100; ++idle) {
    bench.tick();
    EXPECT_TRUE(bench.wire_is_zero());
  }
}

TEST(P1_gate, a_bad_frame_leaves_its_axis_undriven_in_that_tick_only) {
  Bench bench = enabled_bench();
  bench.enable_axis(slot::pwm_lower);
  bench.queue(move(slot::pwm_lower, 90));
  bench.ask(move(axis, 90));
  bench.spoil(axis, FrameFault::wrong_checksum, 1);
  bench.tick();
  EXPECT_FALSE(bench.driven(axis));
  EXPECT_EQ(bench.gate(axis), ILK_GATE_CARD);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_MOVING);
  EXPECT_TRUE(bench.driven(slot::pwm_lower));
  bench.tick();
  EXPECT_TRUE(bench.driven(axis));
  EXPECT_EQ(bench.gate(axis), ILK_GATE_OPEN);
}

TEST(P1_gate, an_axis_that_was_never_enabled_is_not_driven) {
  Bench bench = enabled_bench();
  bench.ask(move(slot::pwm_lower, 50));
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.gate(slot::pwm_lower), ILK_GATE_ENABLE);
}

TEST(P1_gate, a_disabled_axis_stops_in_the_same_tick) {
  Bench bench = enabled_bench();
  bench.ask(move(axis, 50));
  bench.queue(disable(axis));
  bench.tick();
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.gate(axis), ILK_GATE_ENABLE);
}

TEST(P1_gate, each_slot_drives_only_its_own_card) {
  for (uint32_t chosen = 0; chosen < slot::axes; ++chosen) {
    Bench bench;
    bench.to_motion();
    for (uint32_t slot = 0; slot < slot::axes; ++slot) bench.enable_axis(slot);
    bench.ask(move(chosen, 50));
    for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) EXPECT_EQ(bench.driven(slot), slot == chosen);
  }
}

TEST(Direction, leads_to_the_setpoint_from_either_side_on_every_card) {
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    Bench bench;
    bench.to_motion();
    bench.enable_axis(slot);
    for (const int32_t target : {60, -60, 0}) {
      bench.keep_moving(slot, target, 150);
      EXPECT_LE(std::abs(bench.position(slot) - target), 2) << "slot " << slot;
      EXPECT_EQ(bench.position(slot), bench.motor[slot].travelled);
      EXPECT_FALSE(bench.driven(slot));
      EXPECT_EQ(bench.gate(slot), ILK_GATE_SETPOINT);
    }
  }
}

TEST(Direction, none_within_the_deadband) {
  Bench bench = enabled_bench();
  for (const int32_t target : {-2, -1, 0, 1, 2}) {
    EXPECT_EQ(bench.ask(move(axis, target)), ILK_VERDICT_ACCEPTED);
    EXPECT_FALSE(bench.driven(axis)) << target;
    EXPECT_EQ(bench.gate(axis), ILK_GATE_SETPOINT);
  }
  bench.ask(move(axis, 3));
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_INCREASING);
  bench.ask(move(axis, -3));
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_DECREASING);
}

TEST(Direction, follows_the_position_past_the_setpoint) {
  Bench bench = enabled_bench();
  bench.motor[axis].speed = 6;
  bench.keep_moving(axis, 9, 3);
  EXPECT_EQ(bench.position(axis), 12);
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_DECREASING);
}

TEST(L1_progress, an_axis_at_the_fastest_allowed_speed_does_not_hunt) {
  for (int32_t target = -40; target <= 40; ++target) {
    Bench bench = enabled_bench();
    bench.motor[axis].speed = 5;
    bench.keep_moving(axis, target, 60);
    EXPECT_LE(std::abs(bench.position(axis) - target), 2);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  }
}

TEST(P1_gate, zero_drive_is_a_move_that_does_not_drive) {
  Bench bench = enabled_bench();
  EXPECT_EQ(bench.ask(move(axis, 50, 0)), ILK_VERDICT_ACCEPTED);
  EXPECT_FALSE(bench.driven(axis));
  EXPECT_EQ(bench.gate(axis), ILK_GATE_SETPOINT);
}

TEST(L2_recoverable, from_every_fault_and_lock_back_to_motion_of_the_same_axis) {
  Bench bench = enabled_bench();
  bench.motor[axis].travelled += 100;
  bench.tick();
  ASSERT_EQ(bench.axis_state(axis), ILK_AXIS_FAULTED);
  bench.estop_loop_closed = 0;
  bench.tick();
  bench.estop_loop_closed = 1;
  bench.to_ready();
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(bench.ask(move(axis, bench.position(axis) + 50)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

}  // namespace
}  // namespace interlock::kernel_test
