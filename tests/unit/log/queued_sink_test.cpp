#include "log/queued_sink.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/details/log_msg.h>
#include <spdlog/sinks/base_sink.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace interlock {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/** A disk under the test's control: takes nothing while it is held, and can be full. */
class Disk final : public spdlog::sinks::sink {
 public:
  void log(const spdlog::details::log_msg& message) override {
    std::unique_lock lock(mutex_);
    ++begun_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !held_; });
    if (full_) {
      throw std::runtime_error("no space left");
    }
    lines_.emplace_back(message.payload.begin(), message.payload.end());
  }
  void flush() override {}
  void set_pattern(const std::string&) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter>) override {}

  void hold(bool held) {
    const std::lock_guard lock(mutex_);
    held_ = held;
    changed_.notify_all();
  }

  void fill(bool full) {
    const std::lock_guard lock(mutex_);
    full_ = full;
  }

  /** Waits until so many lines were given to it. */
  void wait_for(std::size_t begun) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return begun_ >= begun; });
  }

  std::vector<std::string> lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool held_ = false;
  bool full_ = false;
  std::size_t begun_ = 0;
  std::vector<std::string> lines_;
};

class QueuedSinkTest : public testing::Test {
 protected:
  void say(const std::string& text) {
    sink_->log(spdlog::details::log_msg({}, spdlog::source_loc{}, "app", spdlog::level::info, text));
  }

  /** One line that hangs in the disk, and as many behind it as may wait. */
  void fill_queue() {
    disk_->hold(true);
    say("0");
    disk_->wait_for(1);
    for (std::size_t i = 1; i <= WritingThread::capacity; ++i) {
      say(std::to_string(i));
    }
  }

  /** However long it takes. */
  void wait_until_written() const {
    ASSERT_TRUE(sink_->wait_until_written(WritingThread::Clock::time_point::max()));
  }

  std::shared_ptr<Disk> disk_ = std::make_shared<Disk>();
  std::shared_ptr<LogRing> ring_ = std::make_shared<LogRing>();
  std::unique_ptr<QueuedSink> sink_ = std::make_unique<QueuedSink>(disk_, "the disk", ring_);
};

TEST_F(QueuedSinkTest, WritesWhatComesInItsOrder) {
  for (const char* text : {"a", "b", "c"}) {
    say(text);
  }
  wait_until_written();
  EXPECT_THAT(disk_->lines(), ElementsAre("a", "b", "c"));
  EXPECT_EQ(sink_->lost(), 0u);
}

TEST_F(QueuedSinkTest, AWriterNeverWaitsAndWhatFindsNoRoomIsCounted) {
  fill_queue();
  EXPECT_EQ(sink_->lost(), 0u);
  for (int i = 0; i < 3; ++i) {
    say("no room");
  }
  EXPECT_EQ(sink_->lost(), 3u);
  disk_->hold(false);
}

TEST_F(QueuedSinkTest, AfterAHangAllThatWaitedIsThereInOrderAndTheGapIsToldInItsPlace) {
  fill_queue();
  say("no room");
  say("no room");
  disk_->hold(false);
  wait_until_written();
  say("later");
  wait_until_written();
  const std::vector<std::string> lines = disk_->lines();
  ASSERT_EQ(lines.size(), WritingThread::capacity + 3);
  for (std::size_t i = 0; i <= WritingThread::capacity; ++i) {
    ASSERT_EQ(lines[i], std::to_string(i));
  }
  const std::string told = "2 lines of the log were lost: the disk did not take them in time";
  EXPECT_EQ(lines[WritingThread::capacity + 1], told);
  EXPECT_EQ(lines.back(), "later");
  ASSERT_EQ(ring_->last(), 1u);
  EXPECT_EQ(ring_->after(0)[0].text, told);
  EXPECT_EQ(ring_->after(0)[0].level, LogLevel::warning);
  EXPECT_EQ(sink_->lost(), 2u);
}

TEST_F(QueuedSinkTest, AFullDiskIsToldInTheRingOnceAndItsLinesAreCounted) {
  disk_->fill(true);
  say("a");
  say("b");
  wait_until_written();
  EXPECT_EQ(sink_->lost(), 2u);
  ASSERT_EQ(ring_->last(), 1u);
  EXPECT_THAT(ring_->after(0)[0].text, HasSubstr("the log cannot be written to the disk: no space left"));
  disk_->fill(false);
  say("c");
  wait_until_written();
  EXPECT_THAT(disk_->lines(), ElementsAre("c", HasSubstr("2 lines of the log were lost")));
}

TEST_F(QueuedSinkTest, AnEndWhileTheDiskHangsDoesNotWaitForIt) {
  disk_->hold(true);
  say("a");
  disk_->wait_for(1);
  say("b");
  EXPECT_FALSE(sink_->wait_until_written(WritingThread::Clock::now()));
  sink_->flush();
  const std::weak_ptr<LogRing> ring = ring_;
  sink_.reset();
  ring_.reset();
  EXPECT_FALSE(ring.expired()) << "the hanging thread still has what it works on";
  disk_->hold(false);
}

TEST_F(QueuedSinkTest, ThreadsThatWriteTogetherLoseNothingUncounted) {
  constexpr std::size_t each = WritingThread::capacity;
  const auto write = [&] {
    for (std::size_t i = 0; i < each; ++i) {
      say("x");
    }
  };
  {
    const std::jthread one(write);
    const std::jthread other(write);
  }
  wait_until_written();
  const auto lines = disk_->lines();
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(lines, "x")) + sink_->lost(), 2 * each);
}

}  // namespace
}  // namespace interlock
