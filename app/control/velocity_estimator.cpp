#include "control/velocity_estimator.hpp"

#include <algorithm>
#include <cmath>

namespace interlock {
void VelocityEstimator::add(std::int32_t position_counts, std::uint32_t time_us) noexcept {
  if (count_ != 0) {
    const std::uint32_t later_us = time_us - sample(0).time_us;
    if (0u - later_us <= rules_.window_us) {
      return;
    }
    if (later_us > rules_.window_us || is_jump(position_counts, later_us)) {
      count_ = 0;
    }
  }
  samples_[next_] = {position_counts, time_us};
  next_ = (next_ + 1) % most_samples;
  count_ = std::min(count_ + 1, most_samples);
  while (covered_us() > rules_.window_us) {
    --count_;
  }
}

bool VelocityEstimator::is_jump(std::int32_t position_counts, std::uint32_t later_us) const noexcept {
  const double step = std::abs(static_cast<double>(position_counts) - sample(0).position_counts);
  return !(step <= rules_.fastest_counts_per_s * later_us / us_per_s + rules_.noise_counts);
}

std::uint32_t VelocityEstimator::covered_us() const noexcept {
  return sample(0).time_us - sample(count_ - 1).time_us;
}

std::optional<VelocityEstimate> VelocityEstimator::estimate() const noexcept {
  if (count_ < 2 || covered_us() < rules_.window_us / 2) {
    return std::nullopt;
  }
  // Times and positions before the newest reading: small whole numbers, so that every sum is exact.
  double sum_t = 0.0;
  double sum_p = 0.0;
  double sum_tt = 0.0;
  double sum_tp = 0.0;
  for (std::size_t age = 1; age < count_; ++age) {
    const double t = sample(0).time_us - sample(age).time_us;
    const double p = static_cast<double>(sample(0).position_counts) - sample(age).position_counts;
    sum_t += t;
    sum_p += p;
    sum_tt += t * t;
    sum_tp += t * p;
  }
  const auto n = static_cast<double>(count_);
  const double spread = n * sum_tt - sum_t * sum_t;
  return VelocityEstimate{(n * sum_tp - sum_t * sum_p) / spread * us_per_s, sum_t / n / us_per_s};
}

}  // namespace interlock
