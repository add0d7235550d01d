/**
 * @file
 * Which requests end the task of their axis once the kernel accepts them.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "interlock/types.h"
#include "motion/task.hpp"

namespace interlock {

/**
 * Why the task of an axis is not wanted any more after that request: its position means something else, or
 * the axis was disabled, if only within one tick. Empty for requests that leave tasks alone.
 */
constexpr std::optional<TaskReason> end_by(std::uint32_t request_kind) noexcept {
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
