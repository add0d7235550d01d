/**
 * @file
 * Says when a program has given no sign of life for too long.
 */
#pragma once

#include <algorithm>
#include <chrono>

namespace interlock::cli {

/**
 * Counts only time in which the one who looks was awake: it has to look every `step`, and a longer time since
 * the last look counts as one. So a machine that stood still does not make a healthy program a silent one.
 */
class Watchdog {
 public:
  /** By which it counts. */
  using Time = std::chrono::steady_clock::time_point;

  Watchdog(std::chrono::milliseconds limit, Time now) : limit_(limit), last_look_(now) {}

  /** There was a sign of life. */
  void feed() { silent_ = {}; }

  /** Looks; whether there was no sign of life for the limit. */
  bool has_expired(Time now) {
    silent_ += std::min<Time::duration>(now - last_look_, step());
    last_look_ = now;
    return silent_ >= limit_;
  }

  [[nodiscard]] Time next_look() const { return last_look_ + step(); }

 private:
  [[nodiscard]] std::chrono::milliseconds step() const { return limit_ / 5; }

  std::chrono::milliseconds limit_;
  Time::duration silent_{};
  Time last_look_;
};

}  // namespace interlock::cli
