/**
 * @file
 * Reads the [kinematics] and [probe] tables of a robot file. Private to this folder.
 */
#pragma once

#include "robot/table_reader.hpp"

namespace interlock {

/** The family that the table names, and its parameters. */
Kinematics read_kinematics(TableReader table);

ProbeOffsets read_probe(TableReader table);

/** The role of an axis: one of the family's, in the family's unit, that no axis before it plays. */
std::string read_role(TableReader& axis, const Robot& robot, Unit unit);

/** Refuses a robot in which no axis plays a role of its family. */
void refuse_unplayed_roles(TableReader& table, const Robot& robot);

}  // namespace interlock
