#include "needle/noise.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace interlock::needle {

double Noise::between(double lowest, double highest) {
  constexpr std::uint32_t steps = std::numeric_limits<std::uint32_t>::max();
  const double share = (random_.below(steps) + 0.5) / steps;  // never 0, never 1
  return lowest + share * (highest - lowest);
}

double Noise::normal(double deviation) {
  // Box and Muller; the second number of the pair is not kept, so that each call takes two from the stream.
  const double radius = std::sqrt(-2.0 * std::log(between(0.0, 1.0)));
  return deviation * radius * std::cos(2.0 * std::numbers::pi * between(0.0, 1.0));
}

Eigen::Vector3d Noise::normal_vector(double deviation) {
  const double x = normal(deviation);
  const double y = normal(deviation);
  const double z = normal(deviation);
  return {x, y, z};
}

Eigen::Vector3d Noise::direction() {
  const double z = between(-1.0, 1.0);
  const double angle_rad = between(0.0, 2.0 * std::numbers::pi);
  const double beside = std::sqrt(1.0 - z * z);
  return {beside * std::cos(angle_rad), beside * std::sin(angle_rad), z};
}

}  // namespace interlock::needle
