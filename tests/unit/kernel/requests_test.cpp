// The table of requests: every check of each row, in its order, and what is accepted at the boundary. Each
// refusal is compared with a run without the request (P11).
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

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
  bench.ticks(30);
  return bench;
}

Bench ready() { return ready_bench(); }
Bench motion() { return motion_bench(axis); }
Bench homed_motion() { return homed_bench(axis); }
Bench faulted() { return faulted_bench(axis); }

Bench faulted_motion() {
  Bench bench = faulted_bench(axis);
  bench.press();
  return bench;
}

Bench homing() {
  Bench bench = motion();
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  return bench;
}

/// The situation, changed.
std::function<Bench()> after(std::function<Bench()> situation, std::function<void(Bench&)> change) {
  return [=] {
    Bench bench = situation();
    change(bench);
    return bench;
  };
}

void spoil_next(Bench& bench) { bench.spoil(axis, FrameFault::wrong_checksum, 1); }
void pedal_down(Bench& bench) { bench.pedal(true); }
void pedal_disagrees(Bench& bench) { bench.pedal_no_closed = 1; }
void nudge(Bench& bench) { bench.motor[axis].travelled += 2; }
void estop(Bench& bench) { bench.estop_loop_closed = 0; }
void all_wrong(Bench& bench) {
  spoil_next(bench);
  bench.pedal(true);
}

ilk_request_t with(ilk_request_t request, uint32_t consent) {
  request.consent = consent;
  return request;
}

const ilk_request_t worst_move = with(move(axis, 5000, 5000, 5000), 77);
ilk_request_t wave(uint32_t amplitude) {
  ilk_request_t request = move(slot::high_frequency, 50);
  request.amplitude = amplitude;
  return request;
}

struct Row {
  const char* name;
  std::function<Bench()> situation;
  ilk_request_t request;
  ilk_verdict_t verdict;
};

/// An axis without a switch, enabled and disabled; nothing is left of homing.
Bench two_enabled() {
  Bench bench = motion();
  bench.enable_axis(other);
  return bench;
}

Bench wave_bench() { return motion_bench(slot::high_frequency); }

Bench just_reset() {
  Bench bench = locked_bench();
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  return bench;
}

/// Motion from inside of a homed axis' limits to just before its travel is spent is in limits_test.cpp.
const Row rows[] = {
    {"HEARTBEAT_in_INIT", init_bench, heartbeat(1), ILK_VERDICT_MODE},
    {"STOP_in_INIT", init_bench, stop(), ILK_VERDICT_MODE},

    {"RESET_in_INIT", init_bench, reset(), ILK_VERDICT_MODE},
    {"RESET_in_READY", after(ready, pedal_down), reset(), ILK_VERDICT_MODE},
    {"RESET_in_MOTION", motion, reset(), ILK_VERDICT_MODE},
    {"RESET_pedal_before_cause",
     after(locked_bench,
           [](Bench& bench) {
             pedal_down(bench);
             estop(bench);
           }),
     reset(), ILK_VERDICT_PEDAL_DOWN},
    {"RESET_pedal_disagrees", after(locked_bench, pedal_disagrees), reset(), ILK_VERDICT_PEDAL_DOWN},
    {"RESET_estop", after(locked_bench, estop), reset(), ILK_VERDICT_CAUSE_PRESENT},
    {"RESET_one_bad_bus_tick", after(locked_bench, [](Bench& bench) { bench.transaction_done = 0; }), reset(),
     ILK_VERDICT_CAUSE_PRESENT},
    {"RESET_one_missed_deadline", after(locked_bench, [](Bench& bench) { bench.deadlines_missed = 1; }),
     reset(), ILK_VERDICT_CAUSE_PRESENT},
    {"RESET_app_silent",
     after(locked_bench,
           [](Bench& bench) {
             bench.app_alive = false;
             bench.ticks(29);
           }),
     reset(), ILK_VERDICT_CAUSE_PRESENT},

    {"DISABLE_in_INIT", init_bench, disable(axis), ILK_VERDICT_MODE},
    {"DISABLE_of_a_faulted_axis", faulted, disable(axis), ILK_VERDICT_FAULTED},

    {"ENABLE_in_INIT", init_bench, enable(axis), ILK_VERDICT_MODE},
    {"ENABLE_in_LOCKED", after(locked_bench, spoil_next), enable(axis), ILK_VERDICT_MODE},
    {"ENABLE_of_a_faulted_axis", after(faulted, spoil_next), enable(axis), ILK_VERDICT_FAULTED},
    {"ENABLE_without_a_frame", after(ready, spoil_next), enable(axis), ILK_VERDICT_CARD},
    {"ENABLE_in_motion", after(ready, nudge), enable(axis), ILK_VERDICT_BUSY},
    {"ENABLE_before_power_is_up", after(just_reset, [](Bench& bench) { bench.ticks(8); }), enable(axis),
     ILK_VERDICT_BUSY},

    {"CLEAR_FAULT_in_INIT", init_bench, clear_fault(axis), ILK_VERDICT_MODE},
    {"CLEAR_FAULT_of_a_sound_axis", after(ready, all_wrong), clear_fault(axis), ILK_VERDICT_NO_FAULT},
    {"CLEAR_FAULT_of_a_homing_axis", homing, clear_fault(axis), ILK_VERDICT_NO_FAULT},
    {"CLEAR_FAULT_without_a_frame", after(faulted_motion, spoil_next), clear_fault(axis),
     ILK_VERDICT_CAUSE_PRESENT},
    {"CLEAR_FAULT_in_motion", after(faulted_motion, nudge), clear_fault(axis), ILK_VERDICT_CAUSE_PRESENT},
    {"CLEAR_FAULT_with_the_pedal", faulted_motion, clear_fault(axis), ILK_VERDICT_PEDAL_DOWN},
    {"CLEAR_FAULT_pedal_disagrees", after(faulted, pedal_disagrees), clear_fault(axis),
     ILK_VERDICT_PEDAL_DOWN},

    {"MOVE_in_INIT", init_bench, worst_move, ILK_VERDICT_MODE},
    {"MOVE_in_LOCKED", locked_bench, worst_move, ILK_VERDICT_MODE},
    {"MOVE_in_READY", faulted, worst_move, ILK_VERDICT_MODE},
    {"MOVE_for_another_press", faulted_motion, worst_move, ILK_VERDICT_CONSENT},
    {"MOVE_of_a_faulted_axis", faulted_motion, move(axis, 5000, 5000, 5000), ILK_VERDICT_FAULTED},
    {"MOVE_of_a_disabled_axis", motion, move(other, 5000, 5000, 5000), ILK_VERDICT_DISABLED},
    {"MOVE_of_a_homing_axis", homing, move(axis, 5000, 5000, 5000), ILK_VERDICT_BUSY},
    {"MOVE_lease_zero", motion, move(axis, 5000, 5000, 0), ILK_VERDICT_LEASE},
    {"MOVE_lease_too_long", motion, move(axis, 5000, 5000, 21), ILK_VERDICT_LEASE},
    {"MOVE_lease_huge", motion, move(axis, 5000, 5000, UINT32_MAX), ILK_VERDICT_LEASE},
    {"MOVE_drive_zero", motion, move(axis, 5000, 0), ILK_VERDICT_DRIVE},
    {"MOVE_drive_above_the_unhomed_bound", motion, move(axis, 5000, 101), ILK_VERDICT_DRIVE},
    {"MOVE_drive_above_its_bound", homed_motion, move(axis, 5000, 1001), ILK_VERDICT_DRIVE},
    {"MOVE_drive_huge", homed_motion, move(axis, 5000, UINT32_MAX), ILK_VERDICT_DRIVE},
    {"MOVE_amplitude_above_its_bound", wave_bench, wave(201), ILK_VERDICT_DRIVE},
    {"MOVE_amplitude_of_a_plain_card", motion,
     [] {
       ilk_request_t request = move(axis, 50);
       request.amplitude = 1;
       return request;
     }(),
     ILK_VERDICT_DRIVE},
    {"MOVE_unhomed_too_far_up", motion, move(axis, 91), ILK_VERDICT_RANGE},
    {"MOVE_unhomed_too_far_down", motion, move(axis, -91), ILK_VERDICT_RANGE},
    {"MOVE_unhomed_farthest_up", motion, move(axis, INT32_MAX), ILK_VERDICT_RANGE},
    {"MOVE_unhomed_farthest_down", motion, move(axis, INT32_MIN), ILK_VERDICT_RANGE},
    {"MOVE_too_near_to_the_upper_limit", homed_motion, move(axis, 991), ILK_VERDICT_RANGE},
    {"MOVE_too_near_to_the_lower_limit", homed_motion, move(axis, -991), ILK_VERDICT_RANGE},
    {"MOVE_farthest_up", homed_motion, move(axis, INT32_MAX), ILK_VERDICT_RANGE},
    {"MOVE_farthest_down", homed_motion, move(axis, INT32_MIN), ILK_VERDICT_RANGE},

    {"HOME_in_INIT", init_bench, home(axis), ILK_VERDICT_MODE},
    {"HOME_in_LOCKED", locked_bench, home(axis), ILK_VERDICT_MODE},
    {"HOME_in_READY", ready, with(home(axis), 77), ILK_VERDICT_MODE},
    {"HOME_for_another_press", faulted_motion, with(home(axis), 77), ILK_VERDICT_CONSENT},
    {"HOME_of_a_faulted_axis", faulted_motion, home(axis), ILK_VERDICT_FAULTED},
    {"HOME_of_a_disabled_axis_without_a_switch", motion, home(other), ILK_VERDICT_DISABLED},
    {"HOME_of_a_homing_axis", homing, home(axis), ILK_VERDICT_BUSY},
    {"HOME_without_a_switch", two_enabled, home(other), ILK_VERDICT_NO_SWITCH},

    {"SET_HOME_in_INIT", init_bench, set_home(axis), ILK_VERDICT_MODE},
    {"SET_HOME_in_LOCKED", after(locked_bench, all_wrong), set_home(axis), ILK_VERDICT_MODE},
    {"SET_HOME_in_MOTION", motion, set_home(axis), ILK_VERDICT_MODE},
    {"SET_HOME_with_the_pedal", after(faulted, all_wrong), set_home(axis), ILK_VERDICT_PEDAL_DOWN},
    {"SET_HOME_pedal_disagrees", after(ready, pedal_disagrees), set_home(axis), ILK_VERDICT_PEDAL_DOWN},
    {"SET_HOME_of_a_faulted_axis", after(faulted, spoil_next), set_home(axis), ILK_VERDICT_FAULTED},
    {"SET_HOME_without_a_frame", after(ready, spoil_next), set_home(axis), ILK_VERDICT_CARD},
    {"SET_HOME_in_motion", after(ready, nudge), set_home(axis), ILK_VERDICT_BUSY},

    {"RESTORE_in_INIT", init_bench, restore(axis, 5000), ILK_VERDICT_MODE},
    {"RESTORE_in_LOCKED", after(locked_bench, all_wrong), restore(axis, 5000), ILK_VERDICT_MODE},
    {"RESTORE_in_MOTION", motion, restore(axis, 5000), ILK_VERDICT_MODE},
    {"RESTORE_with_the_pedal", after(faulted, all_wrong), restore(axis, 5000), ILK_VERDICT_PEDAL_DOWN},
    {"RESTORE_of_a_faulted_axis", after(faulted, spoil_next), restore(axis, 5000), ILK_VERDICT_FAULTED},
    {"RESTORE_without_a_frame", after(ready, spoil_next), restore(axis, 5000), ILK_VERDICT_CARD},
    {"RESTORE_in_motion", after(ready, nudge), restore(axis, 5000), ILK_VERDICT_BUSY},
    {"RESTORE_above", ready, restore(axis, 1001), ILK_VERDICT_RANGE},
    {"RESTORE_below", ready, restore(axis, -1001), ILK_VERDICT_RANGE},
    {"RESTORE_farthest", ready, restore(axis, INT32_MIN), ILK_VERDICT_RANGE},
};

void PrintTo(const Row& row, std::ostream* stream) { *stream << row.name; }

class P11_row : public testing::TestWithParam<Row> {};

INSTANTIATE_TEST_SUITE_P(Request, P11_row, testing::ValuesIn(rows),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(P11_row, refuses_with_its_first_failing_check_and_changes_nothing) {
  Bench bench = GetParam().situation();
  expect_refused(bench, GetParam().request, GetParam().verdict);
}

TEST(Request_HEARTBEAT, is_accepted_in_every_mode_but_INIT_and_names_the_holder) {
  for (Bench bench : {locked_bench(), ready(), motion()}) {
    bench.app_alive = false;
    EXPECT_EQ(bench.ask(heartbeat(77)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.system().holder, 77u);
    EXPECT_EQ(bench.system().app_age_ticks, 0u);
  }
}

TEST(Request_STOP, is_accepted_without_effect_in_LOCKED) {
  Bench bench = locked_bench();
  Bench undisturbed = bench;
  undisturbed.tick();
  EXPECT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(state_without_counters(bench), state_without_counters(undisturbed));
}

TEST(Request_RESET, is_accepted_in_the_tick_of_the_release_and_with_every_contact_released_only) {
  for (const uint32_t no : {0u, 1u, 2u}) {
    for (const uint32_t nc : {0u, 1u, 2u}) {
      Bench bench = locked_bench();
      bench.pedal(true);
      bench.ticks(20);
      bench.pedal_no_closed = no;
      bench.pedal_nc_closed = nc;
      EXPECT_EQ(bench.ask(reset()), no == 0 && nc == 1 ? ILK_VERDICT_ACCEPTED : ILK_VERDICT_PEDAL_DOWN);
    }
  }
}

TEST(Request_RESET, judges_the_app_as_it_was_before_the_requests_of_the_tick) {
  Bench bench;
  bench.app_alive = false;
  bench.ticks(5);
  bench.queue(heartbeat(1));
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
}

TEST(Request_DISABLE, is_accepted_from_every_other_state_and_stops_the_axis_now) {
  Bench moving = motion();
  moving.ask(move(axis, 50));
  Bench enabled_in_ready = ready();
  enabled_in_ready.enable_axis(axis);
  for (Bench bench : {locked_bench(), ready(), enabled_in_ready, motion(), moving, homing()}) {
    EXPECT_EQ(bench.ask(disable(axis)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_DISABLED);
    EXPECT_FALSE(bench.driven(axis));
    EXPECT_EQ(bench.axis(axis).lease_ticks, 0u);
    EXPECT_EQ(bench.axis(axis).homing_phase, uint32_t{ILK_HOMING_NONE});
  }
}

TEST(Request_ENABLE, needs_rest_since_the_last_DISABLE) {
  for (Bench bench : {ready(), motion()}) {
    EXPECT_EQ(bench.ask(disable(axis)), ILK_VERDICT_ACCEPTED);
    for (int waited = 1; waited < 10; ++waited) EXPECT_EQ(bench.ask(enable(axis)), ILK_VERDICT_BUSY);
    EXPECT_EQ(bench.ask(enable(axis)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_ENABLED);
    EXPECT_FALSE(bench.driven(axis));
  }
}

TEST(Request_ENABLE, needs_power_to_be_up) {
  Bench bench = just_reset();
  for (int powered = 1; powered < 10; ++powered) EXPECT_EQ(bench.ask(enable(axis)), ILK_VERDICT_BUSY);
  EXPECT_EQ(bench.ask(enable(axis)), ILK_VERDICT_ACCEPTED);
}

TEST(Request_ENABLE, of_an_enabled_axis_is_accepted_without_effect) {
  Bench moving = motion();
  moving.ask(move(axis, 50));
  moving.ticks(3);
  for (Bench bench : {motion(), moving, homing()}) {
    Bench undisturbed = bench;
    undisturbed.tick();
    EXPECT_EQ(bench.ask(enable(axis)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(state_without_counters(bench), state_without_counters(undisturbed));
    EXPECT_EQ(decisions(bench), decisions(undisturbed));
  }
}

TEST(Request_CLEAR_FAULT, leaves_DISABLED_in_READY_and_in_LOCKED) {
  for (Bench bench : {faulted(), after(faulted, estop)()}) {
    EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_DISABLED);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
    EXPECT_EQ(bench.axis(axis).fault_tick, 0u);
    EXPECT_EQ(bench.axis(axis).fault_value, 0);
    EXPECT_FALSE(bench.homed(axis));
  }
}

TEST(Request_MOVE, is_accepted_at_every_boundary) {
  Bench unhomed = two_enabled();
  EXPECT_EQ(unhomed.ask(move(axis, 90, 1, 1)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(unhomed.ask(move(axis, 90, 100, 20)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(unhomed.ask(move(other, -90, 100, 20)), ILK_VERDICT_ACCEPTED);
  Bench homed = homed_motion();
  EXPECT_EQ(homed.ask(move(axis, 990, 1000)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(homed.ask(move(axis, -990, 1000)), ILK_VERDICT_ACCEPTED);
  Bench waves = wave_bench();
  EXPECT_EQ(waves.ask(wave(200)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(waves.out().command[slot::high_frequency].amplitude, 200u);
  EXPECT_EQ(waves.ask(wave(0)), ILK_VERDICT_ACCEPTED);
}

TEST(Request_MOVE, a_refused_one_leaves_the_running_move_alone) {
  Bench bench = motion();
  bench.ask(move(axis, 50, 80, 20));
  expect_refused(bench, move(axis, -91, 80, 20), ILK_VERDICT_RANGE);
  EXPECT_EQ(bench.driven_direction(axis), ILK_DIRECTION_INCREASING);
}

TEST(Request_HOME, is_accepted_at_rest_and_while_moving_and_drops_homed) {
  Bench moving = homed_motion();
  moving.ask(move(axis, 50));
  for (Bench bench : {homed_motion(), moving}) {
    EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_HOMING);
    EXPECT_FALSE(bench.homed(axis));
    EXPECT_FALSE(bench.driven(axis));
  }
}

TEST(Request_SET_HOME, makes_the_place_zero_and_the_axis_homed_by_hand) {
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    Bench bench = ready();
    bench.push(slot, 57);
    bench.rest();
    ASSERT_EQ(bench.position(slot), 57);
    EXPECT_EQ(bench.ask(set_home(slot)), ILK_VERDICT_ACCEPTED);
    EXPECT_EQ(bench.position(slot), 0);
    EXPECT_EQ(bench.axis(slot).homed, uint32_t{ILK_HOMED_BY_HAND});
    bench.push(slot, -20);
    EXPECT_EQ(bench.position(slot), -20);
  }
}

TEST(Request_RESTORE, sets_a_position_within_the_soft_limits_and_makes_no_axis_homed) {
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    Bench bench = ready();
    bench.reference(slot);
    for (const int32_t place : {1000, -1000, -500}) {
      EXPECT_EQ(bench.ask(restore(slot, place)), ILK_VERDICT_ACCEPTED);
      EXPECT_EQ(bench.position(slot), place);
      EXPECT_FALSE(bench.homed(slot));
    }
    bench.push(slot, 30);
    EXPECT_EQ(bench.position(slot), -470);
  }
}

}  // namespace
}  // namespace interlock::kernel_test
