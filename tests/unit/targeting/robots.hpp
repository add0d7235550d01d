/** @file The project's robots with their kinematics. */
#pragma once

#include "project_robots.hpp"
#include "targeting/robot_kinematics.hpp"

namespace interlock::test {

RobotKinematics kinematics_of(const Robot& robot);

/** The place of the axis with that role among the robot's axes. */
std::size_t place_of(const Robot& robot, std::string_view role);

}  // namespace interlock::test
