/**
 * @file
 * What an order goes through that is carried out for as long as the pedal is held, whatever it moves.
 *
 *     waiting -> executing <-> paused -> done, or refused, aborted, expired
 *
 * Release of the pedal pauses, the next press goes on, and an order that does not execute for too long
 * expires. An axis that cannot be moved, a refusal or a lock ends it for all its axes.
 */
#pragma once

#include <cstdint>

#include "interlock/link.h"
#include "motion/order.hpp"
#include "motion/wish.hpp"

namespace interlock {

class HeldOrder {
 public:
  /** What there is to do in a tick. */
  enum class Work : std::uint8_t {
    none,
    begin, /**< the pedal was pressed: from the start, or on after a pause */
    go_on  /**< it is held */
  };

  /** @param patience_ticks how long the order may wait without executing */
  explicit HeldOrder(std::uint32_t patience_ticks) noexcept : patience_ticks_(patience_ticks) {}

  /** Takes an order that moves these axes, bit n for slot n; an open one is replaced. */
  void take(std::uint32_t proposal, std::uint32_t axes, std::uint32_t tick) noexcept;

  /** Aborts the order if it is open and of that proposal. */
  void end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept;

  /** Aborts the order if it is open. */
  void end_all(OrderReason reason, std::uint32_t tick) noexcept;

  /** Aborts the order if it is open and moves the axis in `slot`. */
  void end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept;

  /** Aborts the order because of the axis in `slot`. */
  void fail(OrderReason reason, std::uint32_t code, std::uint32_t slot, std::uint32_t tick) noexcept;

  /** It was carried out. */
  void finish(OrderReason reason, std::uint32_t tick) noexcept;

  /** Looks at a snapshot: goes on, pauses, expires or fails. */
  [[nodiscard]] Work judge(const ilk_snapshot_t& snapshot) noexcept;

  /** A refusal ends the order; MODE says only that the pedal was released meanwhile, which the next snapshot
   * shows. */
  void on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept;

  [[nodiscard]] bool is_open() const noexcept { return interlock::is_open(status_.phase); }
  [[nodiscard]] bool executes() const noexcept { return status_.phase == OrderPhase::executing; }
  /** Whether the order has a part for that slot. */
  [[nodiscard]] bool moves(std::uint32_t slot) const noexcept {
    return slot < ILK_SLOTS && ((axes_ >> slot) & 1u) != 0;
  }
  [[nodiscard]] const OrderStatus& status() const noexcept { return status_; }

  /** Of the axis that the reason is about. */
  [[nodiscard]] std::uint32_t slot() const noexcept { return slot_; }

 private:
  void set_phase(OrderPhase phase, OrderReason reason, std::uint32_t code, std::uint32_t tick) noexcept;
  [[nodiscard]] bool meets_obstacle(const ilk_snapshot_t& snapshot) noexcept;

  std::uint32_t patience_ticks_;
  OrderStatus status_;
  std::uint32_t axes_ = 0;
  std::uint32_t slot_ = 0;
  std::uint32_t idle_since_ = 0; /**< tick since which the order does not execute */
};

}  // namespace interlock
