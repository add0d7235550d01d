/**
 * @file
 * What ends a task whatever it was to do: a locked kernel, an axis out of motion, or a request about its
 * axis.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "interlock/link.h"
#include "interlock/types.h"
#include "motion/task.hpp"

namespace interlock {

struct BlockingCondition {
  TaskReason reason = TaskReason::none;
  std::uint32_t code = 0;
  std::uint32_t slot = 0; /**< of the axis in the way */
};

/** What keeps the axis from being moved by anybody; an axis that is homing is none. */
std::optional<BlockingCondition> blocking_condition(const ilk_snapshot_t& snapshot,
                                                    std::uint32_t slot) noexcept;

// Which requests end the task of their axis once the kernel accepts them.

/**
 * Why the task of an axis is not wanted any more after that request: its position means something else, or
 * the axis was disabled, if only within one tick. Empty for requests that leave tasks alone.
 */
constexpr std::optional<TaskReason> cancelled_by(std::uint32_t request_kind) noexcept {
  switch (request_kind) {
    case ILK_REQUEST_DISABLE:
      return TaskReason::axis_disabled;
    case ILK_REQUEST_SET_HOME:
    case ILK_REQUEST_RESTORE:
      return TaskReason::position_declared;
    default:
      return std::nullopt;
  }
}

}  // namespace interlock
