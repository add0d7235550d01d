#include "service/stop_records.hpp"

#include <gtest/gtest.h>

namespace interlock::web {
namespace {

constexpr SteadyTime start{std::chrono::hours(1)};

AuditEntry stop_of(const char* peer) {
  AuditEntry entry;
  entry.kind = AuditKind::stop;
  entry.detail["peer"] = peer;
  return entry;
}

TEST(StopRecords, TheFirstIsRecordedAtOnceAndTheRestByOneRecordAPause) {
  StopRecords records;
  const auto first = records.add(stop_of("a"), 0, start);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->detail, (nlohmann::json{{"peer", "a"}}));
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(records.add(stop_of("b"), 0, start));
  }
  EXPECT_FALSE(records.due(start + StopRecords::pause - std::chrono::milliseconds(1)));
  const auto rest = records.due(start + StopRecords::pause);
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->detail, (nlohmann::json{{"peer", "b"}, {"unrecorded", 999}}));
  EXPECT_FALSE(records.due(start + 9 * StopRecords::pause)) << "nothing came since";
}

TEST(StopRecords, AFloodOfAnHourIsAHandfulOfRecordsThatCountEachStop) {
  StopRecords records;
  std::uint64_t recorded = 0;
  std::uint64_t counted = 0;
  const auto count = [&](const std::optional<AuditEntry>& entry) {
    if (entry) {
      ++recorded;
      counted += 1 + entry->detail.value("unrecorded", std::uint64_t{0});
    }
  };
  constexpr int seconds = 3600;
  constexpr int each_second = 100;
  for (int second = 0; second < seconds; ++second) {
    for (int i = 0; i < each_second; ++i) {
      count(records.add(stop_of("a"), 1, start + std::chrono::seconds(second)));
    }
  }
  count(records.take());
  EXPECT_EQ(counted, std::uint64_t{2} * seconds * each_second) << "each, and the one before it";
  EXPECT_LE(recorded, seconds / 5 + 1);
}

TEST(StopRecords, OneAfterAPauseIsRecordedAtOnceAndTheEndLeavesNoneOut) {
  StopRecords records;
  EXPECT_TRUE(records.add(stop_of("a"), 0, start));
  EXPECT_TRUE(records.add(stop_of("b"), 0, start + StopRecords::pause));
  EXPECT_FALSE(records.add(stop_of("c"), 3, start + StopRecords::pause));
  const auto last = records.take();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->detail, (nlohmann::json{{"peer", "c"}, {"unrecorded", 3}}));
  EXPECT_FALSE(records.take());
}

}  // namespace
}  // namespace interlock::web
