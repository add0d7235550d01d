#include "oracle/wire.hpp"

#include <gtest/gtest.h>

#include "stage.hpp"

namespace interlock::oracle::test {
namespace {

Words driving(std::uint32_t signal) {
  Words frame{};
  frame[3] = signal;
  frame[14] = 1;
  return frame;
}

AxisRules of_kind(CardKind kind, bool motor_direction) {
  AxisRules rules;
  rules.card = kind;
  rules.motor_direction = motor_direction;
  return rules;
}

TEST(OracleWire, P16_frame_needs_start_word_and_checksum) {
  Words frame = driving(5);
  seal(frame);
  EXPECT_TRUE(wire::is_intact(frame));
  frame[9] ^= 1;
  EXPECT_FALSE(wire::is_intact(frame));
  frame = driving(5);
  seal(frame);
  frame[0]++;
  frame.back()--;
  EXPECT_FALSE(wire::is_intact(frame)) << "the checksum is right, the start word is not";
}

TEST(OracleWire, Every_drive_word_alone_is_drive) {
  EXPECT_TRUE(wire::is_zero_drive(Words{}));
  for (const std::size_t word : {2u, 3u, 4u, 5u, 6u, 14u}) {
    Words frame{};
    frame[word] = 1u << 31;
    EXPECT_FALSE(wire::is_zero_drive(frame)) << "word " << word;
  }
}

TEST(OracleWire, Direction_is_told_for_both_motor_directions) {
  // Published: setDirection is 1 for falling positions, actual = motor_direction ? setDirection :
  // !setDirection.
  EXPECT_FALSE(wire::read_drive(of_kind(CardKind::kPwm, true), driving(7)).rises);
  EXPECT_TRUE(wire::read_drive(of_kind(CardKind::kPwm, true), driving(0x80000007u)).rises);
  EXPECT_TRUE(wire::read_drive(of_kind(CardKind::kPwm, false), driving(7)).rises);
  EXPECT_FALSE(wire::read_drive(of_kind(CardKind::kNonPwm, true), driving(0x40000007u)).rises);
  EXPECT_TRUE(wire::read_drive(of_kind(CardKind::kNonPwm, true), driving(0xC0000007u)).rises);
  EXPECT_EQ(wire::read_drive(of_kind(CardKind::kNonPwm, true), driving(0xC0000007u)).magnitude, 7u);
}

TEST(OracleWire, High_frequency_waves_must_agree) {
  const AxisRules axis = of_kind(CardKind::kHighFrequency, true);
  Words frame{};
  frame[2] = 1u << 24 | 200;
  frame[4] = 200;
  frame[3] = frame[5] = 1196612456u - 4063228u * 10;
  frame[14] = 1;
  const wire::Drive drive = wire::read_drive(axis, frame);
  EXPECT_TRUE(drive.well_formed);
  EXPECT_TRUE(drive.rises);
  EXPECT_EQ(drive.amplitude, 200u);
  frame[5]++;
  EXPECT_FALSE(wire::read_drive(axis, frame).well_formed);
}

TEST(OracleWire, P7_lower_frequency_word_is_faster) {
  EXPECT_EQ(wire::frequency_word(0), 1196612456u);
  EXPECT_EQ(wire::frequency_word(54), 1196612456u - 4063228u);
  EXPECT_EQ(wire::frequency_word(27), 1196612456u - 4063228u / 2);
  EXPECT_EQ(wire::frequency_word(397785), 1196612456u - 4063228u * 23);
  EXPECT_EQ(wire::frequency_word(400000), wire::frequency_word(397785));
  const std::uint32_t bound = 5000;
  const auto with_word = [](std::uint32_t word) { return wire::Drive{true, true, word, 0}; };
  EXPECT_FALSE(wire::exceeds(CardKind::kHighFrequency, with_word(wire::frequency_word(bound)), bound));
  EXPECT_TRUE(wire::exceeds(CardKind::kHighFrequency, with_word(wire::frequency_word(bound) - 1), bound));
}

}  // namespace
}  // namespace interlock::oracle::test
