#include <gtest/gtest.h>

#include <thread>

#include "motion/realtime_channel.hpp"

namespace interlock {
namespace {

struct Pair {
  std::uint64_t value = 0;
  std::uint64_t twice = 0;
};

TEST(TripleBuffer, ShowsTheNewestValue) {
  TripleBuffer<int> buffer;
  EXPECT_EQ(buffer.newest(), 0);
  for (int value = 1; value < 10; ++value) {
    buffer.writing() = value;
    buffer.publish();
  }
  EXPECT_EQ(buffer.newest(), 9);
  EXPECT_EQ(buffer.newest(), 9);
}

TEST(TripleBuffer, NeverShowsHalfAValueNorAnOlderOne) {
  constexpr std::uint64_t last = 200000;
  TripleBuffer<Pair> buffer;
  std::jthread writer([&] {
    for (std::uint64_t value = 1; value <= last; ++value) {
      buffer.writing() = {value, 2 * value};
      buffer.publish();
    }
  });
  for (std::uint64_t seen = 0; seen != last;) {
    const Pair& pair = buffer.newest();
    ASSERT_EQ(pair.twice, 2 * pair.value);
    ASSERT_GE(pair.value, seen);
    seen = pair.value;
  }
}

}  // namespace
}  // namespace interlock
