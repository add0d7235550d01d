/**
 * @file
 * How a trajectory comes to be the loaded one, by whichever way it came.
 */
#pragma once

#include "http/context.hpp"
#include "trajectory/timed_trajectory.hpp"
#include "trajectory/trajectory_error.hpp"

namespace interlock::web {

/** 422 with the code of the error: nothing was loaded. */
Problem unreadable(const TrajectoryError& error);

/** Records it and loads it; nothing is loaded when that fails, or the caller lost session or authority
 * meanwhile (`Context::announce`). */
boost::asio::awaitable<tl::expected<void, Problem>> load_trajectory(const Context& context, Caller caller,
                                                                    TimedTrajectory trajectory);

}  // namespace interlock::web
