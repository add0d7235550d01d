#include "steering/curv_law.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/domain.hpp"

namespace interlock {
namespace {

/** How much slower than the fastest the needle turns at an angle from the wanted one: 1 at that, 0 far off.
 */
double slowing(double error_rad, double width_rad) noexcept {
  return std::exp(-error_rad * error_rad / (2.0 * width_rad * width_rad));
}

/** Mean direction of the bevel over one turn, by the rectangle rule: even steps, as the turn is periodic. */
double mean_direction(double alpha, double width_rad) noexcept {
  constexpr int steps = 2000;
  double along = 0.0;
  double time = 0.0;
  for (int step = 0; step < steps; ++step) {
    const double error_rad = full_turn_rad * ((step + 0.5) / steps - 0.5);
    const double spent = 1.0 / (1.0 - alpha * slowing(error_rad, width_rad));
    along += spent * std::cos(error_rad);
    time += spent;
  }
  return along / time;
}

KinematicsResult<void> check_curvatures(double curvature_per_mm, double largest_per_mm) noexcept {
  return check_range("curvature_per_mm", curvature_per_mm, 0.0, curvature_limit_per_mm).and_then([&] {
    return check_range("largest_curvature_per_mm", largest_per_mm, smallest_bend_per_mm,
                       curvature_limit_per_mm);
  });
}

}  // namespace

KinematicsResult<CurvShare> published_share(double curvature_per_mm, double largest_per_mm) noexcept {
  return check_curvatures(curvature_per_mm, largest_per_mm).map([&]() -> CurvShare {
    if (curvature_per_mm >= largest_per_mm) {
      return {1.0, false};
    }
    const double alpha =
        1.082 * std::exp(-11.17 * curvature_per_mm) - 1.08 * std::exp(-842.8 * curvature_per_mm);
    return {curvature_per_mm > 0.0 ? std::clamp(alpha, 0.0, 1.0) : 0.0, true};
  });
}

KinematicsResult<CurvLaw> CurvLaw::create(const CurvParameters& parameters) noexcept {
  return check_range("fastest_rad_s", parameters.fastest_rad_s, 0.1, 1000.0)
      .and_then([&] { return check_range("width_rad", parameters.width_rad, 0.1, std::numbers::pi); })
      .map([&] { return CurvLaw(parameters); });
}

CurvLaw::CurvLaw(const CurvParameters& parameters) noexcept : parameters_(parameters) {
  for (std::size_t entry = 1; entry < intervals; ++entry) {
    const double rest = 1.0 - static_cast<double>(entry) / intervals;
    shares_[entry] = mean_direction(1.0 - rest * rest, parameters.width_rad);
  }
  shares_[intervals] = 1.0;
}

KinematicsResult<double> CurvLaw::speed_rad_s(double angle_rad, double desired_rad,
                                              double alpha) const noexcept {
  return check_range("rotation_rad", angle_rad, -angle_limit_rad, angle_limit_rad)
      .and_then(
          [&] { return check_range("wanted_rotation_rad", desired_rad, -angle_limit_rad, angle_limit_rad); })
      .and_then([&] { return check_range("alpha", alpha, 0.0, 1.0); })
      .map([&] {
        const double error_rad = wrapped_rad(angle_rad - desired_rad);
        return parameters_.fastest_rad_s * (1.0 - alpha * slowing(error_rad, parameters_.width_rad));
      });
}

KinematicsResult<double> CurvLaw::curvature_share(double alpha) const noexcept {
  return check_range("alpha", alpha, 0.0, 1.0).map([&] {
    const double place = intervals * (1.0 - std::sqrt(1.0 - alpha));
    const auto entry = std::min(static_cast<std::size_t>(place), intervals - 1);
    const double part = place - static_cast<double>(entry);
    return shares_[entry] + part * (shares_[entry + 1] - shares_[entry]);
  });
}

KinematicsResult<CurvShare> CurvLaw::averaged_share(double curvature_per_mm,
                                                    double largest_per_mm) const noexcept {
  return check_curvatures(curvature_per_mm, largest_per_mm).map([&]() -> CurvShare {
    const double share = curvature_per_mm / largest_per_mm;
    if (share >= 1.0) {
      return {1.0, false};
    }
    const auto above = std::upper_bound(shares_.begin() + 1, shares_.end() - 1, share);
    const double low = *(above - 1);
    const double part = std::clamp((share - low) / (*above - low), 0.0, 1.0);
    const double rest = 1.0 - (static_cast<double>(above - 1 - shares_.begin()) + part) / intervals;
    return {1.0 - rest * rest, true};
  });
}

}  // namespace interlock
