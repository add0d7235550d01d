/**
 * @file
 * One line of `interlock kinematics align`.
 */
#pragma once

#include "cli/kinematics_fields.hpp"
#include "robot/robot.hpp"
#include "targeting/robot_kinematics.hpp"

namespace interlock::cli {

/**
 * Aligns the robot with `entry` and `target` of the request, in the scanner's RAS frame, mm; `registration`,
 * `ignore_registration_rotation` and `rotation` where they are not identity, false and 0. The answer has
 * `desired` and `reachable` pose, `setpoints` by axis, the names of `clamped` axes, the `deviation`, the
 * `reachable_tip` and `cannula_length_mm`.
 */
Solved<nlohmann::json> align_line(const Robot& robot, const RobotKinematics& kinematics,
                                  const nlohmann::json& request);

}  // namespace interlock::cli
