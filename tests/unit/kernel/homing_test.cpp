// Homing at two edges of the switch; what bounds it and what ends it; whether the switch is believed
// afterwards.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_lower;
constexpr int32_t offset = -980;
constexpr int32_t edge = -40;  ///< where the switch of `axis` closes

using Phases = std::vector<uint32_t>;

ilk_homing_phase_t phase(const Bench& bench, uint32_t slot = axis) {
  return static_cast<ilk_homing_phase_t>(bench.axis(slot).homing_phase);
}

bool is_homing(const Bench& bench, uint32_t slot = axis) { return bench.axis_state(slot) == ILK_AXIS_HOMING; }

int32_t towards(const Bench& bench, uint32_t slot) {
  return bench.config().axis[slot].limit_side == ILK_LIMIT_UPPER ? 1 : -1;
}

/// HOME was accepted; nothing has moved yet.
Bench homing_bench(uint32_t slot = axis, int32_t switch_at = edge) {
  Bench bench = motion_bench(slot);
  bench.motor[slot].switch_at = switch_at;
  EXPECT_EQ(bench.ask(home(slot)), ILK_VERDICT_ACCEPTED);
  EXPECT_FALSE(bench.driven(slot));
  return bench;
}

/// How far the home lies from where the switch of `axis` closes.
int32_t home_error(const Bench& bench, int32_t switch_at) {
  return bench.position(axis) - offset - (static_cast<int32_t>(bench.motor[axis].travelled) - switch_at);
}

/// Ticks until the axis homes no more; every phase on the way.
Phases finish(Bench& bench, uint32_t slot = axis, uint32_t limit = 4000) {
  Phases phases = {bench.axis(slot).homing_phase};
  for (uint32_t tick = 0; tick < limit && is_homing(bench, slot); ++tick) {
    bench.tick();
    if (bench.axis(slot).homing_phase != phases.back()) phases.push_back(bench.axis(slot).homing_phase);
  }
  return phases;
}

void to_phase(Bench& bench, ilk_homing_phase_t wanted, uint32_t slot = axis) {
  for (uint32_t tick = 0; tick < 4000 && phase(bench, slot) != wanted && is_homing(bench, slot); ++tick)
    bench.tick();
  ASSERT_EQ(phase(bench, slot), wanted);
}

/// The switch never reads one way for long, so that homing waits, until its clock says so.
void wait_in_LOOK(Bench& bench, uint32_t homing_ticks) {
  while (bench.axis(axis).homing_ticks < homing_ticks) {
    bench.tick_with_switch(axis, (homing_ticks - bench.axis(axis).homing_ticks) % 2 == 1);
  }
  ASSERT_EQ(phase(bench), ILK_HOMING_LOOK);
}

class P17_reference : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Every_switch, P17_reference,
                         testing::Values(slot::pwm_lower, slot::non_pwm_upper, slot::non_pwm_inverted,
                                         slot::analog_upper, slot::high_frequency, slot::corrected_lower,
                                         slot::corrected_upper),
                         testing::PrintToStringParamName());

TEST_P(P17_reference, is_the_edge_of_the_slow_approach) {
  const uint32_t slot = GetParam();
  const int32_t way = towards(ready_bench(), slot);
  Bench bench = homing_bench(slot, way * 40);
  const ilk_axis_config_t& config = bench.config().axis[slot];
  bench.motor[slot].coast = 4;
  EXPECT_EQ(phase(bench, slot), ILK_HOMING_LOOK);
  bench.ticks(2);
  EXPECT_FALSE(bench.driven(slot));
  bench.tick();
  EXPECT_EQ(phase(bench, slot), ILK_HOMING_SEEK);
  EXPECT_EQ(bench.out().command[slot].drive, config.home_drive);
  EXPECT_EQ(bench.out().command[slot].amplitude, config.home_amplitude);
  EXPECT_EQ(bench.driven_direction(slot), way > 0 ? ILK_DIRECTION_INCREASING : ILK_DIRECTION_DECREASING);
  bench.ticks(39);
  EXPECT_TRUE(bench.driven(slot));
  bench.tick();
  EXPECT_FALSE(bench.driven(slot)) << "zero drive at the edge, in the tick that sees it";
  to_phase(bench, ILK_HOMING_BACK_OFF, slot);
  EXPECT_EQ(bench.out().command[slot].drive, config.home_drive);
  EXPECT_EQ(bench.driven_direction(slot), way > 0 ? ILK_DIRECTION_DECREASING : ILK_DIRECTION_INCREASING);
  to_phase(bench, ILK_HOMING_APPROACH, slot);
  EXPECT_EQ(bench.out().command[slot].drive, config.home_slow_drive);
  EXPECT_EQ(bench.out().command[slot].amplitude, config.home_amplitude);
  to_phase(bench, ILK_HOMING_REST, slot);
  EXPECT_FALSE(bench.driven(slot));
  EXPECT_FALSE(bench.homed(slot)) << "not before it rests";
  finish(bench, slot);
  EXPECT_EQ(bench.axis_state(slot), ILK_AXIS_ENABLED);
  EXPECT_EQ(bench.axis(slot).homed, uint32_t{ILK_HOMED_BY_SWITCH});
  EXPECT_EQ(bench.motor[slot].travelled, way * 44);
  EXPECT_EQ(bench.position(slot), config.home_offset_counts + way * 4);
  EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE);
  EXPECT_EQ(bench.axis(slot).home_difference_counts, 0);
}

TEST_P(P17_reference, is_found_from_on_the_switch_too) {
  const uint32_t slot = GetParam();
  Bench bench = ready_bench();
  const int32_t way = towards(bench, slot);
  bench = homing_bench(slot, -way * 15);
  EXPECT_EQ(finish(bench, slot),
            (Phases{ILK_HOMING_LOOK, ILK_HOMING_LEAVE, ILK_HOMING_SEEK, ILK_HOMING_BACK_OFF,
                    ILK_HOMING_APPROACH, ILK_HOMING_REST, ILK_HOMING_NONE}));
  EXPECT_TRUE(bench.homed(slot));
  EXPECT_EQ(bench.position(slot), bench.config().axis[slot].home_offset_counts);
  EXPECT_EQ(bench.motor[slot].travelled, -way * 15);
}

TEST(P17_edge, of_which_one_sample_or_frame_in_all_of_homing_is_wrong_gives_the_same_home) {
  for (const int32_t start : {edge, 15}) {
    Bench bench = homing_bench(axis, start);
    for (; is_homing(bench); bench.tick()) {
      Bench wrong = bench;
      wrong.tick_with_switch(axis, bench.axis(axis).switch_triggered == 0);
      Bench blind = bench;
      blind.spoil(axis, FrameFault::missing, 1);
      for (Bench* disturbed : {&wrong, &blind}) {
        finish(*disturbed);
        ASSERT_TRUE(disturbed->homed(axis)) << bench.now();
        ASSERT_LE(std::abs(home_error(*disturbed, start)), 2) << bench.now();
      }
    }
  }
}

TEST(P17_edge, counts_after_the_debounce_time_and_lies_at_the_first_of_those_readings) {
  for (const uint32_t samples : {2u, 3u}) {
    Bench bench = homing_bench();
    to_phase(bench, ILK_HOMING_SEEK);
    bench.ticks(10);
    for (uint32_t sample = 0; sample < samples; ++sample) {
      bench.tick_with_switch(axis, true);
      EXPECT_FALSE(bench.driven(axis) && phase(bench) == ILK_HOMING_SEEK) << "one is enough to stop";
    }
    EXPECT_EQ(phase(bench), samples == 3 ? ILK_HOMING_BACK_OFF : ILK_HOMING_SEEK);
    if (samples == 3) {
      EXPECT_EQ(bench.axis(axis).first_edge_raw, bench.motor[axis].raw_at_start - 11);
    }
  }
}

TEST(P17_edge, may_bounce_on_closing_and_on_opening) {
  for (const int32_t start : {edge, 15}) {
    Bench bench = homing_bench(axis, start);
    bool before = false;
    uint32_t bounce = 0;
    for (uint32_t tick = 0; tick < 4000 && is_homing(bench); ++tick) {
      const bool closed = bench.motor[axis].travelled <= start;
      if (closed != before) bounce = 6;
      before = closed;
      if (bounce > 0) {
        bench.tick_with_switch(axis, bounce-- % 2 == 0 ? !closed : closed);
      } else {
        bench.tick();
      }
    }
    EXPECT_TRUE(bench.homed(axis));
    EXPECT_LE(std::abs(home_error(bench, start)), 4);
  }
}

TEST(P17_edge, must_agree_with_the_first_within_the_tolerance) {
  for (const int32_t apart : {8, 9, -8, -9}) {
    Bench bench = homing_bench();
    to_phase(bench, ILK_HOMING_BACK_OFF);
    bench.motor[axis].switch_at = edge + apart;
    finish(bench);
    const bool agrees = std::abs(apart) == 8;
    EXPECT_EQ(bench.homed(axis), agrees) << apart;
    EXPECT_EQ(bench.fault(axis), agrees ? ILK_FAULT_NONE : ILK_FAULT_SWITCH);
    if (agrees) {
      EXPECT_EQ(bench.position(axis), offset) << "the second one counts";
    }
    if (!agrees) {
      EXPECT_EQ(bench.axis(axis).fault_value, apart);
    }
  }
}

TEST(P17_edge, every_back_off_ends_when_the_switch_is_open_and_the_axis_is_clear) {
  struct Case {
    int32_t hysteresis;
    int32_t left;  ///< counts from the edge
  };
  for (const auto& [hysteresis, left] : {Case{0, 30}, Case{27, 30}, Case{28, 31}, Case{40, 43}}) {
    Bench bench = homing_bench();
    bench.motor[axis].hysteresis = hysteresis;
    to_phase(bench, ILK_HOMING_APPROACH);
    EXPECT_EQ(bench.motor[axis].travelled, edge + left) << hysteresis;
  }
  for (const auto& [start, left] : {Case{0, 30}, Case{28, 31}, Case{40, 43}}) {
    Bench bench = homing_bench(axis, start);
    to_phase(bench, ILK_HOMING_SEEK);
    EXPECT_EQ(bench.motor[axis].travelled, left) << start;
  }
}

TEST(P17_edge, found_open_at_rest_is_approached_again_slowly) {
  Bench bench = homing_bench();
  to_phase(bench, ILK_HOMING_REST);
  bench.motor[axis].switch_at.reset();
  to_phase(bench, ILK_HOMING_APPROACH);
  EXPECT_EQ(bench.out().command[axis].drive, 20u);
  bench.motor[axis].switch_at = edge - 3;
  finish(bench);
  EXPECT_TRUE(bench.homed(axis));
  EXPECT_EQ(home_error(bench, edge - 3), 0);
}

TEST(P17_edge, found_open_at_rest_for_ever_is_bounded_by_the_budget) {
  Bench bench = homing_bench();
  to_phase(bench, ILK_HOMING_REST);
  bench.motor[axis].switch_at.reset();
  finish(bench);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_HOMING_TRAVEL);
}

TEST(P17_edge, is_no_reference_before_the_axis_rests) {
  Bench bench = homing_bench();
  to_phase(bench, ILK_HOMING_REST);
  for (uint32_t tick = 0; tick < 100; ++tick) {
    bench.motor[axis].travelled += tick % 4 < 2 ? 1 : -1;
    bench.tick();
    ASSERT_FALSE(bench.homed(axis));
  }
  finish(bench);
  EXPECT_TRUE(bench.homed(axis));
}

TEST(P17_edge, that_lies_farther_from_rest_than_coast_and_tolerance_is_none) {
  for (const int32_t way : {1, -1}) {
    for (const int32_t beyond : {18, 19}) {
      Bench bench = homing_bench();
      to_phase(bench, ILK_HOMING_REST);
      bench.motor[axis].switch_stuck = true;
      bench.push(axis, way * beyond);
      finish(bench);
      EXPECT_EQ(bench.homed(axis), beyond == 18);
      EXPECT_EQ(bench.fault(axis), beyond == 18 ? ILK_FAULT_NONE : ILK_FAULT_SWITCH);
      if (beyond == 19) {
        EXPECT_EQ(bench.axis(axis).fault_value, way * beyond);
      }
    }
  }
}

TEST(P17_edge, that_was_seen_before_HOME_does_not_count) {
  Bench bench = motion_bench(axis);
  bench.motor[axis].switch_stuck = true;
  bench.ticks(50);
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  bench.ticks(2);
  EXPECT_EQ(phase(bench), ILK_HOMING_LOOK);
  bench.tick();
  EXPECT_EQ(phase(bench), ILK_HOMING_LEAVE);
}

TEST(Homing_difference, between_this_home_and_the_one_before_is_kept_and_ends_with_a_lost_card) {
  Bench bench = homing_bench();
  finish(bench);
  bench.motor[axis].switch_at = edge - 5;
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  finish(bench);
  ASSERT_TRUE(bench.homed(axis));
  EXPECT_EQ(bench.axis(axis).home_difference_counts, -5);
  bench.release();
  bench.spoil(axis, FrameFault::missing, 3);
  bench.ticks(3);
  bench.rest();
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(axis);
  bench.press();
  bench.motor[axis].switch_at = edge - 9;
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  finish(bench);
  EXPECT_TRUE(bench.homed(axis));
  EXPECT_EQ(bench.axis(axis).home_difference_counts, 0);
}

// --- Bounds

TEST(P7_homing, ends_before_its_travel_is_exceeded_coast_included) {
  for (const bool stuck : {false, true}) {
    Bench bench = homing_bench();
    bench.motor[axis].switch_stuck = stuck;
    bench.motor[axis].coast = 8;
    finish(bench);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_HOMING_TRAVEL);
    EXPECT_EQ(bench.axis(axis).fault_value, 2390);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    bench.rest();
    EXPECT_LE(std::abs(bench.motor[axis].travelled), 2400);
    EXPECT_GE(std::abs(bench.motor[axis].travelled), 2390);
    EXPECT_FALSE(bench.homed(axis));
  }
}

TEST(P7_homing, ends_with_its_time_and_says_in_which_phase) {
  Bench bench = homing_bench(axis, -5000);
  wait_in_LOOK(bench, 1000);
  finish(bench);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_HOMING_TIMEOUT);
  EXPECT_EQ(bench.axis(axis).fault_value, ILK_HOMING_SEEK);
  EXPECT_EQ(bench.axis(axis).homing_ticks, 3000u);
  EXPECT_FALSE(bench.homed(axis));
}

TEST(P7_homing, DISABLE_renews_neither_travel_nor_time_and_what_is_spent_is_BUDGET) {
  Bench bench = homing_bench(axis, -5000);
  while (bench.axis(axis).homing_travel_counts < 2388) bench.tick();
  const uint32_t ticks = bench.axis(axis).homing_ticks;
  EXPECT_EQ(bench.ask(disable(axis)), ILK_VERDICT_ACCEPTED);
  bench.motor[axis].travelled -= 4;
  bench.rest();
  EXPECT_GT(bench.axis(axis).homing_travel_counts, 2390u) << "what it coasts is homing's";
  bench.enable_axis(axis);
  EXPECT_EQ(bench.axis(axis).homing_ticks, ticks + 1);
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_BUDGET);
  bench.release();
  bench.press();
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
}

TEST(P7_homing, that_ends_in_the_last_tick_of_its_time_leaves_no_time_for_another) {
  Bench measured = homing_bench();
  finish(measured);
  const uint32_t needed = measured.axis(axis).homing_ticks;
  Bench bench = homing_bench();
  wait_in_LOOK(bench, 3000 - needed);
  finish(bench);
  ASSERT_TRUE(bench.homed(axis));
  ASSERT_EQ(bench.axis(axis).homing_ticks, 3000u);
  EXPECT_EQ(bench.ask(home(axis)), ILK_VERDICT_BUDGET);
  EXPECT_TRUE(bench.homed(axis));
}

TEST(P7_homing, drives_at_most_at_its_bounds_and_away_from_a_switch_that_triggers) {
  Bench bench = homing_bench(axis, -500);
  while (is_homing(bench)) {
    bench.tick();
    ASSERT_LE(bench.out().command[axis].drive, phase(bench) == ILK_HOMING_APPROACH ? 20u : 50u);
  }
  EXPECT_TRUE(bench.homed(axis));
}

// --- Order of faults

TEST(Order_of_faults, STALL_before_HOMING_TIMEOUT) {
  Bench bench = homing_bench(axis, -5000);
  wait_in_LOOK(bench, 2947);
  bench.ticks(3);
  ASSERT_EQ(phase(bench), ILK_HOMING_SEEK);
  bench.motor[axis].frozen = true;
  bench.ticks(49);
  ASSERT_TRUE(is_homing(bench));
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
}

TEST(Order_of_faults, HOMING_TRAVEL_before_HOMING_TIMEOUT) {
  Bench bench = homing_bench(axis, -5000);
  wait_in_LOOK(bench, 607);
  finish(bench);
  EXPECT_EQ(bench.axis(axis).homing_ticks, 3000u);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_HOMING_TRAVEL);
}

TEST(Order_of_faults, SWITCH_before_HOMING_TIMEOUT) {
  const auto disagree = [](Bench& bench) {
    to_phase(bench, ILK_HOMING_BACK_OFF);
    bench.motor[axis].switch_at = edge - 20;
    finish(bench);
    return bench.axis(axis).homing_ticks;
  };
  Bench measured = homing_bench();
  const uint32_t needed = disagree(measured);
  Bench bench = homing_bench();
  wait_in_LOOK(bench, 3000 - needed);
  EXPECT_EQ(disagree(bench), 3000u);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_SWITCH);
}

// --- What ends it

TEST(Homing_disturbed, pedal_release_ends_it_in_any_phase_and_the_next_press_does_not_resume) {
  for (const auto wanted : {ILK_HOMING_SEEK, ILK_HOMING_APPROACH, ILK_HOMING_REST}) {
    Bench bench = homing_bench();
    to_phase(bench, wanted);
    bench.release();
    EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_ENABLED);
    EXPECT_EQ(phase(bench), ILK_HOMING_NONE);
    bench.press();
    bench.ticks(60);
    EXPECT_TRUE(bench.wire_is_zero());
    EXPECT_FALSE(bench.homed(axis));
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
    ASSERT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
    finish(bench);
    EXPECT_TRUE(bench.homed(axis));
  }
}

TEST(Homing_disturbed, a_jammed_axis_stalls_and_one_wired_the_wrong_way_faults) {
  Bench jammed = homing_bench();
  jammed.motor[axis].frozen = true;
  finish(jammed);
  EXPECT_EQ(jammed.fault(axis), ILK_FAULT_STALL);
  Bench reversed = homing_bench();
  reversed.motor[axis].reversed = true;
  finish(reversed);
  EXPECT_EQ(reversed.fault(axis), ILK_FAULT_REVERSE);
}

TEST(Homing_disturbed, one_failure_ends_homing_of_all) {
  Bench bench = ready_bench();
  bench.enable_axis(axis);
  bench.enable_axis(slot::non_pwm_upper);
  bench.press();
  bench.motor[slot::non_pwm_upper].frozen = true;
  bench.queue(home(axis));
  bench.ask(home(slot::non_pwm_upper));
  finish(bench, slot::non_pwm_upper);
  EXPECT_EQ(bench.fault(slot::non_pwm_upper), ILK_FAULT_STALL);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_ENABLED);
  EXPECT_FALSE(bench.homed(axis));
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(Homing, of_all_axes_together_opens_the_full_range) {
  Bench bench = ready_bench();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    bench.enable_axis(slot);
    bench.motor[slot].switch_at = towards(bench, slot) * static_cast<int32_t>(20 + 7 * slot);
  }
  bench.press();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) bench.queue(home(slot));
  bench.ticks(400);
  for (uint32_t slot = 0; slot < slot::axes; ++slot)
    EXPECT_EQ(bench.homed(slot), slot != slot::pwm_free) << slot;
  EXPECT_EQ(bench.ask(move(axis, 900, 1000)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

TEST(Homing, ends_a_running_move_and_does_not_resume_it) {
  Bench bench = homed_bench(axis);
  bench.ask(move(axis, 500, 1000));
  bench.motor[axis].switch_at = -5;
  ASSERT_EQ(bench.ask(home(axis)), ILK_VERDICT_ACCEPTED);
  EXPECT_FALSE(bench.driven(axis));
  finish(bench);
  EXPECT_TRUE(bench.homed(axis));
  bench.ticks(30);
  EXPECT_FALSE(bench.driven(axis));
}

// --- Plausibility of the switch

/// READY; the axis homed at its switch, is disabled and stands `inside` counts on the open side of its home.
Bench homed_at_switch(uint32_t slot, int32_t inside) {
  Bench bench = ready_bench();
  const int32_t way = towards(bench, slot);
  bench = homing_bench(slot, way * 40);
  finish(bench, slot);
  EXPECT_TRUE(bench.homed(slot));
  bench.release();
  bench.ask(disable(slot));
  bench.push(slot, -way * inside);
  bench.rest();
  EXPECT_TRUE(bench.homed(slot));
  return bench;
}

struct Place {
  int32_t inside;
  bool reading;
  bool plausible;
};

class Switch_plausibility : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Every_side, Switch_plausibility,
                         testing::Values(slot::pwm_lower, slot::non_pwm_upper, slot::corrected_lower,
                                         slot::corrected_upper),
                         testing::PrintToStringParamName());

TEST_P(Switch_plausibility, is_judged_against_the_home_after_the_debounce_time) {
  const uint32_t slot = GetParam();
  for (const auto& [inside, reading, plausible] :
       {Place{20, true, true}, Place{21, true, false}, Place{900, true, false}, Place{-18, false, true},
        Place{-19, false, false}, Place{-40, true, true}, Place{900, false, true}}) {
    Bench bench = homed_at_switch(slot, inside);
    bench.motor[slot].switch_stuck = reading;
    bench.ticks(2);
    EXPECT_EQ(bench.fault(slot), ILK_FAULT_NONE) << "a wrong sample is no fault";
    bench.tick();
    EXPECT_EQ(bench.fault(slot), plausible ? ILK_FAULT_NONE : ILK_FAULT_SWITCH) << inside;
    EXPECT_EQ(bench.homed(slot), plausible);
    if (!plausible) {
      EXPECT_EQ(bench.axis(slot).fault_value, -towards(bench, slot) * inside);
    }
  }
}

TEST(Switch_doubt, counts_wrong_readings_in_a_row_only) {
  Bench bench = homed_at_switch(axis, 500);
  for (int round = 0; round < 10; ++round) {
    bench.motor[axis].switch_stuck = true;
    bench.ticks(2);
    bench.motor[axis].switch_stuck = false;
    bench.tick();
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
}

TEST(Switch_doubt, is_not_raised_of_an_axis_homed_by_hand_or_not_at_all) {
  for (const bool by_hand : {true, false}) {
    Bench bench = homed_at_switch(axis, 500);
    EXPECT_EQ(bench.ask(by_hand ? set_home(axis) : restore(axis, 500)), ILK_VERDICT_ACCEPTED);
    bench.motor[axis].switch_stuck = true;
    bench.ticks(20);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  }
}

TEST(Switch_doubt, is_a_fault_that_is_not_cleared_in_its_own_tick) {
  Bench bench = homed_at_switch(axis, 500);
  bench.motor[axis].switch_stuck = true;
  bench.ticks(2);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_CAUSE_PRESENT);
  ASSERT_EQ(bench.fault(axis), ILK_FAULT_SWITCH);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
}

TEST(Order_of_faults, STALL_before_SWITCH) {
  Bench bench = homed_at_switch(axis, 500);
  bench.enable_axis(axis);
  bench.press();
  bench.motor[axis].frozen = true;
  bench.keep_moving(axis, 0, 48);
  bench.motor[axis].switch_stuck = true;
  bench.keep_moving(axis, 0, 3);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
}

}  // namespace
}  // namespace interlock::kernel_test
