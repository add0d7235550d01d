/**
 * @file
 * Reads the [[home_step]] and [draping] tables of a robot file. Private to this folder.
 */
#pragma once

#include "robot/table_reader.hpp"

namespace interlock {

/**
 * Reads the steps of homing into `robot`, whose axes are known already.
 *
 * Refuses what could not work in this order: an axis that homes twice or never, a nudge of an axis whose
 * position is known, a move of one whose position is not.
 */
void read_home_steps(TableReader& table, Robot& robot);

/** Reads the setpoints of the mode "draping", when there are any. */
void read_draping(TableReader& table, Robot& robot);

}  // namespace interlock
