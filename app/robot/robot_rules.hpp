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

/** The first value of which the kernel knows nothing, and with which the app cannot move the robot. */
std::optional<RobotError> app_rule_broken(const Robot& robot);

}  // namespace interlock
