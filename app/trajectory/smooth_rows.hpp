/**
 * @file
 * What the rows of one axis leave open, such that its motion between them is smooth (timed_trajectory.hpp).
 */
#pragma once

#include <span>

#include "trajectory/piecewise_motion.hpp"

namespace interlock {

/** Fills in velocities and accelerations of rows that have positions: the cubic spline through them. Times
 * rise, and are as many as the rows. */
void smooth_positions(std::span<const double> times_s, std::span<MotionState> rows);

/** Fills in accelerations of rows that have positions and velocities: such that the jerk of the quintics
 * between them does not leap. */
void smooth_velocities(std::span<const double> times_s, std::span<MotionState> rows);

}  // namespace interlock
