/**
 * @file
 * What the control thread reports of orders, in words for people.
 */
#pragma once

#include <optional>
#include <string>

#include "motion/order.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** The state of a proposal whose order is in that phase. */
ProposalState state_of(OrderPhase phase) noexcept;

/** Why a move stands where it does, and what to do next. */
std::string detail_of(const OrderStatus& status);

/** Why homing stands where it does, what it does now, and what to do next. */
std::string detail_of(const Robot& robot, const Proposal& proposal, const HomeStatus& status);

/** Why a path stands where it does, what it does now, and what to do next. */
std::string detail_of(const Robot& robot, const Proposal& proposal, const PathStatus& status);

/** Why a sweep stands where it does, what it does now, and what to do next. */
std::string detail_of(const Robot& robot, const Proposal& proposal, const SweepStatus& status);

/** Why a biopsy stands where it does, what it does now, and what to do next. */
std::string detail_of(const Robot& robot, const BiopsyStatus& status);

/** The verdict that ended the order; empty for every other end. */
std::optional<std::string> verdict_of(const OrderStatus& status);

}  // namespace interlock
