/**
 * @file
 * The columns of a written trajectory: `time [s]`, then `yaw [rad]` for a position and `yaw [rad/s]` for a
 * velocity, axes by the names of the robot file, in any order. An axis that has no column is not part of it.
 */
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "robot/robot.hpp"
#include "trajectory/trajectory_error.hpp"

namespace interlock {

/** The first column. */
inline constexpr std::string_view time_column = "time [s]";

/** The columns of one axis; the place 0 is the column of the times. */
struct AxisColumns {
  const Axis* axis = nullptr; /**< of the robot whose header was read */
  std::size_t position = 0;
  std::optional<std::size_t> velocity;
};

/** Reads the fields of a header, each without blanks around it; errors are of line 1. */
TrajectoryResult<std::vector<AxisColumns>> read_header(std::span<const std::string> columns,
                                                       const Robot& robot);

}  // namespace interlock
