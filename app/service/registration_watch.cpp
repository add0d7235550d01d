#include "service/registration_watch.hpp"

#include <cstdint>
#include <cstdlib>
#include <utility>

namespace interlock {

RegistrationWatch::RegistrationWatch(const Robot& robot, const ilk_config_t& config) : config_(config) {
  for (const Axis& axis : robot.axes) {
    if (!axis.role.empty()) {
      axes_.push_back({&axis});
    }
  }
}

std::string RegistrationWatch::see(const ControlView& view) {
  std::string reasons;
  for (Watched& each : axes_) {
    if (view.attached) {
      const std::string reason = look(each, view.snapshot.state.axis[each.axis->slot]);
      reasons += (reasons.empty() || reason.empty() ? "" : " ") + reason;
    }
  }
  return reasons;
}

/** Many small differences of homing count together: each is compared with the first home. A home by hand is
 * wherever somebody says: what was set while the axis had none rests on nothing. */
std::string RegistrationWatch::look(Watched& watched, const ilk_axis_t& now) const {
  const ilk_axis_config_t& rules = config_.axis[watched.axis->slot];
  const bool is_first = !watched.homed;
  const std::uint32_t before = std::exchange(watched.homed, now.homed).value_or(ILK_HOMED_NOT);
  if (now.homed == ILK_HOMED_NOT) {
    const bool is_homing = now.state == ILK_AXIS_HOMING;
    watched.is_rehomed = watched.is_rehomed || (before != ILK_HOMED_NOT && is_homing);
    const bool is_lost = before != ILK_HOMED_NOT && !is_homing;
    return is_lost ? watched.axis->title + " lost its home." : "";
  }
  const auto position = static_cast<std::uint32_t>(now.position_counts);
  const std::uint32_t origin = rules.direction_correction != 0 ? now.raw + position : now.raw - position;
  const std::uint32_t last = std::exchange(watched.last_origin, origin);
  if (before != ILK_HOMED_NOT && origin == last) {
    return "";
  }
  const bool is_rehomed = std::exchange(watched.is_rehomed, false);
  const std::int64_t shift = static_cast<std::int32_t>(origin - watched.origin);
  const bool is_there = now.homed == ILK_HOMED_BY_SWITCH && std::abs(shift) <= rules.home_tolerance_counts;
  if (before == ILK_HOMED_NOT && is_rehomed && is_there) {
    return "";
  }
  watched.origin = origin;
  return before != ILK_HOMED_NOT                       ? watched.axis->title + " was given another home."
         : is_rehomed                                  ? watched.axis->title + " was homed at another place."
         : !is_first && now.homed == ILK_HOMED_BY_HAND ? watched.axis->title + " was given a home."
                                                       : "";
}

}  // namespace interlock
