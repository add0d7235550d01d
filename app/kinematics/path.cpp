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

}  // namespace interlock
