#include "recorder/ring.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "interlock/recorded_block.h"
#include "recorded_run.hpp"

namespace interlock::recorder {
namespace {

using recorder_test::KnownTick;
using recorder_test::RecordedRun;
using recorder_test::ScratchFolder;

Ring opened(const std::filesystem::path& file) {
  Recorded<Ring> ring = Ring::open(file);
  if (!ring) {
    throw std::runtime_error(ring.error());
  }
  return std::move(*ring);
}

/** Reads every tick of a block, the opening not among them. */
std::vector<ilk_recorded_tick_t> ticks_of(const BlockCopy& block) {
  std::vector<ilk_recorded_tick_t> ticks;
  ilk_block_cursor_t cursor{};
  ilk_recorded_tick_t tick{};
  EXPECT_TRUE(ilk_block_begin(&cursor, block.payload.data(), static_cast<std::uint32_t>(block.payload.size()),
                              &tick));
  ilk_tick_result_t result = ILK_TICK_READ;
  while ((result = ilk_block_next(&cursor, &tick)) == ILK_TICK_READ) {
    ticks.push_back(tick);
  }
  EXPECT_EQ(result, ILK_TICK_NONE);
  return ticks;
}

TEST(BlackBox, HoldsEachTicksInputsRequestsVerdictsOutputsAndStateAsTheyWere) {
  const ScratchFolder scratch;
  RecordedRun run(scratch.file("ring"), 7);
  std::vector<KnownTick> known;
  run.run(900, [&](const KnownTick& tick) { known.push_back(tick); });
  const Ring ring = opened(scratch.file("ring"));
  std::size_t next = 0;
  for (std::uint32_t number = ring.oldest(); number <= ring.head(); ++number) {
    const std::optional<BlockCopy> block = ring.copy(number);
    ASSERT_TRUE(block);
    for (const ilk_recorded_tick_t& tick : ticks_of(*block)) {
      ASSERT_LT(next, known.size());
      const KnownTick& was = known[next++];
      ASSERT_EQ(std::memcmp(&tick.now.picture, &was.picture, sizeof was.picture), 0) << next;
      ASSERT_EQ(tick.request_count, was.requests.size());
      ASSERT_EQ(std::memcmp(tick.request, was.requests.data(), was.requests.size() * sizeof(ilk_request_t)),
                0);
      ASSERT_EQ(tick.begun_ns, was.begun_ns);
      ASSERT_EQ(tick.state_hash, ilk_state_hash(&was.picture.state));
    }
  }
  EXPECT_EQ(next, known.size());
  EXPECT_GT(ring.head(), 2U);
}

TEST(BlackBox, HoldsItsSecondsHoweverMuchChanges) {
  const ScratchFolder scratch;
  ilk_config_t config{};
  world_config(&config);
  auto box = std::make_unique<ilk_black_box_t>();
  recorder_test::create_box(*box, scratch.file("ring"), config, 1);
  ilk_state_t state{};
  ilk_inputs_t in{};
  ilk_outputs_t out{};
  std::vector<ilk_request_t> requests(ILK_REQUESTS_PER_TICK);
  ilk_black_box_begin(box.get(), &state);
  constexpr std::uint32_t ticks = 3000;
  for (std::uint32_t n = 1; n <= ticks; ++n) {
    std::memset(&state, static_cast<int>(n), sizeof state);
    std::memset(&in, static_cast<int>(n), sizeof in);
    std::memset(&out, static_cast<int>(n), sizeof out);
    state.tick = n;
    ilk_black_box_note(box.get(), n, &state, &in, requests.data(), ILK_REQUESTS_PER_TICK, &out);
  }
  const Ring ring = opened(scratch.file("ring"));
  const std::optional<std::uint32_t> opening = ring.opening_tick(ring.oldest());
  ASSERT_TRUE(opening);
  EXPECT_LE(*opening, ticks - 1000);
  EXPECT_GT(*opening, 0U) << "the ring was never reused";
  ilk_black_box_close(box.get());
}

TEST(BlackBox, OverwrittenBlockIsGoneAndNeverMixed) {
  const ScratchFolder scratch;
  RecordedRun run(scratch.file("ring"), 1, 1);
  run.run(10);
  const Ring ring = opened(scratch.file("ring"));
  EXPECT_TRUE(ring.copy(1));
  run.run(12'000);
  EXPECT_GT(ring.oldest(), 1U);
  EXPECT_FALSE(ring.copy(1));
  EXPECT_FALSE(ring.opening_tick(1));
  RingPlace place{1, ILK_OPENING_WORDS};
  const std::optional<TickHead> head = ring.next(place);
  ASSERT_TRUE(head);
  EXPECT_EQ(place.block, ring.oldest());
  EXPECT_EQ(head->tick, *ring.opening_tick(ring.oldest()) + 1);
}

TEST(BlackBox, ReaderBesideTheWriterGetsWholeTicksOnly) {
  const ScratchFolder scratch;
  RecordedRun run(scratch.file("ring"), 3, 1);
  run.run(1);
  const Ring ring = opened(scratch.file("ring"));
  std::atomic<bool> done{false};
  std::thread writer([&] {
    run.run(30'000);
    done = true;
  });
  std::mt19937 dice(1);
  std::size_t blocks = 0;
  std::size_t ticks = 0;
  while (!done || blocks == 0) {
    const std::uint32_t oldest = ring.oldest();
    const std::uint32_t number = std::uniform_int_distribution(oldest, ring.head())(dice);
    if (const std::optional<BlockCopy> block = ring.copy(number)) {
      ticks += ticks_of(*block).size();
      blocks += 1;
    }
  }
  writer.join();
  EXPECT_GT(ticks, 0U);
}

TEST(BlackBox, PlaceMeetsEveryTickOnceInOrder) {
  const ScratchFolder scratch;
  RecordedRun run(scratch.file("ring"), 5);
  const Ring ring = opened(scratch.file("ring"));
  RingPlace place;
  std::uint32_t expected = 1;
  for (int round = 0; round < 20; ++round) {
    run.run(97);
    while (const std::optional<TickHead> head = ring.next(place)) {
      ASSERT_EQ(head->tick, expected++);
    }
  }
  EXPECT_EQ(expected, 20U * 97U + 1U);
}

TEST(BlackBox, WritersEndIsSeen) {
  const ScratchFolder scratch;
  RecordedRun killed(scratch.file("killed"));
  RecordedRun ended(scratch.file("ended"));
  const Ring first = opened(scratch.file("killed"));
  const Ring second = opened(scratch.file("ended"));
  EXPECT_TRUE(first.writer_lives());
  EXPECT_FALSE(second.closed());
  killed.die();
  ended.close();
  EXPECT_FALSE(first.writer_lives());
  EXPECT_FALSE(first.closed());
  EXPECT_FALSE(second.writer_lives());
  EXPECT_TRUE(second.closed());
}

TEST(BlackBox, WhatIsNoRingIsRefused) {
  const ScratchFolder scratch;
  EXPECT_FALSE(Ring::open(scratch.file("absent")));
  RecordedRun run(scratch.file("ring"));
  std::filesystem::resize_file(scratch.file("ring"), 100'000);
  EXPECT_FALSE(Ring::open(scratch.file("ring")));
  run.die();
}

}  // namespace
}  // namespace interlock::recorder
