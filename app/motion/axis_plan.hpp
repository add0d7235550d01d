/**
 * @file
 * What the control thread knows of the robot: one entry a slot, copied once, never changed.
 */
#pragma once

#include <array>
#include <cstdint>

#include "interlock/types.h"
#include "robot/robot.hpp"

namespace interlock {

/** The kernel's rules for an axis and the smallest drive that a controller asks for. */
struct AxisPlan {
  ilk_axis_config_t rules{};
  std::uint32_t min_drive = 0;
};

/** The robot as the control thread sees it. A slot without a motor has `rules.max_drive == 0`. */
struct RobotPlan {
  std::array<AxisPlan, ILK_SLOTS> axis{};
  std::uint32_t period_us = 1000;
  std::uint32_t lease_max_ticks = 0;

  RobotPlan(const Robot& robot, const ilk_config_t& config)
      : period_us(config.period_us), lease_max_ticks(config.lease_max_ticks) {
    for (const Axis& each : robot.axes) {
      axis[each.slot] = AxisPlan{config.axis[each.slot], each.drive.min};
    }
  }
};

/** Whether a card of this kind drives a motor. */
constexpr bool drives_motor(std::uint32_t card) noexcept {
  return card != ILK_CARD_NONE && card != ILK_CARD_SENSOR;
}

}  // namespace interlock
