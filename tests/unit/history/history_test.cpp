#include "history/history.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "history/history_feed.hpp"
#include "robot_fixture.hpp"

namespace interlock {
namespace {

using nlohmann::json;
using test::yaw;

TickBucket bucket_of(std::uint32_t number) {
  TickBucket bucket;
  bucket.run = 1;
  bucket.ticks = 33;
  bucket.last_tick = 33 * number;
  bucket.axis[yaw].position_counts.add(static_cast<std::int32_t>(number));
  bucket.axis[yaw].position_counts.add(-static_cast<std::int32_t>(number));
  return bucket;
}

json history_of(const History& history, std::uint64_t after) {
  return history.after(after, test::neuro(), std::nullopt);
}

TEST(History, RowsAfterANumberAreTheNewOnes) {
  History history(7);
  for (std::uint32_t number = 1; number <= 5; ++number) {
    history.add(bucket_of(number));
  }
  const json all = history_of(history, 0);
  EXPECT_EQ(all["app_begun_s"], 7);
  EXPECT_EQ(all["last_tick"], json({33, 66, 99, 132, 165}));
  EXPECT_EQ(all["ticks"], json({33, 33, 33, 33, 33}));
  EXPECT_EQ(all["next"], 5);
  const json later = history_of(history, 3);
  EXPECT_EQ(later["first"], 4);
  EXPECT_EQ(later["last_tick"], json({132, 165}));
  EXPECT_EQ(later["more"], false);
  const json none = history_of(history, 5);
  EXPECT_EQ(none["last_tick"], json::array());
  EXPECT_EQ(none["next"], 5);
}

TEST(History, ALongHistoryComesInSeveralAnswers) {
  History history(7);
  for (std::uint32_t number = 1; number <= 700; ++number) {
    history.add(bucket_of(number));
  }
  std::uint64_t after = 0;
  std::size_t rows = 0;
  std::size_t answers = 0;
  for (bool more = true; more; ++answers) {
    const json answer = history_of(history, after);
    rows += answer["run"].size();
    EXPECT_LE(answer["run"].size(), History::most_of_an_answer);
    after = answer["next"];
    more = answer["more"];
  }
  EXPECT_EQ(rows, 700u);
  EXPECT_EQ(answers, 3u);
}

TEST(History, TheOldestRowsGoAndTheirNumbersAreNotGivenAgain) {
  History history(7);
  for (std::uint32_t number = 1; number <= History::capacity + 10; ++number) {
    history.add(bucket_of(number));
  }
  EXPECT_EQ(history_of(history, 3)["first"], 11);
}

TEST(History, ANumberOfAnotherRunOfTheAppBeginsWithTheOldest) {
  History history(7);
  history.add(bucket_of(1));
  EXPECT_EQ(history_of(history, 900)["first"], 1);
}

TEST(History, WhatAnAxisHadNotIsNull) {
  History history(7);
  history.add(bucket_of(4));
  const json axis = history_of(history, 0)["axes"][0];
  EXPECT_EQ(axis["slot"], yaw);
  EXPECT_EQ(axis["position_counts"], json({{"least", {-4}}, {"greatest", {4}}}));
  EXPECT_EQ(axis["setpoint_counts"], json({{"least", {nullptr}}, {"greatest", {nullptr}}}));
}

TEST(History, ForcesAreInNewtonsFromTheirZeroes) {
  History history(7);
  TickBucket bucket = bucket_of(1);
  bucket.hand_counts.add(2100);
  bucket.hand_counts.add(1900);
  history.add(bucket);
  const ForceScales scales{{0.01, 2000.0}, {0.02, 1000.0}};
  const json forces = history.after(0, test::prostate(), scales)["forces"];
  EXPECT_EQ(forces["hand_n"], json({{"least", {-1.0}}, {"greatest", {1.0}}}));
  EXPECT_EQ(forces["needle_n"], json({{"least", {nullptr}}, {"greatest", {nullptr}}}));
}

TEST(HistoryFeed, HandsOverEachBucketOnce) {
  HistoryFeed feed(RobotPlan(test::neuro(), test::neuro_config()));
  ControlView view = test::ready_view();
  for (std::uint32_t tick = 0; tick < 3 * ticks_of_bucket(1000); ++tick) {
    ++view.snapshot.state.system.tick;
    feed.see(view);
  }
  std::vector<std::uint32_t> last_ticks;
  feed.take([&](const TickBucket& bucket) { last_ticks.push_back(bucket.last_tick); });
  EXPECT_EQ(last_ticks, (std::vector<std::uint32_t>{1022, 1055, 1088}));
  feed.take([&](const TickBucket&) { ADD_FAILURE() << "a bucket came twice"; });
}

}  // namespace
}  // namespace interlock
