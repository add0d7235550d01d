#include "service/navigation_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "robot/catalog.hpp"
#include "service/alignment_view.hpp"

namespace interlock {
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
  const std::string mode = catalog::name(catalog::Family::mode, view.snapshot.state.system.mode);
  if (view.snapshot.state.system.mode == ILK_MODE_LOCKED) {
    return {StatusCode::hardware_failure, 0, mode, "The kernel is locked; the console says why."};
  }
  return {StatusCode::ok, 0, mode, "The kernel is in mode " + mode + "."};
}

/** In the words of CRTK: PAUSED while no motion is taken although there is power. */
std::string operating_state_of(const Robot& robot, const ControlView& view) {
  if (!view.attached || view.snapshot.state.system.mode == ILK_MODE_LOCKED) {
    return "FAULT";
  }
  if (view.snapshot.state.system.mode == ILK_MODE_MOTION) {
    return "ENABLED";
  }
  const bool has_power = std::ranges::any_of(robot.axes, [&](const Axis& axis) {
    const std::uint32_t state = view.snapshot.state.axis[axis.slot].state;
    return state != ILK_AXIS_DISABLED && state != ILK_AXIS_FAULTED;
  });
  return has_power ? "PAUSED" : "DISABLED";
}

/** What pushes against the needle pushes it back along the way it comes, which is the probe's third axis. */
std::optional<igtl::Spatial> force_of(const Context& context, const std::optional<igtl::Matrix>& probe) {
  const std::optional<double> against_n = context.biopsy.needle_force_n(context.view());
  if (!against_n || !probe) {
    return std::nullopt;
  }
  return igtl::Spatial{-*against_n * (*probe)[2], -*against_n * (*probe)[6], -*against_n * (*probe)[10]};
}

/** Axis of a rotation times its angle, rad. */
std::array<double, 3> turn_of(const igtl::Matrix& before, const igtl::Matrix& after) {
  const auto between = [&](std::size_t row, std::size_t column) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += after[4 * row + i] * before[4 * column + i];
    }
    return sum;
  };
  const std::array<double, 3> skew{(between(2, 1) - between(1, 2)) / 2, (between(0, 2) - between(2, 0)) / 2,
                                   (between(1, 0) - between(0, 1)) / 2};
  const double sine = std::hypot(skew[0], skew[1], skew[2]);
  const double angle = std::atan2(sine, (between(0, 0) + between(1, 1) + between(2, 2) - 1) / 2);
  const double scale = sine > 0.0 ? angle / sine : 0.0;
  return {scale * skew[0], scale * skew[1], scale * skew[2]};
}

}  // namespace

void PoseVelocity::measure(std::uint32_t tick, std::uint32_t period_us,
                           const std::optional<igtl::Matrix>& pose) {
  const std::uint32_t ticks = tick - std::exchange(tick_, tick);
  const std::optional<igtl::Matrix> before = std::exchange(pose_, pose);
  velocity_.reset();
  if (!before || !pose || ticks == 0) {
    return;
  }
  const double seconds = ticks * (period_us * 1e-6);
  const std::array<double, 3> turn = turn_of(*before, *pose);
  velocity_ = igtl::Spatial{((*pose)[3] - (*before)[3]) / seconds,
                            ((*pose)[7] - (*before)[7]) / seconds,
                            ((*pose)[11] - (*before)[11]) / seconds,
                            turn[0] / seconds,
                            turn[1] / seconds,
                            turn[2] / seconds};
}

void AxisVelocities::measure(const Robot& robot, const ControlView& view) {
  const std::uint32_t before_tick = std::exchange(tick_, view.snapshot.state.system.tick);
  const std::vector<double> before = std::exchange(positions_, positions_in(robot, view));
  const double seconds = static_cast<double>(tick_ - before_tick) * robot.period_us * 1e-6;
  velocities_.clear();
  if (before.size() == positions_.size() && seconds > 0.0) {
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      velocities_.push_back((positions_[i] - before[i]) / seconds);
    }
  }
}

igtl::RobotState robot_state(const Context& context, const Targeting& kept,
                             const AxisVelocities& velocities) {
  const ControlView& view = context.view();
  const Targeting targeting = judged(kept, context.in_force);
  igtl::RobotState state;
  if (targeting.registration_problem.empty()) {
    state.scanner_from_robot = targeting.registration;
  }
  state.registration_problem = targeting.registration_problem;
  state.entry = targeting.entry_point;
  state.target = targeting.target_point;
  state.treatment_to_tip_mm = targeting.treatment_to_tip_mm;
  state.robot_to_entry_mm = targeting.robot_to_entry_mm;
  state.cannula_to_treatment_mm = targeting.cannula_to_treatment_mm;
  state.treatment_to_robot_at_home_mm = targeting.treatment_to_robot_at_home_mm;
  state.mode = context.registry.app_mode();
  state.health = health_of(view);
  const RobotPoses poses = robot_poses(context.robot, targeting, view);
  state.measured_cp = poses.current;
  state.measured_cf = force_of(context, poses.current);
  state.operating_state = operating_state_of(context.robot, view);
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

}  // namespace interlock
