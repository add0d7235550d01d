/**
 * @file
 * What a motion mode is: it looks at each snapshot and wishes for requests. Sending them is not its business.
 *
 * Every function runs in the control thread: none allocates, blocks or throws.
 */
#pragma once

#include <cstdint>

#include "interlock/link.h"
#include "motion/order.hpp"
#include "motion/wish.hpp"

namespace interlock {

/** One way of turning orders into motion. */
class Mode {
 public:
  virtual ~Mode() = default;

  /** Aborts the order of that proposal, if it is open here. */
  virtual void end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept = 0;

  /** Aborts every open order. */
  virtual void end_all(OrderReason reason, std::uint32_t tick) noexcept = 0;

  /** Aborts the open order that moves the axis in `slot`, if there is one. */
  virtual void end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept = 0;

  /** Looks at a snapshot; adds the requests to send in this tick. */
  virtual void tick(const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept = 0;

  /** A wish of this tick found no room on the link: it is wished for again in the next one. */
  virtual void on_unsent(const Wish& wish) noexcept = 0;

  /** The kernel judged a request. */
  virtual void on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept = 0;

  /** The kernel's word on a request got lost. */
  virtual void on_verdict_lost(const WishOrigin& origin, std::uint32_t tick) noexcept = 0;
};

}  // namespace interlock
