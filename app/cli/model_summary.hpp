/**
 * @file
 * A robot file in a few lines, for people and for programs.
 */
#pragma once

#include <string>

#include "interlock/types.h"
#include "robot/robot.hpp"
#include "robot/robot_error.hpp"

namespace interlock::cli {

/** Lines for people: a line with name, axes and configuration hash, the cards by slot, the steps of homing.
 */
std::string model_text(const Robot& robot, const ilk_config_t& config);

/** One JSON object: `{"valid": true, ...}` with what `model_text` says, in counts. */
std::string model_json(const Robot& robot, const ilk_config_t& config);

/** One JSON object: `{"valid": false, "file": .., "line": .., "key": .., "problem": .., "expected": ..}`. */
std::string model_json(const RobotError& error);

}  // namespace interlock::cli
