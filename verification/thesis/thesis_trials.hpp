/**
 * @file
 * The targets of the thesis' two targeting experiments (Tables 1 and 2), carried into the workspace of the
 * robot as it is described here, since the thesis tells neither its registrations nor its entry points.
 */
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string_view>

#include "robot/robot.hpp"

namespace interlock {

/** One trial as printed. */
struct ThesisTrial {
  Eigen::Vector3d desired; /**< mm, in the frame of its table */
  Eigen::Vector3d actual;
};

/** A table and how its targets become targets of the robot. */
struct ThesisTable {
  std::string_view title;
  std::string_view mapping; /**< for people */
  std::span<const ThesisTrial> trials;
};

/** A straight way in, in the robot's zFrame, mm. */
struct Way {
  Eigen::Vector3d entry;
  Eigen::Vector3d target;
};

/** Whether the thesis printed trials of the robot's family; the functions below need it. */
bool has_thesis_table(const Robot& robot);

/** The table of the robot's family. */
const ThesisTable& thesis_table(const Robot& robot);

/** Carries a difference of two points in the frame of the table to the robot's zFrame. Its transpose goes
 * back. */
Eigen::Matrix3d zframe_from_table(const Robot& robot);

/** Where a trial leads the robot. */
Way way_of(const Robot& robot, const ThesisTrial& trial);

}  // namespace interlock
