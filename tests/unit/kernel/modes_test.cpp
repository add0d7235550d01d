// Both mode tables of the specification: each row where it holds and at its boundary.
#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

Bench moving_bench() {
  Bench bench;
  bench.to_motion();
  bench.enable_axis(slot::pwm_free);
  bench.queue(move(slot::pwm_free, 50));
  bench.tick();
  EXPECT_TRUE(bench.driven(slot::pwm_free));
  return bench;
}

TEST(Modes, valid_configuration_boots_to_LOCKED_BOOT) {
  Bench bench;
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_BOOT);
  EXPECT_EQ(bench.state().cause_value, 0u);
  bench.ticks(100);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_BOOT);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Modes, all_axes_start_disabled_and_not_homed) {
  Bench bench;
  bench.tick();
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    EXPECT_EQ(bench.axis_state(slot), ILK_AXIS_DISABLED);
    EXPECT_EQ(bench.axis(slot).homed, 0u);
  }
}

TEST(Modes, RESET_leads_from_LOCKED_to_READY) {
  Bench bench;
  bench.to_ready();
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_NONE);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Modes, RESET_is_an_edge_so_a_later_cause_locks_again) {
  Bench bench;
  bench.to_ready();
  bench.estop_loop_closed = 0;
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  bench.estop_loop_closed = 1;
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
}

TEST(Modes, estop_locks_READY_in_the_same_tick) {
  Bench bench;
  bench.to_ready();
  bench.estop_loop_closed = 0;
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP);
  EXPECT_EQ(bench.state().cause_value, 0u);
  EXPECT_EQ(bench.state().cause_tick, bench.now());
  EXPECT_EQ(bench.state().estop, 1u);
}

TEST(P2_stop, estop_zeroes_MOTION_in_the_same_tick) {
  Bench bench = moving_bench();
  bench.estop_loop_closed = 0;
  bench.queue(move(slot::pwm_free, 50));
  bench.tick();
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP);
}

TEST(P2_stop, estop_contact_read_as_anything_but_one_is_active) {
  for (const uint32_t contact : {0u, 2u, 3u, 0x80000000u, 0xFFFFFFFFu}) {
    Bench bench = moving_bench();
    bench.estop_loop_closed = contact;
    bench.tick();
    EXPECT_TRUE(bench.wire_is_zero()) << contact;
    EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP) << contact;
    EXPECT_EQ(bench.state().cause_value, contact);
  }
}

TEST(P2_stop, pedal_release_zeroes_in_the_same_tick) {
  Bench bench = moving_bench();
  bench.pedal(false);
  bench.queue(move(slot::pwm_free, 50));
  bench.tick();
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.axis_state(slot::pwm_free), ILK_AXIS_ENABLED);
}

TEST(P2_stop, STOP_zeroes_in_the_same_tick) {
  Bench bench = moving_bench();
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P2_stop, STOP_after_a_MOVE_in_the_same_tick_wins) {
  Bench bench = moving_bench();
  bench.queue(move(slot::pwm_free, 60));
  bench.queue(stop());
  bench.tick();
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Modes, bus_without_a_valid_frame_locks_after_the_limit) {
  for (const bool in_motion : {false, true}) {
    Bench bench;
    in_motion ? bench.to_motion() : bench.to_ready();
    bench.transaction_done = 0;
    bench.ticks(2);
    EXPECT_NE(bench.mode(), ILK_MODE_LOCKED);
    EXPECT_TRUE(bench.wire_is_zero());
    bench.tick();
    EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
    EXPECT_EQ(bench.cause(), ILK_CAUSE_BUS);
    EXPECT_EQ(bench.state().cause_value, 3u);
  }
}

TEST(Modes, bus_is_lost_when_every_frame_is_bad_though_transactions_complete) {
  Bench bench;
  bench.to_ready();
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) bench.spoil(slot, FrameFault::wrong_checksum, 3);
  bench.ticks(3);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_BUS);
}

TEST(Modes, one_valid_frame_from_any_card_keeps_the_bus) {
  Bench bench;
  bench.to_ready();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) bench.spoil(slot, FrameFault::missing, 20);
  bench.ticks(20);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(Modes, bad_bus_ticks_count_in_a_row_only) {
  Bench bench;
  bench.to_ready();
  for (int round = 0; round < 5; ++round) {
    bench.transaction_done = 0;
    bench.ticks(2);
    bench.transaction_done = 1;
    bench.tick();
  }
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P2_stop, failed_transaction_zeroes_in_the_same_tick) {
  Bench bench = moving_bench();
  bench.transaction_done = 0;
  bench.tick();
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Modes, missed_deadlines_in_a_row_lock_at_the_limit) {
  Bench bench;
  bench.to_ready();
  for (int round = 0; round < 3; ++round) {
    bench.deadline_missed = 1;
    bench.ticks(2);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    bench.deadline_missed = 0;
    bench.tick();
  }
  bench.deadline_missed = 0xFFFFFFFFu;
  bench.ticks(2);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_OVERRUN);
  EXPECT_EQ(bench.state().cause_value, 3u);
  EXPECT_EQ(bench.state().overruns, 9u);
}

TEST(Modes, disagreeing_pedal_locks_only_after_longer_than_its_time) {
  Bench bench;
  bench.to_ready();
  bench.pedal_no_closed = 1;
  bench.pedal_nc_closed = 1;
  bench.ticks(8);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_PEDAL);
  EXPECT_EQ(bench.state().cause_value, 3u);
}

TEST(Modes, disagreement_counts_in_a_row_only) {
  Bench bench;
  bench.to_ready();
  for (int round = 0; round < 4; ++round) {
    bench.pedal_no_closed = 1;
    bench.ticks(8);
    bench.pedal_no_closed = 0;
    bench.tick();
  }
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P2_stop, disagreeing_pedal_stops_MOTION_at_once_and_does_not_resume) {
  for (const bool normally_open_opens : {true, false}) {
    Bench bench = moving_bench();
    if (normally_open_opens) {
      bench.pedal_no_closed = 0;
    } else {
      bench.pedal_nc_closed = 1;
    }
    bench.queue(move(slot::pwm_free, 50));
    bench.tick();
    EXPECT_TRUE(bench.wire_is_zero());
    bench.pedal(true);
    bench.keep_moving(slot::pwm_free, 50, 20);
    EXPECT_TRUE(bench.wire_is_zero());
    EXPECT_NE(bench.mode(), ILK_MODE_MOTION);
  }
}

TEST(P8_latch, first_cause_is_kept_and_later_ones_are_listed) {
  Bench bench;
  bench.to_ready();
  bench.estop_loop_closed = 0;
  bench.tick();
  const uint32_t first_tick = bench.state().cause_tick;
  bench.deadline_missed = 1;
  bench.transaction_done = 0;
  bench.ticks(10);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP);
  EXPECT_EQ(bench.state().cause_tick, first_tick);
  EXPECT_EQ(bench.state().cause_value, 0u);
  const uint32_t seen = bench.state().causes_seen;
  EXPECT_EQ(seen, 1u << ILK_CAUSE_ESTOP | 1u << ILK_CAUSE_OVERRUN | 1u << ILK_CAUSE_BUS);
}

TEST(P8_latch, LOCKED_outlives_its_cause_until_RESET) {
  Bench bench;
  bench.to_ready();
  bench.estop_loop_closed = 0;
  bench.tick();
  bench.estop_loop_closed = 1;
  bench.ticks(1000);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.state().causes_seen, 0u);
}

TEST(P8_latch, no_other_request_leaves_LOCKED) {
  Bench bench;
  bench.ticks(5);
  for (uint32_t kind = 0; kind <= ILK_REQUEST_COUNT + 1; ++kind) {
    if (kind == ILK_REQUEST_RESET) continue;
    ilk_request_t request = move(slot::pwm_free, 10);
    request.kind = kind;
    request.holder = 1;
    bench.ask(request);
    EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED) << kind;
  }
}

TEST(Locking, disables_every_axis_but_the_faulted_and_keeps_homed) {
  Bench bench;
  bench.to_ready();
  bench.reference(slot::pwm_free);
  bench.enable_axis(slot::pwm_free);
  bench.enable_axis(slot::pwm_lower);
  bench.motor[slot::non_pwm_upper].travelled += 100;
  bench.tick();
  ASSERT_EQ(bench.axis_state(slot::non_pwm_upper), ILK_AXIS_FAULTED);
  bench.press();
  bench.queue(move(slot::pwm_free, 50));
  bench.queue(home(slot::pwm_lower));
  bench.tick();
  ASSERT_EQ(bench.axis_state(slot::pwm_free), ILK_AXIS_MOVING);
  ASSERT_EQ(bench.axis_state(slot::pwm_lower), ILK_AXIS_HOMING);
  bench.estop_loop_closed = 0;
  bench.tick();
  EXPECT_EQ(bench.axis_state(slot::pwm_free), ILK_AXIS_DISABLED);
  EXPECT_EQ(bench.axis(slot::pwm_free).homed, 1u);
  EXPECT_EQ(bench.axis(slot::pwm_free).lease_ticks, 0u);
  EXPECT_EQ(bench.axis_state(slot::pwm_lower), ILK_AXIS_DISABLED);
  EXPECT_EQ(bench.axis(slot::pwm_lower).homing_phase, uint32_t{ILK_HOMING_NONE});
  EXPECT_EQ(bench.axis_state(slot::non_pwm_upper), ILK_AXIS_FAULTED);
  EXPECT_EQ(bench.fault(slot::non_pwm_upper), ILK_FAULT_JUMP);
}

TEST(Locking, a_pedal_that_disagrees_leaves_its_contacts_as_the_value_of_the_cause) {
  for (const uint32_t closed : {0u, 1u}) {
    Bench bench;
    bench.to_ready();
    bench.pedal_no_closed = closed;
    bench.pedal_nc_closed = closed;
    bench.ticks(bench.config().pedal_disagree_ticks + 1);
    ASSERT_EQ(bench.cause(), ILK_CAUSE_PEDAL);
    EXPECT_EQ(bench.state().cause_value, closed == 1 ? 3u : 0u);
  }
}

TEST(Locking, an_axis_fault_does_not_block_RESET) {
  Bench bench;
  bench.ticks(5);
  bench.motor[slot::pwm_free].travelled += 100;
  bench.tick();
  ASSERT_EQ(bench.axis_state(slot::pwm_free), ILK_AXIS_FAULTED);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
}

TEST(Locking, no_motion_after_RESET_nor_after_the_next_press) {
  Bench bench = moving_bench();
  bench.estop_loop_closed = 0;
  bench.tick();
  bench.estop_loop_closed = 1;
  bench.to_ready();
  bench.ticks(20);
  EXPECT_TRUE(bench.wire_is_zero());
  bench.press();
  bench.ticks(20);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Modes, a_new_axis_fault_ends_MOTION) {
  Bench bench = moving_bench();
  bench.motor[slot::pwm_lower].travelled += 100;
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Modes, a_standing_axis_fault_allows_MOTION_and_keeps_its_axis_undriven) {
  Bench bench;
  bench.to_ready();
  bench.motor[slot::pwm_lower].travelled += 100;
  bench.tick();
  bench.press();
  bench.enable_axis(slot::pwm_free);
  EXPECT_EQ(bench.ask(move(slot::pwm_lower, 50)), ILK_VERDICT_FAULTED);
  bench.keep_moving(slot::pwm_free, 50, 10);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  EXPECT_TRUE(bench.driven(slot::pwm_free));
  EXPECT_FALSE(bench.driven(slot::pwm_lower));
  EXPECT_EQ(bench.gate(slot::pwm_lower), ILK_GATE_ENABLE);
}

TEST(Modes, a_lost_required_card_ends_MOTION_at_the_limit_and_blocks_it) {
  Bench bench;
  bench.to_motion();
  bench.spoil(slot::sensor, FrameFault::missing, 30);
  bench.ticks(2);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.pedal(false);
  bench.ticks(6);
  bench.pedal(true);
  bench.ticks(10);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.card[slot::sensor].fault_ticks = 0;
  bench.press();
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(Modes, a_lost_required_motor_card_blocks_MOTION_though_its_axis_may_be_faulted) {
  ilk_config_t config = standard_config();
  config.axis[slot::pwm_lower].required = 1;
  seal(config);
  Bench bench(config);
  bench.to_ready();
  bench.spoil(slot::pwm_lower, FrameFault::missing, 100);
  bench.ticks(3);
  ASSERT_EQ(bench.fault(slot::pwm_lower), ILK_FAULT_CARD_LOST);
  bench.ticks(6);
  bench.pedal(true);
  bench.ticks(10);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.card[slot::pwm_lower].fault_ticks = 0;
  bench.press();
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(Modes, a_change_of_holder_ends_MOTION_in_the_same_tick) {
  Bench bench = moving_bench();
  bench.queue(heartbeat(2));
  const uint32_t late_move = bench.queue(move(slot::pwm_free, 50));
  bench.app_alive = false;
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.verdict_of(late_move), ILK_VERDICT_MODE);
  EXPECT_EQ(bench.state().holder, 2u);
}

TEST(Modes, the_same_holder_keeps_MOTION) {
  Bench bench = moving_bench();
  bench.queue(heartbeat(1));
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(P10_silence, MOTION_ends_when_the_app_is_silent_for_its_timeout) {
  Bench bench = moving_bench();
  bench.app_alive = false;
  for (uint32_t silent = 1; silent < 30; ++silent) {
    bench.queue(move(slot::pwm_free, 1000 - 960));
    bench.tick();
    ASSERT_EQ(bench.mode(), ILK_MODE_MOTION) << silent;
  }
  bench.queue(move(slot::pwm_free, 50));
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(P10_silence, only_a_HEARTBEAT_counts_as_the_app) {
  Bench bench;
  bench.to_motion();
  bench.enable_axis(slot::pwm_free);
  bench.app_alive = false;
  bench.keep_moving(slot::pwm_free, 80, 31);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.state().app_alive, 0u);
}

TEST(P10_silence, a_HEARTBEAT_just_in_time_keeps_MOTION) {
  Bench bench;
  bench.to_motion();
  bench.app_alive = false;
  for (int round = 0; round < 5; ++round) {
    bench.ticks(28);
    bench.queue(heartbeat(1));
    bench.tick();
    EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  }
}

TEST(P10_silence, a_new_attachment_is_silent_until_its_HEARTBEAT) {
  Bench bench = moving_bench();
  bench.link_generation = 2;
  bench.last_sequence = 0;
  bench.app_alive = false;
  bench.tick();
  EXPECT_EQ(bench.state().app_alive, 0u);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(P10_silence, MOTION_is_not_entered_without_the_app) {
  Bench bench;
  bench.to_ready();
  bench.arm();
  bench.app_alive = false;
  bench.ticks(35);
  bench.pedal(true);
  bench.ticks(20);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
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
    EXPECT_EQ(bench.gate(slot::pwm_free), ILK_GATE_MODE);
  }
}

TEST(P13_configuration, an_invalid_one_never_leaves_INIT) {
  ilk_config_t config = standard_config();
  config.axis[slot::pwm_free].coast_counts = 0;
  seal(config);
  Bench bench(config);
  EXPECT_EQ(bench.mode(), ILK_MODE_INIT);
  bench.ticks(5);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_MODE);
  EXPECT_EQ(bench.ask(heartbeat(1)), ILK_VERDICT_MODE);
  bench.estop_loop_closed = 0;
  bench.ticks(5);
  bench.estop_loop_closed = 1;
  bench.pedal(true);
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_INIT);
  EXPECT_TRUE(bench.wire_is_zero());
}

}  // namespace
}  // namespace interlock::kernel_test
