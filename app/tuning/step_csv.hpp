/**
 * @file
 * A run as a table: a row for each control tick.
 */
#pragma once

#include <string>

#include "tuning/step_run.hpp"

namespace interlock {

/**
 * Header and rows with the columns time_s, position_counts (as read), setpoint_counts,
 * velocity_counts_per_s (true), setpoint_velocity_counts_per_s, drive and
 * estimated_velocity_counts_per_s, which is empty while it is not known.
 */
std::string step_csv(const StepRun& run);

}  // namespace interlock
