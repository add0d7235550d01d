#include "log/log_ring.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace interlock {

void LogRing::add(LogLine line) {
  {
    const std::lock_guard lock(lines_mutex_);
    line.sequence = ++last_;
    lines_.push_back(std::move(line));
    if (lines_.size() > capacity) {
      lines_.pop_front();
    }
  }
  const std::lock_guard lock(listener_mutex_);
  listener_();
}

std::vector<LogLine> LogRing::newest(std::size_t count, LogLevel at_least) const {
  std::vector<LogLine> found;
  {
    const std::lock_guard lock(lines_mutex_);
    for (auto line = lines_.rbegin(); line != lines_.rend() && found.size() < count; ++line) {
      if (line->level >= at_least) {
        found.push_back(*line);
      }
    }
  }
  std::reverse(found.begin(), found.end());
  return found;
}

std::vector<LogLine> LogRing::after(std::uint64_t sequence) const {
  const std::lock_guard lock(lines_mutex_);
  const auto first = std::find_if(lines_.begin(), lines_.end(),
                                  [&](const LogLine& line) { return line.sequence > sequence; });
  return {first, lines_.end()};
}

std::uint64_t LogRing::last() const {
  const std::lock_guard lock(lines_mutex_);
  return last_;
}

void LogRing::on_line(std::function<void()> listener) {
  const std::lock_guard lock(listener_mutex_);
  listener_ = std::move(listener);
}

}  // namespace interlock
