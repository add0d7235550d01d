// Stall by time and by effort: driven ticks without progress add up; what is progress, and what clears.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;
constexpr uint32_t stall_ticks = 50;
constexpr uint32_t effort_ticks = 20;  ///< of full drive, 1000

/// Progress of more than noise clears the effort, of 6 counts both sums.
ilk_config_t coarse_config() {
  ilk_config_t config = standard_config();
  config.axis[axis].stall_min_counts = 6;
  seal(config);
  return config;
}

Bench jammed_bench(const ilk_config_t& config = standard_config()) {
  Bench bench = motion_bench(axis, config);
  bench.motor[axis].frozen = true;
  return bench;
}

Bench jammed_homed_bench(const ilk_config_t& config = standard_config()) {
  Bench bench = homed_bench(axis, 0, config);
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

uint32_t driven_until_fault(Bench& bench, int32_t target, uint32_t drive = 100) {
  return driven_until_fault(bench, [=](uint32_t) { return move(axis, target, drive); });
}

TEST(P5_stall, faults_after_exactly_its_driven_ticks_without_progress) {
  for (const int32_t target : {80, -80}) {
    Bench bench = jammed_bench();
    EXPECT_EQ(driven_until_fault(bench, target), stall_ticks);
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
    EXPECT_EQ(bench.axis(axis).fault_value, 0);
    EXPECT_EQ(bench.axis(axis).fault_tick, bench.now());
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    EXPECT_TRUE(bench.wire_is_zero());
  }
}

TEST(P5_stall, is_known_after_the_effort_of_full_drive_or_after_the_time_whichever_comes_first) {
  struct Case {
    uint32_t drive;
    uint32_t ticks;
  };
  for (const auto& [drive, ticks] : {Case{1000, effort_ticks}, Case{999, effort_ticks + 1}, Case{500, 40},
                                     Case{400, stall_ticks}, Case{1, stall_ticks}}) {
    Bench bench = jammed_homed_bench();
    EXPECT_EQ(driven_until_fault(bench, 500, drive), ticks) << drive;
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
    EXPECT_FALSE(bench.homed(axis));
  }
}

TEST(P5_stall, an_axis_without_a_bound_of_effort_is_judged_by_time_alone) {
  ilk_config_t config = standard_config();
  config.axis[axis].full_speed_counts_per_s = 200;
  config.axis[axis].stall_effort_ticks = 0;
  config.axis[axis].stall_ticks = 400;
  seal(config);
  Bench bench = jammed_homed_bench(config);
  EXPECT_EQ(driven_until_fault(bench, 500, 1000), 400u);
}

TEST(P5_stall, effort_adds_up_over_different_drives) {
  Bench bench = jammed_homed_bench();
  bench.keep_moving(axis, 500, 10, 1000);
  EXPECT_EQ(driven_until_fault(bench, 500, 500), 20u);
}

TEST(P5_stall, keeps_the_axis_undriven_until_cleared_and_enabled_and_then_counts_anew) {
  Bench bench = jammed_bench();
  driven_until_fault(bench, 80);
  bench.press();
  bench.keep_moving(axis, 80, 20);
  EXPECT_TRUE(bench.wire_is_zero());
  bench.release();
  ASSERT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  bench.press();
  bench.keep_moving(axis, 80, 20);
  EXPECT_TRUE(bench.wire_is_zero());
  bench.enable_axis(axis);
  EXPECT_EQ(driven_until_fault(bench, 80), stall_ticks);
}

// --- Progress

TEST(P5_stall, progress_of_its_minimum_clears_both_and_less_does_not_clear_the_time) {
  for (const int32_t progress : {5, 6}) {
    Bench bench = jammed_homed_bench(coarse_config());
    bench.keep_moving(axis, 500, 40, 100);
    bench.motor[axis].travelled += progress;
    EXPECT_EQ(driven_until_fault(bench, 500), progress == 6 ? stall_ticks : stall_ticks - 40);
    EXPECT_EQ(bench.axis(axis).fault_value, progress == 6 ? 0 : 5);
  }
}

TEST(P5_stall, progress_beyond_noise_clears_the_effort_and_noise_does_not) {
  for (const int32_t progress : {1, 2}) {
    Bench bench = jammed_homed_bench(coarse_config());
    bench.keep_moving(axis, 500, effort_ticks - 1, 1000);
    bench.motor[axis].travelled += progress;
    EXPECT_EQ(driven_until_fault(bench, 500, 1000), progress == 2 ? effort_ticks : 1);
  }
}

TEST(P5_stall, progress_may_come_in_single_counts_from_the_mark) {
  Bench bench = jammed_bench();
  for (int round = 0; round < 20; ++round) {
    bench.motor[axis].travelled += 1;
    bench.keep_moving(axis, 80, 20);
    ASSERT_EQ(bench.fault(axis), ILK_FAULT_NONE) << round;
  }
}

TEST(P5_stall, an_axis_that_creeps_at_full_drive_is_known_by_its_time) {
  Bench bench = jammed_homed_bench(coarse_config());
  const uint32_t driven = driven_until_fault(bench, [&bench](uint32_t tick) {
    bench.motor[axis].travelled += tick == 15 || tick == 30 ? 2 : 0;
    return move(axis, 500, 1000);
  });
  EXPECT_EQ(driven, stall_ticks) << "4 counts of 6";
}

TEST(P5_stall, progress_while_undriven_or_pushed_by_hand_counts_in_the_commanded_direction_alone) {
  for (const int32_t way : {1, -1}) {
    Bench bench = jammed_bench();
    bench.keep_moving(axis, 80, 30);
    bench.release();
    bench.ask(disable(axis));
    bench.push(axis, way * 6);
    bench.rest();
    bench.enable_axis(axis);
    bench.press();
    EXPECT_EQ(driven_until_fault(bench, 60), way == 1 ? stall_ticks : stall_ticks - 30);
  }
}

TEST(P5_stall, an_axis_that_was_pushed_back_by_hand_is_judged_from_where_it_was_enabled) {
  for (const bool frozen : {false, true}) {
    Bench bench = homed_bench(axis, 0, coarse_config());
    bench.keep_moving(axis, 400, 60);
    bench.release();
    bench.ask(disable(axis));
    bench.push(axis, -300);
    bench.rest();
    bench.enable_axis(axis);
    bench.press();
    bench.motor[axis].frozen = frozen;
    EXPECT_EQ(driven_until_fault(
                  bench, [](uint32_t) { return move(axis, 400, 1000); }, 60),
              frozen ? effort_ticks : 60u);
    EXPECT_EQ(bench.fault(axis), frozen ? ILK_FAULT_STALL : ILK_FAULT_NONE);
  }
}

TEST(P5_stall, neither_ENABLE_nor_a_push_back_forgives_what_was_driven_before) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 30);
  bench.release();
  bench.ask(disable(axis));
  bench.push(axis, -6);
  bench.rest();
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(driven_until_fault(bench, 60), stall_ticks - 30);
}

TEST(P5_stall, a_change_of_direction_moves_the_marks_and_keeps_the_sums) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, 30);
  bench.keep_moving(axis, -80, 1);
  bench.motor[axis].travelled += 5;
  bench.keep_moving(axis, -80, 1);
  bench.motor[axis].travelled -= 5;
  EXPECT_EQ(driven_until_fault(bench, -80), stall_ticks - 32)
      << "back to where the mark was set is no progress";
}

TEST(P5_stall, a_jump_and_a_reset_card_are_no_progress) {
  for (const bool reset_card : {false, true}) {
    Bench bench = jammed_bench();
    bench.keep_moving(axis, 80, 30);
    bench.motor[axis].travelled += reset_card ? 7 : 100;
    if (reset_card) bench.card[axis].heartbeat = 0;
    bench.tick();
    ASSERT_EQ(bench.fault(axis), reset_card ? ILK_FAULT_CARD_RESET : ILK_FAULT_JUMP);
    bench.pedal(false);
    bench.rest();
    ASSERT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
    bench.enable_axis(axis);
    bench.press();
    EXPECT_EQ(driven_until_fault(bench, bench.position(axis) + 60), stall_ticks - 30);
  }
}

// --- Arrival

TEST(P5_stall, arrival_after_an_advance_of_more_than_noise_clears_both) {
  for (const int32_t advance : {1, 2}) {
    Bench bench = jammed_homed_bench(coarse_config());
    bench.keep_moving(axis, advance + 2 + 1, 15, 1000);
    bench.motor[axis].travelled += advance;
    bench.keep_moving(axis, advance + 1, 1, 1000);
    ASSERT_EQ(bench.gate(axis), ILK_GATE_SETPOINT);
    EXPECT_EQ(driven_until_fault(bench, 500, 100), advance == 2 ? stall_ticks : stall_ticks - 15);
  }
}

TEST(P5_stall, arrival_behind_what_was_reached_makes_no_new_ground_of_it) {
  ilk_config_t config = standard_config();
  config.axis[axis].noise_counts = 0;
  config.axis[axis].stall_min_counts = 20;
  config.axis[axis].stall_ticks = 400;
  config.axis[axis].deadband_counts = 5;
  seal(config);
  Bench bench = homed_bench(axis, 0, config);
  const int64_t begun = bench.motor[axis].travelled;
  bench.motor[axis].speed = 0;
  const auto stand = [&](int32_t counts, int32_t target, uint32_t ticks) {
    bench.motor[axis].travelled = begun + counts;
    bench.keep_moving(axis, target, ticks, 1000);
  };
  for (const int32_t counts : {0, 7, 14, 20, 28, 35}) stand(counts, 500, 1);
  stand(28, 500, 1);
  stand(25, 25, 2);
  EXPECT_EQ(bench.axis(axis).stall_driven_ticks, 0u) << "arrived, beyond the stall mark";
  uint32_t ticks = 0;
  for (int32_t counts = 26; bench.fault(axis) == ILK_FAULT_NONE && counts < 34; ++counts) {
    stand(counts, 500, 15);
    ticks += 15;
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_LE(ticks, 30u) << "20 ticks of full drive";
}

TEST(P5_stall, arrival_because_the_setpoint_was_moved_to_the_axis_does_not_clear) {
  Bench bench = jammed_bench();
  bench.keep_moving(axis, 80, stall_ticks - 1);
  bench.keep_moving(axis, 0, 10);
  ASSERT_EQ(bench.gate(axis), ILK_GATE_SETPOINT);
  EXPECT_EQ(driven_until_fault(bench, 80), 1u);
}

TEST(P5_stall, arrival_without_a_live_lease_clears_nothing) {
  Bench bench = jammed_homed_bench(coarse_config());
  bench.keep_moving(axis, 5, 14, 1000);
  bench.ask(move(axis, 5, 1000, 1));
  bench.motor[axis].travelled += 4;
  bench.tick();
  EXPECT_EQ(bench.gate(axis), ILK_GATE_LEASE);
  EXPECT_EQ(driven_until_fault(bench, 500), stall_ticks - 15);
}

TEST(P5_stall, an_encoder_that_froze_after_an_advance_cannot_arrive_for_ever) {
  Bench bench = jammed_homed_bench(coarse_config());
  bench.motor[axis].travelled += 3;
  uint32_t driven = 0;
  for (int round = 0; round < 500 && bench.fault(axis) == ILK_FAULT_NONE; ++round) {
    bench.keep_moving(axis, 9, 5, 1000);
    driven += bench.driven(axis) ? 5 : 0;
    bench.keep_moving(axis, 3, 2, 1000);
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_LE(driven, 2 * effort_ticks + 5);
}

// --- What clears nothing

struct Pretext {
  const char* name;
  std::function<void(Bench&)> act;  ///< after 30 of 50 driven ticks; leaves the axis enabled in MOTION
};

void PrintTo(const Pretext& pretext, std::ostream* stream) { *stream << pretext.name; }

void back_to_motion(Bench& bench) {
  bench.pedal(false);
  bench.rest();
  if (bench.fault(axis) != ILK_FAULT_NONE) {
    EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  }
  bench.enable_axis(axis);
  bench.press();
}

const Pretext pretexts[] = {
    {"a_new_MOVE", [](Bench&) {}},
    {"idle_time", [](Bench& bench) { bench.ticks(2000); }},
    {"release_and_press",
     [](Bench& bench) {
       bench.release();
       bench.press();
     }},
    {"DISABLE_and_ENABLE",
     [](Bench& bench) {
       bench.ask(disable(axis));
       bench.rest();
       bench.enable_axis(axis);
     }},
    {"a_lock_and_RESET",
     [](Bench& bench) {
       bench.estop_loop_closed = 0;
       bench.tick();
       bench.estop_loop_closed = 1;
       bench.to_ready();
       back_to_motion(bench);
     }},
    {"another_fault_and_its_CLEAR_FAULT",
     [](Bench& bench) {
       bench.motor[axis].travelled -= 25;
       bench.tick();
       ASSERT_EQ(bench.fault(axis), ILK_FAULT_JUMP);
       back_to_motion(bench);
     }},
    {"a_lost_card",
     [](Bench& bench) {
       bench.pedal(false);
       bench.spoil(axis, FrameFault::missing, 3);
       bench.ticks(3);
       ASSERT_EQ(bench.fault(axis), ILK_FAULT_CARD);
       back_to_motion(bench);
     }},
    {"SET_HOME_and_RESTORE",
     [](Bench& bench) {
       bench.pedal(false);
       bench.rest();
       EXPECT_EQ(bench.ask(restore(axis, 500)), ILK_VERDICT_ACCEPTED);
       EXPECT_EQ(bench.ask(set_home(axis)), ILK_VERDICT_ACCEPTED);
       bench.press();
     }},
    {"noise", [](Bench& bench) { bench.motor[axis].dither = 1; }},
    {"reverse_motion", [](Bench& bench) { bench.motor[axis].travelled -= 7; }},
};

class P5_pretext : public testing::TestWithParam<Pretext> {};

INSTANTIATE_TEST_SUITE_P(Is, P5_pretext, testing::ValuesIn(pretexts),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(P5_pretext, no_progress) {
  Bench bench = jammed_bench();
  for (uint32_t driven = 0; driven < 30; ++driven) bench.ask(move(axis, 80, 100, 1));
  bench.tick();
  GetParam().act(bench);
  EXPECT_EQ(driven_until_fault(bench, bench.position(axis) + 60), stall_ticks - 30);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
}

TEST(P5_stall, neither_a_changing_direction_nor_short_leases_nor_lost_frames_clear) {
  const std::function<ilk_request_t(uint32_t)> orders[] = {
      [](uint32_t tick) { return move(axis, tick % 2 == 0 ? 80 : -80); },
      [](uint32_t tick) { return tick % 4 == 0 ? move(axis, 80, 100, 1) : disable(slot::pwm_lower); },
  };
  for (const auto& order : orders) {
    Bench bench = jammed_bench();
    EXPECT_EQ(driven_until_fault(bench, order), stall_ticks);
  }
  Bench blind = jammed_bench();
  EXPECT_EQ(driven_until_fault(blind,
                               [&blind](uint32_t tick) {
                                 if (tick % 3 == 1) blind.spoil(axis, FrameFault::missing, 2);
                                 return move(axis, 80);
                               }),
            stall_ticks);
}

TEST(P5_stall, a_bound_is_judged_in_the_next_tick_whatever_the_state_and_without_a_frame) {
  for (const bool disabled : {false, true}) {
    Bench bench = jammed_bench();
    bench.keep_moving(axis, 80, stall_ticks - 1);
    bench.queue(move(axis, 80));
    bench.tick();
    ASSERT_TRUE(bench.driven(axis));
    bench.spoil(axis, FrameFault::missing, 1);
    if (disabled) bench.queue(disable(axis));
    bench.tick();
    EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  }
}

TEST(P5_stall, a_bound_met_under_another_fault_stays_met) {
  ilk_config_t config = standard_config();
  config.common.bad_frame_limit = 1;
  seal(config);
  Bench bench = jammed_bench(config);
  bench.keep_moving(axis, 80, stall_ticks);
  bench.spoil(axis, FrameFault::missing, 1);
  bench.tick();
  ASSERT_EQ(bench.fault(axis), ILK_FAULT_CARD);
  bench.pedal(false);
  bench.rest();
  ASSERT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_CAUSE_PRESENT) << "a fault of this very tick";
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(driven_until_fault(bench, bench.position(axis) + 60), stall_ticks);
}

TEST(P5_stall, axes_count_apart) {
  Bench bench = ready_bench();
  bench.enable_axis(axis);
  bench.enable_axis(slot::pwm_lower);
  bench.motor[axis].frozen = true;
  bench.press();
  for (uint32_t tick = 0; tick <= stall_ticks; ++tick) {
    bench.queue(move(slot::pwm_lower, 60));
    bench.keep_moving(axis, 80, 1);
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_STALL);
  EXPECT_EQ(bench.fault(slot::pwm_lower), ILK_FAULT_NONE);
  EXPECT_EQ(bench.position(slot::pwm_lower), 50);
}

TEST(L1_progress, an_axis_that_moves_slowly_but_enough_does_not_stall) {
  Bench bench = jammed_homed_bench();
  for (uint32_t tick = 0; tick < 900; ++tick) {
    bench.motor[axis].travelled += tick % 20 == 19 ? 1 : 0;
    bench.keep_moving(axis, 80, 1);
    ASSERT_EQ(bench.fault(axis), ILK_FAULT_NONE) << tick;
  }
}

}  // namespace
}  // namespace interlock::kernel_test
