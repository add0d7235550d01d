/**
 * @file
 * One axis in every tick, read from the kernel's black box while it is being written.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "recorder/ring.hpp"

namespace interlock::recorder {

/** The words of a sensor card's frame with its analog inputs (spec/frames.md, words 7 and 8). */
using AnalogWords = std::array<std::uint32_t, 2>;

/** An axis in one tick. */
struct AxisTick {
  std::uint32_t tick = 0;
  std::uint64_t begun_ns = 0;                  /**< CLOCK_MONOTONIC at which the tick began */
  std::uint32_t card_time_us = 0;              /**< the card's clock at its newest valid frame */
  std::optional<std::int32_t> position_counts; /**< of a valid frame */
  std::optional<std::int32_t> setpoint_counts; /**< while MOVING */
  std::int32_t drive = 0;                      /**< that left the kernel's gate; negative: decreasing */
  std::optional<AnalogWords> analog;           /**< of a valid frame of the sensor card that was asked for */
};

/** Which ticks of which axis. */
struct AxisSpan {
  std::uint32_t slot = 0;
  std::uint32_t seconds = 1;           /**< of kernel time */
  std::optional<std::uint32_t> until;  /**< last tick; nothing: the newest */
  std::optional<std::uint32_t> sensor; /**< slot of a sensor card that is wanted besides */
};

/** The ticks of that span that the ring still holds, oldest first. A block that the kernel overwrites
 * meanwhile, or that is not as it was written, is left out. */
std::vector<AxisTick> full_rate(const Ring& ring, const AxisSpan& span);

}  // namespace interlock::recorder
