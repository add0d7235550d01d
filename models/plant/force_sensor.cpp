#include "plant/force_sensor.hpp"

#include <algorithm>
#include <limits>

namespace interlock::plant {

std::uint16_t ForceSensor::at(std::size_t input, std::int64_t noise_counts) const {
  if (!parameters_.input[input]) {
    return 0;
  }
  const std::int64_t counts = std::int64_t{parameters_.input[input]->zero_counts} + force_counts_[input] +
                              load_counts_[input] + noise_counts;
  return static_cast<std::uint16_t>(
      std::clamp<std::int64_t>(counts, 0, std::numeric_limits<std::uint16_t>::max()));
}

wire::AnalogReadings ForceSensor::read() {
  wire::AnalogReadings readings{};
  for (std::size_t input = 0; input < readings.size(); ++input) {
    const std::uint32_t widest = parameters_.input[input] ? parameters_.input[input]->noise_counts : 0;
    readings[input] = at(input, std::int64_t{noise_.below(2 * widest + 1)} - widest);
  }
  return readings;
}

}  // namespace interlock::plant
