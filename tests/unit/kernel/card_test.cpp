// Cards: what makes a frame valid, what a lost card does to its axis, and how it comes back.
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

TEST_P(Bad_frame, is_never_used) {
  Bench bench;
  bench.to_ready();
  const uint32_t raw = bench.axis(axis).raw;
  bench.motor[axis].travelled += 5;
  bench.spoil(axis, GetParam(), 1);
  bench.tick();
  EXPECT_EQ(bench.axis(axis).card_valid, 0u);
  EXPECT_EQ(bench.axis(axis).raw, raw);
  EXPECT_EQ(bench.position(axis), 0);
  bench.tick();
  EXPECT_EQ(bench.axis(axis).card_valid, 1u);
  EXPECT_EQ(bench.position(axis), 5);
}

TEST_P(Bad_frame, loses_the_card_at_the_limit_in_a_row_and_not_before) {
  Bench bench;
  bench.to_motion_homed(axis);
  for (int round = 0; round < 3; ++round) {
    bench.spoil(axis, GetParam(), 2);
    bench.ticks(3);
    ASSERT_EQ(bench.fault(axis), ILK_FAULT_NONE);
    ASSERT_EQ(bench.axis(axis).homed, 1u);
    ASSERT_EQ(bench.mode(), ILK_MODE_MOTION);
  }
  bench.spoil(axis, GetParam(), 3);
  bench.ticks(3);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD_LOST);
  EXPECT_EQ(bench.axis(axis).fault_value, 3);
  EXPECT_EQ(bench.axis(axis).homed, 0u);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.fault(slot::pwm_free), ILK_FAULT_NONE);
}

TEST_P(Bad_frame, counts_for_an_axis_in_every_state) {
  Bench bench;
  bench.to_ready();
  bench.spoil(axis, GetParam(), 3);
  bench.ticks(3);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD_LOST) << "disabled";
}

TEST(Card_lost, can_be_cleared_when_frames_are_valid_again) {
  Bench bench;
  bench.to_ready();
  bench.spoil(axis, FrameFault::missing, 10);
  bench.ticks(9);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_CAUSE_PRESENT);
  EXPECT_EQ(bench.ask(clear_fault(axis)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(axis);
  bench.press();
  EXPECT_EQ(bench.ask(move(axis, 50)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

TEST(Card_lost, with_the_whole_bus_loses_every_reference) {
  Bench bench;
  bench.to_ready();
  bench.reference(axis);
  bench.transaction_done = 0;
  bench.ticks(3);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_BUS);
  EXPECT_EQ(bench.axis(axis).homed, 0u);
}

TEST(Card_lost, a_card_that_comes_back_is_judged_without_its_heartbeat) {
  Bench bench;
  bench.to_ready();
  const uint32_t heartbeat = bench.card[axis].heartbeat;
  bench.spoil(axis, FrameFault::missing, 3);
  bench.ticks(3);
  bench.card[axis].heartbeat = heartbeat - 1;
  bench.tick();
  EXPECT_EQ(bench.axis(axis).card_valid, 1u);
}

TEST(Card_lost, a_card_not_yet_lost_is_judged_by_its_heartbeat) {
  Bench bench;
  bench.to_ready();
  const uint32_t heartbeat = bench.card[axis].heartbeat;
  bench.spoil(axis, FrameFault::missing, 2);
  bench.ticks(2);
  bench.card[axis].heartbeat = heartbeat - 1;
  bench.tick();
  EXPECT_EQ(bench.axis(axis).card_valid, 0u);
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_CARD_LOST);
}

TEST(Frames_in, the_first_frame_is_judged_without_its_heartbeat) {
  Bench bench;
  bench.card[axis].heartbeat = 0xFFFFFFFFu;
  bench.tick();
  ASSERT_EQ(bench.inputs().frame[axis][incoming::heartbeat], 0u);
  EXPECT_EQ(bench.axis(axis).card_valid, 1u);
}

TEST(Frames_in, the_heartbeat_of_a_sensor_card_is_judged_too) {
  Bench bench;
  bench.to_motion();
  const uint32_t stuck = bench.card[slot::sensor].heartbeat - 1;
  for (int tick = 0; tick < 3; ++tick) {
    bench.card[slot::sensor].heartbeat = stuck;
    bench.tick();
    EXPECT_EQ(bench.axis(slot::sensor).card_valid, 0u);
  }
  EXPECT_EQ(bench.mode(), ILK_MODE_READY) << "a required card was lost";
}

TEST(Frames_in, the_tick_echo_is_not_judged_in_the_first_tick) {
  Bench bench;
  for (Card& card : bench.card) card.heard_tick = 123456;
  bench.tick();
  EXPECT_EQ(bench.axis(axis).card_valid, 1u);
}

TEST(Frames_in, a_card_that_is_deaf_is_not_believed) {
  Bench bench;
  bench.to_ready();
  const uint32_t heard = bench.card[axis].heard_tick;
  for (int tick = 0; tick < 3; ++tick) {
    bench.tick();
    bench.card[axis].heard_tick = heard;
  }
  EXPECT_EQ(bench.fault(axis), ILK_FAULT_NONE);
  bench.ticks(1);
  EXPECT_EQ(bench.axis(axis).card_valid, 0u);
}

TEST(Frames_in, a_frame_of_an_unfinished_transaction_is_not_used) {
  for (const uint32_t done : {0u, 2u, 0xFFFFFFFFu}) {
    Bench bench;
    bench.to_ready();
    bench.transaction_done = done;
    bench.tick();
    for (uint32_t slot = 0; slot < slot::axes; ++slot) EXPECT_EQ(bench.axis(slot).card_valid, 0u) << done;
  }
}

TEST(Frames_in, words_without_meaning_are_ignored) {
  Bench bench;
  bench.to_ready();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) {
    for (const std::size_t word : std::initializer_list<std::size_t>{1, 4, 5, 6, 13, ILK_FRAME_WORDS - 2}) {
      bench.tick_with([slot, word](ilk_inputs_t& in) {
        in.frame[slot][word] = 0xDEADBEEFu;
        write_checksum(in.frame[slot]);
      });
      EXPECT_EQ(bench.axis(slot).card_valid, 1u);
      EXPECT_EQ(bench.axis(slot).switch_triggered, 0u);
    }
  }
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(Frames_in, status_and_time_are_kept_from_valid_frames) {
  Bench bench;
  bench.to_ready();
  bench.tick_with([](ilk_inputs_t& in) {
    in.frame[axis][incoming::status] = 0xBu;
    in.frame[axis][incoming::time_us] = 0xFFFFFF00u;
    write_checksum(in.frame[axis]);
  });
  EXPECT_EQ(bench.axis(axis).card_status, 0xBu);
  EXPECT_EQ(bench.axis(axis).card_time_us, 0xFFFFFF00u);
}

TEST(Frames_in, an_empty_slot_may_hold_anything) {
  Bench bench;
  bench.to_ready();
  bench.tick_with([](ilk_inputs_t& in) {
    in.frames_received = 0xFFFFFFFFu;
    std::fill(std::begin(in.frame[slot::empty]), std::end(in.frame[slot::empty]), 0xFFFFFFFFu);
  });
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.axis(slot::empty).state, uint32_t{ILK_AXIS_DISABLED});
}

TEST(P16_frames, every_single_wrong_bit_of_a_frame_is_found) {
  Bench bench;
  bench.to_ready();
  for (uint32_t bit = 0; bit < ILK_FRAME_WORDS * 32; ++bit) {
    bench.tick_with([bit](ilk_inputs_t& in) { in.frame[axis][bit / 32] ^= 1u << bit % 32; });
    ASSERT_EQ(bench.axis(axis).card_valid, 0u) << bit;
    bench.tick();
    ASSERT_EQ(bench.axis(axis).card_valid, 1u) << bit;
  }
  EXPECT_EQ(bench.axis(axis).fault, uint32_t{ILK_FAULT_NONE});
}

TEST(P16_frames, a_checksum_failure_is_counted) {
  Bench bench;
  bench.to_ready();
  const uint32_t before = bench.axis(axis).checksum_failures;
  bench.spoil(axis, FrameFault::wrong_checksum, 2);
  bench.ticks(3);
  bench.spoil(axis, FrameFault::missing, 1);
  bench.ticks(2);
  EXPECT_EQ(bench.axis(axis).checksum_failures, before + 2);
}

TEST(P16_frames, a_wrong_start_word_with_a_right_checksum_is_never_used) {
  for (const uint32_t start : {0u, 0xFEFEFE00u, 0xFEFEFE02u, 0x01FEFEFEu}) {
    Bench bench;
    bench.to_ready();
    bench.tick_with([start](ilk_inputs_t& in) {
      in.frame[axis][0] = start;
      write_checksum(in.frame[axis]);
    });
    EXPECT_EQ(bench.axis(axis).card_valid, 0u);
  }
}

}  // namespace
}  // namespace interlock::kernel_test
