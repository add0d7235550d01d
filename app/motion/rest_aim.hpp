/**
 * @file
 * Where a MOVE aims so that its axis comes to rest at a target.
 *
 * The kernel ends drive where the deadband around its setpoint begins. An axis that coasts on by less than
 * that would always rest on the side from which it came. So the setpoint lies beyond the target, by the
 * deadband less what the axis coasts from the smallest drive; never short of it.
 */
#pragma once

#include <cstdint>

#include "motion/axis_plan.hpp"

namespace interlock {

class RestAim {
 public:
  /** At the target itself. */
  RestAim() = default;
  explicit RestAim(const AxisPlan& plan) noexcept;

  /** The setpoint for an axis that stands at `position_counts` and shall rest at `target_counts`. */
  [[nodiscard]] std::int32_t setpoint(std::int32_t target_counts, std::int32_t position_counts) noexcept;

 private:
  std::int64_t deadband_counts_ = 0;
  std::int64_t beyond_counts_ = 0;
  std::int64_t way_ = 0; /**< 1 or -1: from where the target was last approached; 0: from nowhere yet */
};

}  // namespace interlock
