#include "motion/held_order.hpp"

#include "motion/obstacle.hpp"

namespace interlock {

void HeldOrder::set_phase(OrderPhase phase, OrderReason reason, std::uint32_t code,
                          std::uint32_t tick) noexcept {
  status_ = {status_.proposal, phase, reason, code, tick};
}

void HeldOrder::take(std::uint32_t proposal, std::uint32_t axes, std::uint32_t tick) noexcept {
  status_.proposal = proposal;
  axes_ = axes;
  slot_ = 0;
  idle_since_ = tick;
  set_phase(OrderPhase::waiting, OrderReason::none, 0, tick);
}

void HeldOrder::end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept {
  if (status_.proposal == proposal) {
    end_all(reason, tick);
  }
}

void HeldOrder::end_all(OrderReason reason, std::uint32_t tick) noexcept {
  if (is_open()) {
    set_phase(OrderPhase::aborted, reason, 0, tick);
  }
}

void HeldOrder::end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept {
  if (is_open() && moves(slot)) {
    fail(reason, 0, slot, tick);
  }
}

void HeldOrder::fail(OrderReason reason, std::uint32_t code, std::uint32_t slot,
                     std::uint32_t tick) noexcept {
  slot_ = slot;
  set_phase(OrderPhase::aborted, reason, code, tick);
}

void HeldOrder::finish(OrderReason reason, std::uint32_t tick) noexcept {
  set_phase(OrderPhase::done, reason, 0, tick);
}

HeldOrder::Work HeldOrder::judge(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  if (!is_open() || meets_obstacle(snapshot)) {
    return Work::none;
  }
  const bool held = snapshot.state.system.mode == ILK_MODE_MOTION;
  if (executes()) {
    if (held) {
      return Work::go_on;
    }
    set_phase(OrderPhase::paused, OrderReason::pedal_released, 0, now);
    idle_since_ = now;
  } else if (now - idle_since_ > patience_ticks_) {
    set_phase(OrderPhase::expired, OrderReason::waited_too_long, 0, now);
  } else if (held) {
    set_phase(OrderPhase::executing, OrderReason::none, 0, now);
    return Work::begin;
  }
  return Work::none;
}

bool HeldOrder::meets_obstacle(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (!moves(slot)) {
      continue;
    }
    const ilk_axis_t& axis = snapshot.state.axis[slot];
    if (const auto obstacle = obstacle_of(snapshot, slot)) {
      fail(obstacle->reason, obstacle->code, slot, now);
      return true;
    }
    if (axis.state == ILK_AXIS_HOMING || axis.homed == 0) {
      const bool homing = axis.state == ILK_AXIS_HOMING;
      fail(homing ? OrderReason::axis_homing : OrderReason::not_homed, 0, slot, now);
      return true;
    }
  }
  return false;
}

void HeldOrder::on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  const bool routine = verdict == ILK_VERDICT_ACCEPTED || verdict == ILK_VERDICT_MODE;
  if (!routine && origin.proposal == status_.proposal && is_open()) {
    slot_ = origin.slot;
    set_phase(OrderPhase::refused, OrderReason::kernel_refused, verdict, tick);
  }
}

}  // namespace interlock
