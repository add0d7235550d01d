/**
 * @file
 * The MOVEs of one axis: sent when something about them changes, renewed before their lease runs out, and
 * given back when the axis is let go.
 */
#pragma once

#include <cstdint>

#include "interlock/link.h"
#include "motion/axis_plan.hpp"
#include "motion/kernel_request.hpp"

namespace interlock {

class SetpointLease {
 public:
  SetpointLease() = default;
  SetpointLease(std::uint32_t slot, const AxisPlan& plan, std::uint32_t lease_ticks) noexcept
      : slot_(slot), max_amplitude_(plan.rules.max_amplitude), lease_ticks_(lease_ticks) {}

  [[nodiscard]] std::uint32_t ticks() const noexcept { return lease_ticks_; }

  /** A MOVE is due at once, whatever was sent before. */
  void renew_at_once() noexcept { due_at_once_ = true; }

  /** Requests for a MOVE when the target or the drive has changed or the lease has to be renewed. */
  void hold(std::uint32_t task, std::uint32_t tick, std::int32_t target_counts, std::uint32_t drive,
            KernelRequests& requests) noexcept;

  /**
   * Gives back the lease, if the kernel may still hold one. A snapshot that shows the axis at rest proves
   * nothing: the newest MOVE may have crossed it.
   */
  void let_go(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept;

  /** The request of this tick was not sent: what was sent before it still stands. */
  void on_unsent() noexcept;

 private:
  /** The newest MOVE. */
  struct Sent {
    bool may_drive = false; /**< its lease may still drive the axis */
    std::uint32_t tick = 0;
    std::int32_t target_counts = 0;
    std::uint32_t drive = 0;
  };

  void send(std::uint32_t task, const Sent& sent, std::uint32_t lease_ticks,
            KernelRequests& requests) noexcept;

  std::uint32_t slot_ = 0;
  std::uint32_t max_amplitude_ = 0;
  std::uint32_t lease_ticks_ = 1;
  Sent sent_;
  Sent before_;              /**< before `sent_`, which the port may not have taken */
  bool due_at_once_ = false; /**< nothing was sent since the start, or since what could not be sent */
};

}  // namespace interlock
