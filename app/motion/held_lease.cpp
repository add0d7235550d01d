#include "motion/held_lease.hpp"

namespace interlock {

bool HeldLease::overdue(const Moment& now) const noexcept {
  if (!renewed_) {
    return false;
  }
  if (now.tick_us == 0) {
    return now.time - renewed_->time >= patience_;
  }
  const std::uint64_t ticks = now.tick - renewed_->tick;
  return std::chrono::microseconds(ticks * now.tick_us) >= patience_;
}

}  // namespace interlock
