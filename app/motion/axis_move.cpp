#include "motion/axis_move.hpp"

#include <algorithm>

#include "motion/drive_law.hpp"
#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

constexpr std::uint32_t renewals_per_lease = 3;
constexpr std::uint32_t held_back_ticks = 500;
/** A change of the wanted drive below this fraction of the last one waits for the renewal. */
constexpr std::uint32_t drive_step_fraction = 16;

bool is_limit(std::uint32_t gate) noexcept {
  return gate == ILK_GATE_HARD_LIMIT || gate == ILK_GATE_SOFT_LIMIT || gate == ILK_GATE_UNHOMED_TRAVEL;
}

}  // namespace

void AxisMove::aim(std::int32_t target_counts, std::uint32_t max_drive) noexcept {
  target_counts_ = target_counts;
  max_drive_ = max_drive;
  sent_drive_ = 0;
}

void AxisMove::start(const ilk_snapshot_t& snapshot) noexcept {
  rest_.restart(snapshot.state.axis[slot_].position_counts, snapshot.state.tick);
  unblocked_tick_ = snapshot.state.tick;
  holds_lease_ = false;
}

AxisMove::Progress AxisMove::watch(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  const std::int32_t position = snapshot.state.axis[slot_].position_counts;
  if (distance(position, target_counts_) > plan_.rules.deadband_counts) {
    rest_.restart(position, now);
  } else if (rest_.rests(position, plan_.rules.noise_counts, now)) {
    return Progress::arrived;
  }
  return held_back(snapshot) ? Progress::blocked : Progress::going;
}

bool AxisMove::held_back(const ilk_snapshot_t& snapshot) noexcept {
  if (!is_limit(snapshot.gate[slot_])) {
    unblocked_tick_ = snapshot.state.tick;
  }
  return snapshot.state.tick - unblocked_tick_ >= held_back_ticks;
}

void AxisMove::hold(std::uint32_t proposal, const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept {
  const std::uint32_t now = snapshot.state.tick;
  const std::uint32_t drive = wanted_drive(snapshot.state.axis[slot_]);
  const std::uint32_t change = std::max(drive, sent_drive_) - std::min(drive, sent_drive_);
  const bool due = now - sent_tick_ >= lease_ticks_ / renewals_per_lease;
  if (!holds_lease_ || due || change > sent_drive_ / drive_step_fraction) {
    wishes.add(wish_for(proposal, drive, lease_ticks_));
    holds_lease_ = true;
    sent_tick_ = now;
    sent_drive_ = drive;
  }
}

void AxisMove::let_go(std::uint32_t proposal, const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept {
  if (!holds_lease_) {
    return;
  }
  holds_lease_ = false;
  if (snapshot.state.mode == ILK_MODE_MOTION && snapshot.state.axis[slot_].state == ILK_AXIS_MOVING) {
    wishes.add(wish_for(proposal, 0, 1));
  }
}

std::uint32_t AxisMove::wanted_drive(const ilk_axis_t& axis) const noexcept {
  const std::uint32_t bound = drive_bound(plan_.rules, axis);
  const std::uint32_t ceiling = max_drive_ == 0 ? bound : std::min(bound, max_drive_);
  return drive_law(plan_.rules, plan_.min_drive, ceiling).at(distance(axis.position_counts, target_counts_));
}

Wish AxisMove::wish_for(std::uint32_t proposal, std::uint32_t drive,
                        std::uint32_t lease_ticks) const noexcept {
  return {{ILK_REQUEST_MOVE, slot_, proposal}, target_counts_, drive, plan_.rules.max_amplitude, lease_ticks};
}

}  // namespace interlock
