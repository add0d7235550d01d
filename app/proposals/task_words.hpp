/**
 * @file
 * What the control thread reports of tasks, in words for people.
 */
#pragma once

#include <optional>
#include <string>

#include "motion/biopsy_run.hpp"
#include "motion/task.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** The state of a proposal whose task is in that phase. */
ProposalState state_of(TaskPhase phase) noexcept;

/** Why a proposal stands where it does, what it does now, and what to do next. `found`: of the newest biopsy.
 */
std::string detail_of(const Robot& robot, const Proposal& proposal, const TaskStatus& status,
                      const BiopsyFindings& found);

/** The verdict that ended the task; empty for every other end. */
std::optional<std::string> verdict_of(const TaskStatus& status);

}  // namespace interlock
