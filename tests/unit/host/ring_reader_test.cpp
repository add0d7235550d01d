#include "ring_reader.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <random>
#include <thread>

#include "interlock/kernel.h"
#include "interlock/link_reader.h"

namespace {

using Requests = std::array<ilk_request_t, ILK_REQUESTS_PER_TICK>;

/// Both regions in ordinary memory; the reader cannot tell.
struct Ring {
  ilk_link_kernel_region_t kernel{};
  ilk_link_app_region_t app{};
  uint32_t tail = 0;
  uint32_t dropped = 0;
  Requests read{};

  uint32_t take() {
    const uint32_t count = ilk_ring_read(&app, &tail, &dropped, read.data());
    kernel.request_tail = tail;
    return count;
  }
};

ilk_request_t numbered(uint32_t sequence) {
  ilk_request_t request{};
  request.sequence = sequence;
  request.kind = ILK_REQUEST_HEARTBEAT;
  request.holder = ~sequence;
  request.crc = ilk_request_crc(&request);
  return request;
}

uint32_t draw(std::mt19937& engine) { return static_cast<uint32_t>(engine()); }

TEST(RequestRing, HandsOverEveryRequestOnceAndInOrder) {
  Ring ring;
  uint32_t put = 0;
  uint32_t taken = 0;
  std::mt19937 random(7);
  while (taken < 10'000) {
    for (uint32_t n = draw(random) % 24; n > 0; --n) {
      const ilk_request_t request = numbered(put + 1);
      put += ilk_link_put_request(&ring.kernel, &ring.app, &request) ? 1 : 0;
    }
    const uint32_t count = ring.take();
    ASSERT_LE(count, uint32_t{ILK_REQUESTS_PER_TICK});
    for (uint32_t i = 0; i < count; ++i) {
      const ilk_request_t expected = numbered(++taken);
      ASSERT_EQ(std::memcmp(&ring.read.at(i), &expected, sizeof expected), 0);
    }
  }
  EXPECT_EQ(ring.dropped, 0u);
}

TEST(RequestRing, TakesSixteenATickAndLeavesTheRestForTheNext) {
  Ring ring;
  for (uint32_t n = 1; n <= ILK_LINK_REQUESTS; ++n) {
    const ilk_request_t request = numbered(n);
    ASSERT_TRUE(ilk_link_put_request(&ring.kernel, &ring.app, &request));
  }
  const ilk_request_t one_too_many = numbered(ILK_LINK_REQUESTS + 1);
  EXPECT_FALSE(ilk_link_put_request(&ring.kernel, &ring.app, &one_too_many));
  for (uint32_t tick = 0; tick < ILK_LINK_REQUESTS / ILK_REQUESTS_PER_TICK; ++tick) {
    EXPECT_EQ(ring.take(), uint32_t{ILK_REQUESTS_PER_TICK});
    EXPECT_EQ(ring.read.front().sequence, tick * ILK_REQUESTS_PER_TICK + 1);
  }
  EXPECT_EQ(ring.take(), 0u);
}

TEST(RequestRing, CountersWrap) {
  Ring ring;
  ring.tail = ring.kernel.request_tail = ring.app.request_head = UINT32_MAX - 2;
  for (uint32_t n = 1; n <= 6; ++n) {
    const ilk_request_t request = numbered(n);
    ASSERT_TRUE(ilk_link_put_request(&ring.kernel, &ring.app, &request));
  }
  EXPECT_EQ(ring.take(), 6u);
  EXPECT_EQ(ring.read.at(5).sequence, 6u);
  EXPECT_EQ(ring.dropped, 0u);
}

TEST(RequestRing, HeadBeyondTheRingIsSkippedAndCounted) {
  Ring ring;
  ring.app.request_head = ILK_LINK_REQUESTS + 1;
  EXPECT_EQ(ring.take(), 0u);
  EXPECT_EQ(ring.dropped, ILK_LINK_REQUESTS + 1);
  EXPECT_EQ(ring.tail, ILK_LINK_REQUESTS + 1);
  const ilk_request_t request = numbered(1);
  ASSERT_TRUE(ilk_link_put_request(&ring.kernel, &ring.app, &request));
  EXPECT_EQ(ring.take(), 1u);
}

TEST(RequestRing, DroppedCountSaturates) {
  Ring ring;
  ring.dropped = UINT32_MAX - 5;
  ring.app.request_head = 1000;
  EXPECT_EQ(ring.take(), 0u);
  EXPECT_EQ(ring.dropped, UINT32_MAX);
}

TEST(RequestRing, RandomHeadsNeverExceedSixteenNorReadBeyondTheRing) {
  Ring ring;
  std::mt19937 random(11);
  for (int i = 0; i < 100'000; ++i) {
    const uint32_t near = ring.tail + draw(random) % (3 * ILK_LINK_REQUESTS) - ILK_LINK_REQUESTS;
    ring.app.request_head = draw(random) % 2 == 0 ? near : draw(random);
    const uint32_t before = ring.tail;
    const uint32_t waiting = ring.app.request_head - before;
    const uint32_t count = ring.take();
    ASSERT_LE(count, uint32_t{ILK_REQUESTS_PER_TICK});
    ASSERT_EQ(ring.tail - before, waiting > ILK_LINK_REQUESTS ? waiting : count);
  }
}

TEST(RequestRing, EveryWordOfARecordRewrittenDuringTheTickIsOneThatWasWrittenThere) {
  constexpr uint32_t kWords = sizeof(ilk_request_t) / sizeof(uint32_t);
  Ring ring;
  std::atomic<bool> done{false};
  std::thread attacker([&] {
    for (uint32_t round = 0; !done; ++round) {
      for (ilk_request_t& request : ring.app.request) {
        for (uint32_t w = 0; w < kWords; ++w) {
          __atomic_store_n(reinterpret_cast<uint32_t*>(&request) + w, round * kWords + w, __ATOMIC_RELAXED);
        }
      }
      __atomic_store_n(&ring.app.request_head, round * 5, __ATOMIC_RELAXED);
    }
  });
  for (uint32_t read = 0; read < 100'000;) {
    const uint32_t count = ring.take();
    ASSERT_LE(count, uint32_t{ILK_REQUESTS_PER_TICK});
    read += count + 1;
    for (uint32_t i = 0; i < count; ++i) {
      const auto words = std::bit_cast<std::array<uint32_t, kWords>>(ring.read.at(i));
      for (uint32_t w = 0; w < kWords; ++w) {
        ASSERT_TRUE(words[w] == 0 || words[w] % kWords == w);
      }
    }
  }
  done = true;
  attacker.join();
}

}  // namespace
