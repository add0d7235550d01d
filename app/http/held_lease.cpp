#include "http/held_lease.hpp"

#include "interlock/sim_bus.h"

namespace interlock::web {

void HeldLease::hold(const ControlView& view, TimePoint now) {
  held_ = true;
  renewed_ = now;
  renewed_tick_ = view.snapshot.state.system.tick;
}

bool HeldLease::overdue(const ControlView& view, TimePoint now) const {
  if (!held_) {
    return false;
  }
  if (!view.attached || view.snapshot.clock != ILK_CLOCK_SIM) {
    return now - renewed_ >= patience_;
  }
  const std::uint64_t ticks = view.snapshot.state.system.tick - renewed_tick_;
  return ticks * view.snapshot.period_us >=
         static_cast<std::uint64_t>(std::chrono::microseconds(patience_).count());
}

}  // namespace interlock::web
