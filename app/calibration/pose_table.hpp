/**
 * @file
 * Poses of the tool that were measured while the axes stood still, as a table:
 *
 *     yaw [rad],insertion [mm],...,tool_x [mm],tool_y [mm],tool_z [mm]
 *     -0.5,10,...,12.31,180.02,77.60
 *
 * A column for each axis that plays a role in the kinematics, with its position as the app shows it, and the
 * treatment point. Optional: `direction_x`, `direction_y`, `direction_z`, the unit vector in which probe or
 * needle advances; `sd [mm]` and `sd [rad]`, the standard deviation of the measured point along each
 * coordinate and of the direction about each axis across it. Columns stand in any order.
 */
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "robot/robot.hpp"

namespace interlock {

/** A row of the table. Points and directions are in the frame of whatever measured them. */
struct MeasuredPose {
  std::uint32_t line = 0;        /**< of the table, from 1 */
  std::vector<double> positions; /**< of the robot's axes in their order, mm or rad; 0 without a role */
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> direction; /**< unit vector */
  std::optional<double> sd_mm;              /**< of the point, along each coordinate */
  std::optional<double> sd_rad;             /**< of the direction, about each axis across it */
};

/** More rows are refused. */
inline constexpr std::size_t most_measured_poses = 10000;

/** Why these deviations cannot be those of a tracker (0.0001 to 20 mm, 0.000001 to 0.5 rad); nothing when
 * they can. */
std::optional<std::string> deviation_problem(const std::optional<double>& sd_mm,
                                             const std::optional<double>& sd_rad);

/** Reads the table; the error names line and column. Refused: an axis without a column, an unknown or a
 * repeated column, a field that is no finite number, a position beyond the axis' soft limits, a direction
 * that is no unit vector (1e-3), a deviation that no tracker has, a row that stands there twice. `file` names
 * the table in errors. */
tl::expected<std::vector<MeasuredPose>, RobotError> read_poses(std::string_view text, const std::string& file,
                                                               const Robot& robot);

}  // namespace interlock
