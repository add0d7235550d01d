// Outgoing frames, with the words of spec/frames.md written out.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

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

/// Words 2 to 6 of a frame that drives up and of one that drives down.
struct Signal {
  const char* name;
  uint32_t slot;
  uint32_t motor_direction;
  uint32_t drive;
  uint32_t amplitude;
  std::array<uint32_t, 5> up;
  std::array<uint32_t, 5> down;
};

constexpr uint32_t wave_of_54 = 1196612456u - 4063228u;

const Signal signals[] = {
    {"PWM", slot::pwm_lower, 1, 777, 0, {0, 0x80000000u + 777}, {0, 777}},
    {"PWM_inverted", slot::pwm_lower, 0, 777, 0, {0, 777}, {0, 0x80000000u + 777}},
    {"PWM_largest", slot::pwm_lower, 1, 0x7FFFFFFFu, 0, {0, 0xFFFFFFFFu}, {0, 0x7FFFFFFFu}},
    {"NON_PWM", slot::non_pwm_upper, 1, 777, 0, {0, 0xC0000000u + 777}, {0, 0x40000000u + 777}},
    {"NON_PWM_inverted", slot::non_pwm_upper, 0, 777, 0, {0, 0x40000000u + 777}, {0, 0xC0000000u + 777}},
    {"NON_PWM_largest", slot::non_pwm_upper, 1, 0x3FFFFFFFu, 0, {0, 0xFFFFFFFFu}, {0, 0x7FFFFFFFu}},
    {"ANALOG", slot::analog_upper, 1, 777, 0, {0, 0, 0, 0, 0x80000000u + 777}, {0, 0, 0, 0, 777}},
    {"ANALOG_largest",
     slot::analog_upper,
     1,
     0x7FFFFFFFu,
     0,
     {0, 0, 0, 0, 0xFFFFFFFFu},
     {0, 0, 0, 0, 0x7FFFFFFFu}},
    {"HIGH_FREQUENCY",
     slot::high_frequency,
     1,
     54,
     200,
     {0x010000C8u, wave_of_54, 0xC8u, wave_of_54},
     {0xC8u, wave_of_54, 0x010000C8u, wave_of_54}},
    {"HIGH_FREQUENCY_inverted",
     slot::high_frequency,
     0,
     54,
     7,
     {7, wave_of_54, 0x01000007u, wave_of_54},
     {0x01000007u, wave_of_54, 7, wave_of_54}},
};

void PrintTo(const Signal& signal, std::ostream* stream) { *stream << signal.name; }

class P16_signal : public testing::TestWithParam<Signal> {};

INSTANTIATE_TEST_SUITE_P(Card, P16_signal, testing::ValuesIn(signals),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(P16_signal, is_what_the_card_expects_and_nothing_else) {
  const Signal& signal = GetParam();
  ilk_config_t config = standard_config();
  config.axis[signal.slot].motor_direction = signal.motor_direction;
  config.axis[signal.slot].max_drive = std::max(1000u, signal.drive);
  seal(config);
  Bench bench = homed_bench(signal.slot, 0, config);
  for (const int32_t target : {500, -500}) {
    Frame expected{};
    expected[0] = 0xFEFEFE01u;
    const auto& words = target > 0 ? signal.up : signal.down;
    std::copy(words.begin(), words.end(), expected.begin() + 2);
    const auto frame = wire_after_move(bench, signal.slot, target, signal.drive, signal.amplitude);
    expected[13] = bench.now();
    expected[14] = 1;
    expected.back() = 0xFFFFFFFFu - std::accumulate(expected.begin(), expected.end() - 1, 0u);
    EXPECT_TRUE(std::equal(frame.begin(), frame.end(), expected.begin())) << target;
  }
}

TEST(P16_frames, carry_start_word_tick_and_checksum_to_every_card_and_no_signal_at_rest) {
  Bench bench;
  for (int tick = 0; tick < 50; ++tick) {
    bench.tick();
    for (uint32_t slot = 0; slot <= slot::sensor; ++slot) {
      const std::span<const uint32_t> frame(bench.out().frame[slot]);
      EXPECT_EQ(frame[0], 0xFEFEFE01u);
      EXPECT_EQ(frame[13], static_cast<uint32_t>(tick));
      EXPECT_EQ(std::accumulate(frame.begin(), frame.end(), 0u), 0xFFFFFFFFu);
      EXPECT_EQ(std::count(frame.begin(), frame.end(), 0u), ILK_FRAME_WORDS - (tick == 0 ? 2 : 3));
    }
  }
}

ilk_config_t fast_wave_config() {
  ilk_config_t config = standard_config();
  config.axis[slot::high_frequency].max_drive = 397785;
  seal(config);
  return config;
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

}  // namespace
}  // namespace interlock::kernel_test
