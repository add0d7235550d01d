#include <array>
#include <cstdio>

#include "tuning/step_run.hpp"

namespace interlock {

std::string step_csv(const StepRun& run) {
  std::string text =
      "time_s,position_counts,setpoint_counts,velocity_counts_per_s,setpoint_velocity_counts_per_s,drive,"
      "estimated_velocity_counts_per_s\n";
  std::array<char, 160> line{};
  for (const StepRow& row : run.rows) {
    const int length =
        std::snprintf(line.data(), line.size(), "%.6f,%d,%.3f,%.3f,%.3f,%u,", row.time_s, row.position_counts,
                      row.setpoint.position_counts, row.true_velocity_counts_per_s,
                      row.setpoint.velocity_counts_per_s, row.drive);
    text.append(line.data(), static_cast<std::size_t>(length));
    if (row.estimated_velocity_counts_per_s) {
      const int rest = std::snprintf(line.data(), line.size(), "%.3f", *row.estimated_velocity_counts_per_s);
      text.append(line.data(), static_cast<std::size_t>(rest));
    }
    text += '\n';
  }
  return text;
}

}  // namespace interlock
