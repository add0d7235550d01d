#include "motion/manual_mode.hpp"

#include <algorithm>
#include <cstdlib>

#include "motion/drive_law.hpp"
#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

constexpr std::uint32_t longest_lease_ticks = 50;
constexpr std::uint32_t renewals_per_lease = 3;
constexpr std::uint32_t rest_ticks = 50;
constexpr std::uint32_t held_back_ticks = 500;
constexpr std::uint64_t patience_us = 60'000'000;
/** A change of the wanted drive below this fraction of the last one waits for the renewal. */
constexpr std::uint32_t drive_step_fraction = 16;

std::uint64_t distance(std::int32_t a, std::int32_t b) noexcept {
  return static_cast<std::uint64_t>(std::llabs(static_cast<std::int64_t>(a) - b));
}

bool is_limit(std::uint32_t gate) noexcept {
  return gate == ILK_GATE_HARD_LIMIT || gate == ILK_GATE_SOFT_LIMIT || gate == ILK_GATE_UNHOMED_TRAVEL;
}

}  // namespace

ManualMode::ManualMode(const RobotPlan& plan) noexcept
    : plan_(plan),
      lease_ticks_(std::clamp(plan.lease_max_ticks, 1u, longest_lease_ticks)),
      patience_ticks_(static_cast<std::uint32_t>(patience_us / std::max(1u, plan.period_us))) {}

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
  job.order = order;
  job.idle_since = tick;
  job.sent_drive = 0;
  orders_[order.slot] = OrderStatus{order.proposal, OrderPhase::waiting, OrderReason::none, 0, tick};
}

void ManualMode::end(std::uint32_t slot, std::uint32_t proposal, OrderReason reason,
                     std::uint32_t tick) noexcept {
  if (slot < ILK_SLOTS && orders_[slot].proposal == proposal && is_open(orders_[slot].phase)) {
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

MoveWishes ManualMode::tick(const ilk_snapshot_t& snapshot) noexcept {
  MoveWishes wishes;
  const std::uint32_t now = snapshot.state.tick;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    Job& job = jobs_[slot];
    if (is_open(orders_[slot].phase)) {
      judge(slot, snapshot);
    }
    if (orders_[slot].phase == OrderPhase::executing) {
      const std::uint32_t drive = wanted_drive(slot, snapshot.state.axis[slot]);
      const auto change = static_cast<std::uint32_t>(
          distance(static_cast<std::int32_t>(drive), static_cast<std::int32_t>(job.sent_drive)));
      const bool due = now - job.sent_tick >= lease_ticks_ / renewals_per_lease;
      if (!job.holds_lease || due || change > job.sent_drive / drive_step_fraction) {
        wishes.add(wish_for(slot, drive, lease_ticks_));
        job.holds_lease = true;
        job.sent_tick = now;
        job.sent_drive = drive;
      }
    } else if (job.holds_lease) {
      job.holds_lease = false;
      if (snapshot.state.mode == ILK_MODE_MOTION && snapshot.state.axis[slot].state == ILK_AXIS_MOVING) {
        wishes.add(wish_for(slot, 0, 1));
      }
    }
  }
  return wishes;
}

void ManualMode::judge(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  const ilk_axis_t& axis = snapshot.state.axis[slot];
  if (snapshot.state.mode != ILK_MODE_READY && snapshot.state.mode != ILK_MODE_MOTION) {
    set_phase(slot, OrderPhase::aborted, OrderReason::locked, snapshot.state.cause, now);
  } else if (axis.state == ILK_AXIS_FAULTED) {
    set_phase(slot, OrderPhase::aborted, OrderReason::axis_faulted, axis.fault, now);
  } else if (axis.state == ILK_AXIS_HOMING) {
    set_phase(slot, OrderPhase::aborted, OrderReason::axis_homing, 0, now);
  } else if (axis.state != ILK_AXIS_ENABLED && axis.state != ILK_AXIS_MOVING) {
    set_phase(slot, OrderPhase::aborted, OrderReason::axis_disabled, 0, now);
  } else if (snapshot.state.mode == ILK_MODE_MOTION) {
    follow(slot, snapshot);
  } else {
    pause_or_expire(slot, snapshot);
  }
}

void ManualMode::pause_or_expire(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  Job& job = jobs_[slot];
  if (orders_[slot].phase == OrderPhase::executing) {
    set_phase(slot, OrderPhase::paused, OrderReason::pedal_released, 0, now);
    job.idle_since = now;
  } else if (now - job.idle_since > patience_ticks_) {
    set_phase(slot, OrderPhase::expired, OrderReason::waited_too_long, 0, now);
  }
}

void ManualMode::follow(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  Job& job = jobs_[slot];
  if (orders_[slot].phase != OrderPhase::executing) {
    if (now - job.idle_since > patience_ticks_) {
      set_phase(slot, OrderPhase::expired, OrderReason::waited_too_long, 0, now);
      return;
    }
    set_phase(slot, OrderPhase::executing, OrderReason::none, 0, now);
    job.rest_position = snapshot.state.axis[slot].position_counts;
    job.rest_since = now;
    job.unblocked_tick = now;
    job.holds_lease = false;
    return;
  }
  if (at_rest_on_target(slot, snapshot)) {
    set_phase(slot, OrderPhase::done, OrderReason::arrived, 0, now);
  } else if (held_back(slot, snapshot)) {
    set_phase(slot, OrderPhase::aborted, OrderReason::blocked, snapshot.gate[slot], now);
  }
}

bool ManualMode::at_rest_on_target(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  Job& job = jobs_[slot];
  const ilk_axis_config_t& rules = plan_.axis[slot].rules;
  const std::int32_t position = snapshot.state.axis[slot].position_counts;
  const bool on_target = distance(position, job.order.target_counts) <= rules.deadband_counts;
  const bool still = distance(position, job.rest_position) <= rules.noise_counts;
  if (!on_target || !still) {
    job.rest_position = position;
    job.rest_since = snapshot.state.tick;
    return false;
  }
  return snapshot.state.tick - job.rest_since >= rest_ticks;
}

bool ManualMode::held_back(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  Job& job = jobs_[slot];
  if (!is_limit(snapshot.gate[slot])) {
    job.unblocked_tick = snapshot.state.tick;
  }
  return snapshot.state.tick - job.unblocked_tick >= held_back_ticks;
}

std::uint32_t ManualMode::wanted_drive(std::uint32_t slot, const ilk_axis_t& axis) const noexcept {
  const AxisPlan& plan = plan_.axis[slot];
  const Order& order = jobs_[slot].order;
  const std::uint32_t bound = drive_bound(plan.rules, axis);
  const std::uint32_t ceiling = order.max_drive == 0 ? bound : std::min(bound, order.max_drive);
  return drive_law(plan.rules, plan.min_drive, ceiling)
      .at(distance(axis.position_counts, order.target_counts));
}

MoveWish ManualMode::wish_for(std::uint32_t slot, std::uint32_t drive,
                              std::uint32_t lease_ticks) const noexcept {
  const Order& order = jobs_[slot].order;
  return {order.proposal, slot, order.target_counts, drive, plan_.axis[slot].rules.max_amplitude,
          lease_ticks};
}

void ManualMode::on_unsent(const MoveWish& wish) noexcept { jobs_[wish.slot].holds_lease = wish.drive == 0; }

void ManualMode::on_verdict(std::uint32_t slot, std::uint32_t proposal, std::uint32_t verdict,
                            std::uint32_t tick) noexcept {
  // MODE says only that the pedal was released between the snapshot and the request; the next snapshot
  // pauses.
  if (verdict == ILK_VERDICT_ACCEPTED || verdict == ILK_VERDICT_MODE) {
    return;
  }
  if (slot < ILK_SLOTS && orders_[slot].proposal == proposal && is_open(orders_[slot].phase)) {
    set_phase(slot, OrderPhase::refused, OrderReason::kernel_refused, verdict, tick);
  }
}

}  // namespace interlock
