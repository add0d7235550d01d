/**
 * @file
 * Errors of targeting: how they are distributed, and those that the thesis' tables show, to be injected.
 */
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <random>
#include <vector>

#include "robot/robot.hpp"

namespace interlock {

/**
 * What lies between the encoders and the tip, as an offset of the treatment point: play, bending, clearances.
 * It is drawn anew with every insertion, each axis by itself, from a normal distribution. In mm, in the axes
 * of the robot's table.
 */
struct MechanicalError {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();

  /** One error (mm), drawn from the distribution. */
  [[nodiscard]] Eigen::Vector3d draw(std::mt19937_64& random) const;
};

/** Mean and sample standard deviation of the errors in the table of the robot's family, recomputed from its
 * positions. */
MechanicalError published_error(const Robot& robot);

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
