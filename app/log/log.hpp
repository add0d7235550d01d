/**
 * @file
 * The app's log. Everything is written by spdlog's default logger, from any thread; it goes to the ring that
 * the console reads at once, and to standard error and a rotating file by threads of their own: nobody who
 * logs waits for a disk, a pipe or a terminal.
 */
#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "log/log_level.hpp"
#include "log/log_ring.hpp"

namespace interlock {

class QueuedSink;
class RepeatFilter;

class Log {
 public:
  static constexpr std::size_t file_bytes = 5u << 20u;
  static constexpr std::size_t old_files = 4;

  /**
   * Makes the log and takes over spdlog's default logger. On leaving, what still waits is written,
   * for a second at most, and the default logger goes back to standard error only.
   *
   * @param file file to write, with its folders; empty: none
   * @return the error names the file and why it cannot be written
   */
  static tl::expected<std::unique_ptr<Log>, std::string> start(const std::filesystem::path& file,
                                                               LogLevel level);

  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  ~Log();

  /** Lines below this level are not written. */
  [[nodiscard]] LogLevel level() const;
  /** Lines below this level are no longer written. */
  void set_level(LogLevel level);

  /** Says how often the last line came again, unless that is still going on; to be called now and then. */
  void tell_repetitions();

  /** The newest lines, for those who watch. */
  [[nodiscard]] LogRing& ring() { return *ring_; }

  /** Lines that did not get to standard error or to the file, because it was slow or failed; the sum of both.
   */
  [[nodiscard]] std::uint64_t lines_lost() const;

 private:
  using QueuedSinks = std::vector<std::shared_ptr<QueuedSink>>;

  Log(std::shared_ptr<LogRing> ring, QueuedSinks sinks, LogLevel level);

  std::shared_ptr<LogRing> ring_; /**< shared with threads that hang in writing */
  QueuedSinks sinks_;
  std::shared_ptr<RepeatFilter> filter_;
  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace interlock
