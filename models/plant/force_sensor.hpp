/**
 * @file
 * A force sensor behind the analog inputs of a sensor card.
 */
#ifndef INTERLOCK_PLANT_FORCE_SENSOR_HPP
#define INTERLOCK_PLANT_FORCE_SENSOR_HPP

#include "plant/parameters.hpp"
#include "plant/random.hpp"
#include "plant/wire.hpp"

namespace interlock::plant {

class ForceSensor {
 public:
  /** @param noise the sensor's own stream of random numbers */
  ForceSensor(const SensorParameters& parameters, const Random& noise)
      : parameters_(parameters), noise_(noise) {}

  /** Presses on the sensor: its input reads so many counts more, or less, until it is pressed again. */
  void press(std::size_t input, std::int32_t counts) { force_counts_[input] = counts; }

  /** Something in the surroundings presses besides. */
  void load(std::size_t input, std::int32_t counts) { load_counts_[input] = counts; }

  /** No hand presses on any input. */
  void release() { force_counts_ = {}; }

  /** What the converters read now, noise included; 0 where nothing is connected. */
  wire::AnalogReadings read();

  const std::string& name() const { return parameters_.name; }
  bool is_connected(std::size_t input) const { return parameters_.input[input].has_value(); }
  std::int32_t force_counts(std::size_t input) const { return force_counts_[input]; }

  /** The reading without noise. */
  std::uint16_t counts(std::size_t input) const { return at(input, 0); }

 private:
  std::uint16_t at(std::size_t input, std::int64_t noise_counts) const;

  SensorParameters parameters_;
  Random noise_;
  std::array<std::int32_t, wire::kAnalogInputs> force_counts_{};
  std::array<std::int32_t, wire::kAnalogInputs> load_counts_{};
};

}  // namespace interlock::plant

#endif
