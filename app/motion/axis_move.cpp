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
}

void AxisMove::start(const ilk_snapshot_t& snapshot) noexcept {
  rest_.restart(snapshot.state.axis[slot_].position_counts, snapshot.state.tick);
  unblocked_tick_ = snapshot.state.tick;
  due_at_once_ = true;
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
  const std::uint32_t change = std::max(drive, sent_.drive) - std::min(drive, sent_.drive);
  const bool due = due_at_once_ || !sent_.may_drive || now - sent_.tick >= lease_ticks_ / renewals_per_lease;
  if (due || change > sent_.drive / drive_step_fraction) {
    wishes.add(wish_for(proposal, drive, lease_ticks_));
    note_sent({true, now, drive});
  }
}

void AxisMove::let_go(std::uint32_t proposal, const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept {
  if (!sent_.may_drive) {
    return;
  }
  const std::uint32_t state = snapshot.state.axis[slot_].state;
  const bool may_move = state == ILK_AXIS_MOVING || state == ILK_AXIS_ENABLED;
  if (snapshot.state.mode == ILK_MODE_MOTION && may_move) {
    wishes.add(wish_for(proposal, 0, 1));
  }
  note_sent({false, snapshot.state.tick, 0});
}

void AxisMove::note_sent(const Sent& sent) noexcept {
  before_ = sent_;
  sent_ = sent;
  due_at_once_ = false;
}

void AxisMove::on_unsent() noexcept {
  sent_ = before_;
  due_at_once_ = true;
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
