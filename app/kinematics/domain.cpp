#include "kinematics/domain.hpp"

#include <cmath>

namespace interlock {

using Code = KinematicsError::Code;

KinematicsResult<void> check_range(std::string_view quantity, double value, double lowest, double highest,
                                   Code code) noexcept {
  if (!std::isfinite(value)) {
    return tl::unexpected(KinematicsError{Code::not_finite, quantity, {}, lowest, highest});
  }
  if (value < lowest || value > highest) {
    return tl::unexpected(KinematicsError{code, quantity, value, lowest, highest});
  }
  return {};
}

KinematicsResult<void> check_geometry(std::string_view quantity, double value, double lowest, double highest,
                                      Code code) noexcept {
  const bool only_rounding = value >= lowest - boundary_slack && value <= highest + boundary_slack;
  return only_rounding ? KinematicsResult<void>{} : check_range(quantity, value, lowest, highest, code);
}

KinematicsResult<void> check_lengths(
    std::initializer_list<std::pair<std::string_view, double>> lengths) noexcept {
  for (const auto& [quantity, length] : lengths) {
    const auto checked = check_range(quantity, length, -length_limit_mm, length_limit_mm);
    if (!checked) {
      return checked;
    }
  }
  return {};
}

KinematicsResult<void> check_point(const std::string_view (&quantities)[3],
                                   const Eigen::Vector3d& point) noexcept {
  return check_lengths({{quantities[0], point.x()}, {quantities[1], point.y()}, {quantities[2], point.z()}});
}

}  // namespace interlock
