#include "needle/imager.hpp"

namespace interlock::needle {

std::optional<Image> Imager::at(double time_s, const Eigen::Vector3d& tip_mm,
                                const Eigen::Vector3d& target_mm) {
  if (time_s >= next_s_) {
    next_s_ += parameters_.period_s;
    const Eigen::Vector3d seen_tip_mm = tip_mm + noise_.normal_vector(parameters_.deviation_mm);
    const Eigen::Vector3d seen_target_mm = target_mm + noise_.normal_vector(parameters_.deviation_mm);
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
