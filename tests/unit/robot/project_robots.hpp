/** @file Both robots of the project, as their files say. */
#pragma once

#include "robot/robot.hpp"

namespace interlock::test {

const Robot& neuro();
const Robot& prostate();

}  // namespace interlock::test
