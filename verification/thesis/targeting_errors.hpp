/**
 * @file
 * Errors of targeting: how they are distributed, and how those of the thesis' tables are.
 */
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "robot/robot.hpp"

namespace interlock {

/** Errors of many insertions. All zero when there were none. */
struct ErrorDistribution {
  std::size_t insertions = 0;
  Eigen::Vector3d mean_absolute_mm = Eigen::Vector3d::Zero(); /**< of each axis */
  double mean_mm = 0.0;                                       /**< of the distances */
  double median_mm = 0.0;
  double p95_mm = 0.0;
  double worst_mm = 0.0;
};

ErrorDistribution distribution_of(const std::vector<Eigen::Vector3d>& errors);

/** That of the thesis' own trials, in the axes of its table. */
ErrorDistribution published_distribution(const Robot& robot);

}  // namespace interlock
