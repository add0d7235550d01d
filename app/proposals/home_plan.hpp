/**
 * @file
 * What a wish for homing means for this robot, and whether it may be granted now.
 */
#pragma once

#include <cstdint>
#include <tl/expected.hpp>
#include <vector>

#include "motion/mailbox.hpp"
#include "proposals/move_check.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** The home steps and the axes that a wish names. */
struct HomePlan {
  std::uint32_t first_step = 0;     /**< index of the robot's home steps */
  std::uint32_t step_count = 0;     /**< 0: the one axis alone, at its switch */
  std::vector<std::uint32_t> slots; /**< of all axes that move, each once, in the order in which they move */
};

/** Finds what the draft names: AXIS, NOT_FOUND or INVALID when there is no such thing. */
tl::expected<HomePlan, Refusal> plan_home(const Robot& robot, const HomeDraft& draft);

/**
 * Judges a plan against the newest view: CONFIG_MISMATCH, MODE, then for each axis FAULTED and DISABLED,
 * then NO_SWITCH, then NOT_HOMED where a step goes to a position and no earlier step homes the axis, and last
 * SEPARATION (separation.hpp).
 */
void check_home(const Robot& robot, const ilk_config_t& config, const ControlView& view, const HomePlan& plan,
                CheckList& checks);

}  // namespace interlock
