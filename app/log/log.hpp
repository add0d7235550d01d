/**
 * @file
 * The app's log. Everything is written by spdlog's default logger, from any thread; it goes to standard
 * error, to a rotating file, and to the ring that the console reads.
 */
#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "log/log_level.hpp"
#include "log/log_ring.hpp"

namespace interlock {

class RepeatFilter;

class Log {
 public:
  static constexpr std::size_t file_bytes = 5u << 20u;
  static constexpr std::size_t old_files = 4;

  /**
   * Makes the log and takes over spdlog's default logger. On leaving, the default logger goes back to
   * standard error only.
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
  [[nodiscard]] LogRing& ring() { return ring_; }

 private:
  Log(std::vector<spdlog::sink_ptr> sinks, LogLevel level);

  LogRing ring_;
  std::shared_ptr<RepeatFilter> filter_;
  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace interlock
