#include "trajectory/synchronised_plan.hpp"

#include <algorithm>

#include "trajectory/ruckig_calculate.hpp"

namespace interlock {

using Planner = ruckig::Ruckig<ruckig::DynamicDOFs>;
using Input = ruckig::InputParameter<ruckig::DynamicDOFs>;
using Output = ruckig::Trajectory<ruckig::DynamicDOFs>;

namespace {

using Code = TrajectoryError::Code;
using Checked = TrajectoryResult<void>;

Checked check_axis(const PlannedAxis& axis) {
  const struct {
    const char* quantity;
    double value;
    double lowest;
    double highest;
  } checks[] = {{" position", axis.now.position, -position_limit, position_limit},
                {" velocity", axis.now.velocity, -largest_rate, largest_rate},
                {" acceleration", axis.now.acceleration, -largest_rate, largest_rate},
                {" velocity limit", axis.limits.velocity, smallest_rate, largest_rate},
                {" acceleration limit", axis.limits.acceleration, smallest_rate, largest_rate},
                {" jerk limit", axis.limits.jerk, smallest_rate, largest_rate}};
  for (const auto& [quantity, value, lowest, highest] : checks) {
    if (const Checked checked = check_within(axis.name + quantity, value, lowest, highest); !checked) {
      return checked;
    }
  }
  return {};
}

Checked check_target(const AxisTarget& target) {
  const std::string& name = target.axis.name;
  const auto& [lowest, highest] = target.allowed;
  return check_axis(target.axis)
      .and_then([&] { return check_within(name + " lowest position", lowest, -position_limit, highest); })
      .and_then([&] { return check_within(name + " highest position", highest, lowest, position_limit); })
      .and_then([&] { return check_within(name + " target", target.position, lowest, highest); });
}

/** All but the end. */
PiecewiseMotion motion_of(const ruckig::Profile& profile, const RuckigUnit& unit) {
  PiecewiseMotion motion;
  const auto append = [&](const auto& parts, std::size_t part) {
    const MotionState start = unit.from_ruckig(parts.p[part], parts.v[part], parts.a[part]);
    motion.append({start, parts.j[part] * unit.length}, parts.t[part]);
  };
  if (profile.brake.duration > 0) {
    for (std::size_t part = 0; part < profile.brake.t.size(); ++part) {
      append(profile.brake, part);
    }
  }
  for (std::size_t part = 0; part < profile.t.size(); ++part) {
    append(profile, part);
  }
  return motion;
}

TrajectoryError refusal(ruckig::Result result) {
  const auto no_solution = [](const char* problem, const char* expected) {
    return TrajectoryError{Code::no_solution, 0, "", problem, expected};
  };
  switch (result) {
    case ruckig::ErrorInvalidInput:
      return no_solution("Ruckig does not accept the state or the limits", "finite numbers, positive limits");
    case ruckig::ErrorTrajectoryDuration:
      return no_solution("the motion takes too long", "7600 s at most: a shorter way or larger limits");
    case ruckig::ErrorPositionalLimits:
      return no_solution("the motion leaves the positions allowed", "a slower start");
    case ruckig::ErrorZeroLimits:
      return no_solution("a limit of zero leaves no motion", "positive limits");
    case ruckig::ErrorExecutionTimeCalculation:
      return no_solution("Ruckig found no fastest motion of an axis (error -110)",
                         "another target or limits");
    case ruckig::ErrorSynchronizationCalculation:
      return no_solution("Ruckig found no common duration of the axes (error -111)",
                         "another target, limits or duration");
    default:
      return no_solution("Ruckig failed for a reason that it does not tell", "another target or limits");
  }
}

/** The profiles of all axes. */
TrajectoryResult<Output> solved(Input& input) {
  Planner planner(input.degrees_of_freedom);
  Output output(input.degrees_of_freedom);
  const ruckig::Result result = calculate(planner, input, output);
  if (result != ruckig::Working && result != ruckig::Finished) {
    return tl::unexpected(refusal(result));
  }
  return output;
}

/** A plan whose axes end where `end_of(place, profile)` says. */
template <typename EndOf>
SynchronisedPlan plan_of(const Output& output, std::span<const RuckigUnit> units, const EndOf& end_of) {
  SynchronisedPlan plan;
  const auto profiles = output.get_profiles();
  for (const ruckig::Profile& profile : profiles.front()) {
    PiecewiseMotion motion = motion_of(profile, units[plan.axes.size()]);
    motion.end_at(end_of(plan.axes.size(), profile));
    plan.duration_s = std::max(plan.duration_s, motion.duration_s());
    plan.axes.push_back(std::move(motion));
  }
  return plan;
}

/** Nothing, when the plan keeps the axis where it may be, or brings it there from where it started. */
Checked check_reach(const AxisTarget& target, const PositionRange& reach) {
  PositionRange allowed = target.allowed;
  widen(allowed, target.axis.now.position);
  const std::string what = target.axis.name + " on its way";
  const auto& [lowest, highest] = allowed;
  return check_within(what, reach.lowest, lowest - planning_slack, highest).and_then([&] {
    return check_within(what, reach.highest, lowest, highest + planning_slack);
  });
}

/** Nothing, when that holds for all axes of the plan. */
Checked check_reach(std::span<const AxisTarget> targets, const SynchronisedPlan& plan) {
  Checked checked;
  for (std::size_t place = 0; checked && place < targets.size(); ++place) {
    checked = check_reach(targets[place], plan.axes[place].reach());
  }
  return checked;
}

TrajectoryError no_axis() { return {Code::empty, 0, "", "a plan without axes", "one axis at least"}; }

}  // namespace

TrajectoryResult<SynchronisedPlan> plan_move(std::span<const AxisTarget> targets, double minimum_duration_s) {
  if (targets.empty()) {
    return tl::unexpected(no_axis());
  }
  Input input(targets.size());
  input.synchronization = ruckig::Synchronization::Phase;
  input.minimum_duration = minimum_duration_s;
  std::vector<RuckigUnit> units;
  Checked checked = check_within("minimum duration [s]", minimum_duration_s, 0.0, longest_plan_s);
  for (std::size_t place = 0; checked && place < targets.size(); ++place) {
    const auto& [axis, position, allowed] = targets[place];
    checked = check_target(targets[place]);
    units.push_back(put_axis(input, place, axis.now, position, axis.limits));
  }
  // Ruckig arrives to within 1e-8; the plan ends exactly at the targets.
  const auto target_of = [&](std::size_t place, const ruckig::Profile&) { return targets[place].position; };
  return checked.and_then([&] { return solved(input); })
      .map([&](const Output& output) { return plan_of(output, units, target_of); })
      .and_then(
          [&](const SynchronisedPlan& plan) { return check_reach(targets, plan).map([&] { return plan; }); });
}

TrajectoryResult<SynchronisedPlan> plan_stop(std::span<const PlannedAxis> axes) {
  if (axes.empty()) {
    return tl::unexpected(no_axis());
  }
  Input input(axes.size());
  input.control_interface = ruckig::ControlInterface::Velocity;
  input.synchronization = ruckig::Synchronization::None;
  std::vector<RuckigUnit> units;
  Checked checked;
  for (std::size_t place = 0; checked && place < axes.size(); ++place) {
    const auto& [name, now, limits] = axes[place];
    checked = check_axis(axes[place]);
    units.push_back(put_axis(input, place, now, now.position, limits));
  }
  const auto end_of = [&](std::size_t place, const ruckig::Profile& profile) {
    return units[place].from_ruckig(profile.p.back(), 0.0, 0.0).position;
  };
  return checked.and_then([&] { return solved(input); }).map([&](const Output& output) {
    return plan_of(output, units, end_of);
  });
}

}  // namespace interlock
