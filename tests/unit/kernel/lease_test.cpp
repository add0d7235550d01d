// MOVE, its lease, its direction and its deadband; the gates that say why an axis stands.
#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;

TEST(P1_gate, a_lease_drives_for_exactly_its_ticks_that_of_its_acceptance_included) {
  for (const uint32_t lease : {1u, 2u, 7u, 20u}) {
    Bench bench = motion_bench(axis);
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

TEST(P1_gate, a_lease_runs_on_while_the_axis_is_not_driven_and_a_new_one_starts_anew) {
  Bench bench = motion_bench(axis);
  bench.ask(move(axis, 90, 100, 5));
  bench.spoil(axis, FrameFault::missing, 2);
  bench.ticks(3);
  bench.ask(move(axis, 90, 100, 5));
  bench.spoil(axis, FrameFault::missing, 2);
  bench.ticks(4);
  EXPECT_TRUE(bench.driven(axis));
  bench.tick();
  EXPECT_FALSE(bench.driven(axis));
}

TEST(P1_gate, names_the_first_condition_that_blocks) {
  Bench bench = motion_bench(axis);
  bench.ticks(50);
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.gate(axis), ILK_GATE_LEASE);
  EXPECT_EQ(bench.gate(slot::pwm_lower), ILK_GATE_ENABLE);
  EXPECT_EQ(bench.gate(slot::empty), ILK_GATE_CARD);
  bench.ask(move(axis, 50));
  EXPECT_EQ(bench.gate(axis), ILK_GATE_OPEN);
  bench.ask(disable(axis));
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.gate(axis), ILK_GATE_ENABLE);
  bench.spoil(axis, FrameFault::missing, 1);
  bench.tick();
  EXPECT_EQ(bench.gate(axis), ILK_GATE_CARD);
  bench.release();
  EXPECT_EQ(bench.gate(axis), ILK_GATE_MODE);
}

TEST(P1_gate, each_slot_drives_only_its_own_card) {
  Bench enabled = ready_bench();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) enabled.enable_axis(slot);
  enabled.press();
  for (uint32_t chosen = 0; chosen < slot::axes; ++chosen) {
    Bench bench = enabled;
    bench.ask(move(chosen, 50));
    for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) EXPECT_EQ(bench.driven(slot), slot == chosen);
  }
}

TEST(Direction, leads_to_the_setpoint_from_either_side_on_every_card) {
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    Bench bench = homed_bench(slot);
    for (const int32_t target : {60, -60, 0}) {
      bench.keep_moving(slot, target, 150);
      EXPECT_LE(std::abs(bench.position(slot) - target), 2) << "slot " << slot;
      EXPECT_EQ(bench.position(slot), bench.motor[slot].travelled);
      EXPECT_FALSE(bench.driven(slot));
      EXPECT_EQ(bench.gate(slot), ILK_GATE_SETPOINT);
    }
  }
}

TEST(Direction, is_none_within_the_deadband_and_follows_the_position_past_the_setpoint) {
  Bench bench = motion_bench(axis);
  for (const int32_t target : {-2, -1, 0, 1, 2}) {
    EXPECT_EQ(bench.ask(move(axis, target)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.gate(axis), ILK_GATE_SETPOINT) << target;
  }
  bench.ask(move(axis, -3));
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_DECREASING);
  bench.motor[axis].frozen = true;
  bench.ask(move(axis, 3));
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_INCREASING);
  bench.motor[axis].travelled += 7;
  bench.tick();
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_DECREASING);
}

TEST(L1_progress, an_axis_at_the_fastest_allowed_speed_does_not_hunt) {
  for (int32_t target = -40; target <= 40; target += 3) {
    Bench bench = homed_bench(axis);
    bench.motor[axis].speed = 5;
    bench.keep_moving(axis, target, 60);
    EXPECT_LE(std::abs(bench.position(axis) - target), 2);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  }
}

TEST(L2_recoverable, from_every_fault_and_lock_back_to_motion_of_the_same_axis) {
  Bench bench = faulted_bench(axis);
  bench.motor[axis].creep = 5;
  bench.ticks(50);
  ASSERT_EQ(bench.cause(), ILK_CAUSE_RUNAWAY);
  bench.motor[axis].creep = 0;
  bench.rest();
  bench.to_ready();
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(bench.ask(move(axis, bench.position(axis) + 50)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

}  // namespace
}  // namespace interlock::kernel_test
