/**
 * @file
 * How fast an axis is driven, by its distance from the setpoint.
 */
#pragma once

#include <cstdint>

#include "interlock/types.h"
#include "robot/robot.hpp"

namespace interlock {

/** Drive bounds of one approach. */
struct DriveLaw {
  std::uint32_t full_drive = 0; /**< the axis' largest drive, to which the slope refers */
  std::uint32_t dead_zone = 0;  /**< largest drive that does not move the axis, from which the slope begins */
  std::uint32_t floor = 0;      /**< smallest drive of the move */
  std::uint32_t ceiling = 0;    /**< largest drive of this move */
  std::uint32_t slow_counts = 1; /**< distance at which the slope reaches `full_drive` */

  /** Drive at that distance: proportional, at least `floor`, at most `ceiling`. */
  [[nodiscard]] std::uint32_t at(std::uint64_t distance_counts) const noexcept;

  bool operator==(const DriveLaw&) const = default;
};

/**
 * The law of an axis.
 *
 * The slope is gentle enough for a plant that answers late: it begins at three times the coasting distance,
 * so that the axis enters the deadband at less than a tenth of its full speed. The floor is `floor_drive`.
 *
 * @param rules the kernel's rules for the axis
 * @param drive of the robot file
 * @param ceiling largest drive of the move
 */
DriveLaw drive_law(const ilk_axis_config_t& rules, const DriveBounds& drive, std::uint32_t ceiling) noexcept;

}  // namespace interlock
