/**
 * @file
 * How good a step was, in numbers.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "tuning/step_run.hpp"

namespace interlock {

struct StepFigures {
  double rms_velocity_error_percent = 0.0; /**< true velocity against the profile's at the same time, over the
                                              whole profile, of its peak */
  double largest_position_error_counts =
      0.0;                             /**< true position against the profile's, over the whole profile */
  std::int32_t final_error_counts = 0; /**< last reading less target */
  double overshoot_counts = 0.0;       /**< farthest true position beyond the target */
  std::optional<double> settle_ms; /**< from the end of the profile until the encoder, without noise, stays
                                      within the deadband; nothing if it does not */
};

/** The figures of a run, which has at least one row. */
StepFigures figures_of(const StepRun& run);

}  // namespace interlock
