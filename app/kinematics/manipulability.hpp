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
#include <array>
#include <cstddef>

#include "kinematics/joints.hpp"

namespace interlock {

/** Singular values of the scaled Jacobian, without unit. */
struct Manipulability {
  double measure = 0.0;  /**< product of all six: Yoshikawa's sqrt(det(J Jᵀ)); 0 where a direction is lost */
  double smallest = 0.0; /**< tool motion per joint motion in the worst direction */
  double largest = 0.0;  /**< and in the best */
};

/** A Jacobian whose entries have no unit any more. */
using ScaledJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 7>;

/** Of a scaled Jacobian; all zero when an entry is not finite. */
Manipulability manipulability_of(const ScaledJacobian& scaled) noexcept;

/** Of a Jacobian with columns as `fields`; the characteristic length lies between 0.001 and 10 000 mm. */
template <typename Joints, int columns, std::size_t count>
KinematicsResult<Manipulability> manipulability(const Eigen::Matrix<double, 6, columns>& jacobian,
                                                const std::array<JointField<Joints>, count>& fields,
                                                double characteristic_length_mm) noexcept {
  static_assert(columns == static_cast<int>(count));
  return check_range("characteristic_length_mm", characteristic_length_mm, 0.001, length_limit_mm).map([&] {
    ScaledJacobian scaled = jacobian;
    scaled.template bottomRows<3>() *= characteristic_length_mm;
    for (std::size_t joint = 0; joint < count; ++joint) {
      if (fields[joint].unit == Unit::rad) {
        scaled.col(static_cast<Eigen::Index>(joint)) /= characteristic_length_mm;
      }
    }
    return manipulability_of(scaled);
  });
}

}  // namespace interlock
