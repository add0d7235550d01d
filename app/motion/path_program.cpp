#include "motion/path_program.hpp"

namespace interlock {
namespace {

std::uint32_t bit_of(std::uint32_t slot) noexcept { return slot < ILK_SLOTS ? 1u << slot : 0u; }

}  // namespace

std::uint32_t mask_of(const PathLeg& leg) noexcept {
  std::uint32_t mask = 0;
  if (const auto* move = std::get_if<MoveLeg>(&leg)) {
    for (const AxisCounts& target : move->targets) {
      mask |= bit_of(target.slot);
    }
  } else {
    for (const TrajectoryAxis& axis : std::get<TimedLeg>(leg).trajectory.axes()) {
      mask |= bit_of(axis.slot);
    }
  }
  return mask;
}

std::uint32_t PathProgram::mask() const noexcept {
  std::uint32_t mask = 0;
  for (const PathLeg& leg : legs) {
    mask |= mask_of(leg);
  }
  return mask;
}

}  // namespace interlock
