/**
 * @file
 * Which requests end the order of their axis once the kernel accepts them.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "interlock/types.h"
#include "motion/order.hpp"

namespace interlock {

/**
 * Why the order of an axis is not wanted any more after that request: its position means something else, or
 * the axis was disabled, if only within one tick. Empty for requests that leave orders alone.
 */
constexpr std::optional<OrderReason> end_by(std::uint32_t request_kind) noexcept {
  switch (request_kind) {
    case ILK_REQUEST_DISABLE:
      return OrderReason::axis_disabled;
    case ILK_REQUEST_SET_HOME:
    case ILK_REQUEST_RESTORE:
      return OrderReason::position_declared;
    default:
      return std::nullopt;
  }
}

}  // namespace interlock
