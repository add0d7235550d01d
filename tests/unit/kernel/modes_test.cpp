// The table of modes: each row where it holds and at its boundary; power; what a change of mode drops.
#include <gtest/gtest.h>

#include <functional>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;

Bench moving_bench() {
  Bench bench = motion_bench(axis);
  bench.ask(move(axis, 50));
  EXPECT_TRUE(bench.driven(axis));
  return bench;
}

TEST(Modes, a_valid_configuration_boots_to_LOCKED_BOOT_with_every_axis_disabled_and_not_homed) {
  Bench bench;
  EXPECT_EQ(bench.cause(), ILK_CAUSE_BOOT);
  bench.ticks(100);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_BOOT);
  EXPECT_EQ(bench.system().cause_value, 0u);
  EXPECT_TRUE(bench.wire_is_zero());
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    EXPECT_EQ(bench.axis_state(slot), ILK_AXIS_DISABLED);
    EXPECT_FALSE(bench.homed(slot));
  }
}

TEST(P13_configuration, an_invalid_one_never_leaves_INIT) {
  ilk_config_t config = standard_config();
  config.axis[axis].coast_counts = 0;
  seal(config);
  Bench bench(config);
  bench.ticks(5);
  for (uint32_t kind = ILK_REQUEST_HEARTBEAT; kind <= ILK_REQUEST_RESTORE; ++kind) {
    ilk_request_t request = move(axis, 10);
    request.kind = kind;
    EXPECT_EQ(bench.ask(request), ILK_VERDICT_MODE) << kind;
  }
  bench.estop_loop_closed = 0;
  bench.ticks(5);
  bench.estop_loop_closed = 1;
  bench.pedal(true);
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_INIT);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_NONE);
  EXPECT_EQ(bench.system().causes_seen, 0u);
  EXPECT_FALSE(bench.powered());
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(P1_gate, power_is_on_in_READY_and_MOTION_only) {
  Bench bench;
  bench.ticks(5);
  EXPECT_FALSE(bench.powered());
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.powered());
  bench.rest();
  bench.press();
  EXPECT_TRUE(bench.powered());
  bench.estop_loop_closed = 0;
  bench.tick();
  EXPECT_FALSE(bench.powered());
}

// --- Causes

struct Cause {
  const char* name;
  ilk_cause_t cause;
  uint32_t ticks;  ///< after which it locks, and not before
  uint32_t value;
  std::function<void(Bench&)> begin;
  std::function<void(Bench&)> end;
  ilk_verdict_t reset_meanwhile = ILK_VERDICT_CAUSE_PRESENT;
  uint32_t rest_ticks = 0;  ///< until RESET is accepted after its end
};

void PrintTo(const Cause& cause, std::ostream* stream) { *stream << cause.name; }

/// The slot is FAULTED by a jump and moves on.
void run_away(Bench& bench, uint32_t slot) {
  bench.motor[slot].travelled += 100;
  bench.tick();
  if (bench.mode() == ILK_MODE_READY && bench.pedal_no_closed == 1) bench.pedal(false);
  bench.rest();
  bench.motor[slot].creep = 2;
}

const Cause causes[] = {
    {"estop", ILK_CAUSE_ESTOP, 1, 0, [](Bench& bench) { bench.estop_loop_closed = 0; },
     [](Bench& bench) { bench.estop_loop_closed = 1; }},
    {"bus_transactions_fail", ILK_CAUSE_BUS, 3, 3, [](Bench& bench) { bench.transaction_done = 0; },
     [](Bench& bench) { bench.transaction_done = 1; }},
    {"bus_every_frame_bad", ILK_CAUSE_BUS, 3, 3,
     [](Bench& bench) {
       for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) bench.spoil(slot, FrameFault::wrong_checksum, 1000);
     },
     [](Bench& bench) {
       for (Card& card : bench.card) card.fault_ticks = 0;
     }},
    {"pedal_both_closed", ILK_CAUSE_PEDAL, 9, 3,
     [](Bench& bench) { bench.pedal_no_closed = bench.pedal_nc_closed = 1; },
     [](Bench& bench) { bench.pedal(false); }, ILK_VERDICT_PEDAL_DOWN},
    {"pedal_both_open", ILK_CAUSE_PEDAL, 9, 0,
     [](Bench& bench) { bench.pedal_no_closed = bench.pedal_nc_closed = 0; },
     [](Bench& bench) { bench.pedal(false); }, ILK_VERDICT_PEDAL_DOWN},
    {"overrun", ILK_CAUSE_OVERRUN, 3, 3, [](Bench& bench) { bench.deadlines_missed = 1; },
     [](Bench& bench) { bench.deadlines_missed = 0; }},
    {"runaway", ILK_CAUSE_RUNAWAY, 11, slot::pwm_lower,
     [](Bench& bench) { run_away(bench, slot::pwm_lower); },
     [](Bench& bench) { bench.motor[slot::pwm_lower].creep = 0; }, ILK_VERDICT_CAUSE_PRESENT, 9},
};

class P8_latch : public testing::TestWithParam<Cause> {
 protected:
  static void expect_locked(Bench& bench) {
    EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
    EXPECT_EQ(bench.cause(), GetParam().cause);
    EXPECT_EQ(bench.system().causes_seen, 1u << GetParam().cause);
    EXPECT_FALSE(bench.powered());
    EXPECT_TRUE(bench.wire_is_zero());
  }
};

INSTANTIATE_TEST_SUITE_P(Cause, P8_latch, testing::ValuesIn(causes),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(P8_latch, a_cause_locks_READY_after_its_ticks_and_not_before) {
  Bench bench = ready_bench();
  GetParam().begin(bench);
  bench.ticks(GetParam().ticks - 1);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.tick();
  expect_locked(bench);
  EXPECT_EQ(bench.system().cause_value, GetParam().value);
  EXPECT_EQ(bench.system().cause_tick, bench.now());
}

TEST_P(P8_latch, a_cause_locks_MOTION) {
  Bench bench = moving_bench();
  GetParam().begin(bench);
  bench.keep_moving(axis, 50, GetParam().ticks - 1);
  EXPECT_NE(bench.mode(), ILK_MODE_LOCKED);
  bench.keep_moving(axis, 50, 1);
  expect_locked(bench);
  EXPECT_EQ(bench.axis_state(axis),
            bench.fault(axis) == ILK_FAULT_NONE ? ILK_AXIS_DISABLED : ILK_AXIS_FAULTED);
}

TEST_P(P8_latch, is_left_by_RESET_alone_and_only_when_the_cause_is_gone) {
  Bench bench = ready_bench();
  GetParam().begin(bench);
  bench.ticks(GetParam().ticks);
  EXPECT_EQ(bench.ask(reset()), GetParam().reset_meanwhile);
  GetParam().end(bench);
  bench.ticks(GetParam().rest_ticks);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  Bench later = bench;
  later.ticks(1000);
  EXPECT_EQ(later.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(later.cause(), GetParam().cause);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_NONE);
  EXPECT_EQ(bench.system().causes_seen, 0u);
  EXPECT_EQ(bench.system().cause_tick, 0u);
}

TEST(P8_latch_first, cause_is_kept_and_later_ones_are_listed) {
  Bench bench = ready_bench();
  bench.estop_loop_closed = 0;
  bench.tick();
  const uint32_t first_tick = bench.system().cause_tick;
  bench.deadlines_missed = 1;
  bench.transaction_done = 0;
  bench.pedal_no_closed = 1;
  bench.ticks(10);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP);
  EXPECT_EQ(bench.system().cause_tick, first_tick);
  EXPECT_EQ(bench.system().causes_seen,
            1u << ILK_CAUSE_ESTOP | 1u << ILK_CAUSE_OVERRUN | 1u << ILK_CAUSE_BUS | 1u << ILK_CAUSE_PEDAL);
}

TEST(P8_latch_first, of_two_causes_in_one_tick_the_earlier_in_the_list_is_kept) {
  Bench bench = ready_bench();
  bench.transaction_done = 0;
  bench.deadlines_missed = 1;
  bench.ticks(2);
  bench.estop_loop_closed = 0;
  bench.tick();
  EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP);
  EXPECT_EQ(bench.system().causes_seen,
            1u << ILK_CAUSE_ESTOP | 1u << ILK_CAUSE_OVERRUN | 1u << ILK_CAUSE_BUS);
}

TEST(P8_latch_first, no_request_but_RESET_leaves_LOCKED) {
  Bench bench;
  bench.ticks(5);
  for (uint32_t kind = 0; kind <= ILK_REQUEST_COUNT + 1; ++kind) {
    if (kind == ILK_REQUEST_RESET) continue;
    ilk_request_t request = move(axis, 10);
    request.kind = kind;
    request.holder = 1;
    bench.ask(request);
    EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED) << kind;
  }
}

TEST(Modes, a_cause_counts_in_a_row_only) {
  Bench bench = ready_bench();
  for (int round = 0; round < 5; ++round) {
    bench.transaction_done = 0;
    bench.deadlines_missed = 1;
    bench.ticks(2);
    bench.transaction_done = 1;
    bench.deadlines_missed = 0;
    bench.pedal_nc_closed = 0;
    bench.ticks(8);
    bench.pedal(false);
    bench.ticks(1);
  }
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.system().overruns, 10u);
}

TEST(Modes, each_missed_deadline_counts_against_the_limit) {
  for (const uint32_t missed : {1u, 2u, 3u, 0xFFFFFFFFu}) {
    Bench bench = ready_bench();
    bench.deadlines_missed = missed;
    bench.tick();
    EXPECT_EQ(bench.mode(), missed < 3 ? ILK_MODE_READY : ILK_MODE_LOCKED);
    bench.tick();
    EXPECT_EQ(bench.mode(), missed < 2 ? ILK_MODE_READY : ILK_MODE_LOCKED);
    EXPECT_EQ(bench.system().overruns, missed < 4 ? 2 * missed : 0xFFFFFFFFu);
  }
}

TEST(Modes, one_valid_frame_from_any_card_keeps_the_bus) {
  Bench bench = ready_bench();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) bench.spoil(slot, FrameFault::missing, 20);
  bench.ticks(20);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P2_stop, an_estop_contact_read_as_anything_but_closed_stops) {
  for (const uint32_t contact : {0u, 2u, 3u, 0x80000000u, 0xFFFFFFFFu}) {
    Bench bench = moving_bench();
    bench.estop_loop_closed = contact;
    bench.keep_moving(axis, 50, 1);
    EXPECT_TRUE(bench.wire_is_zero()) << contact;
    EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP) << contact;
    EXPECT_EQ(bench.system().cause_value, contact);
  }
}

TEST(P2_stop, a_failed_transaction_stops_in_its_tick) {
  Bench bench = moving_bench();
  bench.transaction_done = 0;
  bench.keep_moving(axis, 50, 1);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(P2_stop, LOCKED_and_READY_drive_nothing_whatever_is_asked) {
  Bench bench;
  bench.ticks(5);
  for (const bool ready : {false, true}) {
    if (ready) bench.to_ready();
    for (uint32_t slot = 0; slot < slot::axes; ++slot) {
      bench.queue(enable(slot));
      bench.queue(move(slot, 50));
    }
    bench.tick();
    EXPECT_TRUE(bench.wire_is_zero());
    EXPECT_EQ(bench.gate(axis), ILK_GATE_MODE);
  }
}

// --- MOTION begins

TEST(MOTION_begins, power_up_ticks_after_power_came_on_and_a_press_before_is_used_up) {
  for (const uint32_t early : {0u, 1u}) {
    ilk_config_t config = standard_config();
    config.common.power_up_ticks = 50;
    seal(config);
    Bench bench(config);
    bench.ticks(5);
    ASSERT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
    bench.ticks(45 - early);
    bench.pedal(true);
    bench.ticks(5);
    EXPECT_EQ(bench.mode(), early == 0 ? ILK_MODE_MOTION : ILK_MODE_READY);
    bench.ticks(100);
    EXPECT_EQ(bench.mode(), early == 0 ? ILK_MODE_MOTION : ILK_MODE_READY) << "the next try needs a release";
    EXPECT_EQ(bench.system().pedal_armed, 0u);
    if (early == 1) bench.press();
  }
}

TEST(MOTION_begins, power_up_is_counted_anew_after_each_lock) {
  Bench bench = ready_bench();
  bench.estop_loop_closed = 0;
  bench.tick();
  EXPECT_EQ(bench.system().powered_ticks, 0u);
}

TEST(MOTION_begins, not_while_a_required_card_is_lost_and_the_press_is_used_up) {
  ilk_config_t config = standard_config();
  config.axis[slot::pwm_lower].required = 1;
  seal(config);
  for (const uint32_t slot : {slot::sensor, slot::pwm_lower}) {
    Bench bench = ready_bench(config);
    bench.spoil(slot, FrameFault::missing, 9);
    bench.ticks(3);
    bench.pedal(true);
    bench.ticks(5);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    bench.ticks(30);
    ASSERT_EQ(bench.axis(slot).card_valid, 1u);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    bench.press();
    EXPECT_EQ(bench.mode(), ILK_MODE_MOTION) << "a fault of the axis does not block it";
  }
}

TEST(MOTION_begins, two_bad_frames_of_a_required_card_do_not_block_it) {
  Bench bench = ready_bench();
  bench.pedal(true);
  bench.ticks(3);
  bench.spoil(slot::sensor, FrameFault::missing, 2);
  bench.ticks(2);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(MOTION_begins, not_while_a_DISABLED_axis_moves_and_the_press_is_used_up) {
  for (const int32_t stride : {2, 3}) {
    Bench bench = ready_bench();
    bench.ticks(5);
    bench.pedal(true);
    bench.motor[axis].creep = stride * 2;
    bench.ticks(5);
    bench.motor[axis].creep = 0;
    EXPECT_EQ(bench.mode(), stride == 2 ? ILK_MODE_MOTION : ILK_MODE_READY) << "20 counts, or 30";
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
    if (stride == 2) continue;
    bench.ticks(50);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    bench.press();
  }
}

TEST(MOTION_begins, rest_ticks_after_a_DISABLED_axis_moved) {
  for (const uint32_t early : {0u, 1u}) {
    Bench bench = ready_bench();
    bench.push(axis, 24);
    bench.ticks(4 - early);
    bench.pedal(true);
    bench.ticks(5);
    EXPECT_EQ(bench.mode(), early == 0 ? ILK_MODE_MOTION : ILK_MODE_READY);
  }
}

TEST(MOTION_begins, beside_an_axis_fault_and_keeps_that_axis_undriven) {
  Bench bench = faulted_bench(slot::pwm_lower);
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(bench.ask(move(slot::pwm_lower, 50)), ILK_VERDICT_FAULTED);
  bench.keep_moving(axis, 50, 10);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  EXPECT_TRUE(bench.driven(axis));
  EXPECT_FALSE(bench.driven(slot::pwm_lower));
  EXPECT_EQ(bench.gate(slot::pwm_lower), ILK_GATE_ENABLE);
}

// --- MOTION ends

struct End {
  const char* name;
  uint32_t ticks;  ///< after which MOTION ends, and not before
  std::function<void(Bench&)> begin;
};

void PrintTo(const End& end, std::ostream* stream) { *stream << end.name; }

const End ends[] = {
    {"pedal_released", 1, [](Bench& bench) { bench.pedal(false); }},
    {"normally_open_contact_alone", 1, [](Bench& bench) { bench.pedal_no_closed = 0; }},
    {"normally_closed_contact_alone", 1, [](Bench& bench) { bench.pedal_nc_closed = 1; }},
    {"app_silent", 30, [](Bench& bench) { bench.app_alive = false; }},
    {"STOP", 1, [](Bench& bench) { bench.queue(stop()); }},
    {"new_axis_fault", 1, [](Bench& bench) { bench.motor[slot::non_pwm_upper].travelled += 100; }},
    {"required_card_lost", 3, [](Bench& bench) { bench.spoil(slot::sensor, FrameFault::missing, 30); }},
    {"change_of_holder", 1, [](Bench& bench) { bench.holder = 2; }},
    {"new_attachment", 1,
     [](Bench& bench) {
       bench.link_generation = 2;
       bench.last_sequence = 0;
     }},
};

class MOTION_ends : public testing::TestWithParam<End> {};

INSTANTIATE_TEST_SUITE_P(When, MOTION_ends, testing::ValuesIn(ends),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(MOTION_ends, in_that_tick_with_zero_drive_and_nothing_is_resumed) {
  Bench bench = moving_bench();
  bench.enable_axis(slot::pwm_lower);
  bench.ask(home(slot::pwm_lower));
  GetParam().begin(bench);
  bench.keep_moving(axis, 60, GetParam().ticks - 1);
  ASSERT_EQ(bench.mode(), ILK_MODE_MOTION);
  ASSERT_TRUE(bench.driven(axis));
  bench.queue(move(axis, 60));
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_TRUE(bench.powered());
  EXPECT_EQ(bench.system().consent, 0u);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_ENABLED);
  EXPECT_EQ(bench.axis(axis).lease_ticks, 0u);
  EXPECT_EQ(bench.axis(axis).setpoint_counts, 0);
  EXPECT_EQ(bench.axis_state(slot::pwm_lower), ILK_AXIS_ENABLED);
  EXPECT_EQ(bench.axis(slot::pwm_lower).homing_phase, uint32_t{ILK_HOMING_NONE});
  EXPECT_FALSE(bench.homed(slot::pwm_lower));
  bench.app_alive = true;
  bench.card[slot::sensor].fault_ticks = 0;
  bench.pedal(true);
  bench.ticks(8);
  EXPECT_NE(bench.mode(), ILK_MODE_MOTION) << "the pedal alone does not begin it again";
  bench.pedal(false);
  bench.rest();
  bench.press();
  bench.ticks(30);
  EXPECT_TRUE(bench.wire_is_zero()) << "neither does the next press resume what was dropped";
}

TEST(P2_stop, STOP_after_a_MOVE_in_the_same_tick_wins) {
  Bench bench = moving_bench();
  bench.queue(move(axis, 60));
  bench.queue(stop());
  bench.tick();
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(MOTION_ends_not, for_a_HEARTBEAT_of_the_same_holder) {
  Bench bench = moving_bench();
  EXPECT_EQ(bench.ask(heartbeat(1)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(P10_silence, a_HEARTBEAT_just_in_time_keeps_MOTION_and_nothing_else_counts_as_one) {
  Bench bench = moving_bench();
  bench.app_alive = false;
  for (int round = 0; round < 5; ++round) {
    bench.keep_moving(axis, 50, 28);
    bench.queue(heartbeat(1));
    bench.tick();
    EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
    EXPECT_EQ(bench.system().app_age_ticks, 0u);
  }
  bench.tick();
  EXPECT_EQ(bench.system().app_age_ticks, 1u) << "the age is 1 in the tick after";
  bench.keep_moving(axis, 50, 28);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  bench.keep_moving(axis, 50, 1);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.system().app_alive, 0u);
}

TEST(P10_silence, the_app_is_silent_at_boot_whatever_attachment_it_has) {
  for (const uint32_t generation : {0u, 1u}) {
    Bench bench;
    bench.link_generation = generation;
    bench.app_alive = false;
    bench.tick();
    EXPECT_EQ(bench.system().app_alive, 0u);
    EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
  }
}

// --- What a lock leaves

TEST(Locking, disables_every_axis_but_the_faulted_drops_its_orders_and_keeps_homed) {
  Bench bench = faulted_bench(slot::non_pwm_upper);
  bench.reference(axis);
  bench.enable_axis(axis);
  bench.enable_axis(slot::pwm_lower);
  bench.press();
  bench.queue(move(axis, 50));
  bench.queue(home(slot::pwm_lower));
  bench.tick();
  ASSERT_EQ(bench.axis_state(axis), ILK_AXIS_MOVING);
  ASSERT_EQ(bench.axis_state(slot::pwm_lower), ILK_AXIS_HOMING);
  bench.estop_loop_closed = 0;
  bench.tick();
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_DISABLED);
  EXPECT_TRUE(bench.homed(axis));
  EXPECT_EQ(bench.axis(axis).lease_ticks, 0u);
  EXPECT_EQ(bench.axis_state(slot::pwm_lower), ILK_AXIS_DISABLED);
  EXPECT_EQ(bench.axis(slot::pwm_lower).homing_phase, uint32_t{ILK_HOMING_NONE});
  EXPECT_EQ(bench.axis_state(slot::non_pwm_upper), ILK_AXIS_FAULTED);
  EXPECT_EQ(bench.fault(slot::non_pwm_upper), ILK_FAULT_JUMP);
}

TEST(Locking, an_axis_fault_does_not_block_RESET) {
  Bench bench = faulted_bench(axis);
  bench.estop_loop_closed = 0;
  bench.tick();
  bench.estop_loop_closed = 1;
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_FAULTED);
}

}  // namespace
}  // namespace interlock::kernel_test
