#include "log/log.hpp"

#include <fcntl.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <utility>

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
  logger->flush_on(spdlog::level::info);
  return logger;
}

/**
 * Whoever reads standard error through a pipe and stops reading must not hold up the app, STOP least of all.
 * What finds no room there is still in the file and in the ring.
 */
void wait_for_no_reader() {
  struct stat status{};
  if (fstat(STDERR_FILENO, &status) == 0 && S_ISFIFO(status.st_mode)) {
    fcntl(STDERR_FILENO, F_SETFL, fcntl(STDERR_FILENO, F_GETFL) | O_NONBLOCK);
  }
}

}  // namespace

tl::expected<std::unique_ptr<Log>, std::string> Log::start(const std::filesystem::path& file,
                                                           LogLevel level) {
  wait_for_no_reader();
  std::vector<spdlog::sink_ptr> sinks{std::make_shared<spdlog::sinks::stderr_color_sink_mt>()};
  if (!file.empty()) {
    try {
      sinks.push_back(
          std::make_shared<spdlog::sinks::rotating_file_sink_mt>(file.string(), file_bytes, old_files));
    } catch (const spdlog::spdlog_ex& error) {
      return tl::make_unexpected("cannot write the log " + file.string() + ": " + error.what() +
                                 "; expected a folder that this user may write to");
    }
  }
  return std::unique_ptr<Log>(new Log(std::move(sinks), level));
}

Log::Log(std::vector<spdlog::sink_ptr> sinks, LogLevel level)
    : filter_(std::make_shared<RepeatFilter>(std::move(sinks), ring_)), logger_(logger_of(filter_)) {
  set_level(level);
  spdlog::set_default_logger(logger_);
}

Log::~Log() {
  ring_.on_line([] {});
  filter_->end();
  spdlog::set_default_logger(logger_of(std::make_shared<spdlog::sinks::stderr_color_sink_mt>()));
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
