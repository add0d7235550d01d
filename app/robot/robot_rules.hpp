/**
 * @file
 * Rules that a robot must keep before the kernel may have it, told at their place in its file. Private to
 * this folder.
 */
#pragma once

#include <optional>

#include "interlock/types.h"
#include "robot/robot.hpp"
#include "robot/robot_error.hpp"

namespace interlock {

/** The rule of the kernel that `verdict` says is broken, where it is kept in the file, and how. */
RobotError kernel_rule_broken(const Robot& robot, ilk_config_verdict_t verdict);

/** The first card in a slot that does not exist, or of a type that nobody can drive. */
std::optional<RobotError> card_out_of_place(const Robot& robot);

/** The first travel of homing, or setpoint of draping, that leaves the range of its axis; the kernel knows
 * nothing of either. */
std::optional<RobotError> step_out_of_range(const Robot& robot);

}  // namespace interlock
