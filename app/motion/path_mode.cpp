#include "motion/path_mode.hpp"

namespace interlock {
namespace {

/** For axes that lag behind the end of their path; the slowest settling seen on the plant takes a tenth. */
constexpr double settle_s = 5.0;

}  // namespace

PathMode::PathMode(const RobotPlan& plan)
    : period_s_(plan.period_s()),
      settle_ticks_(static_cast<std::uint32_t>(settle_s / plan.period_s())),
      walk_(plan),
      order_(plan.patience_ticks()) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    trackers_[slot] = AxisTracker(slot, plan.axis[slot], plan.lease_ticks());
  }
}

void PathMode::take(const PathOrder& order, std::uint32_t tick) noexcept {
  program_ = order.program;
  leg_ = 0;
  order_.take(order.proposal, program_->mask(), tick);
  if (program_->legs.empty()) {
    order_.finish(OrderReason::arrived, tick);
  } else {
    walk_.take(program_->legs.front());
  }
  tell();
}

void PathMode::end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept {
  order_.end(proposal, reason, tick);
  tell();
}

void PathMode::end_all(OrderReason reason, std::uint32_t tick) noexcept {
  order_.end_all(reason, tick);
  tell();
}

/** Axes that a later leg moves count as well: what could not be carried out whole is not begun. */
void PathMode::end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept {
  order_.end_axis(slot, reason, tick);
  tell();
}

void PathMode::tick(const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept {
  switch (order_.judge(snapshot)) {
    case HeldOrder::Work::begin:
      begin(snapshot);
      break;
    case HeldOrder::Work::go_on:
      follow(snapshot);
      break;
    case HeldOrder::Work::none:
      break;
  }
  tell();
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (follows(slot)) {
      trackers_[slot].hold(status_.order.proposal, snapshot, points_[slot], wishes);
    } else {
      trackers_[slot].let_go(status_.order.proposal, snapshot, wishes);
    }
  }
}

std::optional<Setpoint> PathMode::setpoint(std::uint32_t slot) const noexcept {
  return slot < ILK_SLOTS && follows(slot) ? std::optional(points_[slot].now) : std::nullopt;
}

/** Begins the leg, or goes on with it after a pause. */
void PathMode::begin(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  std::array<double, ILK_SLOTS> velocities{};
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    velocities[slot] = trackers_[slot].velocity_counts_per_s();
  }
  if (!walk_.begin(snapshot, velocities)) {
    order_.end_all(OrderReason::no_path, now);
    return;
  }
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    trackers_[slot].start(snapshot);
  }
  points_ = walk_.points();
  seen_tick_ = now;
  end_tick_ = now;
  resting_ = false;
}

void PathMode::follow(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
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
      order_.fail(OrderReason::off_path, 0, slot, snapshot.state.system.tick);
      return true;
    }
  }
  return false;
}

/** At the end of the path: all axes come to rest, and rest for as long as the leg says. */
void PathMode::settle(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  std::uint32_t late = ILK_SLOTS;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (moves(slot) && !trackers_[slot].arrived(snapshot, points_[slot])) {
      late = slot;
    }
  }
  if (late != ILK_SLOTS) {
    resting_ = false;
    if (now - end_tick_ > settle_ticks_) {
      order_.fail(OrderReason::goal_late, snapshot.gate[late], late, now);
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
  const std::uint32_t now = snapshot.state.system.tick;
  resting_ = false;
  end_tick_ = now;
  if (walk_.go_on()) {
    return;
  }
  if (leg_ + 1 == program_->legs.size()) {
    order_.finish(OrderReason::arrived, now);
    return;
  }
  ++leg_;
  walk_.take(program_->legs[leg_]);
  begin(snapshot);
}

void PathMode::tell() noexcept { status_ = {order_.status(), leg_, order_.slot()}; }

void PathMode::on_unsent(const Wish& wish) noexcept {
  if (wish.origin.slot < ILK_SLOTS && wish.origin.proposal == status_.order.proposal) {
    trackers_[wish.origin.slot].on_unsent();
  }
}

void PathMode::on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  order_.on_verdict(origin, verdict, tick);
  tell();
}

void PathMode::on_verdict_lost(const WishOrigin& /*origin*/, std::uint32_t /*tick*/) noexcept {
  // A MOVE is renewed before its lease runs out, and each renewal has a verdict of its own.
}

}  // namespace interlock
