#include "targeting/registration.hpp"

#include <Eigen/LU>

namespace interlock {
namespace {

/** Newton's iteration for the polar factor (Higham 1986): each step squares the error, so that from
 * `registration_tolerance` three steps reach the last digit; the fourth is for safety. */
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& almost) noexcept {
  Eigen::Matrix3d rotation = almost;
  for (int step = 0; step < 4; ++step) {
    rotation = 0.5 * (rotation + rotation.inverse().transpose()).eval();
  }
  return rotation;
}

}  // namespace

KinematicsResult<Registration> Registration::create(const RowMajor& numbers, bool ignore_rotation) noexcept {
  return pose_from(numbers, registration_tolerance).map([&](Pose pose) {
    pose.linear() = ignore_rotation ? Eigen::Matrix3d::Identity().eval() : nearest_rotation(pose.linear());
    return Registration(pose);
  });
}

}  // namespace interlock
