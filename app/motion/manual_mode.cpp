#include "motion/manual_mode.hpp"

#include "motion/obstacle.hpp"

namespace interlock {

ManualMode::ManualMode(const RobotPlan& plan) noexcept : patience_ticks_(plan.patience_ticks()) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    jobs_[slot].move = AxisMove(slot, plan.axis[slot], plan.lease_ticks());
  }
}

void ManualMode::set_phase(std::uint32_t slot, OrderPhase phase, OrderReason reason, std::uint32_t code,
                           std::uint32_t tick) noexcept {
  OrderStatus& status = orders_[slot];
  status.phase = phase;
  status.reason = reason;
  status.code = code;
  status.tick = tick;
}

void ManualMode::take(const Order& order, std::uint32_t tick) noexcept {
  if (order.slot >= ILK_SLOTS) {
    return;
  }
  Job& job = jobs_[order.slot];
  job.move.aim(order.target_counts, order.max_drive);
  job.idle_since = tick;
  orders_[order.slot] = OrderStatus{order.proposal, OrderPhase::waiting, OrderReason::none, 0, tick};
}

void ManualMode::end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (orders_[slot].proposal == proposal && is_open(orders_[slot].phase)) {
      set_phase(slot, OrderPhase::aborted, reason, 0, tick);
    }
  }
}

void ManualMode::end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept {
  if (slot < ILK_SLOTS && is_open(orders_[slot].phase)) {
    set_phase(slot, OrderPhase::aborted, reason, 0, tick);
  }
}

void ManualMode::end_all(OrderReason reason, std::uint32_t tick) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (is_open(orders_[slot].phase)) {
      set_phase(slot, OrderPhase::aborted, reason, 0, tick);
    }
  }
}

void ManualMode::tick(const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (is_open(orders_[slot].phase)) {
      judge(slot, snapshot);
    }
    if (orders_[slot].phase == OrderPhase::executing) {
      jobs_[slot].move.hold(orders_[slot].proposal, snapshot, wishes);
    } else {
      jobs_[slot].move.let_go(orders_[slot].proposal, snapshot, wishes);
    }
  }
}

void ManualMode::judge(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  if (const auto obstacle = obstacle_of(snapshot, slot)) {
    set_phase(slot, OrderPhase::aborted, obstacle->reason, obstacle->code, now);
  } else if (snapshot.state.axis[slot].state == ILK_AXIS_HOMING) {
    set_phase(slot, OrderPhase::aborted, OrderReason::axis_homing, 0, now);
  } else if (snapshot.state.system.mode == ILK_MODE_MOTION) {
    follow(slot, snapshot);
  } else {
    pause_or_expire(slot, snapshot);
  }
}

bool ManualMode::waited_too_long(std::uint32_t slot, std::uint32_t tick) const noexcept {
  return tick - jobs_[slot].idle_since > patience_ticks_;
}

void ManualMode::pause_or_expire(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  if (orders_[slot].phase == OrderPhase::executing) {
    set_phase(slot, OrderPhase::paused, OrderReason::pedal_released, 0, now);
    jobs_[slot].idle_since = now;
  } else if (waited_too_long(slot, now)) {
    set_phase(slot, OrderPhase::expired, OrderReason::waited_too_long, 0, now);
  }
}

void ManualMode::follow(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  Job& job = jobs_[slot];
  if (orders_[slot].phase != OrderPhase::executing) {
    if (waited_too_long(slot, now)) {
      set_phase(slot, OrderPhase::expired, OrderReason::waited_too_long, 0, now);
      return;
    }
    set_phase(slot, OrderPhase::executing, OrderReason::none, 0, now);
    job.move.start(snapshot);
    return;
  }
  switch (job.move.watch(snapshot)) {
    case AxisMove::Progress::going:
      break;
    case AxisMove::Progress::arrived:
      set_phase(slot, OrderPhase::done, OrderReason::arrived, 0, now);
      break;
    case AxisMove::Progress::blocked:
      set_phase(slot, OrderPhase::aborted, OrderReason::blocked, snapshot.gate[slot], now);
      break;
  }
}

void ManualMode::on_unsent(const Wish& wish) noexcept {
  const std::uint32_t slot = wish.origin.slot;
  if (slot < ILK_SLOTS && orders_[slot].proposal == wish.origin.proposal) {
    jobs_[slot].move.on_unsent();
  }
}

void ManualMode::on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  // MODE says only that the pedal was released between the snapshot and the request; the next snapshot
  // pauses.
  if (verdict == ILK_VERDICT_ACCEPTED || verdict == ILK_VERDICT_MODE) {
    return;
  }
  const std::uint32_t slot = origin.slot;
  if (slot < ILK_SLOTS && orders_[slot].proposal == origin.proposal && is_open(orders_[slot].phase)) {
    set_phase(slot, OrderPhase::refused, OrderReason::kernel_refused, verdict, tick);
  }
}

void ManualMode::on_verdict_lost(const WishOrigin& /*origin*/, std::uint32_t /*tick*/) noexcept {
  // A MOVE is renewed before its lease runs out, and each renewal has a verdict of its own.
}

}  // namespace interlock
