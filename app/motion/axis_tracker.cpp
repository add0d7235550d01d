#include "motion/axis_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "motion/drive_law.hpp"
#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

/** Speed for each count behind the path, per second: slow beside the motor's lag of some milliseconds, so
 * that catching up does not swing. */
constexpr double catch_up_per_s = 20.0;

std::int32_t rounded(double counts) noexcept { return saturated(std::llround(counts)); }

}  // namespace

void AxisTracker::start(const ilk_snapshot_t& snapshot) noexcept {
  rest_.restart(snapshot.state.axis[slot_].position_counts, snapshot.state.tick);
  lease_.renew_at_once();
}

bool AxisTracker::off_path(const ilk_snapshot_t& snapshot, const PathPoint& point) const noexcept {
  const double error = point.position - snapshot.state.axis[slot_].position_counts;
  return !(std::abs(error) <= plan_.rates.following_error_counts);
}

bool AxisTracker::arrived(const ilk_snapshot_t& snapshot, const PathPoint& point) noexcept {
  const std::int32_t position = snapshot.state.axis[slot_].position_counts;
  if (distance(position, rounded(point.position)) > plan_.rules.deadband_counts) {
    rest_.restart(position, snapshot.state.tick);
    return false;
  }
  return rest_.rests(position, plan_.rules.noise_counts, snapshot.state.tick);
}

void AxisTracker::hold(std::uint32_t proposal, const ilk_snapshot_t& snapshot, const PathPoint& point,
                       Wishes& wishes) noexcept {
  const std::int32_t position = snapshot.state.axis[slot_].position_counts;
  std::int32_t target = rounded(point.position);
  std::uint32_t drive = 0;
  if (point.velocity == 0.0) {
    drive = drive_law(plan_.rules, plan_.min_drive, plan_.rules.max_drive).at(distance(position, target));
  } else {
    const double forward = point.velocity > 0.0 ? 1.0 : -1.0;
    const double behind = forward * (point.position - position);
    target = rounded(forward * std::max(forward * point.ahead, forward * point.position));
    drive = drive_at(forward * point.velocity + catch_up_per_s * behind);
  }
  // An axis that has just homed stands nearer to its limit than any setpoint may be.
  const SetpointRange range = setpoint_range(plan_.rules, snapshot.state.axis[slot_], snapshot.state.mode);
  target = std::clamp(target, range.lowest_counts, range.highest_counts);
  lease_.hold(proposal, snapshot.state.tick, target, drive, wishes);
}

std::uint32_t AxisTracker::drive_at(double counts_per_s) const noexcept {
  const double share = counts_per_s / plan_.rates.full_speed_counts_per_s;
  return static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * plan_.rules.max_drive);
}

}  // namespace interlock
