#include "service/registration_watch.hpp"

#include <cstdlib>
#include <utility>

#include "proposals/checks.hpp"

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

std::string RegistrationWatch::look(Watched& watched, const ilk_axis_t& now) const {
  const ilk_axis_config_t& rules = config_.axis[watched.axis->slot];
  const ilk_axis_t then = std::exchange(watched.last, now);
  if (now.homed == ILK_HOMED_NOT) {
    const bool is_homing = now.state == ILK_AXIS_HOMING;
    watched.is_rehomed = watched.is_rehomed || (then.homed != ILK_HOMED_NOT && is_homing);
    const bool is_lost = then.homed != ILK_HOMED_NOT && !is_homing;
    return is_lost ? watched.axis->title + " lost its home." : "";
  }
  if (then.homed == ILK_HOMED_NOT) {
    const bool is_rehomed = std::exchange(watched.is_rehomed, false);
    const std::uint32_t difference = static_cast<std::uint32_t>(std::abs(now.home_difference_counts));
    const bool is_there = now.homed == ILK_HOMED_BY_SWITCH && difference <= rules.home_tolerance_counts;
    return is_rehomed && !is_there ? watched.axis->title + " was homed at another place." : "";
  }
  return keeps_reference(rules, then, now) ? "" : watched.axis->title + " was given another home.";
}

}  // namespace interlock
