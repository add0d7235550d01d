/**
 * @file
 * A biopsy that somebody may propose, at a point of the guide frame or at the target of the targeting.
 */
#pragma once

#include <array>
#include <optional>
#include <string>

#include "http/context.hpp"

namespace interlock::web {

/**
 * A biopsy at `target_mm` in the guide frame (motion/biopsy_run.hpp), or without it at the target point of
 * the targeting, seen from where registration and encoders say that the needle is. Then also 409 NO_TARGET
 * and NOT_HOMED, a problem of the kinematics, or UNREACHABLE when the target lies farther beside the needle's
 * way than the needle can bend; and the proposal ends when registration, probe or target change.
 */
boost::asio::awaitable<tl::expected<Task, Problem>> biopsy_draft(
    const Context& context, std::optional<std::array<double, 3>> target_mm, std::string author);

}  // namespace interlock::web
