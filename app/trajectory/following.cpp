#include "trajectory/following.hpp"

#include <cmath>
#include <limits>

namespace interlock {
namespace {

using FollowingCode = FollowingState::Code;

constexpr double smallest_tolerance = 1e-9;
constexpr double longest_goal_wait_s = 3600.0;

/** The axis that has used up most of one of its tolerances. */
struct Worst {
  std::size_t axis = 0;
  double distance = 0.0;
  double share = -1.0; /**< of the tolerance; above 1 is beyond it */
};

Worst worst_of(const TimedTrajectory& trajectory, const FollowingRules& rules, double time_s,
               std::span<const double> measured, double FollowingTolerance::* tolerance) noexcept {
  Worst worst;
  for (std::size_t axis = 0; axis < trajectory.axes().size(); ++axis) {
    const double distance = std::abs(measured[axis] - trajectory.at(axis, time_s).position);
    const double share = distance / (rules.axes[axis].*tolerance);
    const double counted = std::isnan(share) ? std::numeric_limits<double>::infinity() : share;
    if (counted > worst.share) {
      worst = {axis, distance, counted};
    }
  }
  return worst;
}

FollowingState state_of(FollowingCode code, const Worst& worst) noexcept {
  return {code, worst.axis, worst.distance};
}

}  // namespace

TrajectoryResult<void> check_rules(const FollowingRules& rules, const TimedTrajectory& trajectory) {
  if (rules.axes.size() != trajectory.axes().size()) {
    return tl::unexpected(TrajectoryError{
        TrajectoryError::Code::wrong_columns, 0, "tolerances", std::to_string(rules.axes.size()) + " axes",
        std::to_string(trajectory.axes().size()) + " as in the trajectory"});
  }
  TrajectoryResult<void> checked = check_within("goal wait [s]", rules.goal_wait_s, 0.0, longest_goal_wait_s);
  for (std::size_t axis = 0; checked && axis < rules.axes.size(); ++axis) {
    const std::string& name = trajectory.axes()[axis].name;
    const auto& [path, goal] = rules.axes[axis];
    checked = check_within(name + " path tolerance", path, smallest_tolerance, position_limit).and_then([&] {
      return check_within(name + " goal tolerance", goal, smallest_tolerance, path);
    });
  }
  return checked;
}

FollowingState follow(const TimedTrajectory& trajectory, const FollowingRules& rules, double time_s,
                      std::span<const double> measured) noexcept {
  const Worst path = worst_of(trajectory, rules, time_s, measured, &FollowingTolerance::path);
  if (path.share > 1) {
    return state_of(FollowingCode::off_path, path);
  }
  if (!(time_s >= trajectory.end_s())) {
    return state_of(FollowingCode::under_way, path);
  }
  const Worst goal = worst_of(trajectory, rules, time_s, measured, &FollowingTolerance::goal);
  if (goal.share <= 1) {
    return state_of(FollowingCode::reached, goal);
  }
  const bool late = time_s > trajectory.end_s() + rules.goal_wait_s;
  return state_of(late ? FollowingCode::goal_late : FollowingCode::under_way, goal);
}

}  // namespace interlock
