#include "steering/force_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinematics/domain.hpp"

namespace interlock {
namespace {

KinematicsResult<void> check_reading(std::uint32_t reading) noexcept {
  return check_range("force_reading_counts", reading, 0.0, largest_reading);
}

}  // namespace

KinematicsResult<ForceCalibration> ForceCalibration::create(const SensorChannel& channel,
                                                            double units_per_newton) noexcept {
  return check_range("force_slope_magnitude", std::abs(channel.slope), 1e-6, 1e6)
      .and_then([&] { return check_reading(channel.reference); })
      .and_then(
          [&] { return check_range("units_per_newton_magnitude", std::abs(units_per_newton), 1e-6, 1e6); })
      .map([&] {
        // The intercept falls out of the difference to the zero.
        return ForceCalibration(channel.slope / units_per_newton, channel.reference);
      });
}

KinematicsResult<double> ForceCalibration::force_n(std::uint32_t reading) const noexcept {
  return check_reading(reading).map([&] { return newton_per_count_ * (reading - zero_counts_); });
}

KinematicsResult<ForceCalibration> ForceCalibration::zeroed(std::span<const std::uint32_t> readings,
                                                            const ZeroingRules& rules) const noexcept {
  const double scale_n = std::abs(newton_per_count_);
  const double least = std::max<double>(1.0, static_cast<double>(rules.least_readings));
  return check_range("zeroing_readings", static_cast<double>(readings.size()), least, 1e9)
      .and_then([&]() -> KinematicsResult<ForceCalibration> {
        const auto [smallest, largest] = std::minmax_element(readings.begin(), readings.end());
        const double mean =
            std::accumulate(readings.begin(), readings.end(), 0.0) / static_cast<double>(readings.size());
        return check_reading(*largest)
            .and_then([&] {
              return check_range("zeroing_spread_n", scale_n * (*largest - *smallest), 0.0,
                                 rules.widest_spread_n);
            })
            .and_then([&] {
              return check_range("zeroing_distance_n", scale_n * std::abs(mean - file_zero_counts_), 0.0,
                                 rules.farthest_n);
            })
            .map([&] {
              ForceCalibration result = *this;
              result.zero_counts_ = mean;
              return result;
            });
      });
}

}  // namespace interlock
