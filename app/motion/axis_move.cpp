#include "motion/axis_move.hpp"

#include <algorithm>

#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

constexpr std::uint32_t held_back_ticks = 500;

bool is_limit(std::uint32_t gate) noexcept {
  return gate == ILK_GATE_HARD_LIMIT || gate == ILK_GATE_SOFT_LIMIT || gate == ILK_GATE_UNHOMED_TRAVEL;
}

}  // namespace

void AxisMove::aim(std::int32_t target_counts, std::uint32_t max_drive) noexcept {
  target_counts_ = target_counts;
  max_drive_ = max_drive;
}

void AxisMove::start(const ilk_snapshot_t& snapshot) noexcept {
  rest_.restart(snapshot.state.axis[slot_].position_counts, snapshot.state.system.tick);
  unblocked_tick_ = snapshot.state.system.tick;
  lease_.renew_at_once();
}

AxisMove::Progress AxisMove::watch(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
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
    unblocked_tick_ = snapshot.state.system.tick;
  }
  return snapshot.state.system.tick - unblocked_tick_ >= held_back_ticks;
}

void AxisMove::hold(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  const ilk_axis_t& axis = snapshot.state.axis[slot_];
  // The kernel takes no setpoint beyond this range: the target it may refuse, what leads to it has to be
  // within.
  const SetpointRange range = setpoint_range(plan_.rules, axis, snapshot.state.system.mode);
  const std::int32_t beyond = rest_aim_.setpoint(target_counts_, axis.position_counts);
  const bool is_taken = beyond >= range.lowest_counts && beyond <= range.highest_counts;
  lease_.hold(task, snapshot.state.system.tick, is_taken ? beyond : target_counts_, desired_drive(axis),
              requests);
}

std::uint32_t AxisMove::desired_drive(const ilk_axis_t& axis) const noexcept {
  return law_of(plan_, axis, max_drive_).at(distance(axis.position_counts, target_counts_));
}

DriveLaw AxisMove::law_of(const AxisPlan& plan, const ilk_axis_t& axis, std::uint32_t max_drive) noexcept {
  const std::uint32_t bound = drive_bound(plan.rules, axis);
  const std::uint32_t ceiling = max_drive == 0 ? bound : std::min(bound, max_drive);
  return drive_law(plan.rules, plan.drive, ceiling);
}

}  // namespace interlock
