/**
 * @file
 * What the mode "cooperative_biopsy" needs to know of a robot: its force sensor, where the needle meets the
 * skin, what a hand's force means, and the membranes that are expected.
 */
#pragma once

#include <cstdint>
#include <vector>

#include "robot/sensor.hpp"

namespace interlock {

struct Biopsy {
  /** As many membranes as the detector takes. */
  static constexpr std::size_t most_membranes = 16;

  std::uint32_t sensor_slot = 0;
  SensorChannel hand;            /**< force of the surgeon's hand */
  SensorChannel needle;          /**< force at the needle */
  double units_per_newton = 1.0; /**< of both channels: the unit of their published lines is not published */
  double entry_mm = 0.0;         /**< insertion at which the tip is at the skin */
  double deadband_n = 1.0;
  double gain_mm_s_n = 1.0;
  double fastest_mm_s = 5.0;
  double curvature_per_mm = 0.0041; /**< largest of the needle, as believed before the first image */
  std::vector<double> membranes_mm; /**< depths below the skin, until somebody sets others */

  bool operator==(const Biopsy&) const = default;
};

}  // namespace interlock
