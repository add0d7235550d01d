#include "interlock/replay.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "recorded_run.hpp"
#include "recorder/recorder.hpp"

namespace interlock::recorder {
namespace {

using recorder_test::RecordedRun;

/** The blocks of a run, and what a replay of them comes to. */
class Replay : public ::testing::Test {
 protected:
  void record(std::uint32_t seed, std::uint32_t ticks) {
    RecordedRun run(seed, 60);
    run.run(ticks);
    take(run.ring());
  }

  void take(const Ring& ring) {
    config_ = ring.run().config;
    blocks_.clear();
    for (std::uint32_t number = ring.oldest(); number <= ring.head(); ++number) {
      blocks_.push_back(*ring.copy(number));
    }
    ilk_replay_begin(&replay_, &config_);
  }

  /** What the run was, tick by tick, as another kernel would have recorded it. */
  void record_changed(const std::function<void(ilk_picture_t&)>& change) {
    const auto box = std::make_unique<ilk_black_box_t>();
    recorder_test::create_box(*box, config_, 60);
    const auto tick = std::make_unique<ilk_recorded_tick_t>();
    const auto cursor = std::make_unique<ilk_block_cursor_t>();
    bool begun = false;
    for (const BlockCopy& block : blocks_) {
      ASSERT_TRUE(ilk_block_begin(cursor.get(), &config_, block.payload.data(),
                                  static_cast<std::uint32_t>(block.payload.size()), tick.get()));
      if (!std::exchange(begun, true)) {
        ilk_black_box_begin(box.get(), &tick->picture.state);
      }
      while (ilk_block_next(cursor.get(), tick.get()) == ILK_TICK_READ) {
        ilk_picture_t was = tick->picture;
        change(was);
        ilk_black_box_note(box.get(), tick->begun_ns, &was.state, &was.inputs, tick->request,
                           tick->request_count, &was.out);
      }
    }
    take(recorder_test::ring_of(*box));
    ilk_black_box_close(box.get());
  }

  ilk_replay_result_t replay_from(std::size_t first) {
    ilk_replay_result_t result = ILK_REPLAY_IDENTICAL;
    for (std::size_t n = first; n < blocks_.size() && result == ILK_REPLAY_IDENTICAL; ++n) {
      const BlockCopy& block = blocks_[n];
      result =
          ilk_replay_block(&replay_, block.number, block.payload.data(),
                           static_cast<std::uint32_t>(block.payload.size()), &difference_, nullptr, nullptr);
      if (result == ILK_REPLAY_DIFFERS && difference_.words == 0 && n + 1 < blocks_.size()) {
        const BlockCopy& next = blocks_[n + 1];
        ilk_replay_name(&replay_, next.number, next.payload.data(),
                        static_cast<std::uint32_t>(next.payload.size()), &difference_);
      }
    }
    return result;
  }

  [[nodiscard]] std::string differing() const {
    return ilk_word_name(ilk_picture_fields(), difference_.offset).text;
  }

  ilk_config_t config_{};
  std::vector<BlockCopy> blocks_;
  ilk_replay_t replay_{};
  ilk_difference_t difference_{};
};

TEST_F(Replay, RunWithEveryKindOfFaultComesOutTheSameToTheLastBit) {
  record(1, 40'000);
  EXPECT_EQ(replay_from(0), ILK_REPLAY_IDENTICAL) << differing();
  EXPECT_EQ(replay_.ticks, 40'000U);
  EXPECT_EQ(replay_.first_tick, 1U);
  EXPECT_EQ(replay_.last_tick, 40'000U);
  EXPECT_EQ(replay_.gaps, 0U);
  EXPECT_GT(replay_.requests, 40'000U);
}

TEST_F(Replay, MayBeginAtAnyBlock) {
  record(2, 3000);
  ASSERT_GT(blocks_.size(), 5U);
  EXPECT_EQ(replay_from(4), ILK_REPLAY_IDENTICAL);
  EXPECT_GT(replay_.first_tick, 1U);
  EXPECT_EQ(replay_.last_tick, 3000U);
}

TEST_F(Replay, MissingBlockIsAGapAndNoDifference) {
  record(2, 3000);
  blocks_.erase(blocks_.begin() + 2);
  EXPECT_EQ(replay_from(0), ILK_REPLAY_IDENTICAL);
  EXPECT_EQ(replay_.gaps, 1U);
  EXPECT_LT(replay_.ticks, 3000U);
}

TEST_F(Replay, FirstDifferingTickIsNamedWithTheBitThatTheNextRecordedStateShows) {
  record(3, 2000);
  // A kernel that came to another setpoint in tick 150, and kept it.
  record_changed([](ilk_picture_t& was) {
    was.state.axis[2].setpoint_counts ^= was.state.system.tick >= 150 ? 0x50 : 0;
  });
  EXPECT_EQ(replay_from(0), ILK_REPLAY_DIFFERS);
  EXPECT_EQ(difference_.tick, 150U);
  EXPECT_FALSE(difference_.outputs);
  EXPECT_EQ(replay_.last_tick, 149U);
  EXPECT_EQ(differing(), "state.axis[2].setpoint_counts");
  EXPECT_EQ(difference_.bit, 4U);
  EXPECT_EQ(difference_.recorded ^ difference_.replayed, 0x50U);
  EXPECT_EQ(difference_.words, 1U);
  EXPECT_GT(difference_.seen_tick, 150U);
}

TEST_F(Replay, WordThatChangedBetweenTwoTicksIsNamedAtOnce) {
  record(3, 2000);
  constexpr std::size_t offset = offsetof(ilk_state_t, axis[2].setpoint_counts);
  blocks_[1].payload[offset / sizeof(std::uint32_t)] ^= 0x50;
  EXPECT_EQ(replay_from(0), ILK_REPLAY_DIFFERS);
  EXPECT_EQ(differing(), "state.axis[2].setpoint_counts");
  EXPECT_EQ(difference_.tick, replay_.last_tick);
  EXPECT_EQ(difference_.seen_tick, replay_.last_tick);
}

TEST_F(Replay, OutputsThatTheKernelWouldNotGiveAreReportedWithTheirTick) {
  record(4, 2000);
  // A run in which the tenth tick drove an axis although nothing allowed it.
  record_changed([](ilk_picture_t& was) { was.out.command[6].drive += was.state.system.tick == 10 ? 8 : 0; });
  EXPECT_EQ(replay_from(0), ILK_REPLAY_DIFFERS);
  EXPECT_EQ(difference_.tick, 10U);
  EXPECT_TRUE(difference_.outputs);
  EXPECT_EQ(difference_.words, 0U) << "the state is the same, then and later";
  EXPECT_EQ(replay_.last_tick, 9U);
}

TEST_F(Replay, AnotherConfigurationLeadsElsewhere) {
  record(5, 5000);
  config_.axis[0].max_delta_counts += 1;
  config_.crc = ilk_config_crc(&config_);
  EXPECT_EQ(replay_from(0), ILK_REPLAY_DIFFERS);
}

TEST_F(Replay, WhatIsNoRecordIsNotFollowed) {
  record(6, 500);
  constexpr std::size_t groups = offsetof(ilk_tick_record_t, groups) / sizeof(std::uint32_t);
  for (const std::size_t word : {std::size_t{0}, std::size_t{3}, groups, groups + 1}) {
    std::vector<BlockCopy> spoilt{blocks_[0]};
    spoilt[0].payload[ILK_OPENING_WORDS + word] ^= 0x40000000;
    std::swap(spoilt, blocks_);
    ilk_replay_begin(&replay_, &config_);
    EXPECT_EQ(replay_from(0), ILK_REPLAY_UNREADABLE) << word;
    std::swap(spoilt, blocks_);
  }
  blocks_[0].payload.resize(100);
  ilk_replay_begin(&replay_, &config_);
  EXPECT_EQ(replay_from(0), ILK_REPLAY_UNREADABLE);
}

TEST_F(Replay, AnyWordsInTheirPlaceAreReadToAnEnd) {
  record(6, 500);
  std::mt19937 dice(1);
  for (int n = 0; n < 2000; ++n) {
    BlockCopy spoilt = blocks_[0];
    for (int words = 0; words < 5; ++words) {
      const auto place = std::uniform_int_distribution<std::size_t>(ILK_OPENING_WORDS, 2000)(dice);
      spoilt.payload[place] = static_cast<std::uint32_t>(dice());
    }
    ilk_replay_begin(&replay_, &config_);
    ilk_replay_block(&replay_, 1, spoilt.payload.data(), static_cast<std::uint32_t>(spoilt.payload.size()),
                     &difference_, nullptr, nullptr);
  }
}

}  // namespace
}  // namespace interlock::recorder
