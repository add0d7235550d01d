#include "steering/membrane_detector.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/domain.hpp"
#include "steering/angle.hpp"

namespace interlock {
namespace {

/** Below it the needle is in no tissue. */
constexpr double least_force_n = 0.1;

std::size_t periods_of(double time_s, double period_s) noexcept {
  return static_cast<std::size_t>(std::llround(time_s / period_s));
}

KinematicsResult<void> check_cue(const CueParameters& cue) noexcept {
  return check_range("cue_amplitude_mm", cue.amplitude_mm, 0.0, 1.0)
      .and_then([&] { return check_range("cue_frequency_hz", cue.frequency_hz, 0.1, 100.0); })
      .and_then([&] { return check_range("cue_periods", static_cast<double>(cue.periods), 0.0, 100.0); });
}

KinematicsResult<void> check_rule(const MembraneParameters& rule) noexcept {
  return check_range("period_s", rule.period_s, 1e-4, 0.1)
      .and_then([&] { return check_range("cutoff_hz", rule.cutoff_hz, 0.1, 0.5 / rule.period_s); })
      .and_then([&] { return check_range("arm_mm", rule.arm_mm, 0.0, 100.0); })
      .and_then([&] { return check_range("skip_mm", rule.skip_mm, rule.arm_mm, 200.0); })
      .and_then([&] { return check_range("least_peak_n", rule.least_peak_n, 0.0, 1000.0); })
      .and_then([&] { return check_range("least_drop_n", rule.least_drop_n, 1e-3, 1000.0); })
      .and_then([&] { return check_range("least_drop_share", rule.least_drop_share, 0.0, 1.0); })
      .and_then([&] { return check_range("drop_time_s", rule.drop_time_s, rule.period_s, 1.0); })
      .and_then([&] { return check_range("slowest_mm_s", rule.slowest_mm_s, 0.0, 100.0); })
      .and_then([&] { return check_range("slowest_share", rule.slowest_share, 0.0, 1.0); })
      .and_then([&] { return check_range("refractory_s", rule.refractory_s, 0.0, 60.0); })
      .and_then([&] { return check_range("roughest_n", rule.roughest_n, 1e-3, 1000.0); })
      .and_then([&] { return check_range("rough_time_s", rule.rough_time_s, 3.0 * rule.period_s, 60.0); })
      .and_then([&] { return check_cue(rule.cue); });
}

KinematicsResult<void> check_depths(std::span<const double> depths_mm) noexcept {
  double least_mm = 0.0;
  auto checked = check_range("membrane_count", static_cast<double>(depths_mm.size()), 0.0,
                             static_cast<double>(MembraneDetector::most_membranes));
  for (std::size_t membrane = 0; checked && membrane < depths_mm.size(); ++membrane) {
    checked = check_range("membrane_depth_mm", depths_mm[membrane], least_mm, length_limit_mm);
    least_mm = std::nextafter(depths_mm[membrane], length_limit_mm);
  }
  return checked;
}

KinematicsResult<void> check_sample(const MembraneSample& sample) noexcept {
  return check_range("force_n", sample.force_n, -1e4, 1e4)
      .and_then([&] { return check_lengths({{"depth_mm", sample.depth_mm}}); })
      .and_then([&] { return check_range("speed_mm_s", sample.speed_mm_s, -1000.0, 1000.0); });
}

}  // namespace

double cue_offset_mm(const CueParameters& cue, double since_s) noexcept {
  const double turns = cue.frequency_hz * since_s;
  const bool sways = turns >= 0.0 && turns < static_cast<double>(cue.periods);
  return sways ? cue.amplitude_mm * std::sin(full_turn_rad * turns) : 0.0;
}

KinematicsResult<MembraneDetector> MembraneDetector::create(const MembraneParameters& parameters,
                                                            std::span<const double> depths_mm) {
  return check_rule(parameters).and_then([&] { return check_depths(depths_mm); }).map([&] {
    return MembraneDetector(parameters, depths_mm);
  });
}

MembraneDetector::MembraneDetector(const MembraneParameters& parameters, std::span<const double> depths_mm)
    : parameters_(parameters),
      count_(depths_mm.size()),
      window_(std::max<std::size_t>(1, periods_of(parameters.drop_time_s, parameters.period_s))) {
  std::copy(depths_mm.begin(), depths_mm.end(), depths_mm_.begin());
}

KinematicsResult<MembraneState> MembraneDetector::step(const MembraneSample& sample) noexcept {
  const auto checked = check_sample(sample);
  if (!checked) {
    return tl::unexpected(checked.error());
  }
  low_pass(sample.force_n);
  while (left() > 0 && sample.depth_mm > depths_mm_[next_] + parameters_.skip_mm) {
    close({});
  }
  const bool near_membrane =
      left() > 0 && std::abs(sample.depth_mm - depths_mm_[next_]) <= parameters_.arm_mm;
  const bool goes_in = sample.speed_mm_s >= parameters_.slowest_mm_s && deaf_periods_ == 0;
  deaf_periods_ -= deaf_periods_ > 0 ? 1 : 0;
  if (!goes_in || near_membrane != near_membrane_) {
    taken_ = 0;
    near_membrane_ = near_membrane;
  }
  MembraneState state{.armed = goes_in && near_membrane, .rough = is_rough()};
  if (state.armed) {
    take(sample);
    const Taken& highest = peak();
    state.found = !state.rough && is_drop(highest, sample.speed_mm_s);
    if (state.found) {
      close(highest.sample.depth_mm);
      deaf_periods_ = periods_of(parameters_.refractory_s, parameters_.period_s);
      cue_periods_ = 0;
    }
  } else if (goes_in && is_clear(sample.depth_mm)) {
    measure_roughness(sample);
    take(sample);
  }
  if (cue_periods_) {
    const double since_s = static_cast<double>(*cue_periods_) * parameters_.period_s;
    state.cue_offset_mm = cue_offset_mm(parameters_.cue, since_s);
    const bool over = parameters_.cue.frequency_hz * since_s >= static_cast<double>(parameters_.cue.periods);
    cue_periods_ = over ? std::nullopt : std::optional(*cue_periods_ + 1);
  }
  return state;
}

void MembraneDetector::reset() noexcept {
  next_ = 0;
  taken_ = 0;
  deaf_periods_ = 0;
  settled_ = false;
  fall_n2_ = 0.0;
  falls_ = 0;
  cue_periods_.reset();
}

void MembraneDetector::low_pass(double force_n) noexcept {
  const double share = 1.0 - std::exp(-full_turn_rad * parameters_.cutoff_hz * parameters_.period_s);
  force_n_ = settled_ ? force_n_ + share * (force_n - force_n_) : force_n;
  settled_ = true;
}

/** No membrane can be here, whether it is left or not. */
bool MembraneDetector::is_clear(double depth_mm) const noexcept {
  const bool before_next = left() == 0 || depth_mm < depths_mm_[next_] - parameters_.skip_mm;
  return before_next && (next_ == 0 || depth_mm > depths_mm_[next_ - 1] + parameters_.skip_mm);
}

void MembraneDetector::measure_roughness(const MembraneSample& sample) noexcept {
  const Taken& oldest = window_[taken_ % window_.size()];
  const bool even = sample.speed_mm_s >= parameters_.slowest_share * oldest.sample.speed_mm_s;
  if (taken_ < window_.size() || oldest.force_n < least_force_n || !even) {
    return;
  }
  const double fall_n = std::max(0.0, oldest.force_n - force_n_);
  ++falls_;
  const double share =
      std::max(1.0 / static_cast<double>(falls_), parameters_.period_s / parameters_.rough_time_s);
  fall_n2_ += share * (fall_n * fall_n - fall_n2_);
}

bool MembraneDetector::is_rough() const noexcept {
  const bool known = static_cast<double>(falls_) * parameters_.period_s >= parameters_.rough_time_s / 3.0;
  return known && fall_n2_ > parameters_.roughest_n * parameters_.roughest_n;
}

void MembraneDetector::take(const MembraneSample& sample) noexcept {
  window_[taken_ % window_.size()] = {force_n_, sample};
  ++taken_;
}

const MembraneDetector::Taken& MembraneDetector::peak() const noexcept {
  const auto end = window_.begin() + static_cast<std::ptrdiff_t>(std::min(taken_, window_.size()));
  return *std::max_element(window_.begin(), end, [](const Taken& left, const Taken& right) {
    return left.force_n < right.force_n;
  });
}

bool MembraneDetector::is_drop(const Taken& peak, double speed_mm_s) const noexcept {
  const double least_n = std::max(parameters_.least_drop_n, parameters_.least_drop_share * peak.force_n);
  return peak.force_n >= parameters_.least_peak_n && peak.force_n - force_n_ >= least_n &&
         speed_mm_s >= parameters_.slowest_share * peak.sample.speed_mm_s;
}

void MembraneDetector::close(MembraneRecord record) noexcept {
  records_[next_] = record;
  ++next_;
  taken_ = 0;
}

}  // namespace interlock
