/**
 * @file
 * What there is to look at before somebody approves a proposal: its checks, the profile of its motion, and
 * its ghost, the robot and the way of its tip in the scanner. Schema `ProposalPlan` of spec/openapi.yaml.
 */
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "http/targeting.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock::web {

/** Takes some tens of milliseconds for a long path: no work for the network thread. */
nlohmann::json proposal_plan(const Robot& robot, const ilk_config_t& config, const Targeting& targeting,
                             const Proposal& proposal);

}  // namespace interlock::web
