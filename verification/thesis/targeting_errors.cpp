#include "targeting_errors.hpp"

#include <algorithm>
#include <cmath>

#include "thesis_trials.hpp"

namespace interlock {
namespace {

std::vector<Eigen::Vector3d> published_errors(const Robot& robot) {
  std::vector<Eigen::Vector3d> errors;
  for (const ThesisTrial& trial : thesis_table(robot).trials) {
    errors.push_back(trial.actual - trial.desired);
  }
  return errors;
}

}  // namespace

Eigen::Vector3d MechanicalError::draw(std::mt19937_64& random) const {
  std::normal_distribution<double> standard;
  Eigen::Vector3d drawn = mean;
  for (int axis = 0; axis < 3; ++axis) {
    drawn(axis) += deviation(axis) * standard(random);
  }
  return drawn;
}

MechanicalError published_error(const Robot& robot) {
  const std::vector<Eigen::Vector3d> errors = published_errors(robot);
  const auto count = static_cast<double>(errors.size());
  MechanicalError published;
  for (const Eigen::Vector3d& error : errors) {
    published.mean += error / count;
  }
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& error : errors) {
    squares += (error - published.mean).cwiseAbs2();
  }
  published.deviation = (squares / (count - 1.0)).cwiseSqrt();
  return published;
}

ErrorDistribution distribution_of(const std::vector<Eigen::Vector3d>& errors) {
  ErrorDistribution distribution;
  if (errors.empty()) {
    return distribution;
  }
  const auto count = static_cast<double>(errors.size());
  std::vector<double> distances;
  for (const Eigen::Vector3d& error : errors) {
    distribution.mean_absolute_mm += error.cwiseAbs() / count;
    distribution.mean_mm += error.norm() / count;
    distances.push_back(error.norm());
  }
  std::ranges::sort(distances);
  const auto at = [&](double share) {
    return distances[static_cast<std::size_t>(std::lround(share * (count - 1.0)))];
  };
  distribution.insertions = errors.size();
  distribution.median_mm = at(0.5);
  distribution.p95_mm = at(0.95);
  distribution.worst_mm = distances.back();
  return distribution;
}

ErrorDistribution published_distribution(const Robot& robot) {
  return distribution_of(published_errors(robot));
}

}  // namespace interlock
