/**
 * @file
 * What a motion mode is: it looks at each snapshot and wishes for moves. Sending them is not its business.
 *
 * Every function runs in the control thread: none allocates, blocks or throws.
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "interlock/types.h"
#include "motion/order.hpp"

namespace interlock {

/** One MOVE that a mode wants sent, for the order that it serves. */
struct MoveWish {
  std::uint32_t proposal = 0;
  std::uint32_t slot = 0;
  std::int32_t target_counts = 0;
  std::uint32_t drive = 0;
  std::uint32_t amplitude = 0;
  std::uint32_t lease_ticks = 0;
};

/** At most one wish an axis and tick. */
class MoveWishes {
 public:
  void add(const MoveWish& wish) noexcept { wishes_[count_++] = wish; }
  [[nodiscard]] std::span<const MoveWish> all() const noexcept { return {wishes_.data(), count_}; }

 private:
  std::array<MoveWish, ILK_SLOTS> wishes_{};
  std::size_t count_ = 0;
};

/** One way of turning orders into motion. */
class Mode {
 public:
  virtual ~Mode() = default;

  /** Takes an order; an open one of the same axis is replaced. */
  virtual void take(const Order& order, std::uint32_t tick) noexcept = 0;

  /** Aborts the order of that proposal, if it is still open. */
  virtual void end(std::uint32_t slot, std::uint32_t proposal, OrderReason reason,
                   std::uint32_t tick) noexcept = 0;

  /** Aborts every open order. */
  virtual void end_all(OrderReason reason, std::uint32_t tick) noexcept = 0;

  /** Looks at a snapshot; returns the moves to send in this tick. */
  [[nodiscard]] virtual MoveWishes tick(const ilk_snapshot_t& snapshot) noexcept = 0;

  /** A wish of this tick found no room on the link: it is wished for again in the next one. */
  virtual void on_unsent(const MoveWish& wish) noexcept = 0;

  /** The kernel judged a move of that order. */
  virtual void on_verdict(std::uint32_t slot, std::uint32_t proposal, std::uint32_t verdict,
                          std::uint32_t tick) noexcept = 0;

  [[nodiscard]] virtual const OrderTable& orders() const noexcept = 0;
};

}  // namespace interlock
