#include "motion/rest_aim.hpp"

#include <algorithm>
#include <cmath>

#include "motion/setpoint_range.hpp"

namespace interlock {

RestAim::RestAim(const AxisPlan& plan) noexcept : deadband_counts_(plan.rules.deadband_counts) {
  if (const auto map = DriveMap::create(plan.control.drive)) {
    const double slowest = map->speed(plan.control.drive.min_drive, 1);
    const double coast = std::floor(slowest * plan.control.piv.lead_s);
    beyond_counts_ = deadband_counts_ -
                     static_cast<std::int64_t>(std::clamp(coast, 0.0, static_cast<double>(deadband_counts_)));
  }
}

std::int32_t RestAim::setpoint(std::int32_t target_counts, std::int32_t position_counts) noexcept {
  const std::int64_t left = std::int64_t{target_counts} - position_counts;
  const bool is_near = left <= deadband_counts_ && left >= -deadband_counts_;
  if (left != 0 && (!is_near || way_ == 0)) {
    way_ = left > 0 ? 1 : -1;
  }
  return saturated(target_counts + way_ * beyond_counts_);
}

}  // namespace interlock
