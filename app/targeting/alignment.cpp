#include "targeting/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace interlock {
namespace {

AxisSetpoint setpoint_of(const Axis& axis, double position) {
  const std::int32_t lowest = axis.lowest_setpoint_counts();
  const std::int32_t highest = axis.highest_setpoint_counts();
  const double within = std::clamp(position, axis.to_unit(lowest), axis.to_unit(highest));
  const std::int32_t counts = std::clamp(axis.to_counts(within).value_or(lowest), lowest, highest);
  const double half_count = 0.5 / std::abs(axis.counts_per_unit);
  return {axis.slot, counts, std::abs(within - position) > half_count};
}

}  // namespace

bool is_tolerable(const Deviation& deviation, double tolerance_mm, double tolerance_deg) noexcept {
  return deviation.distance_mm <= tolerance_mm &&
         deviation.angle_rad * 180.0 / std::numbers::pi <= tolerance_deg;
}

KinematicsResult<Alignment> align(const Robot& robot, const RobotKinematics& kinematics,
                                  const Registration& registration, const EntryTarget& aim) {
  const Pose& scanner_from_zframe = registration.scanner_from_zframe();
  const Pose zframe_from_scanner = scanner_from_zframe.inverse();
  const auto exact = kinematics.positions_for(zframe_from_scanner * aim.entry,
                                              zframe_from_scanner * aim.target, aim.rotation_rad);
  const auto desired =
      exact.and_then([&](const AxisPositions& reach) { return kinematics.zframe_from_treatment(reach); });
  if (!desired) {
    return tl::unexpected(desired.error());
  }
  Alignment alignment;
  AxisPositions positions = *exact;
  for (std::size_t place = 0; place < positions.size(); ++place) {
    if (const Axis& axis = robot.axes[place]; !axis.role.empty()) {
      alignment.setpoints.push_back(setpoint_of(axis, positions[place]));
      positions[place] = axis.to_unit(alignment.setpoints.back().counts);
    }
  }
  return kinematics.zframe_from_treatment(positions).map([&](const Pose& reached) {
    alignment.desired = scanner_from_zframe * *desired;
    alignment.reachable = scanner_from_zframe * reached;
    alignment.reachable_tip =
        alignment.reachable * Eigen::Vector3d(0.0, 0.0, kinematics.probe().treatment_to_tip_mm);
    alignment.error_budget = error_budget_of(robot, kinematics, scanner_from_zframe, positions, aim.accuracy);
    alignment.deviation = deviation(alignment.reachable, alignment.desired);
    if (const auto depth_mm = kinematics.depth_mm(positions)) {
      const double length_mm =
          *depth_mm + kinematics.probe().robot_to_entry_mm - kinematics.probe().cannula_to_treatment_mm;
      alignment.cannula_length_mm = length_mm > 0.0 ? std::optional(length_mm) : std::nullopt;
    }
    return alignment;
  });
}

}  // namespace interlock
