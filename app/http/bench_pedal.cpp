#include "http/bench_pedal.hpp"

#include "interlock/sim_bus.h"

namespace interlock::web {
namespace {

constexpr std::chrono::milliseconds patience{500};

}  // namespace

void BenchPedal::hold(const ControlView& view, TimePoint now) {
  held_ = true;
  renewed_ = now;
  renewed_tick_ = view.snapshot.state.tick;
}

bool BenchPedal::overdue(const ControlView& view, TimePoint now) const {
  if (!held_) {
    return false;
  }
  if (!view.attached || view.snapshot.clock != ILK_CLOCK_SIM) {
    return now - renewed_ >= patience;
  }
  const std::uint64_t ticks = view.snapshot.state.tick - renewed_tick_;
  return ticks * view.snapshot.period_us >=
         static_cast<std::uint64_t>(std::chrono::microseconds(patience).count());
}

}  // namespace interlock::web
