#include "interlock/replay.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "recorded_run.hpp"
#include "recorder/recorder.hpp"

namespace interlock::recorder {
namespace {

using recorder_test::RecordedRun;
using recorder_test::ScratchFolder;

/** The blocks of a run, and what a replay of them comes to. */
class Replay : public ::testing::Test {
 protected:
  void record(std::uint32_t seed, std::uint32_t ticks) {
    RecordedRun run(scratch_.file("ring"), seed, 60);
    run.run(ticks);
    const Recorded<Ring> ring = Ring::open(scratch_.file("ring"));
    ASSERT_TRUE(ring);
    config_ = ring->run().config;
    for (std::uint32_t number = ring->oldest(); number <= ring->head(); ++number) {
      blocks_.push_back(*ring->copy(number));
    }
    ilk_replay_begin(&replay_, &config_);
  }

  ilk_replay_result_t replay_from(std::size_t first) {
    ilk_replay_result_t result = ILK_REPLAY_IDENTICAL;
    for (std::size_t n = first; n < blocks_.size() && result == ILK_REPLAY_IDENTICAL; ++n) {
      const BlockCopy& block = blocks_[n];
      result =
          ilk_replay_block(&replay_, block.number, block.payload.data(),
                           static_cast<std::uint32_t>(block.payload.size()), &difference_, nullptr, nullptr);
    }
    return result;
  }

  [[nodiscard]] std::string differing() const {
    return ilk_word_name(ilk_picture_fields(), difference_.offset).text;
  }

  ScratchFolder scratch_;
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

TEST_F(Replay, FirstDifferingBitIsTold) {
  record(3, 2000);
  auto* const payload = blocks_[1].payload.data();
  // The opening of the second block, as a kernel that had come to another setpoint would have left it.
  const std::size_t offset = offsetof(ilk_picture_t, state.axis[2].setpoint_counts);
  payload[offset / sizeof(std::uint32_t)] ^= 0x50;
  EXPECT_EQ(replay_from(0), ILK_REPLAY_DIFFERS);
  EXPECT_EQ(differing(), "state.axis[2].setpoint_counts");
  EXPECT_EQ(difference_.bit, 4U);
  EXPECT_EQ(difference_.recorded ^ difference_.replayed, 0x50U);
  EXPECT_EQ(difference_.words, 1U);
  EXPECT_EQ(difference_.tick, replay_.last_tick);
}

TEST_F(Replay, OutputsThatTheKernelWouldNotGiveAreTold) {
  record(4, 10);
  auto picture = std::make_unique<ilk_recorded_tick_t>();
  // A run in which the tenth tick drove an axis although nothing allowed it.
  ScratchFolder other;
  auto box = std::make_unique<ilk_black_box_t>();
  recorder_test::create_box(*box, other.file("ring"), config_, 1);
  ilk_block_cursor_t cursor{};
  ASSERT_TRUE(ilk_block_begin(&cursor, blocks_[0].payload.data(),
                              static_cast<std::uint32_t>(blocks_[0].payload.size()), picture.get()));
  ilk_black_box_begin(box.get(), &picture->now.picture.state);
  while (ilk_block_next(&cursor, picture.get()) == ILK_TICK_READ) {
    ilk_picture_t& was = picture->now.picture;
    ilk_outputs_t out = was.out;
    out.command[6].drive += was.state.tick == 10 ? 8 : 0;
    ilk_black_box_note(box.get(), picture->begun_ns, &was.state, &was.inputs, picture->request,
                       picture->request_count, &out);
  }
  const Recorded<Ring> ring = Ring::open(other.file("ring"));
  ASSERT_TRUE(ring);
  blocks_ = {*ring->copy(1)};
  ilk_black_box_close(box.get());
  EXPECT_EQ(replay_from(0), ILK_REPLAY_DIFFERS);
  EXPECT_EQ(differing(), "out.command[6].drive");
  EXPECT_EQ(difference_.tick, 10U);
  EXPECT_EQ(difference_.bit, 3U);
  EXPECT_EQ(difference_.recorded - difference_.replayed, 8U);
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
  for (const std::size_t word : {0U, 3U, 8U, 20U}) {
    std::vector<BlockCopy> spoilt{blocks_[0]};
    spoilt[0].payload[ILK_OPENING_WORDS + word] ^= 0x40000001;
    std::swap(spoilt, blocks_);
    ilk_replay_begin(&replay_, &config_);
    EXPECT_EQ(replay_from(0), ILK_REPLAY_UNREADABLE) << word;
    std::swap(spoilt, blocks_);
  }
  blocks_[0].payload.resize(100);
  ilk_replay_begin(&replay_, &config_);
  EXPECT_EQ(replay_from(0), ILK_REPLAY_UNREADABLE);
}

}  // namespace
}  // namespace interlock::recorder
