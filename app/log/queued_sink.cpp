#include "log/queued_sink.hpp"

#include <spdlog/details/log_msg_buffer.h>

#include <chrono>
#include <exception>
#include <utility>

namespace interlock {

/** What the thread works on, and owns for as long as it lives. */
class QueuedSink::Target {
 public:
  Target(spdlog::sink_ptr sink, std::string place, std::shared_ptr<LogRing> ring)
      : sink_(std::move(sink)), place_(std::move(place)), ring_(std::move(ring)) {}

  [[nodiscard]] spdlog::sinks::sink& sink() const { return *sink_; }

  void write(const spdlog::details::log_msg& message) {
    try {
      sink_->log(message);
      sink_->flush();
      fails_ = false;
    } catch (const std::exception& error) {
      if (!std::exchange(fails_, true)) {
        ring_->add({0, std::chrono::system_clock::now(), LogLevel::error,
                    "the log cannot be written to " + place_ + ": " + error.what(), 0});
      }
      throw;
    }
  }

  void tell_lost(std::uint64_t lost) {
    const auto now = std::chrono::system_clock::now();
    const std::string text = std::to_string(lost) + (lost == 1 ? " line" : " lines") +
                             " of the log were lost: " + place_ + " did not take them in time";
    ring_->add({0, now, LogLevel::warning, text, 0});
    write(spdlog::details::log_msg(now, {}, "app", spdlog::level::warn, text));
  }

 private:
  spdlog::sink_ptr sink_;
  std::string place_;
  std::shared_ptr<LogRing> ring_;
  bool fails_ = false; /**< the last line could not be written */
};

QueuedSink::QueuedSink(spdlog::sink_ptr target, std::string place, std::shared_ptr<LogRing> ring)
    : target_(std::make_shared<Target>(std::move(target), std::move(place), std::move(ring))),
      thread_([on = target_](std::uint64_t lost) { on->tell_lost(lost); }) {}

void QueuedSink::log(const spdlog::details::log_msg& message) {
  thread_.add([on = target_, kept = spdlog::details::log_msg_buffer(message)] { on->write(kept); });
}

void QueuedSink::flush() { wait_until_written(WritingThread::Clock::now() + longest_flush); }

void QueuedSink::set_pattern(const std::string& pattern) { target_->sink().set_pattern(pattern); }

void QueuedSink::set_formatter(std::unique_ptr<spdlog::formatter> formatter) {
  target_->sink().set_formatter(std::move(formatter));
}

}  // namespace interlock
