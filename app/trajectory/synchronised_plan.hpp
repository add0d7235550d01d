/**
 * @file
 * A jerk-limited motion of several axes that arrive together, planned by Ruckig from any state in which they
 * are.
 *
 * Move: from where the axes are, and however they move, to rest at their targets, in the shortest time that
 * velocity, acceleration and jerk of every axis allow, or in a longer one. From rest the axes move in
 * proportion, along the straight line from positions to targets. An axis that is faster than its limits is
 * braked first.
 *
 * Stop: every axis by itself, to rest as soon as its limits allow.
 *
 * A difference that an axis makes up in 10 ns at its limits is a rounding error (`rounding_s`): a plan from a
 * state that exceeds a limit by no more begins at the limit, and an axis that is at rest at its target up to
 * that stays there.
 *
 * To plan anew on the way, start from `at` of the plan that is being followed. Planning allocates and takes
 * some microseconds an axis: it has no place in the control thread. A finished plan only answers.
 *
 * Units are those of the axes (mm or rad) and seconds.
 */
#pragma once

#include <span>
#include <string>
#include <vector>

#include "robot/motion_rates.hpp"
#include "trajectory/piecewise_motion.hpp"
#include "trajectory/trajectory_error.hpp"

namespace interlock {

/**
 * A difference that an axis makes up within this time at its limits is a rounding error: of its position by
 * the velocity limit, of its velocity by the acceleration limit, of its acceleration by the jerk limit.
 */
inline constexpr double rounding_s = 1e-8;

/** Rounding is forgiven by this much where a plan is held against the positions allowed. */
inline constexpr double planning_slack = 1e-7;

/** One axis of a plan. */
struct PlannedAxis {
  std::string name; /**< for errors */
  MotionState now;
  RateLimits limits; /**< each from `smallest_rate` to `largest_rate` */
};

/** An axis and where it shall go. */
struct AxisTarget {
  PlannedAxis axis;
  double position = 0.0; /**< where it comes to rest */
  PositionRange allowed; /**< for the target and the whole way there; a start outside may come back in */
};

/** Motions of several axes that end at the same time. */
struct SynchronisedPlan {
  std::vector<PiecewiseMotion> axes; /**< in the order in which they were given */
  double duration_s = 0.0;           /**< until the last is at rest */
};

/**
 * Plans a move that takes at least `minimum_duration_s`. NOT_FINITE and OUT_OF_RANGE name axis and quantity,
 * OUT_OF_RANGE also when an axis is too fast to stay within its positions; NO_SOLUTION says why Ruckig found
 * none.
 */
TrajectoryResult<SynchronisedPlan> plan_move(std::span<const AxisTarget> targets,
                                             double minimum_duration_s = 0.0);

/** Plans a stop. Where it leads is for the caller to judge, by `reach`: a stop is never refused for that. */
TrajectoryResult<SynchronisedPlan> plan_stop(std::span<const PlannedAxis> axes);

}  // namespace interlock
