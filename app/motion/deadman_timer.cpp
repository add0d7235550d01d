#include "motion/deadman_timer.hpp"

namespace interlock {

bool DeadmanTimer::overdue(const Moment& now) const noexcept {
  if (!renewed_) {
    return false;
  }
  if (now.tick_us == 0) {
    return now.time - renewed_->time >= timeout_;
  }
  const std::uint64_t ticks = now.tick - renewed_->tick;
  return std::chrono::microseconds(ticks * now.tick_us) >= timeout_;
}

}  // namespace interlock
