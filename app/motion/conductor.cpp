#include "motion/conductor.hpp"

namespace interlock {

void Conductor::take(const Order& order, std::uint32_t tick) noexcept {
  manual_.take(order, tick);
  if (home_.is_open()) {
    manual_.end(order.proposal, OrderReason::axis_homing, tick);
  }
  if (path_.is_open()) {
    manual_.end(order.proposal, OrderReason::superseded, tick);
  }
}

void Conductor::take(const HomeOrder& order, std::uint32_t tick) noexcept {
  manual_.end_all(OrderReason::axis_homing, tick);
  path_.end_all(OrderReason::axis_homing, tick);
  home_.take(order, tick);
}

void Conductor::take(const PathOrder& order, std::uint32_t tick) noexcept {
  manual_.end_all(OrderReason::superseded, tick);
  home_.end_all(OrderReason::superseded, tick);
  path_.take(order, tick);
}

void Conductor::end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept {
  manual_.end(proposal, reason, tick);
  home_.end(proposal, reason, tick);
  path_.end(proposal, reason, tick);
}

void Conductor::end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept {
  manual_.end_axis(slot, reason, tick);
  home_.end_axis(slot, reason, tick);
  path_.end_axis(slot, reason, tick);
}

void Conductor::end_all(OrderReason reason, std::uint32_t tick) noexcept {
  manual_.end_all(reason, tick);
  home_.end_all(reason, tick);
  path_.end_all(reason, tick);
}

/** Moves and paths give back their leases before homing asks for their axes. */
Wishes Conductor::tick(const ilk_snapshot_t& snapshot) noexcept {
  Wishes wishes;
  manual_.tick(snapshot, wishes);
  path_.tick(snapshot, wishes);
  home_.tick(snapshot, wishes);
  return wishes;
}

void Conductor::on_unsent(const Wish& wish) noexcept {
  manual_.on_unsent(wish);
  home_.on_unsent(wish);
  path_.on_unsent(wish);
}

void Conductor::on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  manual_.on_verdict(origin, verdict, tick);
  home_.on_verdict(origin, verdict, tick);
  path_.on_verdict(origin, verdict, tick);
}

void Conductor::on_verdict_lost(const WishOrigin& origin, std::uint32_t tick) noexcept {
  manual_.on_verdict_lost(origin, tick);
  home_.on_verdict_lost(origin, tick);
  path_.on_verdict_lost(origin, tick);
}

}  // namespace interlock
