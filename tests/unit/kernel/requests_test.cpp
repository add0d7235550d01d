// Each row of the request table: every check where it refuses and at the boundary where it does not,
// and each row's order of checks. Refusals are compared with a run without the request (P11).
#include <gtest/gtest.h>

#include <string>

#include "inert.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_lower;
constexpr uint32_t other = slot::pwm_free;

Bench init_bench() {
  ilk_config_t config = standard_config();
  config.crc ^= 1u;
  Bench bench(config);
  bench.ticks(2);
  return bench;
}

Bench locked_bench() {
  Bench bench;
  bench.ticks(5);
  return bench;
}

Bench ready_bench() {
  Bench bench;
  bench.to_ready();
  return bench;
}

Bench motion_bench() {
  Bench bench;
  bench.to_motion();
  bench.enable_axis(axis);
  return bench;
}

/// READY; the axis has a JUMP fault, two ticks old.
Bench faulted_bench() {
  Bench bench = ready_bench();
  bench.motor[axis].travelled += 100;
  bench.ticks(2);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
  return bench;
}

Bench faulted_motion_bench() {
  Bench bench = faulted_bench();
  bench.press();
  return bench;
}

Bench homing_bench() {
  Bench bench = motion_bench();
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_HOMING);
  return bench;
}

Bench homed_motion_bench() {
  Bench bench;
  bench.to_motion_homed(axis);
  return bench;
}

void spoil_next(Bench& bench) { bench.spoil(axis, FrameFault::wrong_checksum, 1); }

// --- HEARTBEAT

TEST(Request_HEARTBEAT, is_refused_in_INIT) {
  Bench bench = init_bench();
  EXPECT_EQ(bench.ask(heartbeat(1)), ILK_VERDICT_MODE);
}

TEST(Request_HEARTBEAT, is_accepted_in_every_other_mode_and_names_the_holder) {
  for (Bench bench : {locked_bench(), ready_bench(), motion_bench()}) {
    bench.app_alive = false;
    EXPECT_EQ(bench.ask(heartbeat(77)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.state().holder, 77u);
    EXPECT_EQ(bench.state().app_age_ticks, 0u);
  }
}

// --- STOP

TEST(Request_STOP, is_refused_in_INIT) {
  Bench bench = init_bench();
  expect_refused(bench, stop(), ILK_VERDICT_MODE);
}

TEST(Request_STOP, ends_MOTION) {
  Bench bench = motion_bench();
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(Request_STOP, is_accepted_without_effect_in_READY_and_LOCKED) {
  for (Bench bench : {locked_bench(), ready_bench()}) {
    Bench undisturbed = bench;
    undisturbed.tick();
    EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(state_without_counters(bench), state_without_counters(undisturbed));
  }
}

// --- RESET

TEST(Request_RESET, is_MODE_in_every_mode_but_LOCKED) {
  for (Bench bench : {init_bench(), ready_bench(), motion_bench()}) {
    expect_refused(bench, reset(), ILK_VERDICT_MODE);
  }
}

TEST(Request_RESET, is_accepted_when_all_is_clear) {
  Bench bench = locked_bench();
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(Request_RESET, is_PEDAL_DOWN_unless_every_channel_reads_released) {
  for (const uint32_t no : {0u, 1u, 2u}) {
    for (const uint32_t nc : {0u, 1u, 2u}) {
      Bench bench = locked_bench();
      bench.pedal_no_closed = no;
      bench.pedal_nc_closed = nc;
      if (no == 0 && nc == 1) {
        EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
      } else {
        expect_refused(bench, reset(), ILK_VERDICT_PEDAL_DOWN);
      }
    }
  }
}

TEST(Request_RESET, is_accepted_in_the_tick_of_the_release) {
  Bench bench = locked_bench();
  bench.pedal(true);
  bench.ticks(20);
  bench.pedal(false);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
}

TEST(Request_RESET, is_CAUSE_PRESENT_while_the_estop_is_active) {
  Bench bench = locked_bench();
  bench.estop_loop_closed = 0;
  expect_refused(bench, reset(), ILK_VERDICT_CAUSE_PRESENT);
  bench.estop_loop_closed = 1;
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
}

TEST(Request_RESET, is_CAUSE_PRESENT_while_the_app_is_silent) {
  Bench bench;
  bench.app_alive = false;
  bench.ticks(5);
  expect_refused(bench, reset(), ILK_VERDICT_CAUSE_PRESENT);
  bench.queue(heartbeat(1));
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT)
      << "whether the app is alive is decided once a tick, before requests";
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
}

TEST(Request_RESET, is_CAUSE_PRESENT_while_the_bus_is_lost) {
  Bench bench = locked_bench();
  bench.transaction_done = 0;
  bench.ticks(3);
  expect_refused(bench, reset(), ILK_VERDICT_CAUSE_PRESENT);
  bench.transaction_done = 1;
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
}

TEST(Request_RESET, is_CAUSE_PRESENT_before_any_card_has_answered) {
  Bench bench;
  bench.transaction_done = 0;
  bench.tick();
  expect_refused(bench, reset(), ILK_VERDICT_CAUSE_PRESENT);
}

TEST(Request_RESET, is_CAUSE_PRESENT_while_deadlines_are_missed) {
  Bench bench = ready_bench();
  bench.deadline_missed = 1;
  bench.ticks(3);
  ASSERT_EQ(bench.cause(), ILK_CAUSE_OVERRUN);
  expect_refused(bench, reset(), ILK_VERDICT_CAUSE_PRESENT);
  bench.deadline_missed = 0;
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
}

TEST(Request_RESET, checks_the_pedal_before_the_cause) {
  Bench bench = locked_bench();
  bench.estop_loop_closed = 0;
  bench.pedal(true);
  expect_refused(bench, reset(), ILK_VERDICT_PEDAL_DOWN);
}

// --- DISABLE

TEST(Request_DISABLE, is_refused_in_INIT) {
  Bench bench = init_bench();
  expect_refused(bench, disable(axis), ILK_VERDICT_MODE);
}

TEST(Request_DISABLE, is_FAULTED_for_a_faulted_axis) {
  Bench bench = faulted_bench();
  expect_refused(bench, disable(axis), ILK_VERDICT_FAULTED);
}

TEST(Request_DISABLE, is_accepted_from_every_other_state_and_stops_the_axis_now) {
  Bench moving = motion_bench();
  moving.ask(move(axis, 50));
  Bench enabled_in_ready = ready_bench();
  enabled_in_ready.enable_axis(axis);
  for (Bench bench :
       {locked_bench(), ready_bench(), enabled_in_ready, motion_bench(), moving, homing_bench()}) {
    EXPECT_EQ(bench.ask(disable(axis)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_DISABLED);
    EXPECT_FALSE(bench.driven(axis));
    EXPECT_EQ(bench.axis(axis).lease_ticks, 0u);
    EXPECT_EQ(bench.axis(axis).homing_phase, uint32_t{ILK_HOMING_NONE});
  }
}

// --- ENABLE

TEST(Request_ENABLE, is_MODE_in_INIT_and_LOCKED) {
  for (Bench bench : {init_bench(), locked_bench()}) expect_refused(bench, enable(axis), ILK_VERDICT_MODE);
}

TEST(Request_ENABLE, is_accepted_in_READY_and_MOTION) {
  for (Bench bench : {ready_bench(), motion_bench()}) {
    EXPECT_EQ(bench.ask(enable(other)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.axis_state(other), ILK_AXIS_ENABLED);
    EXPECT_FALSE(bench.driven(other));
  }
}

TEST(Request_ENABLE, is_FAULTED_for_a_faulted_axis_even_without_a_card) {
  Bench bench = faulted_bench();
  expect_refused(bench, enable(axis), ILK_VERDICT_FAULTED);
  spoil_next(bench);
  EXPECT_EQ(bench.ask(enable(axis)), ILK_VERDICT_FAULTED);
}

TEST(Request_ENABLE, is_CARD_without_a_valid_frame_in_this_tick) {
  Bench bench = ready_bench();
  spoil_next(bench);
  expect_refused(bench, enable(axis), ILK_VERDICT_CARD);
  EXPECT_EQ(bench.ask(enable(axis)), ILK_VERDICT_ACCEPTED);
}

TEST(Request_ENABLE, checks_the_mode_first) {
  Bench bench = locked_bench();
  spoil_next(bench);
  expect_refused(bench, enable(axis), ILK_VERDICT_MODE);
}

// --- CLEAR_FAULT

TEST(Request_CLEAR_FAULT, is_MODE_in_INIT) {
  Bench bench = init_bench();
  expect_refused(bench, clear_fault(axis), ILK_VERDICT_MODE);
}

TEST(Request_CLEAR_FAULT, is_NO_FAULT_for_a_sound_axis) {
  for (Bench bench : {locked_bench(), ready_bench(), motion_bench(), homing_bench()}) {
    expect_refused(bench, clear_fault(axis), ILK_VERDICT_NO_FAULT);
  }
}

TEST(Request_CLEAR_FAULT, leaves_DISABLED) {
  Bench locked = faulted_bench();
  locked.estop_loop_closed = 0;
  locked.tick();
  for (Bench bench : {faulted_bench(), locked}) {
    EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_DISABLED);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
    EXPECT_EQ(bench.axis(axis).homed, 0u);
  }
}

TEST(Request_CLEAR_FAULT, is_CAUSE_PRESENT_without_a_valid_frame_in_this_tick) {
  Bench bench = faulted_bench();
  spoil_next(bench);
  expect_refused(bench, clear_fault(axis), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
}

TEST(Request_CLEAR_FAULT, is_CAUSE_PRESENT_in_the_tick_of_the_fault) {
  Bench bench = ready_bench();
  bench.motor[axis].travelled += 100;
  expect_refused(bench, clear_fault(axis), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
}

TEST(Request_CLEAR_FAULT, is_PEDAL_DOWN_with_the_pedal_pressed_or_disagreeing) {
  Bench pressed = faulted_motion_bench();
  expect_refused(pressed, clear_fault(axis), ILK_VERDICT_PEDAL_DOWN);
  Bench disagreeing = faulted_bench();
  disagreeing.pedal_nc_closed = 0;
  expect_refused(disagreeing, clear_fault(axis), ILK_VERDICT_PEDAL_DOWN);
}

TEST(Request_CLEAR_FAULT, checks_in_order) {
  Bench bench = faulted_motion_bench();
  spoil_next(bench);
  expect_refused(bench, clear_fault(axis), ILK_VERDICT_CAUSE_PRESENT);
  spoil_next(bench);
  expect_refused(bench, clear_fault(other), ILK_VERDICT_NO_FAULT);
}

// --- MOVE

TEST(Request_MOVE, is_MODE_outside_MOTION) {
  for (Bench bench : {init_bench(), locked_bench(), ready_bench()}) {
    expect_refused(bench, move(axis, 50), ILK_VERDICT_MODE);
  }
}

TEST(Request_MOVE, is_FAULTED_for_a_faulted_axis) {
  Bench bench = faulted_motion_bench();
  expect_refused(bench, move(axis, 50), ILK_VERDICT_FAULTED);
}

TEST(Request_MOVE, is_DISABLED_for_an_axis_not_enabled) {
  Bench bench = motion_bench();
  expect_refused(bench, move(other, 50), ILK_VERDICT_DISABLED);
}

TEST(Request_MOVE, is_BUSY_while_homing) {
  Bench bench = homing_bench();
  expect_refused(bench, move(axis, 50), ILK_VERDICT_BUSY);
}

TEST(Request_MOVE, takes_leases_from_one_to_the_longest) {
  Bench bench = motion_bench();
  expect_refused(bench, move(axis, 50, 100, 0), ILK_VERDICT_LEASE);
  expect_refused(bench, move(axis, 50, 100, 21), ILK_VERDICT_LEASE);
  expect_refused(bench, move(axis, 50, 100, 0xFFFFFFFFu), ILK_VERDICT_LEASE);
  EXPECT_EQ(bench.ask(move(axis, 50, 100, 1)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(move(axis, 50, 100, 20)), ILK_VERDICT_ACCEPTED);
}

TEST(Request_MOVE, takes_drive_up_to_the_unhomed_bound_while_not_homed) {
  Bench bench = motion_bench();
  EXPECT_EQ(bench.ask(move(axis, 50, 0)), ILK_VERDICT_ACCEPTED);
  EXPECT_FALSE(bench.driven(axis));
  EXPECT_EQ(bench.ask(move(axis, 50, 100)), ILK_VERDICT_ACCEPTED);
  expect_refused(bench, move(axis, 50, 101), ILK_VERDICT_DRIVE);
  expect_refused(bench, move(axis, 50, 0xFFFFFFFFu), ILK_VERDICT_DRIVE);
}

TEST(Request_MOVE, takes_drive_up_to_its_bound_when_homed) {
  Bench bench = homed_motion_bench();
  EXPECT_EQ(bench.ask(move(axis, 50, 1000)), ILK_VERDICT_ACCEPTED);
  expect_refused(bench, move(axis, 50, 1001), ILK_VERDICT_DRIVE);
}

TEST(Request_MOVE, takes_amplitude_up_to_its_bound) {
  Bench bench = motion_bench();
  bench.enable_axis(slot::high_frequency);
  ilk_request_t wave = move(slot::high_frequency, 50);
  wave.amplitude = 200;
  EXPECT_EQ(bench.ask(wave), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.out().command[slot::high_frequency].amplitude, 200u);
  wave.amplitude = 201;
  expect_refused(bench, wave, ILK_VERDICT_DRIVE);
  ilk_request_t plain = move(axis, 50);
  plain.amplitude = 1;
  expect_refused(bench, plain, ILK_VERDICT_DRIVE);
}

TEST(Request_MOVE, takes_setpoints_not_nearer_than_coast_to_a_soft_limit) {
  Bench bench = homed_motion_bench();
  EXPECT_EQ(bench.ask(move(axis, 990)), ILK_VERDICT_ACCEPTED);
  expect_refused(bench, move(axis, 991), ILK_VERDICT_RANGE);
  expect_refused(bench, move(axis, INT32_MAX), ILK_VERDICT_RANGE);
  EXPECT_EQ(bench.ask(move(axis, -990)), ILK_VERDICT_ACCEPTED);
  expect_refused(bench, move(axis, -991), ILK_VERDICT_RANGE);
  expect_refused(bench, move(axis, INT32_MIN), ILK_VERDICT_RANGE);
}

TEST(Request_MOVE, takes_setpoints_within_the_unhomed_travel_while_not_homed) {
  Bench bench = motion_bench();
  EXPECT_EQ(bench.ask(move(axis, 90)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(move(axis, -90)), ILK_VERDICT_ACCEPTED);
  expect_refused(bench, move(axis, 91), ILK_VERDICT_RANGE);
  expect_refused(bench, move(axis, -91), ILK_VERDICT_RANGE);
  expect_refused(bench, move(axis, INT32_MIN), ILK_VERDICT_RANGE);
  expect_refused(bench, move(axis, INT32_MAX), ILK_VERDICT_RANGE);
}

TEST(Request_MOVE, measures_the_unhomed_travel_from_the_press_and_not_from_where_the_axis_is) {
  Bench bench = motion_bench();
  bench.keep_moving(axis, 40, 30);
  ASSERT_EQ(bench.position(axis), 29);
  EXPECT_EQ(bench.ask(move(axis, 90)), ILK_VERDICT_ACCEPTED);
  expect_refused(bench, move(axis, 91), ILK_VERDICT_RANGE);
  EXPECT_EQ(bench.ask(move(axis, -90)), ILK_VERDICT_ACCEPTED);
  expect_refused(bench, move(axis, -91), ILK_VERDICT_RANGE);
}

TEST(Request_MOVE, checks_in_order) {
  const ilk_request_t worst = move(axis, 5000, 5000, 5000);
  Bench ready = faulted_bench();
  expect_refused(ready, worst, ILK_VERDICT_MODE);
  Bench faulted = faulted_motion_bench();
  expect_refused(faulted, worst, ILK_VERDICT_FAULTED);
  Bench bench = motion_bench();
  expect_refused(bench, move(other, 5000, 5000, 5000), ILK_VERDICT_DISABLED);
  Bench homing = homing_bench();
  expect_refused(homing, worst, ILK_VERDICT_BUSY);
  expect_refused(bench, worst, ILK_VERDICT_LEASE);
  expect_refused(bench, move(axis, 5000, 5000), ILK_VERDICT_DRIVE);
  expect_refused(bench, move(axis, 5000), ILK_VERDICT_RANGE);
}

TEST(Request_MOVE, a_refused_one_leaves_the_running_move_alone) {
  Bench bench = motion_bench();
  bench.ask(move(axis, 50, 80, 20));
  expect_refused(bench, move(axis, -91, 80, 20), ILK_VERDICT_RANGE);
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_INCREASING);
}

// --- HOME

TEST(Request_HOME, is_MODE_outside_MOTION) {
  for (Bench bench : {init_bench(), locked_bench(), ready_bench()}) {
    expect_refused(bench, home(axis), ILK_VERDICT_MODE);
  }
}

TEST(Request_HOME, is_FAULTED_for_a_faulted_axis) {
  Bench bench = faulted_motion_bench();
  expect_refused(bench, home(axis), ILK_VERDICT_FAULTED);
}

TEST(Request_HOME, is_DISABLED_for_an_axis_not_enabled_even_without_a_switch) {
  Bench bench = motion_bench();
  expect_refused(bench, home(slot::corrected_lower), ILK_VERDICT_DISABLED);
  expect_refused(bench, home(other), ILK_VERDICT_DISABLED);
}

TEST(Request_HOME, is_BUSY_while_homing) {
  Bench bench = homing_bench();
  expect_refused(bench, home(axis), ILK_VERDICT_BUSY);
}

TEST(Request_HOME, is_NO_SWITCH_without_a_switch) {
  Bench bench = motion_bench();
  bench.enable_axis(other);
  expect_refused(bench, home(other), ILK_VERDICT_NO_SWITCH);
}

TEST(Request_HOME, is_accepted_at_rest_and_while_moving_and_drops_homed) {
  Bench moving = homed_motion_bench();
  moving.ask(move(axis, 50));
  for (Bench bench : {homed_motion_bench(), moving}) {
    EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_HOMING);
    EXPECT_EQ(bench.axis(axis).homed, 0u);
  }
}

// --- SET_HOME and RESTORE share their checks

class Request_SET_HOME_and_RESTORE : public testing::TestWithParam<uint32_t> {
 protected:
  ilk_request_t request(uint32_t slot = axis) const {
    return GetParam() == ILK_REQUEST_SET_HOME ? set_home(slot) : restore(slot, 123);
  }
};

INSTANTIATE_TEST_SUITE_P(Both, Request_SET_HOME_and_RESTORE,
                         testing::Values(uint32_t{ILK_REQUEST_SET_HOME}, uint32_t{ILK_REQUEST_RESTORE}),
                         [](const testing::TestParamInfo<uint32_t>& kind) {
                           return std::string(kind.param == ILK_REQUEST_SET_HOME ? "SET_HOME" : "RESTORE");
                         });

TEST_P(Request_SET_HOME_and_RESTORE, is_MODE_outside_READY) {
  for (Bench bench : {init_bench(), locked_bench(), motion_bench()}) {
    expect_refused(bench, request(), ILK_VERDICT_MODE);
  }
}

TEST_P(Request_SET_HOME_and_RESTORE, is_PEDAL_DOWN_with_the_pedal_pressed_or_disagreeing) {
  Bench pressed = ready_bench();
  pressed.pedal(true);
  expect_refused(pressed, request(), ILK_VERDICT_PEDAL_DOWN);
  Bench disagreeing = ready_bench();
  disagreeing.pedal_no_closed = 1;
  expect_refused(disagreeing, request(), ILK_VERDICT_PEDAL_DOWN);
}

TEST_P(Request_SET_HOME_and_RESTORE, is_FAULTED_for_a_faulted_axis) {
  Bench bench = faulted_bench();
  expect_refused(bench, request(), ILK_VERDICT_FAULTED);
}

TEST_P(Request_SET_HOME_and_RESTORE, is_CARD_without_a_valid_frame_in_this_tick) {
  Bench bench = ready_bench();
  spoil_next(bench);
  expect_refused(bench, request(), ILK_VERDICT_CARD);
}

/** Whether it moved in between one frame alone does not tell. */
TEST_P(Request_SET_HOME_and_RESTORE, is_BUSY_until_two_frames_in_a_row_tell_that_it_rests) {
  Bench bench = ready_bench();
  spoil_next(bench);
  bench.tick();
  expect_refused(bench, request(), ILK_VERDICT_BUSY);
  EXPECT_EQ(bench.ask(request()), ILK_VERDICT_ACCEPTED);
}

TEST_P(Request_SET_HOME_and_RESTORE, is_BUSY_on_the_first_reading_of_a_card_that_was_lost) {
  Bench bench = ready_bench();
  bench.spoil(axis, FrameFault::missing, bench.config().bad_frame_limit);
  bench.ticks(bench.config().bad_frame_limit);
  ASSERT_EQ(bench.fault(axis), ILK_FAULT_CARD_LOST);
  const uint32_t cleared = bench.queue(clear_fault(axis));
  EXPECT_EQ(bench.ask(request()), ILK_VERDICT_BUSY);
  EXPECT_EQ(bench.verdict_of(cleared), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(request()), ILK_VERDICT_ACCEPTED);
}

TEST_P(Request_SET_HOME_and_RESTORE, is_BUSY_while_the_counter_changes) {
  for (const int32_t motion : {1, -1}) {
    Bench bench = ready_bench();
    bench.motor[axis].travelled += motion;
    expect_refused(bench, request(), ILK_VERDICT_BUSY);
    EXPECT_EQ(bench.ask(request()), ILK_VERDICT_ACCEPTED);
  }
}

/** A motor that has not moved yet may still coast. */
TEST_P(Request_SET_HOME_and_RESTORE, is_BUSY_in_the_tick_in_which_drive_ends) {
  Bench bench = homed_motion_bench();
  bench.motor[axis].frozen = true;
  ASSERT_EQ(bench.ask(move(axis, 50)), ILK_VERDICT_ACCEPTED);
  ASSERT_NE(bench.out().command[axis].drive, 0u);
  bench.pedal(false);
  expect_refused(bench, request(), ILK_VERDICT_BUSY);
  EXPECT_EQ(bench.ask(request()), ILK_VERDICT_ACCEPTED);
}

TEST_P(Request_SET_HOME_and_RESTORE, checks_in_order) {
  Bench locked = locked_bench();
  locked.pedal(true);
  expect_refused(locked, request(), ILK_VERDICT_MODE);
  Bench faulted = faulted_bench();
  spoil_next(faulted);
  expect_refused(faulted, request(), ILK_VERDICT_FAULTED);
  faulted.pedal(true);
  expect_refused(faulted, request(), ILK_VERDICT_PEDAL_DOWN);
}

TEST(Request_SET_HOME, makes_the_place_zero_and_the_axis_homed) {
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    Bench bench = ready_bench();
    bench.push(slot, 57);
    bench.tick();
    ASSERT_EQ(bench.position(slot), 57);
    EXPECT_EQ(bench.ask(set_home(slot)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.position(slot), 0);
    EXPECT_EQ(bench.axis(slot).homed, 1u);
    EXPECT_EQ(bench.axis_state(slot), ILK_AXIS_DISABLED);
    bench.push(slot, -20);
    EXPECT_EQ(bench.position(slot), -20);
  }
}

TEST(Request_SET_HOME, is_RANGE_where_zero_lies_outside_of_the_soft_limits) {
  struct Case {
    int32_t min_counts;
    int32_t max_counts;
    ilk_verdict_t verdict;
  };
  for (const Case& each : {Case{0, 1200, ILK_VERDICT_ACCEPTED}, Case{1, 1200, ILK_VERDICT_RANGE},
                           Case{-1200, 0, ILK_VERDICT_ACCEPTED}, Case{-1200, -1, ILK_VERDICT_RANGE}}) {
    ilk_config_t config = standard_config();
    config.axis[slot::pwm_free].min_counts = each.min_counts;
    config.axis[slot::pwm_free].max_counts = each.max_counts;
    config.axis[slot::pwm_free].home_offset_counts = each.min_counts;
    seal(config);
    Bench bench(config);
    bench.to_ready();
    if (each.verdict == ILK_VERDICT_ACCEPTED) {
      EXPECT_EQ(bench.ask(set_home(slot::pwm_free)), ILK_VERDICT_ACCEPTED);
    } else {
      expect_refused(bench, set_home(slot::pwm_free), each.verdict);
    }
  }
}

TEST(Request_RESTORE, sets_the_position_and_makes_no_axis_homed) {
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    Bench bench = ready_bench();
    EXPECT_EQ(bench.ask(restore(slot, -500)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.position(slot), -500);
    EXPECT_EQ(bench.axis(slot).homed, 0u);
    bench.push(slot, 30);
    EXPECT_EQ(bench.position(slot), -470);
  }
}

TEST(Request_RESTORE, takes_positions_within_the_soft_limits) {
  Bench bench = ready_bench();
  EXPECT_EQ(bench.ask(restore(axis, 1000)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(restore(axis, -1000)), ILK_VERDICT_ACCEPTED);
  expect_refused(bench, restore(axis, 1001), ILK_VERDICT_RANGE);
  expect_refused(bench, restore(axis, -1001), ILK_VERDICT_RANGE);
  expect_refused(bench, restore(axis, INT32_MIN), ILK_VERDICT_RANGE);
  expect_refused(bench, restore(axis, INT32_MAX), ILK_VERDICT_RANGE);
}

TEST(Request_RESTORE, checks_rest_before_range) {
  Bench bench = ready_bench();
  bench.motor[axis].travelled += 1;
  expect_refused(bench, restore(axis, 5000), ILK_VERDICT_BUSY);
}

}  // namespace
}  // namespace interlock::kernel_test
