/**
 * @file
 * One axis on its way to one setpoint, carried by leases: what every mode that moves an axis has in common.
 *
 * A move is renewed while it is held and stops by itself when it is not.
 */
#pragma once

#include <cstdint>

#include "interlock/link.h"
#include "motion/axis_plan.hpp"
#include "motion/drive_law.hpp"
#include "motion/kernel_request.hpp"
#include "motion/rest_aim.hpp"
#include "motion/rest_watch.hpp"
#include "motion/setpoint_lease.hpp"

namespace interlock {

class AxisMove {
 public:
  /** How far a move came. */
  enum class Progress : std::uint8_t {
    going,
    arrived, /**< at rest within the deadband */
    blocked  /**< a limit held the axis back for too long; the snapshot's gate says which */
  };

  /** How such a move is driven, by its distance from the target. `max_drive` 0: the axis' own bound. */
  static DriveLaw law_of(const AxisPlan& plan, const ilk_axis_t& axis, std::uint32_t max_drive) noexcept;

  AxisMove() = default;
  AxisMove(std::uint32_t slot, const AxisPlan& plan, std::uint32_t lease_ticks) noexcept
      : slot_(slot), plan_(plan), lease_(slot, plan, lease_ticks), rest_aim_(plan) {}

  /** Sets a new target. `max_drive` 0: the axis' own bound. */
  void aim(std::int32_t target_counts, std::uint32_t max_drive) noexcept;

  /** The pedal was pressed, or the aim is new: a MOVE is due at once. */
  void start(const ilk_snapshot_t& snapshot) noexcept;

  /** How far the axis has come since `start`. */
  [[nodiscard]] Progress watch(const ilk_snapshot_t& snapshot) noexcept;

  /** Requests for a MOVE when the lease or the drive has to be renewed. */
  void hold(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept;

  /** Gives back the lease, if the kernel may still hold one. */
  void let_go(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
    lease_.let_go(task, snapshot, requests);
  }

  /** The request of this tick was not sent: what was sent before it still stands. */
  void on_unsent() noexcept { lease_.on_unsent(); }

 private:
  [[nodiscard]] bool held_back(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] std::uint32_t desired_drive(const ilk_axis_t& axis) const noexcept;

  std::uint32_t slot_ = 0;
  AxisPlan plan_;
  SetpointLease lease_;
  std::int32_t target_counts_ = 0;
  std::uint32_t max_drive_ = 0;
  std::uint32_t unblocked_tick_ = 0; /**< newest tick in which no limit held the axis back */
  RestAim rest_aim_;
  RestWatch rest_;
};

}  // namespace interlock
