/**
 * @file
 * A card without a motor: analog channels and what their readings mean.
 */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace interlock {

/**
 * One analog input of a sensor card. A reading of the converter becomes a value by a line, less the value of
 * a reference reading at which nothing acts on the sensor.
 */
struct SensorChannel {
  std::string name;      /**< for programs: "needle_force" */
  std::string title;     /**< for people: "Needle force" */
  std::uint32_t adc = 1; /**< analog input of the card, 1 to 4 */
  double slope = 1.0;    /**< units per count of the converter */
  double intercept = 0.0;
  std::uint32_t reference = 0; /**< counts of the converter when nothing acts on the sensor */
  std::string unit;            /**< "N", or "unspecified" where nobody published it */

  /** What `reading` counts of the converter mean, in `unit`; 0 at the reference. */
  [[nodiscard]] double value(std::uint32_t reading) const;

  bool operator==(const SensorChannel&) const = default;
};

/** One sensor card, by its slot. */
struct Sensor {
  std::uint32_t slot = 0;
  std::string name;
  std::string title;
  bool required = false; /**< losing this card ends MOTION of all axes */
  std::vector<SensorChannel> channels;

  bool operator==(const Sensor&) const = default;
};

}  // namespace interlock
