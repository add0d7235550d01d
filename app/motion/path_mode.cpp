#include "motion/path_mode.hpp"

#include "motion/obstacle.hpp"

namespace interlock {
namespace {

/** For axes that lag behind the end of their path; the slowest settling seen on the plant takes a tenth. */
constexpr double settle_s = 5.0;

}  // namespace

PathMode::PathMode(const RobotPlan& plan)
    : period_s_(plan.period_s()),
      patience_ticks_(plan.patience_ticks()),
      settle_ticks_(static_cast<std::uint32_t>(settle_s / plan.period_s())),
      walk_(plan) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    trackers_[slot] = AxisTracker(slot, plan.axis[slot], plan.lease_ticks());
  }
}

void PathMode::set_phase(OrderPhase phase, OrderReason reason, std::uint32_t code,
                         std::uint32_t tick) noexcept {
  status_.order = {order_.proposal, phase, reason, code, tick};
}

void PathMode::fail(OrderReason reason, std::uint32_t code, std::uint32_t slot, std::uint32_t tick) noexcept {
  status_.slot = slot;
  set_phase(OrderPhase::aborted, reason, code, tick);
}

void PathMode::take(const PathOrder& order, std::uint32_t tick) noexcept {
  order_ = order;
  status_ = PathStatus{};
  involved_ = order.program->mask();
  idle_since_ = tick;
  if (order.program->legs.empty()) {
    set_phase(OrderPhase::done, OrderReason::arrived, 0, tick);
    return;
  }
  walk_.take(order.program->legs.front());
  set_phase(OrderPhase::waiting, OrderReason::none, 0, tick);
}

void PathMode::end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept {
  if (order_.proposal == proposal) {
    end_all(reason, tick);
  }
}

void PathMode::end_all(OrderReason reason, std::uint32_t tick) noexcept {
  if (is_open()) {
    set_phase(OrderPhase::aborted, reason, 0, tick);
  }
}

void PathMode::end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept {
  if (is_open() && slot < ILK_SLOTS && ((involved_ >> slot) & 1u) != 0) {
    fail(reason, 0, slot, tick);
  }
}

void PathMode::tick(const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept {
  if (is_open()) {
    judge(snapshot);
  }
  const bool executing = status_.order.phase == OrderPhase::executing;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (executing && moves(slot)) {
      trackers_[slot].hold(order_.proposal, snapshot, points_[slot], wishes);
    } else {
      trackers_[slot].let_go(order_.proposal, snapshot, wishes);
    }
  }
}

void PathMode::judge(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  if (meets_obstacle(snapshot)) {
    return;
  }
  if (snapshot.state.mode == ILK_MODE_MOTION) {
    go(snapshot);
  } else if (status_.order.phase == OrderPhase::executing) {
    set_phase(OrderPhase::paused, OrderReason::pedal_released, 0, now);
    idle_since_ = now;
  } else if (waited_too_long(now)) {
    set_phase(OrderPhase::expired, OrderReason::waited_too_long, 0, now);
  }
}

/** Axes that a later leg moves count as well: what could not be carried out whole is not begun. */
bool PathMode::meets_obstacle(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (((involved_ >> slot) & 1u) == 0) {
      continue;
    }
    const ilk_axis_t& axis = snapshot.state.axis[slot];
    if (const auto obstacle = obstacle_of(snapshot, slot)) {
      fail(obstacle->reason, obstacle->code, slot, now);
    } else if (axis.state == ILK_AXIS_HOMING) {
      fail(OrderReason::axis_homing, 0, slot, now);
    } else if (axis.homed == 0) {
      fail(OrderReason::not_homed, 0, slot, now);
    }
    if (!is_open()) {
      return true;
    }
  }
  return false;
}

bool PathMode::waited_too_long(std::uint32_t tick) const noexcept {
  return tick - idle_since_ > patience_ticks_;
}

void PathMode::go(const ilk_snapshot_t& snapshot) noexcept {
  if (status_.order.phase == OrderPhase::executing) {
    follow(snapshot);
  } else if (waited_too_long(snapshot.state.tick)) {
    set_phase(OrderPhase::expired, OrderReason::waited_too_long, 0, snapshot.state.tick);
  } else {
    begin(snapshot);
  }
}

/** Begins the leg, or goes on with it after a pause. */
void PathMode::begin(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  if (!walk_.begin(snapshot)) {
    set_phase(OrderPhase::aborted, OrderReason::no_path, 0, now);
    return;
  }
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    trackers_[slot].start(snapshot);
  }
  points_ = walk_.points();
  seen_tick_ = now;
  end_tick_ = now;
  resting_ = false;
  set_phase(OrderPhase::executing, OrderReason::none, 0, now);
}

void PathMode::follow(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  const bool was_at_end = walk_.at_end();
  walk_.advance((now - seen_tick_) * period_s_);
  seen_tick_ = now;
  points_ = walk_.points();
  if (strays(snapshot)) {
    return;
  }
  if (!was_at_end) {
    end_tick_ = now;
  } else {
    settle(snapshot);
  }
}

bool PathMode::strays(const ilk_snapshot_t& snapshot) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (moves(slot) && trackers_[slot].off_path(snapshot, points_[slot])) {
      fail(OrderReason::off_path, 0, slot, snapshot.state.tick);
      return true;
    }
  }
  return false;
}

/** At the end of the path: all axes come to rest, and rest for as long as the leg says. */
void PathMode::settle(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  std::uint32_t late = ILK_SLOTS;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (moves(slot) && !trackers_[slot].arrived(snapshot, points_[slot])) {
      late = slot;
    }
  }
  if (late != ILK_SLOTS) {
    resting_ = false;
    if (now - end_tick_ > settle_ticks_) {
      fail(OrderReason::goal_late, snapshot.gate[late], late, now);
    }
    return;
  }
  if (!resting_) {
    resting_ = true;
    rest_tick_ = now;
  }
  end_tick_ = now;
  if ((now - rest_tick_) * period_s_ >= walk_.dwell_s()) {
    end_leg(snapshot);
  }
}

void PathMode::end_leg(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  resting_ = false;
  end_tick_ = now;
  if (walk_.go_on()) {
    return;
  }
  if (status_.leg + 1 == order_.program->legs.size()) {
    set_phase(OrderPhase::done, OrderReason::arrived, 0, now);
    return;
  }
  ++status_.leg;
  walk_.take(order_.program->legs[status_.leg]);
  begin(snapshot);
}

void PathMode::on_unsent(const Wish& wish) noexcept {
  if (wish.origin.slot < ILK_SLOTS && wish.origin.proposal == order_.proposal) {
    trackers_[wish.origin.slot].on_unsent();
  }
}

void PathMode::on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  // MODE says only that the pedal was released between the snapshot and the request; the next snapshot
  // pauses.
  const bool routine = verdict == ILK_VERDICT_ACCEPTED || verdict == ILK_VERDICT_MODE;
  if (!routine && origin.proposal == order_.proposal && is_open()) {
    status_.slot = origin.slot;
    set_phase(OrderPhase::refused, OrderReason::kernel_refused, verdict, tick);
  }
}

void PathMode::on_verdict_lost(const WishOrigin& /*origin*/, std::uint32_t /*tick*/) noexcept {
  // A MOVE is renewed before its lease runs out, and each renewal has a verdict of its own.
}

}  // namespace interlock
