#include "log/log.hpp"

#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "log/queued_sink.hpp"
#include "log/repeat_filter.hpp"

namespace interlock {
namespace {

constexpr const char* line_pattern = "%Y-%m-%dT%H:%M:%S.%eZ %l %v";

/** In the order of `LogLevel`. */
constexpr std::array<spdlog::level::level_enum, log_level_names.size()> spdlog_levels{
    spdlog::level::debug, spdlog::level::info, spdlog::level::warn, spdlog::level::err,
    spdlog::level::critical};

std::shared_ptr<spdlog::logger> logger_of(spdlog::sink_ptr sink) {
  auto logger = std::make_shared<spdlog::logger>("app", std::move(sink));
  logger->set_pattern(line_pattern, spdlog::pattern_time_type::utc);
  return logger;
}

/** A thread that hangs in writing holds the lock of its FILE, for which the end of the process would wait in
 * order to write out what is left. */
void end_without_stdio() {
  on_exit([](int status, void*) { _exit(status); }, nullptr);
}

}  // namespace

tl::expected<std::unique_ptr<Log>, std::string> Log::start(const std::filesystem::path& file,
                                                           LogLevel level) {
  // One thread each: a terminal that somebody stopped keeps no line from the file.
  const auto ring = std::make_shared<LogRing>();
  QueuedSinks sinks{std::make_shared<QueuedSink>(std::make_shared<spdlog::sinks::stderr_color_sink_mt>(),
                                                 "standard error", ring)};
  if (!file.empty()) {
    try {
      sinks.push_back(std::make_shared<QueuedSink>(
          std::make_shared<spdlog::sinks::rotating_file_sink_mt>(file.string(), file_bytes, old_files),
          file.string(), ring));
    } catch (const spdlog::spdlog_ex& error) {
      return tl::make_unexpected("cannot write the log " + file.string() + ": " + error.what() +
                                 "; expected a folder that this user may write to");
    }
  }
  return std::unique_ptr<Log>(new Log(ring, std::move(sinks), level));
}

Log::Log(std::shared_ptr<LogRing> ring, QueuedSinks sinks, LogLevel level)
    : ring_(std::move(ring)),
      sinks_(std::move(sinks)),
      filter_(std::make_shared<RepeatFilter>(std::vector<spdlog::sink_ptr>(sinks_.begin(), sinks_.end()),
                                             *ring_)),
      logger_(logger_of(filter_)) {
  set_level(level);
  spdlog::set_default_logger(logger_);
}

Log::~Log() {
  ring_->on_line([] {});
  filter_->end();
  const auto then = WritingThread::Clock::now() + QueuedSink::longest_flush;
  if (!std::ranges::all_of(sinks_, [&](const auto& each) { return each->wait_until_written(then); })) {
    end_without_stdio();
  }
  spdlog::set_default_logger(logger_of(std::make_shared<spdlog::sinks::stderr_color_sink_mt>()));
}

std::uint64_t Log::lines_lost() const {
  std::uint64_t lost = 0;
  for (const auto& each : sinks_) {
    lost += each->lost();
  }
  return lost;
}

void Log::tell_repetitions() { filter_->tell_overdue(std::chrono::system_clock::now()); }

LogLevel Log::level() const {
  const spdlog::level::level_enum level = logger_->level();
  std::size_t i = 0;
  while (i + 1 < spdlog_levels.size() && spdlog_levels[i] != level) {
    ++i;
  }
  return static_cast<LogLevel>(i);
}

void Log::set_level(LogLevel level) { logger_->set_level(spdlog_levels[static_cast<std::size_t>(level)]); }

}  // namespace interlock
