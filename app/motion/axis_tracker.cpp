#include "motion/axis_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

std::int32_t rounded(double counts) noexcept { return saturated(std::llround(counts)); }

/** A lease ahead, and never behind where the axis should be now. */
std::int32_t aim(const PathPoint& point) noexcept {
  const double now = point.now.position_counts;
  const double velocity = point.now.velocity_counts_per_s;
  const double further =
      velocity < 0.0 ? std::min(now, point.ahead_counts) : std::max(now, point.ahead_counts);
  return rounded(velocity == 0.0 ? now : further);
}

}  // namespace

AxisTracker::AxisTracker(std::uint32_t slot, const AxisPlan& plan, std::uint32_t lease_ticks)
    : slot_(slot), plan_(plan), lease_(slot, plan, lease_ticks), rest_aim_(plan) {
  if (auto controller = AxisController::create(plan.control)) {
    controller_ = *controller;
  }
}

void AxisTracker::start(const ilk_snapshot_t& snapshot) noexcept {
  rest_.restart(snapshot.state.axis[slot_].position_counts, snapshot.state.system.tick);
  lease_.renew_at_once();
}

double AxisTracker::velocity_counts_per_s() const noexcept {
  const auto velocity = controller_ ? controller_->velocity() : std::nullopt;
  const double fastest_noise = (plan_.rules.noise_counts + 1.0) / plan_.control.velocity.window_us * us_per_s;
  return velocity && std::abs(velocity->counts_per_s) > fastest_noise ? velocity->counts_per_s : 0.0;
}

double AxisTracker::lag(const ilk_snapshot_t& snapshot, const PathPoint& point) const noexcept {
  const double velocity = point.now.velocity_counts_per_s;
  const double ahead = point.now.position_counts - snapshot.state.axis[slot_].position_counts;
  const double behind = velocity == 0.0 ? 0.0 : std::copysign(1.0, velocity) * ahead;
  return std::max(0.0, behind) / std::max(1.0, static_cast<double>(plan_.rates.following_error_counts));
}

bool AxisTracker::off_path(const ilk_snapshot_t& snapshot, const PathPoint& point) const noexcept {
  const double error = point.now.position_counts - snapshot.state.axis[slot_].position_counts;
  return !(std::abs(error) <= plan_.rates.following_error_counts);
}

bool AxisTracker::arrived(const ilk_snapshot_t& snapshot, const PathPoint& point) noexcept {
  const std::int32_t position = snapshot.state.axis[slot_].position_counts;
  if (distance(position, rounded(point.now.position_counts)) > plan_.rules.deadband_counts) {
    rest_.restart(position, snapshot.state.system.tick);
    return false;
  }
  return rest_.rests(position, plan_.rules.noise_counts, snapshot.state.system.tick);
}

bool AxisTracker::stays(const ilk_snapshot_t& snapshot, const PathPoint& point) const noexcept {
  return distance(snapshot.state.axis[slot_].position_counts, rounded(point.now.position_counts)) <=
         rest_tolerance_counts(plan_.rules);
}

void AxisTracker::hold(std::uint32_t task, const ilk_snapshot_t& snapshot, const PathPoint& point,
                       KernelRequests& requests) noexcept {
  const ilk_axis_t& axis = snapshot.state.axis[slot_];
  // An axis that has just homed stands nearer to its limit than any setpoint may be.
  const SetpointRange range = setpoint_range(plan_.rules, axis, snapshot.state.system.mode);
  const std::int32_t target = std::clamp(rest_aim_.setpoint(aim(point), axis.position_counts),
                                         range.lowest_counts, range.highest_counts);
  std::uint32_t drive = 0;
  if (controller_) {
    drive = controller_->update(axis, snapshot.state.system.tick, point.now, target).drive;
  }
  lease_.hold(task, snapshot.state.system.tick, target, drive, requests);
}

void AxisTracker::let_go(std::uint32_t task, const ilk_snapshot_t& snapshot,
                         KernelRequests& requests) noexcept {
  if (controller_) {
    controller_->observe(snapshot.state.axis[slot_], snapshot.state.system.tick);
  }
  lease_.let_go(task, snapshot, requests);
}

}  // namespace interlock
