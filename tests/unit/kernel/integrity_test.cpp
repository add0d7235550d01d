// P14: memory damage to state or configuration is met before it can move anything.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <vector>

#include "dice.hpp"
#include "inert.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t state_words = sizeof(ilk_state_t) / 4;
using StateWords = std::array<uint32_t, state_words>;

/// The configuration's CRC is checked in slices, one a tick; damage is met by the end of the pass that
/// began after it.
constexpr uint32_t pass_ticks = 11;

void run_busy(Bench& bench) {
  bench.to_ready();
  for (const uint32_t slot : {0u, 1u, 5u}) bench.reference(slot);
  bench.motor[6].travelled += 100;
  bench.rest();
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (slot != 6) bench.enable_axis(slot);
  }
  bench.press();
  bench.queue(home(2));
  bench.queue(home(3));
  for (uint32_t tick = 0; tick < 10; ++tick) {
    for (const uint32_t slot : {0u, 1u, 4u, 5u, 7u}) bench.queue(move(slot, slot % 2 == 0 ? 60 : -60));
    bench.tick();
  }
  bench.spoil(4, FrameFault::missing, 1);
  bench.tick();
}

void expect_contained(const Bench& bench) {
  ASSERT_TRUE(bench.wire_is_zero());
  ASSERT_EQ(bench.mode(), ILK_MODE_LOCKED);
  ASSERT_EQ(bench.cause(), ILK_CAUSE_INTEGRITY);
}

struct Damage {
  const char* name;
  uint32_t trials;
  std::function<void(StateWords&, uint32_t, Dice&)> act;
};

TEST(P14_containment, any_flipped_bit_and_any_other_damage_of_the_state_locks_with_zero_drive_in_that_tick) {
  const Damage damages[] = {
      {"flipped bit", state_words * 32,
       [](StateWords& words, uint32_t trial, Dice&) { words[trial / 32] ^= 1u << trial % 32; }},
      {"other word", 5000,
       [](StateWords& words, uint32_t, Dice& dice) { words[dice.below(state_words)] = dice.word(); }},
      {"close word", 5000,
       [](StateWords& words, uint32_t, Dice& dice) { words[dice.below(state_words)] += dice.below(7) - 3; }},
      {"swapped words", 2500,
       [](StateWords& words, uint32_t, Dice& dice) {
         std::swap(words[dice.below(state_words)], words[dice.below(state_words)]);
       }},
      {"copied word", 2500,
       [](StateWords& words, uint32_t, Dice& dice) {
         words[dice.below(state_words)] = words[dice.below(state_words)];
       }},
      {"cleared", 1, [](StateWords& words, uint32_t, Dice&) { words.fill(0); }},
      {"filled", 1, [](StateWords& words, uint32_t, Dice&) { words.fill(0xFFFFFFFFu); }},
      {"replaced", 2000,
       [](StateWords& words, uint32_t, Dice& dice) {
         std::generate(words.begin(), words.end(), [&dice] { return dice.word(); });
       }},
  };
  Bench bench(ten_axis_config());
  run_busy(bench);
  ASSERT_TRUE(bench.driven(0));
  bench.watched = false;
  const auto sound = std::bit_cast<StateWords>(bench.state());
  Dice dice(142);
  for (const auto& [name, trials, act] : damages) {
    for (uint32_t trial = 0; trial < trials; ++trial) {
      StateWords words = sound;
      act(words, trial, dice);
      if (words == sound) continue;
      Bench hit = bench;
      hit.damage_state() = std::bit_cast<ilk_state_t>(words);
      hit.tick();
      ASSERT_NO_FATAL_FAILURE(expect_contained(hit)) << name << " " << trial;
      ASSERT_FALSE(hit.powered());
    }
  }
}

TEST(P14_containment, after_damage_nothing_is_known_and_every_axis_is_FAULTED_by_INTEGRITY) {
  Bench bench = homed_bench(slot::pwm_free, 30);
  const uint32_t consent = bench.system().consent;
  bench.watched = false;
  bench.keep_moving(slot::pwm_free, 500, 3);
  bench.damage_state().axis[slot::pwm_free].drive ^= 4u;
  bench.tick();
  expect_contained(bench);
  EXPECT_FALSE(bench.powered());
  EXPECT_EQ(bench.system().causes_seen, 1u << ILK_CAUSE_INTEGRITY);
  EXPECT_EQ(bench.system().cause_tick, bench.now());
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    EXPECT_EQ(bench.axis_state(slot), slot < slot::axes ? ILK_AXIS_FAULTED : ILK_AXIS_DISABLED);
    EXPECT_EQ(bench.fault(slot), slot < slot::axes ? ILK_FAULT_INTEGRITY : ILK_FAULT_NONE);
    EXPECT_FALSE(bench.homed(slot));
  }
  bench.ticks(100);
  expect_contained(bench);
  bench.boot_nonce += 1;
  bench.to_ready();
  EXPECT_EQ(bench.ask(enable(slot::pwm_free)), ILK_VERDICT_FAULTED);
  EXPECT_EQ(bench.ask(clear_fault(slot::pwm_free)), ILK_VERDICT_ACCEPTED);
  bench.enable_axis(slot::pwm_free);
  bench.press();
  EXPECT_NE(bench.system().consent, consent);
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 50)), ILK_VERDICT_ACCEPTED);
}

TEST(P14_containment, damage_gives_a_cause_of_its_own_even_while_LOCKED_by_another) {
  Bench bench = ready_bench();
  bench.watched = false;
  bench.estop_loop_closed = 0;
  bench.tick();
  bench.damage_state().axis[slot::pwm_free].position_counts ^= 4;
  bench.tick();
  EXPECT_EQ(bench.cause(), ILK_CAUSE_INTEGRITY);
  EXPECT_EQ(bench.system().causes_seen, 1u << ILK_CAUSE_INTEGRITY | 1u << ILK_CAUSE_ESTOP);
}

TEST(P14_containment, a_lock_by_damage_is_left_only_by_RESET_with_the_pedal_up) {
  Bench bench;
  bench.to_motion();
  bench.watched = false;
  bench.damage_state().seal ^= 1u;
  bench.tick();
  expect_contained(bench);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_PEDAL_DOWN);
  bench.ticks(100);
  expect_contained(bench);
}

TEST(P14_containment, damage_in_INIT_does_not_let_an_invalid_configuration_out) {
  ilk_config_t config = standard_config();
  config.axis[slot::pwm_free].coast_counts = 0;
  seal(config);
  Bench bench(config);
  bench.watched = false;
  bench.ticks(5);
  bench.damage_state().system.mode = ILK_MODE_READY;
  bench.ticks(30);
  bench.ask(reset());
  for (uint32_t slot = 0; slot < slot::axes; ++slot) bench.ask(enable(slot));
  bench.ticks(20);
  bench.pedal(true);
  for (int held = 0; held < 50; ++held) {
    bench.ask(move(slot::pwm_free, 50));
    EXPECT_TRUE(bench.wire_is_zero());
    EXPECT_NE(bench.mode(), ILK_MODE_MOTION);
    EXPECT_NE(bench.mode(), ILK_MODE_READY);
  }
}

TEST(P14_containment, damage_to_the_configuration_locks_within_two_passes) {
  constexpr uint32_t config_words = sizeof(ilk_config_t) / 4;
  Dice dice(144);
  uint32_t slowest = 0;
  Bench sound = ready_bench();
  sound.press();
  for (uint32_t word = 0; word < config_words; ++word) {
    Bench bench = sound;
    bench.watched = false;
    bench.ticks(dice.below(pass_ticks));
    auto words = std::bit_cast<std::array<uint32_t, config_words>>(bench.config());
    words[word] ^= 1u << dice.below(32);
    bench.damage_config() = std::bit_cast<ilk_config_t>(words);
    uint32_t ticks = 0;
    while (bench.cause() != ILK_CAUSE_INTEGRITY && ticks <= 2 * pass_ticks) {
      bench.tick();
      ++ticks;
    }
    ASSERT_EQ(bench.cause(), ILK_CAUSE_INTEGRITY) << word;
    ASSERT_TRUE(bench.wire_is_zero());
    slowest = std::max(slowest, ticks);
  }
  RecordProperty("slowest_ticks", static_cast<int>(slowest));
}

TEST(P14_containment, damage_to_the_configuration_loses_every_reference) {
  Bench bench;
  bench.to_motion_homed(slot::pwm_free);
  bench.watched = false;
  bench.damage_config().axis[slot::pwm_free].direction_correction = 1;
  bench.keep_moving(slot::pwm_free, 500, 2 * pass_ticks);
  expect_contained(bench);
  ASSERT_NE(bench.position(slot::pwm_free), bench.motor[slot::pwm_free].travelled) << "counted the wrong way";
  EXPECT_FALSE(bench.homed(slot::pwm_free));
}

TEST(P14_containment, damage_to_the_configuration_is_reported_with_the_crc_that_was_found) {
  Bench bench;
  bench.to_ready();
  bench.watched = false;
  bench.damage_config().axis[slot::pwm_free].max_drive ^= 1u << 20;
  bench.ticks(2 * pass_ticks);
  expect_contained(bench);
  EXPECT_EQ(bench.system().cause_value, ilk_config_crc(&bench.config()));
}

TEST(P14_containment, a_damaged_configuration_blocks_RESET_until_a_whole_pass_agreed) {
  Bench bench;
  bench.to_ready();
  bench.watched = false;
  bench.damage_config().axis[slot::pwm_free].max_drive ^= 1u << 20;
  bench.ticks(2 * pass_ticks + 1);
  expect_contained(bench);
  for (uint32_t tick = 0; tick < 3 * pass_ticks; ++tick) {
    EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT) << tick;
  }
  bench.damage_config().axis[slot::pwm_free].max_drive ^= 1u << 20;
  uint32_t waited = 0;
  while (bench.ask(reset()) == ILK_VERDICT_CAUSE_PRESENT && waited < 3 * pass_ticks) ++waited;
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_GE(waited, pass_ticks - 1);
  EXPECT_LE(waited, 2 * pass_ticks);
}

/// Every word of the configuration that P1 to P3 rest on.
std::vector<uint32_t*> basis_of(ilk_config_t& config) {
  std::vector<uint32_t*> words = {&config.common.pedal_channels, &config.common.app_timeout_ticks};
  for (ilk_axis_config_t& axis : config.axis) {
    words.insert(words.end(), {&axis.card, &axis.limit_side, &axis.motor_direction});
  }
  return words;
}

TEST(P14_containment, any_flipped_bit_of_what_P1_to_P3_rest_on_locks_with_zero_drive_in_that_tick) {
  Bench bench(ten_axis_config());
  run_busy(bench);
  bench.watched = false;
  Bench sound = bench;
  sound.tick();
  ASSERT_TRUE(sound.driven(0));
  ASSERT_EQ(sound.mode(), ILK_MODE_MOTION);
  const std::size_t words = basis_of(sound.damage_config()).size();
  for (std::size_t word = 0; word < words; ++word) {
    for (uint32_t bit = 0; bit < 32; ++bit) {
      Bench hit = bench;
      *basis_of(hit.damage_config())[word] ^= 1u << bit;
      hit.tick();
      ASSERT_NO_FATAL_FAILURE(expect_contained(hit)) << word << " " << bit;
    }
  }
}

TEST(P14_containment, values_beyond_the_codes_are_no_other_ones_in_what_P1_to_P3_rest_on) {
  Bench bench(ten_axis_config());
  run_busy(bench);
  bench.watched = false;
  Dice dice(146);
  for (int trial = 0; trial < 5000; ++trial) {
    Bench hit = bench;
    const ilk_config_t& before = bench.config();
    const uint32_t slot = dice.below(ILK_SLOTS);
    ilk_axis_config_t& axis = hit.damage_config().axis[slot];
    // What a carry from one packed word into the next would hide.
    const uint32_t carry = 1 + dice.below(0x100);
    axis.card += carry << 8;
    axis.limit_side += dice.one_in(2) ? (carry << 8) - carry : 0u - carry;
    axis.motor_direction -= dice.one_in(2) ? carry : 0;
    ASSERT_NE(axis.card, before.axis[slot].card);
    hit.tick();
    ASSERT_NO_FATAL_FAILURE(expect_contained(hit)) << trial;
  }
}

TEST(P14_containment, damage_that_passes_again_keeps_the_lock_until_RESET_after_a_whole_pass) {
  Bench bench;
  bench.to_motion();
  bench.watched = false;
  bench.damage_config().axis[slot::pwm_free].motor_direction ^= 1u;
  bench.tick();
  expect_contained(bench);
  bench.damage_config().axis[slot::pwm_free].motor_direction ^= 1u;
  bench.pedal(false);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_CAUSE_PRESENT);
  bench.ticks(2 * pass_ticks);
  expect_contained(bench);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P14_containment, a_lock_of_another_cause_keeps_it_when_what_P1_to_P3_rest_on_is_damaged) {
  Bench bench;
  bench.to_motion();
  bench.watched = false;
  bench.estop_loop_closed = 0;
  bench.tick();
  ASSERT_EQ(bench.cause(), ILK_CAUSE_ESTOP);
  bench.damage_config().common.pedal_channels = 1;
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_ESTOP);
  EXPECT_NE(bench.system().causes_seen & 1u << ILK_CAUSE_INTEGRITY, 0u);
}

TEST(P13_configuration, damage_to_what_P1_to_P3_rest_on_does_not_leave_INIT) {
  ilk_config_t config = standard_config();
  config.axis[slot::pwm_free].coast_counts = 0;
  seal(config);
  Bench bench(config);
  bench.watched = false;
  bench.damage_config().common.pedal_channels = 1;
  bench.ticks(2 * pass_ticks);
  EXPECT_EQ(bench.mode(), ILK_MODE_INIT);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(P14_containment, with_a_damaged_configuration_P1_to_P3_hold_until_it_is_found) {
  constexpr uint32_t config_words = sizeof(ilk_config_t) / 4;
  Dice dice(145);
  Bench enabled = ready_bench();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) enabled.enable_axis(slot);
  enabled.press();
  for (int trial = 0; trial < 400; ++trial) {
    Bench bench = enabled;
    bench.watched = false;
    for (auto& motor : bench.motor) motor.switch_stuck = dice.one_in(3);
    const ilk_config_t before = bench.config();
    auto words = std::bit_cast<std::array<uint32_t, config_words>>(bench.config());
    const uint32_t changes = 1 + dice.below(40);
    for (uint32_t change = 0; change < changes; ++change) words[dice.below(config_words)] = dice.word();
    bench.damage_config() = std::bit_cast<ilk_config_t>(words);
    for (uint32_t tick = 0; tick < 2 * pass_ticks; ++tick) {
      bench.pedal(!dice.one_in(10));
      if (dice.one_in(10)) bench.pedal_nc_closed ^= 1u;
      bench.estop_loop_closed = dice.one_in(15) ? 0 : 1;
      for (uint32_t slot = 0; slot < slot::axes; ++slot) {
        ilk_request_t wish = move(slot, dice.between(-2000, 2000), dice.below(2000), 1 + dice.below(20));
        wish.amplitude = dice.below(256);
        bench.queue(dice.one_in(8) ? home(slot) : wish);
      }
      bench.tick();
      const bool may_drive = bench.mode() == ILK_MODE_MOTION && bench.pedal_no_closed == 1 &&
                             bench.pedal_nc_closed == 0 && bench.estop_loop_closed == 1;
      ASSERT_TRUE(may_drive || bench.wire_is_zero()) << "P2, trial " << trial;
      for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
        if (!bench.driven(slot)) continue;
        const ilk_axis_t& axis = bench.axis(slot);
        ASSERT_TRUE(axis.card_valid == 1 && axis.fault == ILK_FAULT_NONE &&
                    (axis.state == ILK_AXIS_MOVING || axis.state == ILK_AXIS_HOMING))
            << "P1, trial " << trial;
        const uint32_t outward = before.axis[slot].limit_side == ILK_LIMIT_UPPER   ? ILK_DIRECTION_INCREASING
                                 : before.axis[slot].limit_side == ILK_LIMIT_LOWER ? ILK_DIRECTION_DECREASING
                                                                                   : ILK_DIRECTION_NONE;
        const bool at_switch = (bench.inputs().frame[slot][incoming::pairs] & incoming::switch_open_bit) == 0;
        ASSERT_FALSE(at_switch && bench.driven_direction(slot) == outward) << "P3, trial " << trial;
      }
    }
    ASSERT_EQ(bench.system().causes_seen >> ILK_CAUSE_INTEGRITY & 1u, 1u) << "trial " << trial;
  }
}

}  // namespace
}  // namespace interlock::kernel_test
