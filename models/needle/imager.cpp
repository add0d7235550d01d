#include "needle/imager.hpp"

#include <cmath>
#include <numbers>

namespace interlock::needle {

std::optional<Image> Imager::at(double time_s, const Eigen::Vector3d& tip_mm,
                                const Eigen::Vector3d& target_mm) {
  if (time_s >= next_s_) {
    next_s_ += parameters_.period_s;
    const double breath_mm =
        parameters_.breathing_mm * std::sin(2 * std::numbers::pi * time_s / parameters_.breath_s);
    const Eigen::Vector3d all_mm(0.0, breath_mm, 0.0);
    const Eigen::Vector3d seen_tip_mm = tip_mm + noise_.normal_vector(parameters_.deviation_mm) + all_mm +
                                        Eigen::Vector3d(parameters_.tip_bias_mm, 0.0, 0.0);
    const Eigen::Vector3d seen_target_mm =
        target_mm + noise_.normal_vector(parameters_.deviation_mm) + all_mm;
    on_the_way_.push_back({time_s, seen_tip_mm, seen_target_mm});
  }
  if (on_the_way_.empty() || time_s < on_the_way_.front().time_s + parameters_.age_s) {
    return std::nullopt;
  }
  const Image arrived = on_the_way_.front();
  on_the_way_.pop_front();
  return arrived;
}

}  // namespace interlock::needle
