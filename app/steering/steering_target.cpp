#include "steering/steering_target.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/domain.hpp"
#include "steering/angle.hpp"
#include "steering/curv_law.hpp"

namespace interlock {

KinematicsResult<SteeringTarget> steering_target(const Eigen::Vector3d& target_in_tip) noexcept {
  const double ahead_mm = target_in_tip.z();
  return check_point({"target_x_mm", "target_y_mm", "target_z_mm"}, target_in_tip)
      .and_then([&] {
        return check_range("target_ahead_mm", ahead_mm, shortest_ahead_mm, length_limit_mm,
                           KinematicsError::Code::out_of_reach);
      })
      .map([&]() -> SteeringTarget {
        const double beside_mm = std::hypot(target_in_tip.x(), target_in_tip.y());
        if (beside_mm == 0.0) {
          return {0.0, 0.0, ahead_mm, 0.0, 0.0};
        }
        const double chord_mm = std::hypot(beside_mm, ahead_mm);
        // The arc spans twice the angle from the tip's axis to the chord.
        const double half_rad = std::atan2(beside_mm, ahead_mm);
        const double sine = beside_mm / chord_mm;
        const double arc_mm = sine > 0.0 ? chord_mm * (half_rad / sine) : chord_mm;
        const double turn_rad = std::atan2(-target_in_tip.x(), target_in_tip.y()) + std::numbers::pi;
        return {within_turn_rad(turn_rad), 2.0 * sine / chord_mm, arc_mm, arc_mm - ahead_mm, beside_mm};
      });
}

KinematicsResult<double> smallest_miss_mm(double beside_mm, double ahead_mm,
                                          double largest_curvature_per_mm) noexcept {
  return check_range("target_beside_mm", beside_mm, 0.0, 2.0 * length_limit_mm)
      .and_then([&] { return check_range("target_ahead_mm", ahead_mm, 0.0, length_limit_mm); })
      .and_then([&] {
        return check_range("largest_curvature_per_mm", largest_curvature_per_mm, smallest_bend_per_mm,
                           curvature_limit_per_mm);
      })
      .map([&] {
        const double sine = largest_curvature_per_mm * ahead_mm;
        const double cosine = std::sqrt(std::max(0.0, 1.0 - sine * sine));
        // From a quarter of the circle on the needle gets no further ahead: its radius is the reach then.
        const double reach_mm = std::min(sine * ahead_mm / (1.0 + cosine), 1.0 / largest_curvature_per_mm);
        return std::max(0.0, beside_mm - reach_mm);
      });
}

}  // namespace interlock
