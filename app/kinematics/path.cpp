#include "kinematics/path.hpp"

#include "kinematics/domain.hpp"

namespace interlock {

KinematicsResult<double> path_length_mm(const Eigen::Vector3d& entry,
                                        const Eigen::Vector3d& target) noexcept {
  const double length_mm = (target - entry).norm();
  return check_point({"entry_x_mm", "entry_y_mm", "entry_z_mm"}, entry)
      .and_then([&] { return check_point({"target_x_mm", "target_y_mm", "target_z_mm"}, target); })
      .and_then([&] {
        return check_range("entry_to_target_mm", length_mm, shortest_path_mm, 4.0 * length_limit_mm,
                           KinematicsError::Code::degenerate);
      })
      .map([&] { return length_mm; });
}

KinematicsResult<void> check_on_axis(const Pose& pose, const std::optional<Eigen::Vector3d>& entry) noexcept {
  const auto rigid = check_rigid(pose);
  if (!rigid || !entry) {
    return rigid;
  }
  return path_length_mm(*entry, pose.translation()).and_then([&](double length_mm) {
    const Eigen::Vector3d ahead = (pose.translation() - *entry) / length_mm;
    return check_range("entry_direction_error", (ahead - pose.linear().col(2)).norm(), 0.0, axis_tolerance,
                       KinematicsError::Code::off_axis);
  });
}

}  // namespace interlock
