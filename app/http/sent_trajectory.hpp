/**
 * @file
 * Trajectories as navigation programs send them, without a header: rows of numbers, or poses in time.
 *
 * Both are read whole or refused with the number of the first bad row, counted from 1, and its column.
 */
#pragma once

#include <tl/expected.hpp>

#include "http/problems.hpp"
#include "http/targeting.hpp"
#include "igtl/wish.hpp"
#include "robot/robot.hpp"
#include "trajectory/timed_trajectory.hpp"

namespace interlock::web {

/** A time, then of each axis in the file's order its position, or its position and its velocity. */
tl::expected<TimedTrajectory, Problem> trajectory_of(const Robot& robot, const igtl::LoadRows& rows);

/**
 * Each pose becomes the setpoints of the alignment with it (targeting/alignment.hpp); between poses the axes
 * go straight. A pose says where the treatment point is and which way the probe comes; how the probe is
 * turned about that way is not taken over. A pose that an axis ends before is refused, not moved.
 */
tl::expected<TimedTrajectory, Problem> trajectory_of(const Robot& robot, const Targeting& targeting,
                                                     const igtl::LoadPoses& poses);

}  // namespace interlock::web
