/**
 * @file
 * One axis along a path, by the velocity-regulated controller of `app/control`.
 *
 * The kernel picks the direction, towards the MOVE's target. So the target runs a lease ahead of the path: an
 * app that falls silent leaves an axis that stops on its path. An axis that is ahead of its path waits for it
 * with zero drive; it never turns round for that.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "control/axis_controller.hpp"
#include "motion/rest_aim.hpp"
#include "motion/rest_watch.hpp"
#include "motion/setpoint_lease.hpp"
#include "motion/trajectory_follower.hpp"

namespace interlock {

class AxisTracker {
 public:
  AxisTracker() = default;
  AxisTracker(std::uint32_t slot, const AxisPlan& plan, std::uint32_t lease_ticks);

  /** A path begins: a MOVE is due at once. */
  void start(const ilk_snapshot_t& snapshot) noexcept;

  /** How fast the axis moves now; 0 when that may as well be the noise of its counter. */
  [[nodiscard]] double velocity_counts_per_s() const noexcept;

  /** How far the axis is behind its point, as a share of the distance that its robot file allows; 0 when it
   * is not, or nobody knows which way its path leads. */
  [[nodiscard]] double lag(const ilk_snapshot_t& snapshot, const PathPoint& point) const noexcept;

  /** Whether the axis is further from its point than its robot file allows. */
  [[nodiscard]] bool off_path(const ilk_snapshot_t& snapshot, const PathPoint& point) const noexcept;

  /** Whether the axis rests within the deadband of the point, which is the end of its path. */
  [[nodiscard]] bool arrived(const ilk_snapshot_t& snapshot, const PathPoint& point) noexcept;

  /** Whether an axis that has arrived there stands there still, whatever the noise of its counter. */
  [[nodiscard]] bool stays(const ilk_snapshot_t& snapshot, const PathPoint& point) const noexcept;

  /** Requests for what follows the path from here. */
  void hold(std::uint32_t task, const ilk_snapshot_t& snapshot, const PathPoint& point,
            KernelRequests& requests) noexcept;

  /** Gives back the lease, if the kernel may still hold one; the velocity is followed on. */
  void let_go(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept;

  /** The request of this tick was not sent: what was sent before it still stands. */
  void on_unsent() noexcept { lease_.on_unsent(); }

 private:
  std::uint32_t slot_ = 0;
  AxisPlan plan_;
  SetpointLease lease_;
  std::optional<AxisController> controller_; /**< none: no path moves the axis, as it has no rates */
  RestAim rest_aim_;
  RestWatch rest_;
};

}  // namespace interlock
