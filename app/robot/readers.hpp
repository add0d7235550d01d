/**
 * @file
 * Readers of the tables of a robot file.
 */
#pragma once

#include "robot/robot.hpp"
#include "robot/table_reader.hpp"

namespace interlock {

// Reads the [biopsy] table of a robot file. Private to this folder.

/** Reads what the mode "cooperative_biopsy" needs, when it is there; the sensors are known already. */
void read_biopsy(TableReader& table, Robot& robot);

// Reads the tables of a robot file that stand for one card each: [[axis]] and [[sensor]]. Private to this
// folder.

/** Reads an axis of `robot`, of which everything above the axes and the axes before this one are known. */
Axis read_axis(TableReader table, const Robot& robot);

/** Reads a sensor of `robot`, of which all axes and the sensors before this one are known. */
Sensor read_sensor(TableReader table, const Robot& robot);

/** Refuses a name or a slot that another axis or sensor of the robot has already. */
void refuse_twins(TableReader& table, const Robot& robot, const std::string& name, std::uint32_t slot);

// Reads the [[home_step]] and [draping] tables of a robot file. Private to this folder.

/**
 * Reads the steps of homing into `robot`, whose axes are known already.
 *
 * Refuses what could not work in this order: an axis that homes twice or never, a nudge of an axis whose
 * position is known, a move of one whose position is not.
 */
void read_home_steps(TableReader& table, Robot& robot);

/** Reads the setpoints of the mode "draping", when there are any. */
void read_draping(TableReader& table, Robot& robot);

// Reads the [kinematics], [probe] and [targeting] tables of a robot file. Private to this folder.

/** The family that the file names, with its parameters, the probe and what is believed of an aim. A robot may
 * have none of them. */
void read_kinematics(TableReader& root, Robot& robot, std::span<const KinematicsFamily> families);

/** The role of an axis: one of the family's, in the family's unit, that no axis before it plays. Left out, it
 * is the one that bears the axis' name, if there is one. */
std::string read_role(TableReader& axis, const Robot& robot, const std::string& axis_name, Unit unit);

/** Refuses a robot in which no axis plays a role of its family. */
void refuse_unplayed_roles(TableReader& table, const Robot& robot);

}  // namespace interlock
