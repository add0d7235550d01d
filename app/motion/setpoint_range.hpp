/**
 * @file
 * Which setpoints the kernel would accept now.
 */
#pragma once

#include <cstdint>

#include "interlock/types.h"

namespace interlock {

/** Lowest and highest setpoint, both allowed; empty when `lowest > highest`. */
struct SetpointRange {
  std::int32_t lowest_counts = 0;
  std::int32_t highest_counts = 0;

  /** Whether a position lies within, ends included. */
  [[nodiscard]] bool contains(std::int32_t counts) const noexcept {
    return lowest_counts <= counts && counts <= highest_counts;
  }
  bool operator==(const SetpointRange&) const = default;
};

/** The nearest count that 32 bits hold. */
std::int32_t saturated(std::int64_t counts) noexcept;

/**
 * The range of the verdict RANGE: the soft limits less the coasting distance when homed, else the travel less
 * the coasting distance that one press of the pedal allows. Outside MOTION that travel starts where the axis
 * stands.
 */
SetpointRange setpoint_range(const ilk_axis_config_t& rules, const ilk_axis_t& axis,
                             std::uint32_t mode) noexcept;

/** Largest drive of the verdict DRIVE: `unhomed_max_drive` while not homed, else `max_drive`. */
std::uint32_t drive_bound(const ilk_axis_config_t& rules, const ilk_axis_t& axis) noexcept;

}  // namespace interlock
