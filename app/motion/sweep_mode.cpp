#include "motion/sweep_mode.hpp"

#include <cmath>

#include "control/frequency_map.hpp"
#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

/** Twenty lags of the motor on the plant: then its speed is that of the frequency. */
constexpr double settle_s = 0.1;

}  // namespace

SweepMode::SweepMode(const RobotPlan& plan)
    : plan_(plan),
      settle_ticks_(static_cast<std::uint32_t>(settle_s / plan.period_s())),
      order_(plan.patience_ticks()) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    leases_[slot] = MoveLease(slot, plan.axis[slot], plan.lease_ticks());
  }
}

void SweepMode::take(const SweepOrder& order, std::uint32_t tick) noexcept {
  sweep_ = order;
  status_ = SweepStatus{};
  order_.take(order.proposal, 1u << order.slot, tick);
  status_.order = order_.status();
  upwards_ = true;
  turning_ = false;
  driven_ticks_ = 0;
  measured_ticks_ = 0;
  measured_counts_ = 0.0;
}

void SweepMode::end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept {
  order_.end(proposal, reason, tick);
  status_.order = order_.status();
}

void SweepMode::end_all(OrderReason reason, std::uint32_t tick) noexcept {
  order_.end_all(reason, tick);
  status_.order = order_.status();
}

void SweepMode::end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept {
  order_.end_axis(slot, reason, tick);
  status_.order = order_.status();
}

void SweepMode::tick(const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept {
  switch (order_.judge(snapshot)) {
    case HeldOrder::Work::begin:
      begin(snapshot);
      break;
    case HeldOrder::Work::go_on:
      go_on(snapshot);
      break;
    case HeldOrder::Work::none:
      break;
  }
  status_.order = order_.status();
  const bool drives = order_.executes() && !turning_;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (drives && slot == sweep_.slot) {
      const std::uint32_t drive = frequency_map::drive_at(sweep_.steps.word(status_.step));
      leases_[slot].hold(sweep_.proposal, snapshot.state.system.tick, target_counts(snapshot), drive, wishes);
    } else {
      leases_[slot].let_go(sweep_.proposal, snapshot, wishes);
    }
  }
}

/** From the start, or where the pedal was released: the way that the axis went is not ended by a pause. */
void SweepMode::begin(const ilk_snapshot_t& snapshot) noexcept {
  seen_tick_ = snapshot.state.system.tick;
  seen_counts_ = snapshot.state.axis[sweep_.slot].position_counts;
  steady_ticks_ = 0;
  leases_[sweep_.slot].renew_at_once();
}

void SweepMode::go_on(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  const ilk_axis_t& axis = snapshot.state.axis[sweep_.slot];
  const ilk_axis_config_t& rules = plan_.axis[sweep_.slot].rules;
  if (turning_) {
    if (rest_.rests(axis.position_counts, rules.noise_counts, now)) {
      turning_ = false;
      upwards_ = !upwards_;
      begin(snapshot);
    }
    return;
  }
  measure(axis, now - seen_tick_);
  seen_tick_ = now;
  seen_counts_ = axis.position_counts;
  if (driven_ticks_ >= sweep_.steps.dwell_ticks) {
    end_step(now);
  }
  if (order_.is_open() && distance(axis.position_counts, target_counts(snapshot)) <= rules.coast_counts) {
    turning_ = true;
    rest_.restart(axis.position_counts, now);
  }
}

void SweepMode::measure(const ilk_axis_t& axis, std::uint32_t ticks) noexcept {
  driven_ticks_ += ticks;
  if (steady_ticks_ >= settle_ticks_) {
    measured_ticks_ += ticks;
    measured_counts_ += static_cast<double>(distance(axis.position_counts, seen_counts_));
  }
  steady_ticks_ += ticks;
}

void SweepMode::end_step(std::uint32_t tick) noexcept {
  if (measured_ticks_ != 0) {
    status_.counts_per_s[status_.step] =
        static_cast<float>(measured_counts_ / (measured_ticks_ * plan_.period_s()));
  }
  driven_ticks_ = 0;
  steady_ticks_ = 0;
  measured_ticks_ = 0;
  measured_counts_ = 0.0;
  ++status_.step;
  if (status_.step == sweep_.steps.count) {
    order_.finish(OrderReason::swept, tick);
  }
}

std::int32_t SweepMode::target_counts(const ilk_snapshot_t& snapshot) const noexcept {
  const SetpointRange range = setpoint_range(plan_.axis[sweep_.slot].rules, snapshot.state.axis[sweep_.slot],
                                             snapshot.state.system.mode);
  return upwards_ ? range.highest_counts : range.lowest_counts;
}

void SweepMode::on_unsent(const Wish& wish) noexcept {
  if (wish.origin.proposal == sweep_.proposal && wish.origin.slot < ILK_SLOTS) {
    leases_[wish.origin.slot].on_unsent();
  }
}

void SweepMode::on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  order_.on_verdict(origin, verdict, tick);
  status_.order = order_.status();
}

void SweepMode::on_verdict_lost(const WishOrigin& /*origin*/, std::uint32_t /*tick*/) noexcept {
  // A MOVE is renewed before its lease runs out, and each renewal has a verdict of its own.
}

}  // namespace interlock
