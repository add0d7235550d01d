#include "log/repeat_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/details/log_msg.h>
#include <spdlog/sinks/ostream_sink.h>

#include <sstream>

namespace interlock {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::Pair;

class RepeatFilterTest : public testing::Test {
 protected:
  RepeatFilterTest() { filter_.set_pattern("%l %v"); }

  void say(const std::string& text, spdlog::level::level_enum level = spdlog::level::info) {
    filter_.log(spdlog::details::log_msg(now_, spdlog::source_loc{}, "app", level, text));
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> kept() const {
    std::vector<std::pair<std::string, std::uint64_t>> found;
    for (const LogLine& line : ring_.after(0)) {
      found.emplace_back(line.text, line.repeated);
    }
    return found;
  }

  LogRing ring_;
  std::ostringstream written_;
  RepeatFilter filter_{{std::make_shared<spdlog::sinks::ostream_sink_mt>(written_)}, ring_};
  UtcTime now_{seconds(1'700'000'000)};
};

TEST_F(RepeatFilterTest, DifferentMessagesAllPass) {
  say("a");
  say("b");
  say("a");
  EXPECT_THAT(kept(), ElementsAre(Pair("a", 0u), Pair("b", 0u), Pair("a", 0u)));
  EXPECT_EQ(written_.str(), "info a\ninfo b\ninfo a\n");
}

TEST_F(RepeatFilterTest, ARepeatedMessageIsLoggedOnceAndCounted) {
  say("again", spdlog::level::warn);
  say("again", spdlog::level::warn);
  say("again", spdlog::level::warn);
  say("other");
  EXPECT_THAT(kept(),
              ElementsAre(Pair("again", 0u), Pair("last message repeated 2 times", 2u), Pair("other", 0u)));
  EXPECT_EQ(written_.str(), "warning again\nwarning last message repeated 2 times\ninfo other\n");
  EXPECT_EQ(ring_.after(1).front().level, LogLevel::warning);
}

TEST_F(RepeatFilterTest, TheSameTextAtAnotherLevelIsAnotherMessage) {
  say("x");
  say("x", spdlog::level::err);
  EXPECT_THAT(kept(), ElementsAre(Pair("x", 0u), Pair("x", 0u)));
}

TEST_F(RepeatFilterTest, AnEndlessRepetitionShowsUpFromTimeToTime) {
  say("stuck");
  now_ += seconds(1);
  say("stuck");
  now_ += RepeatFilter::longest_silence;
  say("stuck");
  EXPECT_THAT(kept(),
              ElementsAre(Pair("stuck", 0u), Pair("last message repeated 1 time", 1u), Pair("stuck", 0u)));
}

TEST_F(RepeatFilterTest, EveryLevelReachesTheRingUnderItsName) {
  constexpr std::pair<spdlog::level::level_enum, LogLevel> levels[] = {
      {spdlog::level::debug, LogLevel::debug},
      {spdlog::level::info, LogLevel::info},
      {spdlog::level::warn, LogLevel::warning},
      {spdlog::level::err, LogLevel::error},
      {spdlog::level::critical, LogLevel::critical}};
  for (const auto& [written, kept] : levels) {
    say("x", written);
    EXPECT_EQ(ring_.newest(1, LogLevel::debug).front().level, kept);
  }
}

TEST_F(RepeatFilterTest, ALineKeepsTheTimeOfItsMessage) {
  say("x");
  EXPECT_EQ(ring_.after(0).front().time, now_);
}

TEST_F(RepeatFilterTest, RepetitionsAtTheEndAreTold) {
  say("again");
  say("again");
  filter_.end();
  EXPECT_THAT(kept(), ElementsAre(Pair("again", 0u), Pair("last message repeated 1 time", 1u)));
  filter_.end();
  EXPECT_EQ(kept().size(), 2u);
}

TEST_F(RepeatFilterTest, RepetitionsAreToldWithoutAnotherMessageOnceTheyAreOver) {
  say("again");
  say("again");
  filter_.tell_overdue(now_ + seconds(9));
  EXPECT_EQ(kept().size(), 1u);
  filter_.tell_overdue(now_ + RepeatFilter::longest_silence);
  EXPECT_THAT(kept(), ElementsAre(Pair("again", 0u), Pair("last message repeated 1 time", 1u)));
}

TEST_F(RepeatFilterTest, AMessageStaysOnItsLine) {
  say("GET /a\n2024-01-01 critical forged\x1b[31m\x7f\r\ttab");
  EXPECT_THAT(kept(),
              ElementsAre(Pair("GET /a\\x0a2024-01-01 critical forged\\x1b[31m\\x7f\\x0d\\x09tab", 0u)));
}

TEST_F(RepeatFilterTest, AMessageCannotTurnItsOwnWritingDirectionOrHideAControl) {
  say("user \xe2\x80\xaenimda\xc2\x9b"
      "31m\xff");
  EXPECT_THAT(kept(), ElementsAre(Pair("user \\u202enimda\\u009b31m\\xff", 0u)));
}

}  // namespace
}  // namespace interlock
