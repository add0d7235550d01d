// Outgoing frames, with the words of spec/frames.md written out.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

std::span<const uint32_t> wire_after_move(Bench& bench, uint32_t slot, int32_t target, uint32_t drive,
                                          uint32_t amplitude = 0) {
  ilk_request_t request = move(slot, target, drive);
  request.amplitude = amplitude;
  EXPECT_EQ(bench.ask(request), ILK_VERDICT_ACCEPTED);
  return bench.out().frame[slot];
}

void expect_only(std::span<const uint32_t> frame, std::initializer_list<std::size_t> used) {
  for (std::size_t word = 1; word + 1 < frame.size(); ++word) {
    if (word == outgoing::tick || std::find(used.begin(), used.end(), word) != used.end()) continue;
    EXPECT_EQ(frame[word], 0u) << "word " << word;
  }
}

TEST(P16_frames, carry_start_word_tick_and_checksum_to_every_card) {
  Bench bench;
  bench.ticks(3);
  for (uint32_t slot = 0; slot <= slot::sensor; ++slot) {
    const std::span<const uint32_t> frame(bench.out().frame[slot]);
    EXPECT_EQ(frame[0], 0xFEFEFE01u);
    EXPECT_EQ(frame[13], bench.now());
    EXPECT_EQ(std::accumulate(frame.begin(), frame.end(), 0u), 0xFFFFFFFFu);
    expect_only(frame, {});
  }
}

TEST(P16_frames, PWM) {
  Bench bench = homed_bench(slot::pwm_lower);
  auto frame = wire_after_move(bench, slot::pwm_lower, 500, 777);
  EXPECT_EQ(frame[3], 0x80000000u + 777);
  EXPECT_EQ(frame[14], 1u);
  expect_only(frame, {3, 14});
  frame = wire_after_move(bench, slot::pwm_lower, -500, 777);
  EXPECT_EQ(frame[3], 777u);
  expect_only(frame, {3, 14});
}

TEST(P16_frames, PWM_with_inverted_motor) {
  Bench bench = homed_bench(slot::corrected_upper);
  EXPECT_EQ(wire_after_move(bench, slot::corrected_upper, 500, 777)[3], 777u);
  EXPECT_EQ(wire_after_move(bench, slot::corrected_upper, -500, 777)[3], 0x80000000u + 777);
}

TEST(P16_frames, NON_PWM) {
  Bench bench = homed_bench(slot::non_pwm_upper);
  auto frame = wire_after_move(bench, slot::non_pwm_upper, 500, 777);
  EXPECT_EQ(frame[3], 0xC0000000u + 777);
  EXPECT_EQ(frame[14], 1u);
  expect_only(frame, {3, 14});
  EXPECT_EQ(wire_after_move(bench, slot::non_pwm_upper, -500, 777)[3], 0x40000000u + 777);
}

TEST(P16_frames, NON_PWM_with_inverted_motor) {
  Bench bench = homed_bench(slot::non_pwm_inverted);
  EXPECT_EQ(wire_after_move(bench, slot::non_pwm_inverted, 500, 777)[3], 0x40000000u + 777);
  EXPECT_EQ(wire_after_move(bench, slot::non_pwm_inverted, -500, 777)[3], 0xC0000000u + 777);
}

TEST(P16_frames, ANALOG) {
  Bench bench = homed_bench(slot::analog_upper);
  auto frame = wire_after_move(bench, slot::analog_upper, 500, 777);
  EXPECT_EQ(frame[6], 0x80000000u + 777);
  EXPECT_EQ(frame[14], 1u);
  expect_only(frame, {6, 14});
  EXPECT_EQ(wire_after_move(bench, slot::analog_upper, -500, 777)[6], 777u);
}

TEST(P16_frames, the_largest_drive_of_each_card_is_carried_whole) {
  struct Largest {
    uint32_t slot;
    uint32_t drive;
    std::size_t word;
  };
  for (const auto& [slot, drive, word] :
       {Largest{slot::pwm_lower, 0x7FFFFFFFu, 3}, Largest{slot::non_pwm_upper, 0x3FFFFFFFu, 3},
        Largest{slot::analog_upper, 0x7FFFFFFFu, 6}}) {
    ilk_config_t config = standard_config();
    config.axis[slot].max_drive = drive;
    seal(config);
    Bench bench = homed_bench(slot, 0, config);
    const uint32_t up = wire_after_move(bench, slot, 500, drive)[word];
    const uint32_t down = wire_after_move(bench, slot, -500, drive)[word];
    EXPECT_EQ(up - drive, word == 3 && slot == slot::non_pwm_upper ? 0xC0000000u : 0x80000000u);
    EXPECT_EQ(down - drive, slot == slot::non_pwm_upper ? 0x40000000u : 0u);
  }
}

ilk_config_t fast_wave_config() {
  ilk_config_t config = standard_config();
  config.axis[slot::high_frequency].max_drive = 397785;
  seal(config);
  return config;
}

TEST(P16_frames, HIGH_FREQUENCY) {
  Bench bench = homed_bench(slot::high_frequency, 0, fast_wave_config());
  auto frame = wire_after_move(bench, slot::high_frequency, 500, 54, 200);
  EXPECT_EQ(frame[2], 0x01000000u + 200);
  EXPECT_EQ(frame[4], 0x00000000u + 200);
  EXPECT_EQ(frame[3], 1196612456u - 4063228u);
  EXPECT_EQ(frame[5], frame[3]);
  EXPECT_EQ(frame[14], 1u);
  expect_only(frame, {2, 3, 4, 5, 14});
  frame = wire_after_move(bench, slot::high_frequency, -500, 54, 200);
  EXPECT_EQ(frame[2], 0x00000000u + 200);
  EXPECT_EQ(frame[4], 0x01000000u + 200);
}

TEST(P16_frames, HIGH_FREQUENCY_with_inverted_motor) {
  ilk_config_t config = standard_config();
  config.axis[slot::high_frequency].motor_direction = 0;
  seal(config);
  Bench bench = homed_bench(slot::high_frequency, 0, config);
  auto frame = wire_after_move(bench, slot::high_frequency, 500, 54, 7);
  EXPECT_EQ(frame[2], 7u);
  EXPECT_EQ(frame[4], 0x01000007u);
}

TEST(P16_frames, HIGH_FREQUENCY_without_amplitude_is_still_a_drive) {
  Bench bench = homed_bench(slot::high_frequency);
  EXPECT_NE(wire_after_move(bench, slot::high_frequency, 500, 54, 0)[3], 0u);
  EXPECT_EQ(bench.gate(slot::high_frequency), ILK_GATE_OPEN);
}

TEST(P16_frames, HIGH_FREQUENCY_drive_is_interpolated_towards_the_slower_side) {
  struct Point {
    uint32_t drive;
    uint32_t word;
  };
  Bench bench = homed_bench(slot::high_frequency, 0, fast_wave_config());
  bench.motor[slot::high_frequency].speed = 0;
  for (const auto& [drive, word] : {Point{1, 1196537212u}, Point{27, 1194580842u}, Point{53, 1192624473u},
                                    Point{54, 1192549228u}, Point{100, 1191164721u}, Point{189, 1188486000u},
                                    Point{397784, 1103158263u}, Point{397785, 1103158212u}}) {
    EXPECT_EQ(wire_after_move(bench, slot::high_frequency, 500, drive, 1)[3], word) << drive;
  }
}

TEST(P16_frames, HIGH_FREQUENCY_more_drive_is_never_a_slower_word) {
  Bench bench = homed_bench(slot::high_frequency, 0, fast_wave_config());
  uint32_t slower = 1196612456u;
  for (uint32_t drive = 1; drive <= 397785; drive += drive < 12000 ? 61 : 997) {
    const int32_t target = bench.position(slot::high_frequency) > 0 ? -500 : 500;
    const uint32_t word = wire_after_move(bench, slot::high_frequency, target, drive, 1)[3];
    ASSERT_LT(word, slower) << drive;
    ASSERT_EQ(word, high_frequency_word(drive));
    slower = word;
  }
}

TEST(P16_frames, a_sensor_card_and_an_empty_slot_get_no_signal) {
  Bench bench = homed_bench(slot::pwm_lower);
  wire_after_move(bench, slot::pwm_lower, 500, 100);
  EXPECT_TRUE(drive_words_zero(bench.out().frame[slot::sensor]));
  EXPECT_TRUE(drive_words_zero(bench.out().frame[slot::empty]));
}

TEST(P16_frames, the_tick_counter_grows_by_one_each_tick) {
  Bench bench;
  bench.tick();
  uint32_t before = bench.out().frame[0][13];
  for (int tick = 0; tick < 50; ++tick) {
    bench.tick();
    for (uint32_t slot = 0; slot <= slot::sensor; ++slot) EXPECT_EQ(bench.out().frame[slot][13], before + 1);
    ++before;
  }
}

}  // namespace
}  // namespace interlock::kernel_test
