/**
 * @file
 * A destination of the log for which no thread that logs waits.
 */
#pragma once

#include <spdlog/sinks/sink.h>

#include <atomic>
#include <memory>
#include <string>

#include "log/log_ring.hpp"
#include "log/writing_thread.hpp"

namespace interlock {

/** Hands lines to another sink in a thread of its own. Lines that are lost because that sink is slow or fails
 * are told of there and in the ring. */
class QueuedSink final : public spdlog::sinks::sink {
 public:
  /** How long an end of the log waits for what is still to be written. */
  static constexpr std::chrono::seconds longest_flush{1};

  /** @param place what `target` writes to, as people know it */
  QueuedSink(spdlog::sink_ptr target, std::string place, std::shared_ptr<LogRing> ring);

  /** Queues a line; one that finds no room is counted. */
  void log(const spdlog::details::log_msg& message) override;

  /** For the end of the log, since it waits: until all is written, or `longest_flush`. */
  void flush() override;

  /** Whether all is written, then if not now. */
  bool wait_until_written(WritingThread::Clock::time_point then) const {
    return thread_.wait_until_done(then);
  }

  /** Lines that were not written, ever. */
  [[nodiscard]] std::uint64_t lost() const { return thread_.lost(); }

  /** Before the first line only: later it may wait. */
  void set_pattern(const std::string& pattern) override;
  /** As `set_pattern`. */
  void set_formatter(std::unique_ptr<spdlog::formatter> formatter) override;

 private:
  class Target;

  std::shared_ptr<Target> target_;
  WritingThread thread_;
};

}  // namespace interlock
