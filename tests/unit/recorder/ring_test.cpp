#include "recorder/ring.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "black_box_door.h"
#include "interlock/recorded_block.h"
#include "recorded_run.hpp"

namespace interlock::recorder {
namespace {

using recorder_test::KnownTick;
using recorder_test::RecordedRun;

/** Reads every tick of a block, the opening not among them. */
std::vector<ilk_recorded_tick_t> ticks_of(const ilk_config_t& config, const BlockCopy& block) {
  std::vector<ilk_recorded_tick_t> ticks;
  ilk_block_cursor_t cursor{};
  ilk_recorded_tick_t tick{};
  EXPECT_TRUE(ilk_block_begin(&cursor, &config, block.payload.data(),
                              static_cast<std::uint32_t>(block.payload.size()), &tick));
  ilk_tick_result_t result = ILK_TICK_READ;
  while ((result = ilk_block_next(&cursor, &tick)) == ILK_TICK_READ) {
    ticks.push_back(tick);
  }
  EXPECT_EQ(result, ILK_TICK_NONE);
  return ticks;
}

TEST(BlackBox, HoldsEachTicksInputsRequestsVerdictsOutputsAndStateAsTheyWere) {
  RecordedRun run(7);
  std::vector<KnownTick> known;
  run.run(2000, [&](const KnownTick& tick) { known.push_back(tick); });
  const Ring ring = run.ring();
  std::size_t next = 0;
  for (std::uint32_t number = ring.oldest(); number <= ring.head(); ++number) {
    const std::optional<BlockCopy> block = ring.copy(number);
    ASSERT_TRUE(block);
    for (const ilk_recorded_tick_t& tick : ticks_of(ring.run().config, *block)) {
      ASSERT_LT(next, known.size());
      const KnownTick& was = known[next++];
      ASSERT_EQ(std::memcmp(&tick.picture, &was.picture, sizeof was.picture), 0) << next;
      ASSERT_EQ(tick.request_count, was.requests.size());
      ASSERT_EQ(std::memcmp(tick.request, was.requests.data(), was.requests.size() * sizeof(ilk_request_t)),
                0);
      ASSERT_EQ(tick.begun_ns, was.begun_ns);
      ASSERT_EQ(tick.state_digest, ilk_state_digest(&was.picture.state));
    }
  }
  EXPECT_EQ(next, known.size());
  EXPECT_GT(ring.head(), 2U);
}

/** A black box of one second in which each tick changes so many words of the inputs; ticks that it holds at
 * least, once it is full. */
double held_s(std::size_t changing) {
  ilk_config_t config{};
  world_config(&config);
  const auto box = std::make_unique<ilk_black_box_t>();
  recorder_test::create_box(*box, config, 1);
  const ilk_outputs_t out{};
  ilk_state_t state{};
  ilk_inputs_t in{};
  auto* const words = &in.frame[0][0];
  std::mt19937 dice(1);
  ilk_black_box_begin(box.get(), &state);
  for (state.system.tick = 1; state.system.tick <= 40'000; ++state.system.tick) {
    std::generate_n(words, changing, std::ref(dice));
    ilk_black_box_note(box.get(), state.system.tick, &state, &in, nullptr, 0, &out);
  }
  const Ring ring = recorder_test::ring_of(*box);
  const double shown = ring.fewest_seconds().value_or(0);
  EXPECT_GE(state.system.tick - *ring.opening_tick(ring.oldest()), shown * 1000);
  ilk_black_box_close(box.get());
  return shown;
}

TEST(BlackBox, HoldsItsSecondsUpToTheBytesThatItIsMadeFor) { EXPECT_GE(held_s(40), 1.0); }

TEST(BlackBox, HoldsLessWhereMoreChangesAndShowsHowMuch) {
  const double held = held_s(320);
  EXPECT_LT(held, 1.0);
  EXPECT_GT(held, 0.1);
}

TEST(BlackBox, OfAQuietMinuteTakesAThirdOfItsRoom) { EXPECT_GE(held_s(0), 3.0); }

TEST(BlackBox, OverwrittenBlockIsGoneAndNeverMixed) {
  RecordedRun run(1, 1);
  run.run(10);
  const Ring ring = run.ring();
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
  RecordedRun run(3, 1);
  run.run(1);
  const Ring ring = run.ring();
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
      ticks += ticks_of(ring.run().config, *block).size();
      blocks += 1;
    }
  }
  writer.join();
  EXPECT_GT(ticks, 0U);
}

TEST(BlackBox, PlaceMeetsEveryTickOnceInOrder) {
  RecordedRun run(5);
  const Ring ring = run.ring();
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
  RecordedRun killed;
  RecordedRun ended;
  const Ring first = killed.ring();
  const Ring second = ended.ring();
  EXPECT_TRUE(first.writer_lives());
  EXPECT_FALSE(second.closed());
  killed.die();
  ended.close();
  EXPECT_FALSE(first.writer_lives());
  EXPECT_FALSE(first.closed());
  EXPECT_FALSE(second.writer_lives());
  EXPECT_TRUE(second.closed());
}

TEST(BlackBox, OfADeadKernelIsStillThere) {
  RecordedRun run;
  const Ring ring = run.ring();
  run.calm(100);
  run.die();
  EXPECT_EQ(ticks_of(ring.run().config, *ring.copy(1)).size(), 100U);
}

TEST(BlackBox, CannotBeWrittenShrunkOrHoledByWhoeverHoldsIt) {
  ilk_config_t config{};
  world_config(&config);
  const auto box = std::make_unique<ilk_black_box_t>();
  recorder_test::create_box(*box, config, 1);
  EXPECT_EQ(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, box->memory, 0), MAP_FAILED);
  EXPECT_LT(pwrite(box->memory, "x", 1, 0), 0);
  EXPECT_LT(ftruncate(box->memory, 0), 0);
  EXPECT_LT(fallocate(box->memory, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, 4096), 0);
  ilk_black_box_close(box.get());
}

TEST(BlackBox, WhatIsNoBlackBoxIsRefused) {
  std::array<int, 2> life{};
  ASSERT_EQ(pipe(life.data()), 0);
  const FileDescriptor writer(life[1]);
  const FileDescriptor unsealed(memfd_create("test", MFD_CLOEXEC));
  ASSERT_EQ(ftruncate(unsealed.get(), 1 << 20), 0);
  const Recorded<Ring> ring = Ring::map(FileDescriptor(dup(unsealed.get())), FileDescriptor(life[0]));
  ASSERT_FALSE(ring);
  EXPECT_NE(ring.error().find("not of one of this user's kernels"), std::string::npos) << ring.error();
}

class BlackBoxDoor : public testing::Test {
 protected:
  void SetUp() override {
    world_config(&config_);
    recorder_test::create_box(*box_, config_, 1);
    ilk_error_t error{};
    ASSERT_EQ(ilk_black_box_door_open(&door_, socket_.c_str(), box_.get(), &error), ILK_LISTEN_OK)
        << error.text;
  }

  recorder_test::ScratchFolder scratch_;
  std::filesystem::path socket_ = scratch_.file("black-box");
  ilk_config_t config_{};
  std::unique_ptr<ilk_black_box_t> box_ = std::make_unique<ilk_black_box_t>();
  ilk_black_box_door_t door_{};
};

TEST_F(BlackBoxDoor, HandsOutTheBlackBoxToAnyNumberOfReadersUntilTheKernelEnds) {
  EXPECT_EQ(std::filesystem::status(socket_).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::vector<Ring> readers;
  for (int n = 0; n < 20; ++n) {
    Recorded<Ring> ring = Ring::connect(socket_);
    ASSERT_TRUE(ring) << ring.error();
    EXPECT_TRUE(ring->writer_lives());
    readers.push_back(std::move(*ring));
  }
  ilk_black_box_door_close(&door_);
  EXPECT_FALSE(std::filesystem::exists(socket_));
  ilk_black_box_close(box_.get());
  EXPECT_FALSE(readers.front().writer_lives());
  EXPECT_TRUE(readers.front().closed());
  EXPECT_FALSE(Ring::connect(socket_));
}

TEST_F(BlackBoxDoor, IsNotKeptByReadersThatConnectAndTakeNothing) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socket_.string().copy(address.sun_path, sizeof address.sun_path - 1);
  std::vector<FileDescriptor> idle;
  for (int n = 0; n < 50; ++n) {
    idle.emplace_back(socket(AF_UNIX, SOCK_SEQPACKET, 0));
    ASSERT_EQ(connect(idle.back().get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  EXPECT_TRUE(Ring::connect(socket_));
  ilk_black_box_door_close(&door_);
  ilk_black_box_close(box_.get());
}

}  // namespace
}  // namespace interlock::recorder
