#include "http/navigation_state.hpp"

#include <algorithm>
#include <utility>

#include "http/alignment_view.hpp"
#include "robot/catalog.hpp"

namespace interlock::web {
namespace {

using igtl::StatusCode;

/** The probe is as far out as it goes. */
constexpr double probe_out_mm = 0.5;

/** Of each axis, in its unit; none without a kernel. */
std::vector<double> positions_in(const Robot& robot, const ControlView& view) {
  std::vector<double> positions;
  for (const Axis& axis : robot.axes) {
    if (view.attached) {
      positions.push_back(axis.to_unit(view.snapshot.state.axis[axis.slot].position_counts));
    }
  }
  return positions;
}

igtl::Status health_of(const ControlView& view) {
  if (!view.attached) {
    return {StatusCode::not_ready, 0, "NO_KERNEL", "No kernel is connected."};
  }
  const std::string mode = catalog::name(catalog::Family::mode, view.snapshot.state.mode);
  if (view.snapshot.state.mode == ILK_MODE_LOCKED) {
    return {StatusCode::hardware_failure, 0, mode, "The kernel is locked; the console says why."};
  }
  return {StatusCode::ok, 0, mode, "The kernel is in mode " + mode + "."};
}

}  // namespace

void AxisVelocities::measure(const Robot& robot, const ControlView& view) {
  const std::uint32_t before_tick = std::exchange(tick_, view.snapshot.state.tick);
  const std::vector<double> before = std::exchange(positions_, positions_in(robot, view));
  const double seconds = static_cast<double>(tick_ - before_tick) * robot.period_us * 1e-6;
  velocities_.clear();
  if (before.size() == positions_.size() && seconds > 0.0) {
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      velocities_.push_back((positions_[i] - before[i]) / seconds);
    }
  }
}

igtl::RobotState robot_state(const Context& context, const Targeting& targeting,
                             const AxisVelocities& velocities) {
  const ControlView& view = context.view();
  igtl::RobotState state;
  state.scanner_from_robot = targeting.registration;
  state.entry = targeting.entry_point;
  state.target = targeting.target_point;
  state.treatment_to_tip_mm = targeting.treatment_to_tip_mm;
  state.robot_to_entry_mm = targeting.robot_to_entry_mm;
  state.cannula_to_treatment_mm = targeting.cannula_to_treatment_mm;
  state.treatment_to_robot_at_home_mm = targeting.treatment_to_robot_at_home_mm;
  state.mode = context.book.app_mode();
  state.health = health_of(view);
  const RobotPoses poses = robot_poses(context.robot, targeting, view);
  state.measured_cp = poses.current;
  state.desired_cp = poses.desired;
  state.measured_jp = positions_in(context.robot, view);
  state.measured_jv = velocities.units_per_s();
  if (!poses.setpoints.empty()) {
    state.desired_jp = state.measured_jp;
  }
  for (std::size_t i = 0; i < state.desired_jp.size(); ++i) {
    const Axis& axis = context.robot.axes[i];
    const auto setpoint = std::ranges::find(poses.setpoints, axis.slot, &AxisSetpoint::slot);
    if (setpoint != poses.setpoints.end()) {
      state.desired_jp[i] = axis.to_unit(setpoint->counts);
    }
  }
  const Axis* insertion = context.robot.with_role("insertion");
  if (insertion != nullptr && view.attached) {
    const ilk_axis_t& axis = view.snapshot.state.axis[insertion->slot];
    const double beyond =
        insertion->to_unit(axis.position_counts) - insertion->to_unit(insertion->lowest_setpoint_counts());
    state.is_probe_out = axis.homed != 0 && beyond <= probe_out_mm;
  }
  return state;
}

}  // namespace interlock::web
