/**
 * @file
 * How well a robot can move its tool in every direction, from its Jacobian.
 *
 * Millimetres and radians do not add. Here a radian counts as `characteristic_length_mm` millimetres, for the
 * tool and for the joints alike: angular rows are multiplied by it, columns of rotating joints divided by it,
 * and the matrix becomes a plain ratio. Values compare only at one characteristic length.
 */
#pragma once

#include <Eigen/Core>

#include "kinematics/joints.hpp"

namespace interlock {

/** Singular values of the scaled Jacobian, without unit. */
struct Manipulability {
  double measure = 0.0; /**< product of all six: Yoshikawa's sqrt(det(J Jᵀ)); 0 where a direction is lost */
  /** Tool motion per joint motion in the worst direction; with fewer than six joints, the worst of as many
   * directions as there are joints. */
  double smallest = 0.0;
  double largest = 0.0; /**< and in the best */
};

/** A Jacobian whose entries have no unit any more; a robot has at most ten joints. */
using ScaledJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 10>;

/** Of a scaled Jacobian; all zero when an entry is not finite. */
Manipulability manipulability_of(const ScaledJacobian& scaled) noexcept;

/** Of a Jacobian with a column for each of `joints`, in their order; the characteristic length lies between
 * 0.001 and 10 000 mm. */
template <typename Columns, typename Joints>
KinematicsResult<Manipulability> manipulability(const Eigen::MatrixBase<Columns>& jacobian,
                                                const Joints& joints,
                                                double characteristic_length_mm) noexcept {
  return check_range("characteristic_length_mm", characteristic_length_mm, 0.001, length_limit_mm).map([&] {
    ScaledJacobian scaled = jacobian;
    scaled.template bottomRows<3>() *= characteristic_length_mm;
    Eigen::Index column = 0;
    for (const Joint& joint : joints) {
      if (joint.unit == Unit::rad) {
        scaled.col(column) /= characteristic_length_mm;
      }
      ++column;
    }
    return manipulability_of(scaled);
  });
}

}  // namespace interlock
