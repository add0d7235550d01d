#include "needle/hand.hpp"

#include <cmath>
#include <numbers>

namespace interlock::needle {

Hand::Hand(const HandParameters& parameters, const Noise& noise)
    : parameters_(parameters),
      noise_(noise),
      usual_n_(noise_.between(parameters.lightest_n, parameters.hardest_n)),
      sway_rad_(noise_.between(0.0, 2.0 * std::numbers::pi)),
      tremor_rad_(noise_.between(0.0, 2.0 * std::numbers::pi)) {}

double Hand::press(double period_s) {
  time_s_ += period_s;
  if (time_s_ >= pause_until_s_ && noise_.chance(period_s / parameters_.seconds_to_pause)) {
    pause_until_s_ = time_s_ + noise_.between(parameters_.shortest_pause_s, parameters_.longest_pause_s);
  }
  const double wanted = time_s_ >= pause_until_s_ ? 1.0 : 0.0;
  share_ += period_s / (parameters_.lag_s + period_s) * (wanted - share_);
  const double turn_rad = 2.0 * std::numbers::pi * time_s_;
  const double sway = parameters_.sway_share * std::sin(parameters_.sway_hz * turn_rad + sway_rad_);
  const double tremor_n = parameters_.tremor_n * std::sin(parameters_.tremor_hz * turn_rad + tremor_rad_);
  return share_ * (usual_n_ * (1.0 + sway) + tremor_n);
}

}  // namespace interlock::needle
