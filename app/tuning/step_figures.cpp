#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tuning/step_run.hpp"

namespace interlock {
namespace {

double rms_velocity_error(const StepRun& run) {
  double sum = 0.0;
  double count = 0.0;
  for (const StepRow& row : run.rows) {
    if (row.time_s <= run.duration_s) {
      const double error = row.true_velocity_counts_per_s - row.setpoint.velocity_counts_per_s;
      sum += error * error;
      count += 1;
    }
  }
  return std::sqrt(sum / count);
}

double largest_position_error(const StepRun& run) {
  double largest = 0.0;
  for (const StepRow& row : run.rows) {
    if (row.time_s <= run.duration_s) {
      largest = std::max(largest, std::abs(row.true_position_counts - row.setpoint.position_counts));
    }
  }
  return largest;
}

double overshoot(const StepRun& run) {
  const double forward = run.target_counts >= run.from_counts ? 1.0 : -1.0;
  double farthest = 0.0;
  for (const StepRow& row : run.rows) {
    farthest = std::max(farthest, forward * (row.true_position_counts - run.target_counts));
  }
  return farthest;
}

std::optional<double> settle_ms(const StepRun& run) {
  const auto outside = [&](const StepRow& row) {
    return std::abs(std::floor(row.true_position_counts) - run.target_counts) > run.deadband_counts;
  };
  const auto last = std::find_if(run.rows.rbegin(), run.rows.rend(), outside);
  if (last == run.rows.rbegin()) {
    return std::nullopt;
  }
  const double settled_s = last == run.rows.rend() ? 0.0 : last->time_s + run.period_s;
  return std::max(0.0, settled_s - run.duration_s) * 1000;
}

}  // namespace

StepFigures figures_of(const StepRun& run) {
  return {.rms_velocity_error_percent = rms_velocity_error(run) / run.peak_counts_per_s * 100,
          .largest_position_error_counts = largest_position_error(run),
          .final_error_counts = run.rows.back().position_counts - run.target_counts,
          .overshoot_counts = overshoot(run),
          .settle_ms = settle_ms(run)};
}

}  // namespace interlock
