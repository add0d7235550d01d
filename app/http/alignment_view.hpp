/** @file What the targeting asks of the robot and where the robot is: schema `AlignmentView` of
 * spec/openapi.yaml. */
#pragma once

#include <nlohmann/json.hpp>

#include "http/targeting.hpp"
#include "motion/mailbox.hpp"
#include "robot/robot.hpp"

namespace interlock::web {

/**
 * The alignment with entry and target, and the current pose of the treatment point by the encoders; of each,
 * a problem in its place when there is none.
 */
nlohmann::json alignment_view(const Robot& robot, const Targeting& targeting, const ControlView& view);

}  // namespace interlock::web
