/**
 * @file
 * Reads the [kinematics] and [probe] tables of a robot file. Private to this folder.
 */
#pragma once

#include "robot/robot.hpp"
#include "robot/table_reader.hpp"

namespace interlock {

/** The family that the file names, with its parameters, and the probe. A robot may have neither. */
void read_kinematics(TableReader& root, Robot& robot, std::span<const KinematicsFamily> families);

/** The role of an axis: one of the family's, in the family's unit, that no axis before it plays. Left out, it
 * is the one that bears the axis' name, if there is one. */
std::string read_role(TableReader& axis, const Robot& robot, const std::string& axis_name, Unit unit);

/** Refuses a robot in which no axis plays a role of its family. */
void refuse_unplayed_roles(TableReader& table, const Robot& robot);

}  // namespace interlock
