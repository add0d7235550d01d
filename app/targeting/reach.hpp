/**
 * @file
 * Where a robot gets to, as cells of space: what random setpoints between the ends of its axes reach by its
 * kinematics, kept as the outer cells alone, so that the answer is bounded.
 */
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "targeting/robot_kinematics.hpp"

namespace interlock {

/** The cells in which setpoints were seen to put the treatment point. */
struct Reach {
  double cell_mm = 0.0; /**< side of a cell */
  std::vector<Eigen::Vector3d>
      shell_mm;          /**< centres, zFrame, of cells that have a neighbour without a setpoint */
  std::size_t cells = 0; /**< all, those within included */
  std::size_t drawn = 0;
  std::size_t refused = 0; /**< setpoints that geometry does not allow */
};

/** Cells along the longest side of the space that is reached. */
inline constexpr int reach_cells_a_side = 24;

/**
 * Draws setpoints that the kernel accepts of homed axes; the same ones each time. A place that only few
 * setpoints reach may be missed; none is shown that no setpoint reaches. `draws` at most
 * `largest_sample_count`.
 */
KinematicsResult<Reach> reach_of(const Robot& robot, const RobotKinematics& kinematics, std::size_t draws);

}  // namespace interlock
