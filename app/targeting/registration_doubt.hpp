/**
 * @file
 * Whether a registration can be right: mistakes of convention and unit that are rigid all the same.
 */
#pragma once

#include <optional>
#include <string>

#include "kinematics/pose.hpp"
#include "robot/robot.hpp"

namespace interlock {

/**
 * Why it puts the robot where its file does not expect it, in a sentence or two for people, with what it
 * looks like: LPS for RAS, metres or centimetres for millimetres, the inverse, a transposed rotation, or the
 * identity, which nobody measures. Empty when there is no doubt. Right conventions within the expected region
 * pass, and so does a mistake whose result lies within it.
 */
std::optional<std::string> registration_doubt(const ExpectedRegistration& expected, const Pose& given);

}  // namespace interlock
