/**
 * @file
 * One axis in every tick, read from the kernel's black box while it is being written.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "recorder/ring.hpp"

namespace interlock::recorder {

/** An axis in one tick. */
struct AxisTick {
  std::uint32_t tick = 0;
  std::uint64_t begun_ns = 0;                  /**< CLOCK_MONOTONIC at which the tick began */
  std::optional<std::int32_t> position_counts; /**< of a valid frame */
  std::optional<std::int32_t> setpoint_counts; /**< while MOVING */
  std::int32_t drive = 0;                      /**< that left the kernel's gate; negative: decreasing */
};

/** Which ticks of which axis. */
struct AxisSpan {
  std::uint32_t slot = 0;
  std::uint32_t seconds = 1;          /**< of kernel time */
  std::optional<std::uint32_t> until; /**< last tick; nothing: the newest */
};

/** The ticks of that span that the ring still holds, oldest first. A block that the kernel overwrites
 * meanwhile, or that is not as it was written, is left out. */
std::vector<AxisTick> full_rate(const Ring& ring, const AxisSpan& span);

}  // namespace interlock::recorder
