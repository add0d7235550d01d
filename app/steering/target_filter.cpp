#include "steering/target_filter.hpp"

#include "kinematics/domain.hpp"

namespace interlock {
namespace {

constexpr double latest_s = 1e6;

KinematicsResult<void> check_target(const Eigen::Vector3d& target_mm) noexcept {
  return check_point({"target_x_mm", "target_y_mm", "target_z_mm"}, target_mm);
}

}  // namespace

KinematicsResult<TargetFilter> TargetFilter::create(const TargetBelief& belief,
                                                    const Eigen::Vector3d& target_mm,
                                                    double time_s) noexcept {
  return check_range("shift_sd_mm", belief.shift_sd_mm, 0.0, 1000.0)
      .and_then([&] { return check_range("wander_mm", belief.wander_mm, 0.0, 100.0); })
      .and_then([&] { return check_range("image_sd_mm", belief.image_sd_mm, 1e-3, 100.0); })
      .and_then([&] { return check_range("farthest_mm", belief.farthest_mm, 0.0, length_limit_mm); })
      .and_then([&] { return check_range("time_s", time_s, -latest_s, latest_s); })
      .and_then([&] { return check_target(target_mm); })
      .map([&] { return TargetFilter(belief, target_mm, time_s); });
}

TargetFilter::TargetFilter(const TargetBelief& belief, const Eigen::Vector3d& target_mm,
                           double time_s) noexcept
    : belief_(belief),
      planned_mm_(target_mm),
      target_mm_(target_mm),
      variance_mm2_(belief.shift_sd_mm * belief.shift_sd_mm),
      time_s_(time_s) {}

KinematicsResult<void> TargetFilter::see(double time_s, const Eigen::Vector3d& target_mm) noexcept {
  return check_range("image_time_s", time_s, time_s_, latest_s)
      .and_then([&] { return check_target(target_mm); })
      .and_then([&] {
        const double image_mm2 = belief_.image_sd_mm * belief_.image_sd_mm;
        double variance_mm2 = variance_mm2_ + belief_.wander_mm * belief_.wander_mm * (time_s - time_s_);
        if (watch_.add((target_mm - target_mm_).squaredNorm() / (variance_mm2 + image_mm2))) {
          variance_mm2 = belief_.shift_sd_mm * belief_.shift_sd_mm;  // it is elsewhere now
        }
        const double shift_mm = (target_mm - planned_mm_).norm();
        return check_range("target_shift_mm", shift_mm, 0.0, belief_.farthest_mm).map([&] {
          const double gain = variance_mm2 / (variance_mm2 + image_mm2);
          target_mm_ += gain * (target_mm - target_mm_);
          variance_mm2_ = (1.0 - gain) * variance_mm2;
          time_s_ = time_s;
        });
      });
}

}  // namespace interlock
