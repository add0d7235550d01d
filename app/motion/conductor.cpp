#include "motion/conductor.hpp"

namespace interlock {

void Conductor::take(const Order& order, std::uint32_t tick) noexcept {
  manual_.take(order, tick);
  if (home_.is_open()) {
    manual_.end(order.proposal, OrderReason::axis_homing, tick);
  }
  if (path_.is_open() || sweep_.is_open() || biopsy_.is_open()) {
    manual_.end(order.proposal, OrderReason::superseded, tick);
  }
}

void Conductor::take(const HomeOrder& order, std::uint32_t tick) noexcept {
  manual_.end_all(OrderReason::axis_homing, tick);
  path_.end_all(OrderReason::axis_homing, tick);
  sweep_.end_all(OrderReason::axis_homing, tick);
  biopsy_.end_all(OrderReason::axis_homing, tick);
  home_.take(order, tick);
}

void Conductor::take(const PathOrder& order, std::uint32_t tick) noexcept {
  end_all(OrderReason::superseded, tick);
  path_.take(order, tick);
}

void Conductor::take(const SweepOrder& order, std::uint32_t tick) noexcept {
  end_all(OrderReason::superseded, tick);
  sweep_.take(order, tick);
}

void Conductor::take(const BiopsyOrder& order, std::uint32_t tick) noexcept {
  end_all(OrderReason::superseded, tick);
  biopsy_.take(order, tick);
}

void Conductor::end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept {
  each_mode([&](Mode& mode) { mode.end(proposal, reason, tick); });
}

void Conductor::end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept {
  each_mode([&](Mode& mode) { mode.end_axis(slot, reason, tick); });
}

void Conductor::end_all(OrderReason reason, std::uint32_t tick) noexcept {
  each_mode([&](Mode& mode) { mode.end_all(reason, tick); });
}

Wishes Conductor::tick(const ilk_snapshot_t& snapshot) noexcept {
  Wishes wishes;
  each_mode([&](Mode& mode) { mode.tick(snapshot, wishes); });
  return wishes;
}

std::optional<Setpoint> Conductor::setpoint(std::uint32_t slot) const noexcept {
  const std::optional<Setpoint> along_path = path_.setpoint(slot);
  return along_path ? along_path : biopsy_.setpoint(slot);
}

void Conductor::on_unsent(const Wish& wish) noexcept {
  each_mode([&](Mode& mode) { mode.on_unsent(wish); });
}

void Conductor::on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  each_mode([&](Mode& mode) { mode.on_verdict(origin, verdict, tick); });
}

void Conductor::on_verdict_lost(const WishOrigin& origin, std::uint32_t tick) noexcept {
  each_mode([&](Mode& mode) { mode.on_verdict_lost(origin, tick); });
}

}  // namespace interlock
