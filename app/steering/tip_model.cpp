#include "steering/tip_model.hpp"

#include <cmath>

#include "kinematics/domain.hpp"
#include "steering/curv_law.hpp"

namespace interlock {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& vector) noexcept {
  return (Eigen::Matrix3d() << 0, -vector.z(), vector.y(), vector.z(), 0, -vector.x(), -vector.y(),
          vector.x(), 0)
      .finished();
}

}  // namespace

Eigen::Vector3d tip_rotation(const NeedleMotion& motion, double curvature_per_mm) noexcept {
  return {curvature_per_mm * motion.insertion_mm, 0.0, motion.rotation_rad};
}

Pose exponential(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) noexcept {
  const double angle = rotation.norm();
  const double squared = angle * angle;
  // Below this the next terms of the series are smaller than the last digit.
  const bool small = angle < 1e-3;
  const double sine_ratio = small ? 1.0 - squared / 6.0 + squared * squared / 120.0 : std::sin(angle) / angle;
  const double half_ratio = small ? 0.5 - squared / 48.0 : std::sin(angle / 2.0) / angle;
  const double cosine_ratio = 2.0 * half_ratio * half_ratio;  // (1 - cos) / squared, without its cancellation
  const double rest_ratio = small ? 1.0 / 6.0 - squared / 120.0 : (1.0 - sine_ratio) / squared;
  const Eigen::Matrix3d cross = cross_matrix(rotation);
  const Eigen::Matrix3d cross_squared = cross * cross;
  Pose pose = Pose::Identity();
  pose.linear() += sine_ratio * cross + cosine_ratio * cross_squared;
  pose.translation() =
      translation + cosine_ratio * (cross * translation) + rest_ratio * (cross_squared * translation);
  return pose;
}

KinematicsResult<void> check_motion(const NeedleMotion& motion, double curvature_per_mm) noexcept {
  return check_range("insertion_mm", motion.insertion_mm, 0.0, length_limit_mm)
      .and_then(
          [&] { return check_range("rotation_rad", motion.rotation_rad, -angle_limit_rad, angle_limit_rad); })
      .and_then(
          [&] { return check_range("curvature_per_mm", curvature_per_mm, 0.0, curvature_limit_per_mm); });
}

KinematicsResult<Pose> moved_tip(const Pose& tip, const NeedleMotion& motion,
                                 double curvature_per_mm) noexcept {
  return check_rigid(tip).and_then([&] { return check_motion(motion, curvature_per_mm); }).map([&]() -> Pose {
    return tip * exponential(Eigen::Vector3d(0.0, 0.0, motion.insertion_mm),
                             tip_rotation(motion, curvature_per_mm));
  });
}

}  // namespace interlock
