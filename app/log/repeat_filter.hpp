/**
 * @file
 * Lets a message that comes again and again into the log once, and counts the rest.
 */
#pragma once

#include <spdlog/sinks/base_sink.h>

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "log/log_ring.hpp"

namespace interlock {

/**
 * Passes messages on to other sinks and to the ring. A message equal to the one before it is counted instead:
 * the next other message, or the same one after `longest_silence`, comes after a line "last message repeated
 * N times".
 *
 * A line stays one line, whatever is in the message: `printable` escapes what could mislead a reader.
 */
class RepeatFilter final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  static constexpr std::chrono::seconds longest_silence{10};

  /** `ring` must outlive the filter. */
  RepeatFilter(std::vector<spdlog::sink_ptr> sinks, LogRing& ring);

  /** Tells of repetitions that no other message will bring to light soon: `longest_silence` after the first.
   */
  void tell_overdue(UtcTime now);

  /** Tells of those that are left. */
  void end();

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override;
  void set_pattern_(const std::string& pattern) override;
  void set_formatter_(std::unique_ptr<spdlog::formatter> formatter) override;

 private:
  [[nodiscard]] bool is_repetition(const spdlog::details::log_msg& message) const;
  void tell_repetitions(UtcTime now);
  void pass(const spdlog::details::log_msg& message, std::uint64_t repeated);

  std::vector<spdlog::sink_ptr> sinks_;
  LogRing& ring_;
  bool any_ = false;
  std::string last_text_;
  spdlog::level::level_enum last_level_ = spdlog::level::off;
  std::string last_logger_;
  UtcTime last_time_;
  std::uint64_t repetitions_ = 0;
};

}  // namespace interlock
