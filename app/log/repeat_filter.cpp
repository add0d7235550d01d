#include "log/repeat_filter.hpp"

#include <spdlog/details/log_msg.h>

#include <utility>

#include "system/printable.hpp"

namespace interlock {
namespace {

LogLevel level_of(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::warn:
      return LogLevel::warning;
    case spdlog::level::err:
      return LogLevel::error;
    case spdlog::level::critical:
      return LogLevel::critical;
    case spdlog::level::info:
      return LogLevel::info;
    default:
      return LogLevel::debug;
  }
}

}  // namespace

RepeatFilter::RepeatFilter(std::vector<spdlog::sink_ptr> sinks, LogRing& ring)
    : sinks_(std::move(sinks)), ring_(ring) {}

void RepeatFilter::sink_it_(const spdlog::details::log_msg& message) {
  if (is_repetition(message)) {
    ++repetitions_;
    return;
  }
  tell_repetitions(message.time);
  any_ = true;
  last_text_.assign(message.payload.begin(), message.payload.end());
  last_level_ = message.level;
  last_logger_.assign(message.logger_name.begin(), message.logger_name.end());
  last_time_ = message.time;
  const std::string line = printable(last_text_);
  spdlog::details::log_msg passed = message;
  passed.payload = line;
  pass(passed, 0);
}

void RepeatFilter::tell_overdue(UtcTime now) {
  const std::lock_guard lock(mutex_);
  if (now - last_time_ >= longest_silence) {
    tell_repetitions(now);
  }
}

void RepeatFilter::end() {
  const std::lock_guard lock(mutex_);
  tell_repetitions(std::chrono::system_clock::now());
}

bool RepeatFilter::is_repetition(const spdlog::details::log_msg& message) const {
  return any_ && message.level == last_level_ && message.time - last_time_ < longest_silence &&
         std::string_view(message.payload.data(), message.payload.size()) == last_text_;
}

void RepeatFilter::tell_repetitions(UtcTime now) {
  if (repetitions_ == 0) {
    return;
  }
  const std::uint64_t count = std::exchange(repetitions_, 0);
  const std::string text =
      "last message repeated " + std::to_string(count) + (count == 1 ? " time" : " times");
  spdlog::details::log_msg told(now, spdlog::source_loc{}, last_logger_, last_level_, text);
  pass(told, count);
}

void RepeatFilter::pass(const spdlog::details::log_msg& message, std::uint64_t repeated) {
  ring_.add({0, message.time, level_of(message.level),
             std::string(message.payload.begin(), message.payload.end()), repeated});
  for (const spdlog::sink_ptr& each : sinks_) {
    each->log(message);
  }
}

void RepeatFilter::flush_() {
  for (const spdlog::sink_ptr& each : sinks_) {
    each->flush();
  }
}

void RepeatFilter::set_pattern_(const std::string& pattern) {
  for (const spdlog::sink_ptr& each : sinks_) {
    each->set_pattern(pattern);
  }
}

void RepeatFilter::set_formatter_(std::unique_ptr<spdlog::formatter> formatter) {
  for (const spdlog::sink_ptr& each : sinks_) {
    each->set_formatter(formatter->clone());
  }
}

}  // namespace interlock
