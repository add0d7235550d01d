#include "motion/drive_law.hpp"

#include <algorithm>

namespace interlock {
namespace {

constexpr std::uint32_t slow_zone_coasts = 3;

}  // namespace

std::uint32_t DriveLaw::at(std::uint64_t distance_counts) const noexcept {
  const std::uint64_t near = std::min<std::uint64_t>(distance_counts, slow_counts);
  const auto proportional =
      dead_zone + static_cast<std::uint32_t>(near * (full_drive - dead_zone) / slow_counts);
  return std::min(std::max(proportional, floor), ceiling);
}

DriveLaw drive_law(const ilk_axis_config_t& rules, const DriveBounds& drive, std::uint32_t ceiling) noexcept {
  DriveLaw law;
  law.full_drive = rules.max_drive;
  law.dead_zone = drive.dead_zone;
  law.floor = floor_drive(drive);
  law.ceiling = std::min(ceiling, rules.max_drive);
  law.slow_counts = std::max(1u, rules.coast_counts * slow_zone_coasts);
  return law;
}

}  // namespace interlock
