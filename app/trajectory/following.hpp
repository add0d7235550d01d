/**
 * @file
 * How well axes follow a trajectory, and whether they have reached its goal.
 *
 * Until the trajectory ends no axis may be further from where it should be than its path tolerance. From then
 * on it may not be further from its last position than that, and the goal is reached when all are within
 * their goal tolerance, for which they have `goal_wait_s`.
 */
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "trajectory/timed_trajectory.hpp"
#include "trajectory/trajectory_error.hpp"

namespace interlock {

/** Allowed distances of one axis, in its unit. */
struct FollowingTolerance {
  double path = 0.0;
  double goal = 0.0; /**< at most `path` */
};

/** How closely a trajectory has to be followed. */
struct FollowingRules {
  std::vector<FollowingTolerance> axes; /**< in the order of the trajectory's axes */
  double goal_wait_s = 0.0;             /**< after the trajectory's end */
};

/** How far the following is. */
struct FollowingState {
  /** What came of following it. */
  enum class Code {
    under_way,
    reached,   /**< the trajectory is over, and all axes are at its goal */
    off_path,  /**< an axis is too far from where it should be, or its position is no number */
    goal_late, /**< an axis did not come to its goal in time */
  };

  Code code = Code::under_way;
  std::size_t axis = 0;  /**< by its place in the trajectory: that with the largest share of its tolerance */
  double distance = 0.0; /**< of that axis, from where it should be */
};

/** Nothing, when the rules fit the trajectory: a path and a goal tolerance above 0 for each axis. */
TrajectoryResult<void> check_rules(const FollowingRules& rules, const TimedTrajectory& trajectory);

/**
 * Judges measured positions, one for each axis of the trajectory, at a time of its rows. The rules have
 * passed `check_rules`.
 */
FollowingState follow(const TimedTrajectory& trajectory, const FollowingRules& rules, double time_s,
                      std::span<const double> measured) noexcept;

}  // namespace interlock
