/**
 * @file
 * From an alignment to the motion that reaches it.
 */
#pragma once

#include "motion/path_program.hpp"
#include "targeting/alignment.hpp"

namespace interlock {

/**
 * Takes the probe out as far as it goes, moves all other axes together to their setpoints, then, with
 * `insert`, inserts the probe. A robot without insertion moves in one leg.
 */
PathProgram pose_program(const Robot& robot, const Alignment& alignment, bool insert);

}  // namespace interlock
