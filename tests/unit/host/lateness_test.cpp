#include "lateness.h"

#include <gtest/gtest.h>

namespace {

constexpr uint64_t kBegan = 7'000'000'000;
constexpr uint64_t kMillisecond = 1'000'000;

struct Lateness : ::testing::Test {
  void add(uint64_t waited_ns, uint64_t now_ns) { ilk_lateness_add(&watch, &shown, waited_ns, now_ns); }

  ilk_lateness_watch_t watch{};
  ilk_lateness_t shown{};
};

TEST_F(Lateness, TotalIsTheSumOfAllWaitsHoweverShort) {
  for (uint64_t n = 0; n < 5000; ++n) {
    add(400, kBegan);
  }
  EXPECT_EQ(shown.total_ms, 2u);
  EXPECT_EQ(shown.worst_us, 0u);
}

TEST_F(Lateness, WorstIsTheLongestWait) {
  add(3 * kMillisecond, kBegan);
  add(7 * kMillisecond, kBegan);
  add(5 * kMillisecond, kBegan);
  EXPECT_EQ(shown.worst_us, 7000u);
}

TEST_F(Lateness, EachSecondIsShownWhenItIsOverAndForgottenAfterTheNext) {
  add(0, kBegan);
  add(20 * kMillisecond, kBegan + 400 * kMillisecond);
  EXPECT_EQ(shown.second_us, 0u);
  add(10 * kMillisecond, kBegan + 1000 * kMillisecond);
  EXPECT_EQ(shown.second_us, 30'000u);
  add(0, kBegan + 1999 * kMillisecond);
  EXPECT_EQ(shown.second_us, 30'000u);
  add(0, kBegan + 2000 * kMillisecond);
  EXPECT_EQ(shown.second_us, 0u);
}

TEST_F(Lateness, Saturates) {
  add(UINT64_MAX / 2, kBegan);
  add(0, kBegan + 1000 * kMillisecond);
  EXPECT_EQ(shown.second_us, UINT32_MAX);
  EXPECT_EQ(shown.worst_us, UINT32_MAX);
  EXPECT_EQ(shown.total_ms, UINT32_MAX);
}

}  // namespace
