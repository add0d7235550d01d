/**
 * @file
 * How often a program may be started again.
 */
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>

namespace interlock::cli {

/** Allows a number of restarts within any window of time. */
class RestartBudget {
 public:
  /** The clock of restarts. */
  using Time = std::chrono::steady_clock::time_point;

  RestartBudget(std::size_t restarts, std::chrono::seconds window) : restarts_(restarts), window_(window) {}

  /** Whether one more restart is allowed now; when it is, it is counted. */
  bool spend(Time now) {
    while (!spent_.empty() && now - spent_.front() >= window_) {
      spent_.pop_front();
    }
    if (spent_.size() >= restarts_) {
      return false;
    }
    spent_.push_back(now);
    return true;
  }

  /** Restarts counted in the window that ended with the last call of `spend`. */
  [[nodiscard]] std::size_t spent() const { return spent_.size(); }

 private:
  std::size_t restarts_;
  std::chrono::seconds window_;
  std::deque<Time> spent_;
};

}  // namespace interlock::cli
