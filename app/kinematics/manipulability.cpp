#include "kinematics/manipulability.hpp"

#include <Eigen/SVD>

namespace interlock {

Manipulability manipulability_of(const ScaledJacobian& scaled) noexcept {
  const Eigen::JacobiSVD<ScaledJacobian> decomposition(scaled);
  const auto& values = decomposition.singularValues();
  return {values.prod(), values.minCoeff(), values.maxCoeff()};
}

}  // namespace interlock
