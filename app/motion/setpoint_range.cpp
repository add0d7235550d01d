#include "motion/setpoint_range.hpp"

#include <algorithm>
#include <limits>

namespace interlock {
std::int32_t saturated(std::int64_t counts) noexcept {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(counts, std::numeric_limits<std::int32_t>::min(),
                                                            std::numeric_limits<std::int32_t>::max()));
}

SetpointRange setpoint_range(const ilk_axis_config_t& rules, const ilk_axis_t& axis,
                             std::uint32_t mode) noexcept {
  const std::int64_t coast = rules.coast_counts;
  if (axis.homed != 0) {
    return {saturated(rules.min_counts + coast), saturated(rules.max_counts - coast)};
  }
  const std::int64_t travelled = mode == ILK_MODE_MOTION ? axis.press_travel_counts : 0;
  const std::int64_t pressed_at = axis.position_counts - travelled;
  const std::int64_t reach = rules.unhomed_travel_counts - coast;
  return {saturated(pressed_at - reach), saturated(pressed_at + reach)};
}

std::uint32_t drive_bound(const ilk_axis_config_t& rules, const ilk_axis_t& axis) noexcept {
  return axis.homed != 0 ? rules.max_drive : rules.unhomed_max_drive;
}

}  // namespace interlock
