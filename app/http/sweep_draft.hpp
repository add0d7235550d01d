/**
 * @file
 * Sweeps of frequency that somebody may propose.
 */
#pragma once

#include <nlohmann/json.hpp>

#include "http/message.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock::web {

/**
 * What a `ProposalDraft` (spec/openapi.yaml) of kind `sweep` asks for; 404 NOT_FOUND for a robot without the
 * mode. Whether the frequencies are in the band of the axis is not judged here.
 */
tl::expected<Task, Problem> sweep_draft(const Robot& robot, const nlohmann::json& body,
                                        const std::string& author);

/** The whole band of the robot's first high-frequency axis, in published steps of a second each. */
tl::expected<Task, Problem> whole_sweep_draft(const Robot& robot, const std::string& author);

}  // namespace interlock::web
