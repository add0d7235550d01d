/**
 * @file
 * Asks Ruckig for a plan, and once more where its arithmetic finds none though there is one.
 */
#pragma once

#include <ruckig/ruckig.hpp>

namespace interlock {

/**
 * What Ruckig says of the input. Where two shapes of the fastest motion meet, as at a way of exactly 2 a³/j²
 * from rest to rest, Ruckig 0.19 at times takes neither for valid (errors -110, -111). A jerk smaller by a
 * millionth leads around it, and is within the limits.
 */
template <typename Planner, typename Input, typename Output>
ruckig::Result calculate(Planner& planner, Input& input, Output& output) {
  constexpr int most_attempts = 4;
  constexpr double less = 1.0 - 1e-6;
  ruckig::Result result = planner.calculate(input, output);
  for (int attempt = 1; attempt < most_attempts && (result == ruckig::ErrorExecutionTimeCalculation ||
                                                    result == ruckig::ErrorSynchronizationCalculation);
       ++attempt) {
    for (double& jerk : input.max_jerk) {
      jerk *= less;
    }
    result = planner.calculate(input, output);
  }
  return result;
}

}  // namespace interlock
