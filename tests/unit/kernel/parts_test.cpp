// Parts of the core by themselves, where a running kernel never brings them: the last lines of defence behind
// rules that already hold. Each must hold alone, because memory may be damaged between the two.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <functional>

#include "bench.hpp"

extern "C" {
#include "frame.h"
#include "gate.h"
#include "integrity.h"
#include "request.h"
}

namespace interlock::kernel_test {
namespace {

/// A moving axis for which every gate is open.
struct OpenGate {
  ilk_axis_config_t config = plain_axis(ILK_CARD_PWM);
  ilk_state_t state{};
  ilk_axis_t axis{};
  ilk_command_t wanted{ILK_DIRECTION_INCREASING, 100, 0};

  OpenGate() {
    state.system.mode = ILK_MODE_MOTION;
    state.system.pedal = ILK_PEDAL_PRESSED;
    axis.state = ILK_AXIS_MOVING;
    axis.card_valid = 1;
    axis.homed = 1;
    axis.lease_ticks = 1;
  }

  ilk_gate_t verdict() const { return ilk_output_gate(&config, &state, &axis, &wanted); }
};

TEST(P1_gate, is_open_when_nothing_blocks) { EXPECT_EQ(OpenGate().verdict(), ILK_GATE_OPEN); }

TEST(P1_gate, a_pedal_that_is_not_pressed_blocks_even_in_MOTION) {
  for (const uint32_t pedal : {uint32_t{ILK_PEDAL_RELEASED}, uint32_t{ILK_PEDAL_DISAGREE}, ILK_PEDAL_COUNT}) {
    OpenGate gate;
    gate.state.system.pedal = pedal;
    EXPECT_EQ(gate.verdict(), ILK_GATE_PEDAL) << pedal;
  }
}

TEST(P1_gate, an_active_E_stop_blocks_even_in_MOTION) {
  OpenGate gate;
  gate.state.system.estop = 1;
  EXPECT_EQ(gate.verdict(), ILK_GATE_ESTOP);
}

TEST(P1_gate, a_moving_axis_without_a_lease_is_blocked) {
  OpenGate gate;
  gate.axis.lease_ticks = 0;
  EXPECT_EQ(gate.verdict(), ILK_GATE_LEASE);
}

TEST(P7_bounds, a_drive_that_the_words_of_the_card_cannot_carry_is_blocked) {
  OpenGate gate;
  gate.config.max_drive = UINT32_MAX;
  gate.wanted.drive = 0x7FFFFFFFu;
  EXPECT_EQ(gate.verdict(), ILK_GATE_OPEN);
  gate.wanted.drive = 0x80000000u;
  EXPECT_EQ(gate.verdict(), ILK_GATE_DRIVE);
}

TEST(P7_bounds, an_amplitude_that_the_words_of_the_card_cannot_carry_is_blocked) {
  OpenGate gate;
  gate.config.max_amplitude = UINT32_MAX;
  gate.wanted.amplitude = 255;
  EXPECT_EQ(gate.verdict(), ILK_GATE_OPEN);
  gate.wanted.amplitude = 256;
  EXPECT_EQ(gate.verdict(), ILK_GATE_DRIVE);
}

TEST(P7_bounds, a_card_without_a_motor_or_of_no_known_kind_is_not_driven) {
  for (const uint32_t card :
       {uint32_t{ILK_CARD_NONE}, uint32_t{ILK_CARD_SENSOR}, ILK_CARD_COUNT, UINT32_MAX}) {
    OpenGate gate;
    gate.config.card = card;
    EXPECT_EQ(gate.verdict(), ILK_GATE_DRIVE) << card;
  }
}

bool packed_to_zero_drive(uint32_t card, const ilk_command_t& command) {
  ilk_axis_config_t config = plain_axis(ILK_CARD_PWM);
  config.card = card;
  Frame frame;
  ilk_frame_pack(&config, &command, 7, frame.data());
  return drive_words_zero(frame);
}

TEST(P16_frames, a_direction_without_drive_is_packed_as_zero_drive) {
  for (const auto card : {ILK_CARD_PWM, ILK_CARD_NON_PWM, ILK_CARD_ANALOG, ILK_CARD_HIGH_FREQUENCY}) {
    EXPECT_FALSE(packed_to_zero_drive(card, {ILK_DIRECTION_INCREASING, 1, 200}));
    EXPECT_TRUE(packed_to_zero_drive(card, {ILK_DIRECTION_INCREASING, 0, 200}));
    EXPECT_TRUE(packed_to_zero_drive(card, {ILK_DIRECTION_NONE, 1, 200}));
  }
}

TEST(P16_frames, a_card_without_a_motor_is_packed_as_zero_drive_whatever_the_command) {
  for (const uint32_t card :
       {uint32_t{ILK_CARD_NONE}, uint32_t{ILK_CARD_SENSOR}, ILK_CARD_COUNT, UINT32_MAX}) {
    EXPECT_TRUE(packed_to_zero_drive(card, {ILK_DIRECTION_INCREASING, 1, 1})) << card;
  }
}

TEST(P15_total, an_effect_of_no_known_kind_or_on_no_axis_changes_nothing) {
  Bench bench;
  bench.to_motion_homed(slot::pwm_free);
  using Words = std::array<uint32_t, sizeof(ilk_state_t) / 4>;
  for (const uint32_t kind : {0u, ILK_REQUEST_COUNT + 1, UINT32_MAX}) {
    ilk_state_t state = bench.state();
    ilk_request_t request = move(slot::pwm_free, 50);
    request.kind = kind;
    ilk_request_apply(&bench.config(), &state, &request);
    EXPECT_EQ(std::bit_cast<Words>(state), std::bit_cast<Words>(bench.state())) << kind;
  }
  for (const uint32_t axis : {uint32_t{ILK_SLOTS}, UINT32_MAX}) {
    ilk_state_t state = bench.state();
    const ilk_request_t request = disable(axis);
    ilk_request_apply(&bench.config(), &state, &request);
    EXPECT_EQ(std::bit_cast<Words>(state), std::bit_cast<Words>(bench.state())) << axis;
  }
}

TEST(P6_jump, half_the_number_space_is_a_jump_whichever_way_the_axis_is_driven) {
  for (const int32_t target : {500, -500}) {
    Bench bench;
    bench.to_motion_homed(slot::pwm_free);
    bench.keep_moving(slot::pwm_free, target, 5);
    bench.motor[slot::pwm_free].travelled += int64_t{1} << 31;
    bench.motor[slot::pwm_free].frozen = true;
    bench.tick();
    EXPECT_EQ(bench.fault(slot::pwm_free), ILK_FAULT_JUMP) << target;
    EXPECT_TRUE(bench.wire_is_zero());
  }
}

// P14: a seal that fits does not make a contradiction true. Each edit breaks one rule of what belongs
// together.
struct Contradiction {
  const char* name;
  ilk_mode_t mode;
  std::function<void(ilk_state_t&, ilk_axis_t&)> edit;
};

void PrintTo(const Contradiction& contradiction, std::ostream* stream) { *stream << contradiction.name; }

using State = ilk_state_t;
using Axis = ilk_axis_t;

const Contradiction contradictions[] = {
    {"unknown_mode", ILK_MODE_READY, [](State& state, Axis&) { state.system.mode = ILK_MODE_COUNT; }},
    {"unknown_cause", ILK_MODE_LOCKED, [](State& state, Axis&) { state.system.cause = ILK_CAUSE_COUNT; }},
    {"cause_in_READY", ILK_MODE_READY, [](State& state, Axis&) { state.system.cause = ILK_CAUSE_ESTOP; }},
    {"LOCKED_without_a_cause", ILK_MODE_LOCKED, [](State& state, Axis&) { state.system.cause = ILK_CAUSE_NONE; }},
    {"unknown_pedal", ILK_MODE_READY, [](State& state, Axis&) { state.system.pedal = ILK_PEDAL_COUNT; }},
    {"no_such_slice", ILK_MODE_READY, [](State& state, Axis&) { state.system.config_slice = ILK_SLOTS; }},
    {"unknown_axis_state", ILK_MODE_MOTION, [](State&, Axis& axis) { axis.state = ILK_AXIS_COUNT; }},
    {"unknown_fault", ILK_MODE_MOTION, [](State&, Axis& axis) { axis.fault = ILK_FAULT_COUNT; }},
    {"unknown_driven_direction", ILK_MODE_MOTION,
     [](State&, Axis& axis) { axis.driven_direction = ILK_DIRECTION_COUNT; }},
    {"unknown_stall_direction", ILK_MODE_MOTION,
     [](State&, Axis& axis) { axis.stall_direction = ILK_DIRECTION_COUNT; }},
    {"unknown_reverse_direction", ILK_MODE_MOTION,
     [](State&, Axis& axis) { axis.reverse_direction = ILK_DIRECTION_COUNT; }},
    {"unknown_homing_phase", ILK_MODE_MOTION,
     [](State&, Axis& axis) { axis.homing_phase = ILK_HOMING_COUNT; }},
    {"homed_is_no_flag", ILK_MODE_MOTION, [](State&, Axis& axis) { axis.homed = 2; }},
    {"FAULTED_without_a_fault", ILK_MODE_MOTION, [](State&, Axis& axis) { axis.state = ILK_AXIS_FAULTED; }},
    {"fault_of_an_ENABLED_axis", ILK_MODE_MOTION, [](State&, Axis& axis) { axis.fault = ILK_FAULT_STALL; }},
    {"lease_of_an_ENABLED_axis", ILK_MODE_MOTION, [](State&, Axis& axis) { axis.lease_ticks = 5; }},
    {"MOVING_without_a_lease", ILK_MODE_MOTION, [](State&, Axis& axis) { axis.state = ILK_AXIS_MOVING; }},
    {"homing_phase_of_an_ENABLED_axis", ILK_MODE_MOTION,
     [](State&, Axis& axis) { axis.homing_phase = ILK_HOMING_SEEK; }},
    {"HOMING_though_homed", ILK_MODE_MOTION,
     [](State&, Axis& axis) {
       axis.state = ILK_AXIS_HOMING;
       axis.homing_phase = ILK_HOMING_SEEK;
       axis.homed = 1;
     }},
    {"MOVING_in_READY", ILK_MODE_READY,
     [](State&, Axis& axis) {
       axis.state = ILK_AXIS_MOVING;
       axis.lease_ticks = 5;
     }},
    {"HOMING_in_READY", ILK_MODE_READY,
     [](State&, Axis& axis) {
       axis.state = ILK_AXIS_HOMING;
       axis.homing_phase = ILK_HOMING_SEEK;
     }},
    {"ENABLED_in_LOCKED", ILK_MODE_LOCKED, [](State&, Axis& axis) { axis.state = ILK_AXIS_ENABLED; }},
};

class P14_contradiction : public testing::TestWithParam<Contradiction> {};

INSTANTIATE_TEST_SUITE_P(Sealed, P14_contradiction, testing::ValuesIn(contradictions),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(P14_contradiction, locks_though_the_seal_fits) {
  constexpr uint32_t slot = slot::pwm_free;
  const Contradiction& contradiction = GetParam();
  Bench bench;
  if (contradiction.mode != ILK_MODE_LOCKED) {
    bench.to_ready();
    bench.enable_axis(slot);
  } else {
    bench.ticks(3);
  }
  if (contradiction.mode == ILK_MODE_MOTION) bench.press();
  ASSERT_EQ(bench.mode(), contradiction.mode);
  bench.watched = false;
  ilk_state_seal(&bench.damage_state());
  Bench resealed = bench;
  resealed.tick();
  ASSERT_NE(resealed.cause(), ILK_CAUSE_INTEGRITY) << "sealing again alone must change nothing";

  contradiction.edit(bench.damage_state(), bench.damage_state().axis[slot]);
  ilk_state_seal(&bench.damage_state());
  bench.tick();
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_INTEGRITY);
}

}  // namespace
}  // namespace interlock::kernel_test
