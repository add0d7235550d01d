#include "log/log_ring.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

namespace interlock {
namespace {

using testing::ElementsAre;

LogLine line(const std::string& text, LogLevel level = LogLevel::info) { return {0, {}, level, text, 0}; }

std::vector<std::string> texts(const std::vector<LogLine>& lines) {
  std::vector<std::string> found;
  for (const LogLine& each : lines) {
    found.push_back(each.text);
  }
  return found;
}

TEST(LogRing, ShowsTheNewestLinesOldestFirst) {
  LogRing ring;
  for (const char* text : {"a", "b", "c"}) {
    ring.add(line(text));
  }
  EXPECT_THAT(texts(ring.newest(2, LogLevel::debug)), ElementsAre("b", "c"));
  EXPECT_THAT(texts(ring.newest(9, LogLevel::debug)), ElementsAre("a", "b", "c"));
  EXPECT_EQ(ring.newest(1, LogLevel::debug)[0].sequence, 3u);
}

TEST(LogRing, CountsOnlyLinesOfTheLevelAskedFor) {
  LogRing ring;
  ring.add(line("old warning", LogLevel::warning));
  ring.add(line("chatter", LogLevel::debug));
  ring.add(line("failure", LogLevel::critical));
  ring.add(line("news"));
  EXPECT_THAT(texts(ring.newest(2, LogLevel::warning)), ElementsAre("old warning", "failure"));
}

TEST(LogRing, KeepsAThousandLinesAndGoesOnNumbering) {
  LogRing ring;
  for (std::size_t i = 0; i < LogRing::capacity + 5; ++i) {
    ring.add(line(std::to_string(i)));
  }
  const auto lines = ring.newest(2 * LogRing::capacity, LogLevel::debug);
  ASSERT_EQ(lines.size(), LogRing::capacity);
  EXPECT_EQ(lines.front().sequence, 6u);
  EXPECT_EQ(lines.back().sequence, LogRing::capacity + 5);
  EXPECT_EQ(ring.last(), LogRing::capacity + 5);
}

TEST(LogRing, GivesTheLinesThatAReaderHasNotSeen) {
  LogRing ring;
  for (const char* text : {"a", "b", "c"}) {
    ring.add(line(text));
  }
  EXPECT_THAT(texts(ring.after(1)), ElementsAre("b", "c"));
  EXPECT_THAT(texts(ring.after(3)), ElementsAre());
}

TEST(LogRing, TellsItsListenerOfEachLine) {
  LogRing ring;
  std::vector<std::uint64_t> told;
  ring.on_line([&] { told.push_back(ring.last()); });
  ring.add(line("a"));
  ring.add(line("b"));
  ring.on_line([] {});
  ring.add(line("c"));
  EXPECT_THAT(told, ElementsAre(1u, 2u));
}

TEST(LogRing, LosesNothingWhenThreadsWriteTogether) {
  LogRing ring;
  const auto write = [&ring] {
    for (std::size_t i = 0; i < LogRing::capacity / 4; ++i) {
      ring.add(line("x"));
    }
  };
  {
    const std::jthread one(write);
    const std::jthread other(write);
  }
  const auto lines = ring.after(0);
  ASSERT_EQ(lines.size(), LogRing::capacity / 2);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].sequence, i + 1);
  }
}

TEST(LogLevel, HasTheNamesOfTheInterface) {
  for (const std::string_view name : log_level_names) {
    EXPECT_EQ(name_of(log_level(name).value()), name);
  }
  EXPECT_FALSE(log_level("warn"));
  EXPECT_LT(log_level("debug"), log_level("critical"));
}

}  // namespace
}  // namespace interlock
