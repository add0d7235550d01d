/**
 * @file
 * The newest lines of the log, kept for whoever wants to see them.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "log/log_level.hpp"
#include "system/utc_time.hpp"

namespace interlock {

/** One line as it was written. */
struct LogLine {
  std::uint64_t sequence = 0; /**< from 1, without a gap */
  UtcTime time;
  LogLevel level = LogLevel::info;
  std::string text;
  std::uint64_t repeated =
      0; /**< how often the line before came again; such a line says so in its text too */

  bool operator==(const LogLine&) const = default;
};

/** Any thread may write and read. A writer waits only while another thread copies a line in or lines out. */
class LogRing {
 public:
  static constexpr std::size_t capacity = 1000;

  /** Keeps the line under the next number; the oldest one makes room. */
  void add(LogLine line);

  /** At most `count` newest lines of at least that level, oldest first. */
  [[nodiscard]] std::vector<LogLine> newest(std::size_t count, LogLevel at_least) const;

  /** The lines with a number above `sequence` that are still kept, oldest first. */
  [[nodiscard]] std::vector<LogLine> after(std::uint64_t sequence) const;

  /** Number of the newest line; 0 when there was none. */
  [[nodiscard]] std::uint64_t last() const;

  /**
   * Tells `listener` after each new line, in the thread that wrote it; it must not log and should only wake
   * somebody who reads. When this returns, the listener before is not running and never runs again.
   */
  void on_line(std::function<void()> listener);

 private:
  mutable std::mutex lines_mutex_;
  std::deque<LogLine> lines_; /**< oldest first */
  std::uint64_t last_ = 0;
  std::mutex listener_mutex_;
  std::function<void()> listener_ = [] {};
};

}  // namespace interlock
