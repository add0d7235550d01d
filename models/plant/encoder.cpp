#include "plant/encoder.hpp"

#include <cmath>

namespace interlock::plant {

Encoder::Encoder(bool decreasing, const AxisParameters& parameters)
    : decreasing_(decreasing),
      noise_counts_(parameters.noise_counts),
      noise_chance_(parameters.noise_chance) {
  restart(parameters.start_counts);
}

std::uint32_t Encoder::steps(double position_counts) const {
  const auto whole = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(position_counts)));
  return decreasing_ ? 0u - whole : whole;
}

void Encoder::restart(double position_counts) {
  origin_ = 0u - steps(position_counts);
  frozen_ = 0;
}

void Encoder::stick(bool stuck, double position_counts) {
  if (stuck && !stuck_) {
    frozen_ = count(position_counts);
  } else if (!stuck && stuck_) {
    origin_ = frozen_ - steps(position_counts);
  }
  stuck_ = stuck;
}

std::uint32_t Encoder::count(double position_counts) const {
  return stuck_ ? frozen_ : origin_ + steps(position_counts);
}

std::uint32_t Encoder::read(double position_counts, Random& random) const {
  const bool noisy = random.chance(noise_chance_);
  return count(position_counts) + (noisy && !stuck_ ? noise_counts_ : 0);
}

}  // namespace interlock::plant
