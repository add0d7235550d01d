/**
 * @file
 * An order: one approved move of one axis, as the control thread carries it out.
 */
#pragma once

#include <array>
#include <cstdint>

#include "interlock/types.h"

namespace interlock {

/** What the network hands to the control thread when a proposal is approved. */
struct Order {
  std::uint32_t proposal = 0; /**< number of the proposal, from 1 */
  std::uint32_t slot = 0;
  std::int32_t target_counts = 0;
  std::uint32_t max_drive = 0; /**< 0: the axis' own bound */
  std::uint32_t stops = 0; /**< STOPs seen by the author; an order older than the newest STOP never starts */
};

/** Where an order stands. The last five are final. */
enum class OrderPhase : std::uint8_t { none, waiting, executing, paused, done, refused, aborted, expired };

constexpr bool is_open(OrderPhase phase) noexcept {
  return phase == OrderPhase::waiting || phase == OrderPhase::executing || phase == OrderPhase::paused;
}

/** Why an order stands where it does. */
enum class OrderReason : std::uint8_t {
  none,
  arrived,        /**< at rest within the deadband */
  pedal_released, /**< waits for the pedal */
  kernel_refused, /**< `code` is the verdict */
  stopped,        /**< STOP */
  cancelled,      /**< its author ended it */
  locked,         /**< `code` is the cause of LOCKED */
  axis_disabled,  /**< the axis was taken out of motion */
  axis_homing,    /**< homing took over the axis */
  axis_faulted,   /**< `code` is the fault */
  blocked,        /**< a limit held the axis back for too long; `code` is the gate */
  link_lost,      /**< the kernel went away */
  waited_too_long /**< not executing for longer than a move may wait */
};

/** Level, not edge: the newest view always tells the whole truth about the slot's newest order. */
struct OrderStatus {
  std::uint32_t proposal = 0;
  OrderPhase phase = OrderPhase::none;
  OrderReason reason = OrderReason::none;
  std::uint32_t code = 0;
  std::uint32_t tick = 0; /**< kernel tick of the last change */

  bool operator==(const OrderStatus&) const = default;
};

using OrderTable = std::array<OrderStatus, ILK_SLOTS>;

}  // namespace interlock
