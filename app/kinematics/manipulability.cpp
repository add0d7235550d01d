#include "kinematics/manipulability.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace interlock {

Manipulability manipulability_of(const ScaledJacobian& scaled) noexcept {
  using Square = Eigen::Matrix<double, 6, 6>;
  using Tall = Eigen::Matrix<double, 10, 6>;
  // A row of zeros and an orthogonal factor change no singular value; a square matrix needs no
  // preconditioner, whose templates take longer to compile than all the rest of the folder.
  Tall transposed = Tall::Zero();
  transposed.topRows(scaled.cols()) = scaled.transpose();
  const Eigen::HouseholderQR<Tall> factors(transposed);
  const Square upper = factors.matrixQR().topRows<6>().triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Square, Eigen::NoQRPreconditioner> decomposition(upper);
  if (decomposition.info() != Eigen::Success) {
    return {};
  }
  const auto& values = decomposition.singularValues();
  return {values.prod(), scaled.cols() == 0 ? 0.0 : values[std::min<Eigen::Index>(6, scaled.cols()) - 1],
          values[0]};
}

}  // namespace interlock
