// The same configuration, inputs and requests give the same bits; every output word is written.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "dice.hpp"
#include "inert.hpp"

namespace interlock::kernel_test {
namespace {

using OutputWords = std::array<uint32_t, sizeof(ilk_outputs_t) / 4>;

ilk_outputs_t filled(uint32_t word) {
  OutputWords words;
  words.fill(word);
  return std::bit_cast<ilk_outputs_t>(words);
}

TEST(Determinism, the_same_run_gives_the_same_bits) {
  const auto run = [] {
    Bench bench(ten_axis_config());
    Dice dice(7);
    std::vector<OutputWords> trace;
    bench.to_motion();
    for (int tick = 0; tick < 500; ++tick) {
      bench.queue(enable(dice.below(ILK_SLOTS)));
      bench.queue(move(dice.below(ILK_SLOTS), dice.between(-90, 90)));
      bench.pedal(!dice.one_in(50));
      bench.tick();
      trace.push_back(std::bit_cast<OutputWords>(bench.out()));
    }
    return trace;
  };
  EXPECT_EQ(run(), run());
}

TEST(P18_independence, an_axis_does_the_same_whatever_the_others_do_at_the_same_mode_and_verdicts) {
  Bench alone = ready_bench(ten_axis_config());
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) alone.enable_axis(slot);
  alone.press();
  Bench busy = alone;
  Dice dice(18);
  for (int tick = 0; tick < 300; ++tick) {
    for (uint32_t slot = 1; slot < ILK_SLOTS; ++slot) {
      alone.queue(move(slot, alone.position(slot)));
      busy.queue(move(slot, busy.position(slot) + dice.between(-3, 3)));
      busy.motor[slot].switch_stuck = dice.one_in(3);
      if (dice.one_in(20)) busy.spoil(slot, FrameFault::missing, 1);
    }
    const int32_t target = dice.between(-40, 40);
    for (Bench* bench : {&alone, &busy}) {
      bench->queue(move(0, target));
      bench->tick();
      ASSERT_EQ(bench->mode(), ILK_MODE_MOTION) << tick;
    }
    ASSERT_EQ(std::memcmp(&alone.axis(0), &busy.axis(0), sizeof(ilk_axis_t)), 0) << tick;
    ASSERT_EQ(std::memcmp(alone.out().frame[0], busy.out().frame[0], sizeof(Frame)), 0) << tick;
  }
}

TEST(Determinism, every_output_word_is_written_and_none_read) {
  Bench bench = motion_bench(0, ten_axis_config());
  bench.queue(move(0, 50));
  for (const bool sound : {true, false}) {
    const ilk_config_t config = bench.config();
    ilk_state_t first = bench.state();
    first.seal ^= sound ? 0u : 1u;
    ilk_state_t second = first;
    ilk_outputs_t zeroed = filled(0);
    ilk_outputs_t garbage = filled(0xA5A5A5A5u);
    ilk_step(&config, &first, &bench.inputs(), nullptr, 0, &zeroed);
    ilk_step(&config, &second, &bench.inputs(), nullptr, 0, &garbage);
    EXPECT_EQ(std::memcmp(&zeroed, &garbage, sizeof zeroed), 0);
    EXPECT_EQ(std::memcmp(&first, &second, sizeof first), 0);
  }
}

TEST(Determinism, every_output_word_is_written_in_INIT) {
  ilk_config_t config = standard_config();
  config.common.version = 0;
  ilk_state_t first;
  ilk_init(&config, &first);
  ilk_state_t second = first;
  const ilk_inputs_t in{};
  ilk_outputs_t zeroed = filled(0);
  ilk_outputs_t garbage = filled(0xA5A5A5A5u);
  ilk_step(&config, &first, &in, nullptr, 0, &zeroed);
  ilk_step(&config, &second, &in, nullptr, 0, &garbage);
  EXPECT_EQ(std::memcmp(&zeroed, &garbage, sizeof zeroed), 0);
}

TEST(Determinism, init_does_not_read_the_state) {
  const ilk_config_t config = standard_config();
  ilk_state_t zeroed;
  ilk_state_t garbage;
  std::memset(&zeroed, 0, sizeof zeroed);
  std::memset(&garbage, 0xA5, sizeof garbage);
  ilk_init(&config, &zeroed);
  ilk_init(&config, &garbage);
  EXPECT_EQ(std::memcmp(&zeroed, &garbage, sizeof zeroed), 0);
}

}  // namespace
}  // namespace interlock::kernel_test
