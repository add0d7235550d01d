// Long seeded runs of a hostile world under the watch, and P15 on arbitrary bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <vector>

#include "bench.hpp"
#include "dice.hpp"

namespace interlock::kernel_test {
namespace {

ilk_request_t wild_request(Dice& dice) {
  ilk_request_t request{};
  request.kind = dice.one_in(20) ? dice.word() : 1 + dice.below(ILK_REQUEST_COUNT);
  request.axis = dice.one_in(20) ? dice.word() : dice.below(ILK_SLOTS);
  request.target_counts = dice.one_in(20) ? static_cast<int32_t>(dice.word()) : dice.between(-1100, 1100);
  request.drive = dice.one_in(20) ? dice.word() : dice.below(1100);
  request.amplitude = dice.one_in(2) ? 0 : dice.below(260);
  request.lease_ticks = dice.below(23);
  request.consent = dice.one_in(4) ? dice.word() : 0;
  request.holder = dice.one_in(30) ? dice.below(3) : 1;
  return request;
}

/// A request that a working app might send, so that the run reaches motion.
ilk_request_t sensible_request(Dice& dice, const Bench& bench) {
  const uint32_t slot = dice.below(slot::axes);
  switch (bench.mode()) {
    case ILK_MODE_LOCKED:
      return dice.one_in(3) ? reset() : clear_fault(slot);
    case ILK_MODE_READY:
      return bench.axis_state(slot) == ILK_AXIS_FAULTED ? clear_fault(slot)
             : dice.one_in(6)                           ? set_home(slot)
                                                        : enable(slot);
    default:
      break;
  }
  if (bench.axis_state(slot) == ILK_AXIS_DISABLED) return enable(slot);
  if (dice.one_in(60)) return home(slot);
  const int32_t place = bench.position(slot);
  ilk_request_t request = move(slot, place + dice.between(-80, 80), 1 + dice.below(100), 1 + dice.below(20));
  if (bench.homed(slot)) request.target_counts = dice.between(-990, 990);
  return request;
}

void calm(Bench& bench) {
  bench.pedal(bench.pedal_no_closed == 1);
  bench.estop_loop_closed = 1;
  bench.transaction_done = 1;
  bench.deadlines_missed = 0;
  for (Card& card : bench.card) card.status = 0;
  bench.app_alive = true;
  for (Motor& motor : bench.motor) {
    motor.frozen = false;
    motor.reversed = false;
    motor.creep = 0;
    motor.dither = 0;
    motor.switch_stuck.reset();
  }
}

void disturb(Bench& bench, Dice& dice) {
  const uint32_t slot = dice.below(ILK_SLOTS);
  Motor& motor = bench.motor[slot];
  switch (dice.below(15)) {
    case 0:
      bench.spoil(slot, static_cast<FrameFault>(1 + dice.below(5)), 1 + dice.below(5));
      break;
    case 1:
      motor.frozen = true;
      break;
    case 2:
      motor.reversed = true;
      break;
    case 3:
      motor.travelled += dice.between(-12, 12);
      break;
    case 4:
      motor.switch_stuck = true;
      break;
    case 5:
      motor.switch_stuck = false;
      break;
    case 6:
      motor.creep = dice.between(-2, 2);
      break;
    case 7:
      bench.estop_loop_closed = dice.below(3);
      break;
    case 8:
      bench.transaction_done = 0;
      break;
    case 9:
      bench.app_alive = false;
      break;
    case 10:
      bench.holder = 1 + dice.below(2);
      break;
    case 11:
      bench.card[slot].status = incoming::status_was_reset;
      break;
    case 12:
      bench.card[slot].heartbeat = dice.below(3);
      break;
    case 13:
      motor.dither = dice.between(-2, 2);
      break;
    default:
      bench.deadlines_missed = dice.below(3);
      break;
  }
}

class Hostile_world : public testing::TestWithParam<uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Seed, Hostile_world, testing::Range(1u, 9u), testing::PrintToStringParamName());

TEST_P(Hostile_world, never_gets_an_unsafe_tick) {
  Dice dice(GetParam());
  Bench bench(GetParam() % 2 == 0 ? standard_config() : ten_axis_config());
  for (Motor& motor : bench.motor) {
    motor.raw_at_start = dice.word();
    motor.speed = 1 + dice.between(0, 2);
    motor.coast = dice.between(0, 5);
    motor.switch_at = dice.between(-60, 60);
  }
  uint32_t moved = 0;
  std::set<uint32_t> faults;
  std::set<uint32_t> verdicts;
  for (uint32_t tick = 0; tick < 15000; ++tick) {
    if (dice.one_in(3000)) {
      ++bench.link_generation;
      bench.last_sequence = 0;
    }
    const uint32_t wishes = dice.below(6);
    for (uint32_t wish = 0; wish < wishes; ++wish) {
      bench.queue(dice.one_in(80) ? wild_request(dice) : sensible_request(dice, bench));
    }
    if (dice.one_in(400)) bench.queue_record(wild_request(dice));
    const bool held = bench.pedal_no_closed == 1;
    if (dice.one_in(held ? 200 : 25)) bench.pedal(!held);
    if (dice.one_in(600)) bench.pedal_nc_closed = dice.below(3);
    if (dice.one_in(80)) disturb(bench, dice);
    if (dice.one_in(80)) calm(bench);
    bench.tick();
    moved += bench.wire_is_zero() ? 0 : 1;
    for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) faults.insert(bench.fault(slot));
    for (uint32_t index = 0; index < bench.out().verdict_count; ++index) {
      verdicts.insert(bench.out().verdict[index].verdict);
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(moved, 1000u) << "the run would show nothing";
  EXPECT_GE(faults.size(), 6u) << "the run would show nothing";
  EXPECT_GE(verdicts.size(), 14u) << "the run would show nothing";
}

TEST(P15_total, arbitrary_bits_everywhere_drive_nothing_unsafe) {
  Dice dice(15);
  const auto random_words = [&dice](auto& target) {
    std::array<uint32_t, sizeof(target) / 4> words;
    std::generate(words.begin(), words.end(), [&dice] { return dice.word(); });
    target = std::bit_cast<std::remove_reference_t<decltype(target)>>(words);
  };
  for (int trial = 0; trial < 3000; ++trial) {
    ilk_config_t config = standard_config();
    ilk_state_t state;
    ilk_init(&config, &state);
    if (dice.one_in(2)) random_words(config);
    if (dice.one_in(2)) random_words(state);
    ilk_inputs_t in;
    random_words(in);
    std::array<ilk_request_t, ILK_REQUESTS_PER_TICK> requests;
    for (ilk_request_t& request : requests) random_words(request);
    ilk_outputs_t out;
    ilk_step(&config, &state, &in, requests.data(), dice.one_in(2) ? 16 : dice.word(), &out);
    for (const auto& frame : out.frame) ASSERT_TRUE(drive_words_zero(frame));
    ASSERT_LE(out.verdict_count, uint32_t{ILK_REQUESTS_PER_TICK});
    for (uint32_t index = 0; index < out.verdict_count; ++index) {
      ASSERT_LT(out.verdict[index].verdict, ILK_VERDICT_COUNT);
    }
    for (const uint32_t gate : out.gate) ASSERT_LT(gate, ILK_GATE_COUNT);
    for (const uint32_t colour : out.lamp) ASSERT_LT(colour, ILK_COLOUR_COUNT);
  }
}

TEST(P15_total, extreme_inputs_to_a_running_kernel_are_met_with_a_stop) {
  Dice dice(151);
  for (int trial = 0; trial < 2000; ++trial) {
    Bench bench;
    bench.to_motion_homed(slot::pwm_free);
    bench.ask(move(slot::pwm_free, 500, 1000));
    bench.watched = false;
    bench.tick_with([&dice](ilk_inputs_t& in) {
      std::array<uint32_t, sizeof(ilk_inputs_t) / 4> words;
      std::generate(words.begin(), words.end(), [&dice] { return dice.word(); });
      in = std::bit_cast<ilk_inputs_t>(words);
    });
    ASSERT_TRUE(bench.wire_is_zero());
  }
}

TEST(P15_total, no_more_than_sixteen_requests_are_read_whatever_the_count) {
  Bench bench;
  bench.to_ready();
  const ilk_config_t config = bench.config();
  ilk_state_t state = bench.state();
  const std::vector<ilk_request_t> sixteen(ILK_REQUESTS_PER_TICK);
  ilk_outputs_t out;
  ilk_step(&config, &state, &bench.inputs(), sixteen.data(), 0xFFFFFFFFu, &out);
  EXPECT_EQ(out.verdict_count, uint32_t{ILK_REQUESTS_PER_TICK});
}

TEST(P15_total, counters_saturate_over_a_long_idle_time) {
  Bench bench;
  bench.app_alive = false;
  bench.transaction_done = 0;
  bench.deadlines_missed = 1;
  bench.pedal_no_closed = 2;
  bench.ticks(70000);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_BOOT);
  EXPECT_TRUE(bench.wire_is_zero());
}

}  // namespace
}  // namespace interlock::kernel_test
