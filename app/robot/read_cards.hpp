/**
 * @file
 * Reads the tables of a robot file that stand for one card each: [[axis]] and [[sensor]]. Private to this
 * folder.
 */
#pragma once

#include "robot/table_reader.hpp"

namespace interlock {

/** Reads an axis of `robot`, of which everything above the axes and the axes before this one are known. */
Axis read_axis(TableReader table, const Robot& robot);

/** Reads a sensor of `robot`, of which all axes and the sensors before this one are known. */
Sensor read_sensor(TableReader table, const Robot& robot);

/** Refuses a name or a slot that another axis or sensor of the robot has already. */
void refuse_twins(TableReader& table, const Robot& robot, const std::string& name, std::uint32_t slot);

}  // namespace interlock
