#include "motion/setpoint_range.hpp"

#include <algorithm>
#include <limits>

#include "interlock/kernel.h"

namespace interlock {
std::int32_t saturated(std::int64_t counts) noexcept {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(counts, std::numeric_limits<std::int32_t>::min(),
                                                            std::numeric_limits<std::int32_t>::max()));
}

SetpointRange setpoint_range(const ilk_axis_config_t& rules, const ilk_axis_t& axis,
                             std::uint32_t mode) noexcept {
  if (axis.homed != ILK_HOMED_NOT) {
    const ilk_reach_t reach = ilk_reach(&rules, &axis);
    return {saturated(reach.low), saturated(reach.high)};
  }
  ilk_axis_t in_press = axis;
  if (mode != ILK_MODE_MOTION) {  // the next press begins with its whole budget
    in_press.unhomed_travel_counts = 0;
  }
  // The kernel's measure of the travel may lie by the noise beside the reading of now, and of each renewal.
  const std::int64_t left = std::max<std::int64_t>(
      0, std::int64_t{ilk_unhomed_travel_left(&rules, &in_press)} - 2 * std::int64_t{rules.noise_counts});
  return {saturated(axis.position_counts - left), saturated(axis.position_counts + left)};
}

std::uint32_t drive_bound(const ilk_axis_config_t& rules, const ilk_axis_t& axis) noexcept {
  return ilk_drive_bound(&rules, &axis);
}

}  // namespace interlock
