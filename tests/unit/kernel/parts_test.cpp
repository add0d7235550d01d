// Parts of the core by themselves, where a running kernel never brings them: the last lines of defence behind
// rules that already hold. Each must hold alone, because memory may be damaged between the two.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "bench.hpp"

extern "C" {
#include "parts.h"
}

namespace interlock::kernel_test {
namespace {

/// A moving axis for which every gate is open.
struct OpenGate {
  ilk_axis_config_t config = switched_axis(ILK_CARD_PWM, ILK_LIMIT_UPPER);
  ilk_system_t system{};
  ilk_axis_t axis{};
  ilk_command_t wanted{ILK_DIRECTION_INCREASING, 100, 0};

  OpenGate() {
    system.mode = ILK_MODE_MOTION;
    system.pedal = ILK_PEDAL_PRESSED;
    axis.state = ILK_AXIS_MOVING;
    axis.card_valid = 1;
    axis.homed = ILK_HOMED_BY_HAND;
    axis.lease_ticks = 1;
  }
};

struct Block {
  ilk_gate_t gate;
  std::function<void(OpenGate&)> edit;
};

TEST(P1_gate, each_condition_blocks_by_itself_whatever_the_others_say) {
  const Block blocks[] = {
      {ILK_GATE_OPEN, [](OpenGate&) {}},
      {ILK_GATE_MODE, [](OpenGate& open) { open.system.mode = ILK_MODE_READY; }},
      {ILK_GATE_MODE, [](OpenGate& open) { open.system.mode = ILK_MODE_COUNT; }},
      {ILK_GATE_PEDAL, [](OpenGate& open) { open.system.pedal = ILK_PEDAL_RELEASED; }},
      {ILK_GATE_PEDAL, [](OpenGate& open) { open.system.pedal = ILK_PEDAL_DISAGREE; }},
      {ILK_GATE_PEDAL, [](OpenGate& open) { open.system.pedal = ILK_PEDAL_COUNT; }},
      {ILK_GATE_ESTOP, [](OpenGate& open) { open.system.estop = 1; }},
      {ILK_GATE_CARD, [](OpenGate& open) { open.axis.card_valid = 0; }},
      {ILK_GATE_ENABLE, [](OpenGate& open) { open.axis.state = ILK_AXIS_DISABLED; }},
      {ILK_GATE_ENABLE, [](OpenGate& open) { open.axis.state = ILK_AXIS_FAULTED; }},
      {ILK_GATE_ENABLE, [](OpenGate& open) { open.axis.state = ILK_AXIS_COUNT; }},
      {ILK_GATE_LEASE, [](OpenGate& open) { open.axis.state = ILK_AXIS_ENABLED; }},
      {ILK_GATE_LEASE, [](OpenGate& open) { open.axis.lease_ticks = 0; }},
      {ILK_GATE_SETPOINT, [](OpenGate& open) { open.wanted.direction = ILK_DIRECTION_NONE; }},
      {ILK_GATE_SETPOINT, [](OpenGate& open) { open.wanted.direction = ILK_DIRECTION_COUNT; }},
      {ILK_GATE_SETPOINT, [](OpenGate& open) { open.wanted.drive = 0; }},
      {ILK_GATE_HARD_LIMIT, [](OpenGate& open) { open.axis.switch_triggered = 1; }},
      {ILK_GATE_SOFT_LIMIT, [](OpenGate& open) { open.axis.position_counts = 990; }},
      {ILK_GATE_OPEN, [](OpenGate& open) { open.axis.position_counts = 989; }},
      {ILK_GATE_SOFT_LIMIT, [](OpenGate& open) { open.axis.position_counts = INT32_MAX; }},
      {ILK_GATE_SOFT_LIMIT,
       [](OpenGate& open) {
         open.wanted.direction = ILK_DIRECTION_DECREASING;
         open.axis.position_counts = -990;
       }},
      {ILK_GATE_UNHOMED_TRAVEL,
       [](OpenGate& open) {
         open.axis.homed = ILK_HOMED_NOT;
         open.axis.unhomed_travel_counts = 90;
       }},
      {ILK_GATE_OPEN,
       [](OpenGate& open) {
         open.axis.homed = ILK_HOMED_NOT;
         open.axis.unhomed_travel_counts = 89;
       }},
      {ILK_GATE_UNHOMED_TRAVEL,
       [](OpenGate& open) {
         open.axis.homed = ILK_HOMED_NOT;
         open.axis.unhomed_travel_counts = UINT32_MAX;
       }},
      {ILK_GATE_UNHOMED_TRAVEL,
       [](OpenGate& open) {
         open.axis.homed = ILK_HOMED_NOT;
         open.axis.state = ILK_AXIS_HOMING;
         open.axis.homing_travel_counts = 2390;
       }},
      {ILK_GATE_DRIVE, [](OpenGate& open) { open.wanted.drive = 1001; }},
      {ILK_GATE_DRIVE,
       [](OpenGate& open) {
         open.axis.homed = ILK_HOMED_NOT;
         open.wanted.drive = 101;
       }},
      {ILK_GATE_OPEN,
       [](OpenGate& open) {
         open.config.max_drive = UINT32_MAX;
         open.wanted.drive = 0x7FFFFFFFu;
       }},
      {ILK_GATE_DRIVE,
       [](OpenGate& open) {
         open.config.max_drive = UINT32_MAX;
         open.wanted.drive = 0x80000000u;
       }},
      {ILK_GATE_DRIVE, [](OpenGate& open) { open.wanted.amplitude = 1; }},
      {ILK_GATE_OPEN,
       [](OpenGate& open) {
         open.config.max_amplitude = UINT32_MAX;
         open.wanted.amplitude = 255;
       }},
      {ILK_GATE_DRIVE,
       [](OpenGate& open) {
         open.config.max_amplitude = UINT32_MAX;
         open.wanted.amplitude = 256;
       }},
      {ILK_GATE_STALL, [](OpenGate& open) { open.axis.stall_driven_ticks = 50; }},
      {ILK_GATE_OPEN, [](OpenGate& open) { open.axis.stall_driven_ticks = 49; }},
      {ILK_GATE_STALL, [](OpenGate& open) { open.axis.effort_low = 20000; }},
      {ILK_GATE_OPEN, [](OpenGate& open) { open.axis.effort_low = 19999; }},
      {ILK_GATE_STALL, [](OpenGate& open) { open.axis.effort_high = 1; }},
  };
  for (const Block& block : blocks) {
    OpenGate open;
    block.edit(open);
    EXPECT_EQ(ilk_output_gate(&open.config, &open.system, &open.axis, &open.wanted), block.gate)
        << "block " << &block - blocks;
  }
  for (const uint32_t card :
       {uint32_t{ILK_CARD_NONE}, uint32_t{ILK_CARD_SENSOR}, ILK_CARD_COUNT, UINT32_MAX}) {
    OpenGate open;
    open.config.card = card;
    EXPECT_EQ(ilk_output_gate(&open.config, &open.system, &open.axis, &open.wanted), ILK_GATE_DRIVE) << card;
  }
}

TEST(P3_hard_limit_part, an_unknown_side_lies_in_no_direction) {
  ilk_axis_config_t config = switched_axis(ILK_CARD_PWM, ILK_LIMIT_UPPER);
  EXPECT_EQ(towards_switch(&config), uint32_t{ILK_DIRECTION_INCREASING});
  for (const uint32_t side : {uint32_t{ILK_LIMIT_NONE}, ILK_LIMIT_COUNT, UINT32_MAX}) {
    config.limit_side = side;
    EXPECT_EQ(towards_switch(&config), uint32_t{ILK_DIRECTION_NONE});
  }
}

TEST(P17_reference_part, an_axis_without_a_switch_has_no_way_to_it_and_none_away) {
  ilk_axis_t axis{};
  for (const auto& [side, towards, away] :
       {std::array{uint32_t{ILK_LIMIT_NONE}, uint32_t{ILK_DIRECTION_NONE}, uint32_t{ILK_DIRECTION_NONE}},
        std::array{uint32_t{ILK_LIMIT_LOWER}, uint32_t{ILK_DIRECTION_DECREASING},
                   uint32_t{ILK_DIRECTION_INCREASING}},
        std::array{uint32_t{ILK_LIMIT_UPPER}, uint32_t{ILK_DIRECTION_INCREASING},
                   uint32_t{ILK_DIRECTION_DECREASING}}}) {
    const ilk_axis_config_t config = switched_axis(ILK_CARD_PWM, static_cast<ilk_limit_side_t>(side));
    axis.homing_phase = ILK_HOMING_SEEK;
    EXPECT_EQ(ilk_homing_command(&config, &axis).direction, towards);
    axis.homing_phase = ILK_HOMING_BACK_OFF;
    EXPECT_EQ(ilk_homing_command(&config, &axis).direction, away);
  }
}

bool packed_to_zero_drive(uint32_t card, const ilk_command_t& command) {
  ilk_axis_config_t config = plain_axis(ILK_CARD_PWM);
  config.card = card;
  Frame frame;
  ilk_frame_pack(&config, &command, 7, frame.data());
  return drive_words_zero(frame);
}

TEST(P16_frames, a_command_without_direction_or_drive_and_a_card_without_a_motor_are_packed_as_zero_drive) {
  for (const auto card : {ILK_CARD_PWM, ILK_CARD_NON_PWM, ILK_CARD_ANALOG, ILK_CARD_HIGH_FREQUENCY}) {
    EXPECT_FALSE(packed_to_zero_drive(card, {ILK_DIRECTION_INCREASING, 1, 200}));
    EXPECT_TRUE(packed_to_zero_drive(card, {ILK_DIRECTION_INCREASING, 0, 200}));
    EXPECT_TRUE(packed_to_zero_drive(card, {ILK_DIRECTION_NONE, 1, 200}));
  }
  for (const uint32_t card :
       {uint32_t{ILK_CARD_NONE}, uint32_t{ILK_CARD_SENSOR}, ILK_CARD_COUNT, UINT32_MAX}) {
    EXPECT_TRUE(packed_to_zero_drive(card, {ILK_DIRECTION_INCREASING, 1, 1})) << card;
  }
}

TEST(P16_frames, a_drive_beyond_the_published_map_is_packed_as_its_fastest_word) {
  ilk_axis_config_t config = plain_axis(ILK_CARD_HIGH_FREQUENCY);
  for (const uint32_t drive : {397785u, 397786u, UINT32_MAX}) {
    Frame frame;
    const ilk_command_t command{ILK_DIRECTION_INCREASING, drive, 1};
    ilk_frame_pack(&config, &command, 7, frame.data());
    EXPECT_EQ(frame[3], 1103158212u) << drive;
  }
}

TEST(P15_total, sums_of_driven_time_and_of_drive_saturate_instead_of_wrapping) {
  const ilk_axis_config_t config = plain_axis(ILK_CARD_PWM);
  ilk_axis_t axis{};
  axis.stall_driven_ticks = UINT32_MAX;
  axis.effort_high = UINT32_MAX;
  axis.effort_low = UINT32_MAX - 50;
  const ilk_command_t command{ILK_DIRECTION_INCREASING, 100, 0};
  ilk_axis_note_drive(&command, &axis);
  EXPECT_EQ(axis.stall_driven_ticks, UINT32_MAX);
  EXPECT_EQ(axis.effort_high, UINT32_MAX);
  EXPECT_EQ(axis.effort_low, UINT32_MAX);
  EXPECT_TRUE(ilk_axis_has_stalled(&config, &axis));
}

TEST(P15_total, effort_carries_into_its_upper_word) {
  ilk_axis_t axis{};
  axis.effort_low = UINT32_MAX;
  const ilk_command_t command{ILK_DIRECTION_DECREASING, 2, 0};
  ilk_axis_note_drive(&command, &axis);
  EXPECT_EQ(axis.effort_high, 1u);
  EXPECT_EQ(axis.effort_low, 1u);
}

TEST(P15_total, arithmetic_stops_at_its_ends) {
  EXPECT_EQ(add_saturating(INT32_MAX, 1), INT32_MAX);
  EXPECT_EQ(add_saturating(INT32_MIN, -1), INT32_MIN);
  EXPECT_EQ(add_saturating(INT32_MIN, INT32_MAX), -1);
  EXPECT_EQ(negate_saturating(INT32_MIN), INT32_MAX);
  EXPECT_EQ(negate_saturating(INT32_MAX), -INT32_MAX);
  EXPECT_EQ(magnitude(INT32_MIN), 0x80000000u);
  EXPECT_EQ(signed_of(0x80000000u), INT32_MIN);
  EXPECT_EQ(signed_of(0x7FFFFFFFu), INT32_MAX);
  EXPECT_EQ(sum_saturating(UINT32_MAX, 1), UINT32_MAX);
  EXPECT_EQ(sum_saturating(UINT32_MAX - 1, 1), UINT32_MAX);
  EXPECT_EQ(count_up(7, 7), 7u);
  EXPECT_EQ(count_up(9, 7), 7u) << "a value beyond the ceiling comes back to it";
  EXPECT_EQ(left_of(3, 4), 0u);
}

TEST(P14_containment, a_slice_beyond_the_last_begins_the_pass_anew) {
  Bench bench = ready_bench();
  bench.damage_state().system.config_slice = ILK_SLOTS + 3;
  bench.reseal();
  bench.ticks(40);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

}  // namespace
}  // namespace interlock::kernel_test
