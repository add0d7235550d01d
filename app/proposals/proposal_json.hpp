/**
 * @file
 * A proposal for people and programs: in words and in JSON.
 */
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "motion/biopsy_run.hpp"
#include "motion/task.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

// What the control thread reports of tasks, in words for people.

/** The state of a proposal whose task is in that phase. */
ProposalState state_of(TaskPhase phase) noexcept;

/** Why a proposal stands where it does, what it does now, and what to do next. `found`: of the newest biopsy.
 */
std::string detail_of(const Robot& robot, const Proposal& proposal, const TaskStatus& status,
                      const BiopsyFindings& found);

/** The verdict that ended the task; empty for every other end. */
std::optional<std::string> verdict_of(const TaskStatus& status);

// Proposals as the HTTP interface shows them.

/** Schema `Proposal` of spec/openapi.yaml. */
nlohmann::json to_json(const Proposal& proposal);

}  // namespace interlock
