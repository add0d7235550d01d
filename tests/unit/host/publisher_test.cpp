#include "publisher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <memory>
#include <thread>
#include <vector>

#include "interlock/link_reader.h"

namespace {

using SnapshotWords = std::array<uint32_t, sizeof(ilk_snapshot_t) / sizeof(uint32_t)>;

constexpr uint32_t kStressPublishes = 1'000'000;
constexpr uint32_t kStressReads = 1'000;

bool is_whole(const ilk_snapshot_t& snapshot) {
  const auto words = std::bit_cast<SnapshotWords>(snapshot);
  return std::ranges::all_of(words, [&](uint32_t word) { return word == words.front(); });
}

struct Link {
  std::unique_ptr<ilk_link_kernel_region_t> region = std::make_unique<ilk_link_kernel_region_t>();
  ilk_publisher_t publisher{};
  ilk_snapshot_t snapshot{};
  ilk_outputs_t out{};
  uint32_t next = 0;
  uint32_t lost = 0;

  Link() {
    ilk_publisher_init(&publisher, &snapshot.state);
    ilk_publisher_attach(&publisher, region.get());
  }

  void publish() {
    snapshot.state.system.tick += 1;
    ilk_publisher_publish(&publisher, &snapshot, &out, 0);
  }

  std::vector<ilk_event_t> events() {
    std::vector<ilk_event_t> all;
    ilk_event_t event{};
    while (ilk_link_next_event(region.get(), &next, &lost, &event)) {
      all.push_back(event);
    }
    return all;
  }
};

TEST(Snapshot, IsNeverTornWhileSeveralReadIt) {
  Link link;
  std::array<std::atomic<uint32_t>, 2> reads{};
  std::atomic<uint32_t> torn{0};
  std::atomic<bool> done{false};
  std::vector<std::thread> readers;
  readers.reserve(reads.size());
  for (auto& count : reads) {
    readers.emplace_back([&] {
      ilk_snapshot_t snapshot{};
      uint32_t lock = 0;
      while (!done) {
        if (ilk_link_read_snapshot(link.region.get(), &snapshot, &lock)) {
          torn += is_whole(snapshot) ? 0 : 1;
          count += 1;
        }
      }
    });
  }
  const auto enough = [&] {
    return std::ranges::all_of(reads, [](const auto& count) { return count >= kStressReads; });
  };
  for (uint32_t n = 1; n <= kStressPublishes || !enough(); ++n) {
    SnapshotWords words{};
    words.fill(n);
    const auto snapshot = std::bit_cast<ilk_snapshot_t>(words);
    ilk_publisher_publish(&link.publisher, &snapshot, &link.out, 0);
  }
  done = true;
  for (std::thread& reader : readers) {
    reader.join();
  }
  EXPECT_EQ(torn, 0u);
}

TEST(Snapshot, IsAbsentBeforeTheFirstPublishAndWhileOneIsWritten) {
  Link link;
  ilk_snapshot_t snapshot{};
  uint32_t lock = 0;
  EXPECT_FALSE(ilk_link_read_snapshot(link.region.get(), &snapshot, &lock));
  link.publish();
  ASSERT_TRUE(ilk_link_read_snapshot(link.region.get(), &snapshot, &lock));
  EXPECT_EQ(snapshot.state.system.tick, 1u);
  EXPECT_EQ(lock, 2u);
  link.region->snapshot_lock = 3;
  EXPECT_FALSE(ilk_link_read_snapshot(link.region.get(), &snapshot, &lock));
}

TEST(Snapshot, WaiterIsWokenByTheNextOne) {
  Link link;
  link.publish();
  std::atomic<bool> woken{false};
  std::thread waiter([&] {
    while (!ilk_link_wait_snapshot(link.region.get(), 2, 1000)) {
    }
    woken = true;
  });
  link.publish();
  waiter.join();
  EXPECT_TRUE(woken);
  EXPECT_FALSE(ilk_link_wait_snapshot(link.region.get(), 4, 0));
}

TEST(Events, TellVerdictsInOrder) {
  Link link;
  link.out.verdict_count = 2;
  link.out.verdict[0] = {1, 41, ILK_REQUEST_MOVE, 3, ILK_VERDICT_ACCEPTED};
  link.out.verdict[1] = {1, 42, ILK_REQUEST_HOME, 4, ILK_VERDICT_MODE};
  link.publish();
  const auto events = link.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].number, 1u);
  EXPECT_EQ(events[0].kind, uint32_t{ILK_EVENT_VERDICT});
  EXPECT_EQ(events[0].tick, 1u);
  EXPECT_EQ(std::to_array(events[0].value),
            (std::array<uint32_t, 4>{41, ILK_REQUEST_MOVE, 3, ILK_VERDICT_ACCEPTED}));
  EXPECT_EQ(std::to_array(events[1].value),
            (std::array<uint32_t, 4>{42, ILK_REQUEST_HOME, 4, ILK_VERDICT_MODE}));
}

TEST(Events, TellEachChangeOnce) {
  Link link;
  ilk_state_t& state = link.snapshot.state;
  state.system.mode = ILK_MODE_LOCKED;
  state.system.cause = ILK_CAUSE_BOOT;
  state.system.cause_value = 77;
  state.axis[2].state = ILK_AXIS_FAULTED;
  state.axis[2].fault = ILK_FAULT_JUMP;
  state.axis[2].fault_value = -9;
  state.axis[5].homed = 1;
  link.publish();
  link.publish();
  const auto events = link.events();
  ASSERT_EQ(events.size(), 4u);
  EXPECT_EQ(events[0].kind, uint32_t{ILK_EVENT_MODE});
  EXPECT_EQ(std::to_array(events[0].value),
            (std::array<uint32_t, 4>{ILK_MODE_INIT, ILK_MODE_LOCKED, ILK_CAUSE_BOOT, 77}));
  EXPECT_EQ(events[1].kind, uint32_t{ILK_EVENT_FAULT});
  EXPECT_EQ(std::to_array(events[1].value),
            (std::array<uint32_t, 4>{2, ILK_FAULT_JUMP, static_cast<uint32_t>(-9), 0}));
  EXPECT_EQ(events[2].kind, uint32_t{ILK_EVENT_AXIS});
  EXPECT_EQ(std::to_array(events[2].value),
            (std::array<uint32_t, 4>{2, ILK_AXIS_DISABLED, ILK_AXIS_FAULTED, 0}));
  EXPECT_EQ(std::to_array(events[3].value),
            (std::array<uint32_t, 4>{5, ILK_AXIS_DISABLED, ILK_AXIS_DISABLED, 1}));
}

TEST(Events, SlowReaderIsToldHowManyItLost) {
  Link link;
  constexpr uint32_t kTicks = 3 * ILK_LINK_EVENTS + 7;
  for (uint32_t n = 1; n <= kTicks; ++n) {
    link.snapshot.state.system.mode = n % 2;
    link.publish();
  }
  const auto events = link.events();
  ASSERT_EQ(events.size(), size_t{ILK_LINK_EVENTS});
  EXPECT_EQ(link.lost, kTicks - ILK_LINK_EVENTS);
  EXPECT_EQ(events.front().number, link.lost + 1);
  EXPECT_EQ(events.back().number, kTicks);
}

TEST(Events, StartAtOneForEachAttachmentAndChangesWithoutAppAreNotRepeated) {
  Link link;
  link.snapshot.state.system.mode = ILK_MODE_LOCKED;
  link.publish();
  ilk_publisher_attach(&link.publisher, nullptr);
  link.snapshot.state.system.mode = ILK_MODE_READY;
  link.publish();
  *link.region = {};
  ilk_publisher_attach(&link.publisher, link.region.get());
  link.next = 0;
  link.snapshot.state.system.mode = ILK_MODE_MOTION;
  link.publish();
  const auto events = link.events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].number, 1u);
  EXPECT_EQ(events[0].value[0], uint32_t{ILK_MODE_READY});
  EXPECT_EQ(link.region->snapshot_lock, 2u);
}

TEST(Events, AreNeverTornWhileTheyAreOverwritten) {
  Link link;
  std::atomic<bool> done{false};
  std::atomic<uint32_t> wrong{0};
  std::atomic<uint32_t> read{0};
  std::thread reader([&] {
    ilk_event_t event{};
    uint32_t next = 0;
    uint32_t lost = 0;
    while (!done || read == 0) {
      if (ilk_link_next_event(link.region.get(), &next, &lost, &event)) {
        const bool whole = event.value[0] == event.number && event.value[3] == ~event.number;
        wrong += whole ? 0 : 1;
        read += 1;
      }
    }
  });
  link.out.verdict_count = 1;
  for (uint32_t n = 1; n <= 200'000; ++n) {
    link.out.verdict[0] = {n, n, ILK_REQUEST_HEARTBEAT, 0, ~n};
    link.publish();
  }
  done = true;
  reader.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
