// Cards: what makes a frame valid, what a lost card and a reset card do to their axis, and how they come
// back.
#include <gtest/gtest.h>

#include <algorithm>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_lower;

class Bad_frame : public testing::TestWithParam<FrameFault> {};

INSTANTIATE_TEST_SUITE_P(Kinds, Bad_frame,
                         testing::Values(FrameFault::wrong_checksum, FrameFault::wrong_start,
                                         FrameFault::missing, FrameFault::repeated, FrameFault::stale_echo));

TEST_P(Bad_frame, is_never_used_and_leaves_its_axis_undriven_in_that_tick) {
  Bench bench = homed_bench(axis);
  bench.keep_moving(axis, 500, 5);
  const uint32_t raw = bench.axis(axis).raw;
  bench.spoil(axis, GetParam(), 1);
  bench.keep_moving(axis, 500, 1);
  EXPECT_EQ(bench.axis(axis).card_valid, 0u);
  EXPECT_EQ(bench.axis(axis).raw, raw);
  EXPECT_FALSE(bench.driven(axis));
  EXPECT_EQ(bench.gate(axis), ILK_GATE_CARD);
  EXPECT_EQ(bench.axis_state(axis), ILK_AXIS_MOVING);
  bench.keep_moving(axis, 500, 1);
  EXPECT_EQ(bench.axis(axis).card_valid, 1u);
  EXPECT_EQ(bench.position(axis), bench.motor[axis].travelled);
  EXPECT_TRUE(bench.driven(axis));
}

TEST_P(Bad_frame, loses_the_card_at_the_limit_in_a_row_and_not_before) {
  Bench bench = homed_bench(axis);
  for (int round = 0; round < 3; ++round) {
    bench.spoil(axis, GetParam(), 2);
    bench.ticks(3);
    ASSERT_EQ(bench.fault(axis), ILK_FAULT_NONE);
    ASSERT_TRUE(bench.homed(axis));
    ASSERT_EQ(bench.mode(), ILK_MODE_MOTION);
  }
  bench.spoil(axis, GetParam(), 3);
  bench.ticks(3);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD);
  EXPECT_EQ(bench.axis(axis).fault_value, 3);
  EXPECT_FALSE(bench.homed(axis));
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.fault(slot::pwm_free), ILK_FAULT_NONE);
}

TEST_P(Bad_frame, counts_for_a_disabled_axis_too) {
  Bench bench = ready_bench();
  bench.spoil(axis, GetParam(), 3);
  bench.ticks(3);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD);
}

TEST(Card_lost, can_be_cleared_at_rest_when_frames_are_valid_again) {
  Bench bench = ready_bench();
  bench.spoil(axis, FrameFault::missing, 10);
  bench.ticks(10);
  for (int still = 1; still < 10; ++still) EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(bench.ask(move(axis, 50)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

TEST(Card_lost, with_the_whole_bus_loses_every_reference) {
  Bench bench = ready_bench();
  bench.reference(axis);
  bench.transaction_done = 0;
  bench.ticks(3);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_BUS);
  EXPECT_FALSE(bench.homed(axis));
}

// --- CARD_RESET

/// What the card does to its heartbeat, and what becomes of its axis.
void expect_after_heartbeat(uint32_t bad_frames, uint32_t missed, uint32_t ahead, ilk_fault_t fault) {
  Bench bench = ready_bench();
  bench.reference(axis);
  const uint32_t before = bench.card[axis].heartbeat;
  bench.spoil(axis, FrameFault::missing, bad_frames);
  bench.ticks(bad_frames);
  bench.card[axis].heartbeat = before + ahead - 1;
  bench.deadlines_missed = missed;
  bench.tick();
  ASSERT_EQ(bench.axis(axis).card_valid, 1u);
  EXPECT_EQ(bench.fault(axis), fault) << bad_frames << " " << missed << " " << ahead;
  EXPECT_EQ(bench.homed(axis), fault == ILK_FAULT_NONE);
  if (fault != ILK_FAULT_NONE) {
    EXPECT_EQ(bench.axis(axis).fault_value, static_cast<int32_t>(ahead));
  }
}

TEST(Card_reset, is_a_heartbeat_that_is_not_ahead_by_1_to_1_and_the_periods_since) {
  for (const uint32_t bad : {0u, 1u, 2u}) {
    for (const uint32_t missed : {0u, 1u, 7u}) {
      const uint32_t most = 2 + bad + missed;
      expect_after_heartbeat(bad, missed, 1, ILK_FAULT_NONE);
      expect_after_heartbeat(bad, missed, most, ILK_FAULT_NONE);
      for (const uint32_t wrong : {0u, most + 1, 0x80000000u, 0xFFFFFFFFu}) {
        expect_after_heartbeat(bad, missed, wrong, ILK_FAULT_CARD_RESET);
      }
    }
  }
}

TEST(Card_reset, the_heartbeat_wraps_and_missed_deadlines_saturate) {
  Bench bench;
  bench.card[axis].heartbeat = 0xFFFFFFF0u;
  bench.to_ready();
  bench.ticks(30);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.deadlines_missed = 0xFFFFFFFFu;
  bench.spoil(axis, FrameFault::missing, 1);
  bench.ticks(2);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
}

TEST(Card_reset, is_told_by_the_status_bit_alone_when_it_comes_up) {
  Bench bench = ready_bench();
  bench.reference(axis);
  bench.card[axis].status = 7;
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.card[axis].status = incoming::status_was_reset;
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD_RESET);
  EXPECT_FALSE(bench.homed(axis));
  for (int still = 2; still < 10; ++still) EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_CAUSE_PRESENT);
  bench.rest();
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED) << "a bit that stays is no new reset";
  bench.rest();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
}

TEST(Card_reset, of_a_bad_frame_is_not_read) {
  Bench bench = ready_bench();
  bench.tick_with([](ilk_inputs_t& in) {
    in.frame[axis][incoming::status] = incoming::status_was_reset;
    in.frame[axis][incoming::heartbeat] = 0;
  });
  EXPECT_EQ(bench.axis(axis).card_valid, 0u);
  bench.tick();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
}

TEST(Card_reset, the_first_frame_after_start_and_after_a_lost_card_is_not_compared) {
  Bench bench;
  bench.card[axis].heartbeat = 0xFFFFFFFFu;
  bench.card[axis].status = incoming::status_was_reset;
  bench.to_ready();
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.card[axis].status = 0;
  bench.spoil(axis, FrameFault::missing, 3);
  bench.ticks(3);
  bench.card[axis].heartbeat = 12;
  bench.card[axis].status = incoming::status_was_reset;
  bench.motor[axis].travelled += 5000;
  bench.ticks(2);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD) << "no other one";
  EXPECT_EQ(bench.mode(), ILK_MODE_READY) << "and no runaway: its mark is taken anew";
  EXPECT_FALSE(bench.homed(axis));
}

// --- Freshness

TEST(Frames_in, the_tick_echo_is_not_judged_until_two_frames_were_sent) {
  Bench bench;
  for (Card& card : bench.card) card.heard_tick = 123456;
  bench.tick();
  EXPECT_EQ(bench.axis(axis).card_valid, 1u);
  bench.ticks(5);
  EXPECT_EQ(bench.axis(axis).card_valid, 1u);
  EXPECT_EQ(bench.axis(axis).bad_frames, 0u);
}

TEST(Frames_in, a_tick_counter_that_wraps_accepts_no_stale_frame) {
  Bench bench = ready_bench();
  bench.damage_state().system.tick = 0xFFFFFFF0u;
  bench.reseal();
  bench.ticks(2);
  for (int tick = 0; tick < 40; ++tick) {
    bench.tick();
    ASSERT_EQ(bench.axis(axis).card_valid, 1u) << tick;
    Bench stale = bench;
    stale.spoil(axis, FrameFault::stale_echo, 1);
    stale.spoil(slot::pwm_free, FrameFault::repeated, 1);
    stale.tick();
    ASSERT_EQ(stale.axis(axis).card_valid, 0u) << tick;
    ASSERT_EQ(stale.axis(slot::pwm_free).card_valid, 0u) << tick;
  }
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(Frames_in, a_card_that_is_deaf_is_not_believed) {
  Bench bench = ready_bench();
  const uint32_t heard = bench.card[axis].heard_tick;
  bench.tick();
  bench.card[axis].heard_tick = heard;
  bench.tick();
  EXPECT_EQ(bench.axis(axis).card_valid, 0u);
}

TEST(Frames_in, a_required_sensor_card_is_judged_by_the_same_rules) {
  Bench bench;
  bench.to_motion();
  bench.spoil(slot::sensor, FrameFault::stale_echo, 3);
  bench.ticks(2);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(Frames_in, a_frame_of_an_unfinished_transaction_is_not_used) {
  for (const uint32_t done : {0u, 2u, 0xFFFFFFFFu}) {
    Bench bench = ready_bench();
    bench.transaction_done = done;
    bench.tick();
    for (uint32_t slot = 0; slot < slot::axes; ++slot) EXPECT_EQ(bench.axis(slot).card_valid, 0u) << done;
  }
}

TEST(Frames_in, words_without_meaning_are_ignored_and_an_empty_slot_may_hold_anything) {
  Bench bench = ready_bench();
  for (const std::size_t word : std::initializer_list<std::size_t>{1, 4, 5, 6, 13, ILK_FRAME_WORDS - 2}) {
    bench.tick_with([word](ilk_inputs_t& in) {
      in.frames_received = 0xFFFFFFFFu;
      std::fill(std::begin(in.frame[slot::empty]), std::end(in.frame[slot::empty]), 0xFFFFFFFFu);
      for (uint32_t slot = 0; slot < slot::axes; ++slot) {
        in.frame[slot][word] = 0xDEADBEEFu;
        write_checksum(in.frame[slot]);
      }
    });
    for (uint32_t slot = 0; slot < slot::axes; ++slot) EXPECT_EQ(bench.axis(slot).card_valid, 1u);
  }
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.axis_state(slot::empty), ILK_AXIS_DISABLED);
}

TEST(Frames_in, status_and_time_are_kept_from_valid_frames) {
  Bench bench = ready_bench();
  bench.tick_with([](ilk_inputs_t& in) {
    in.frame[axis][incoming::status] = 0x3u;
    in.frame[axis][incoming::time_us] = 0xFFFFFF00u;
    write_checksum(in.frame[axis]);
  });
  EXPECT_EQ(bench.axis(axis).card_status, 0x3u);
  EXPECT_EQ(bench.axis(axis).card_time_us, 0xFFFFFF00u);
}

TEST(P16_frames, every_single_wrong_bit_of_a_frame_is_found) {
  Bench bench = ready_bench();
  for (uint32_t bit = 0; bit < ILK_FRAME_WORDS * 32; ++bit) {
    bench.tick_with([bit](ilk_inputs_t& in) { in.frame[axis][bit / 32] ^= 1u << bit % 32; });
    ASSERT_EQ(bench.axis(axis).card_valid, 0u) << bit;
    bench.tick();
    ASSERT_EQ(bench.axis(axis).card_valid, 1u) << bit;
  }
  EXPECT_EQ(bench.axis(axis).checksum_failures, ILK_FRAME_WORDS * 32u);
  bench.spoil(axis, FrameFault::missing, 1);
  bench.ticks(2);
  EXPECT_EQ(bench.axis(axis).checksum_failures, ILK_FRAME_WORDS * 32u) << "no answer is no wrong answer";
}

TEST(P16_frames, a_wrong_start_word_with_a_right_checksum_is_never_used) {
  for (const uint32_t start : {0u, 0xFEFEFE00u, 0xFEFEFE02u, 0x01FEFEFEu}) {
    Bench bench = ready_bench();
    bench.tick_with([start](ilk_inputs_t& in) {
      in.frame[axis][0] = start;
      write_checksum(in.frame[axis]);
    });
    EXPECT_EQ(bench.axis(axis).card_valid, 0u);
  }
}

}  // namespace
}  // namespace interlock::kernel_test
