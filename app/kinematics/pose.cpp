#include "kinematics/pose.hpp"

#include <cmath>

#include "kinematics/domain.hpp"

namespace interlock {

using Code = KinematicsError::Code;
using RowMajorMatrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

Eigen::Matrix3d rotation_x(double angle_rad) noexcept {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return (Eigen::Matrix3d() << 1, 0, 0, 0, c, -s, 0, s, c).finished();
}

Eigen::Matrix3d rotation_y(double angle_rad) noexcept {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return (Eigen::Matrix3d() << c, 0, s, 0, 1, 0, -s, 0, c).finished();
}

Eigen::Matrix3d rotation_z(double angle_rad) noexcept {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return (Eigen::Matrix3d() << c, -s, 0, s, c, 0, 0, 0, 1).finished();
}

KinematicsResult<void> check_rigid(const Pose& pose, double tolerance) noexcept {
  const Eigen::Matrix3d rotation = pose.linear();
  for (int entry = 0; entry < 9; ++entry) {
    const auto checked = check_range("pose_rotation_entry", rotation.data()[entry], -1.0 - tolerance,
                                     1.0 + tolerance, Code::not_rigid);
    if (!checked) {
      return checked;
    }
  }
  const Eigen::Matrix3d gram = rotation.transpose() * rotation;
  const double slip = (gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return check_range("pose_orthonormality_error", slip, 0.0, tolerance, Code::not_rigid)
      .and_then([&] {
        // All but the sign follows from the line before, within half of this.
        return check_range("pose_determinant", rotation.determinant(), 1.0 - 3.0 * tolerance,
                           1.0 + 3.0 * tolerance, Code::not_rigid);
      })
      .and_then([&] { return check_point({"pose_x_mm", "pose_y_mm", "pose_z_mm"}, pose.translation()); });
}

KinematicsResult<Pose> pose_from(const RowMajor& numbers, double tolerance) noexcept {
  Pose pose;
  pose.matrix() = Eigen::Map<const RowMajorMatrix>(numbers.data());
  for (int column = 0; column < 4; ++column) {
    const double expected = column == 3 ? 1.0 : 0.0;
    const auto checked =
        check_range("pose_last_row_entry", pose(3, column), expected, expected, Code::not_rigid);
    if (!checked) {
      return tl::unexpected(checked.error());
    }
  }
  return check_rigid(pose, tolerance).map([&] { return pose; });
}

RowMajor row_major(const Pose& pose) noexcept {
  RowMajor numbers{};
  Eigen::Map<RowMajorMatrix>(numbers.data()) = pose.matrix();
  return numbers;
}

Deviation deviation(const Pose& reached, const Pose& desired) noexcept {
  const Eigen::Vector3d offset = reached.translation() - desired.translation();
  const Eigen::Vector3d ahead = reached.linear().col(2);
  const Eigen::Vector3d asked = desired.linear().col(2);
  return {offset, offset.norm(), std::atan2(ahead.cross(asked).norm(), ahead.dot(asked))};
}

}  // namespace interlock
