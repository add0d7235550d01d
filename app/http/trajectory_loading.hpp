/**
 * @file
 * How a trajectory comes to be the loaded one, by whichever way it came.
 */
#pragma once

#include <optional>

#include "http/context.hpp"
#include "trajectory/timed_trajectory.hpp"
#include "trajectory/trajectory_error.hpp"

namespace interlock::web {

/** 422 with the code of the error: nothing was loaded. */
Problem unreadable(const TrajectoryError& error);

/**
 * Records it and loads it; nothing is loaded when that fails, or the caller lost session or authority
 * meanwhile (`Context::announce`). `targeting_revision`: of registration, probe and target from which it
 * followed, if it did.
 */
boost::asio::awaitable<tl::expected<void, Problem>> load_trajectory(
    const Context& context, Caller caller, TimedTrajectory trajectory,
    std::optional<std::uint32_t> targeting_revision = std::nullopt);

}  // namespace interlock::web
