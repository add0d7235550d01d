#include "targeting_errors.hpp"

#include <algorithm>
#include <cmath>

#include "thesis_trials.hpp"

namespace interlock {

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
  std::vector<Eigen::Vector3d> errors;
  for (const ThesisTrial& trial : thesis_table(robot).trials) {
    errors.push_back(trial.actual - trial.desired);
  }
  return distribution_of(errors);
}

}  // namespace interlock
