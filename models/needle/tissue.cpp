#include "needle/tissue.hpp"

#include <algorithm>
#include <cmath>

namespace interlock::needle {

Tissue::Tissue(const TissueParameters& parameters, const Noise& noise)
    : parameters_(parameters),
      noise_(noise),
      torn_n_(parameters.membranes.size(), -1.0),
      texture_n_(noise_.normal(parameters.texture_n)) {}

double Tissue::press(double depth_mm, double period_s) {
  time_s_ += period_s;
  const double speed_mm_s = (depth_mm - depth_mm_) / period_s;
  depth_mm_ = depth_mm;
  if (depth_mm > deepest_mm_) {
    cut(depth_mm - deepest_mm_);
    deepest_mm_ = depth_mm;
  }
  stick_mm_ = std::clamp(stick_mm_, depth_mm - parameters_.slip_mm, depth_mm + parameters_.slip_mm);
  const double grip = (depth_mm - stick_mm_) / parameters_.slip_mm;
  const double tip_n = cutting_n_ + texture_n_ + membranes(period_s);
  return grip * friction_n_ + std::max(0.0, grip) * tip_n + parameters_.viscosity_n_s_per_mm * speed_mm_s;
}

const Layer& Tissue::layer() const {
  double below_mm = 0.0;
  for (const Layer& layer : parameters_.layers) {
    below_mm += layer.thickness_mm;
    if (deepest_mm_ < below_mm) {
      return layer;
    }
  }
  return parameters_.layers.back();
}

void Tissue::cut(double way_mm) {
  const Layer& here = layer();
  const double most_n = here.stiffness_n_per_mm * way_mm;
  cutting_n_ += std::clamp(here.cutting_n - cutting_n_, -most_n, most_n);
  friction_n_ += here.friction_n_per_mm * way_mm;
  const double kept = std::exp(-way_mm / parameters_.texture_mm);
  texture_n_ = kept * texture_n_ + noise_.normal(parameters_.texture_n * std::sqrt(1.0 - kept * kept));
}

double Tissue::membranes(double period_s) {
  double force_n = 0.0;
  for (std::size_t number = 0; number < torn_n_.size(); ++number) {
    const Membrane& membrane = parameters_.membranes[number];
    double& torn_n = torn_n_[number];
    const double leaning_n = membrane.stiffness_n_per_mm * (deepest_mm_ - membrane.depth_mm);
    if (torn_n >= 0.0) {
      torn_n *= membrane.relaxation_s / (membrane.relaxation_s + period_s);
      force_n += torn_n;
    } else if (leaning_n >= membrane.puncture_n) {
      torn_n = membrane.puncture_n;
      punctures_.push_back({number, time_s_, deepest_mm_});
      force_n += torn_n;
    } else {
      force_n += std::max(0.0, leaning_n);
    }
  }
  return force_n;
}

}  // namespace interlock::needle
