#include "motion/setpoint_lease.hpp"

#include <algorithm>

namespace interlock {
namespace {

constexpr std::uint32_t renewals_per_lease = 3;
/** A change of the wanted drive below this fraction of the last one waits for the renewal. */
constexpr std::uint32_t drive_step_fraction = 16;

/** A lease ends by one of a single tick, and a MOVE without drive is refused; this one moves no axis, for it
 * is within every dead zone and has no amplitude. */
constexpr std::uint32_t smallest_drive = 1;

}  // namespace

void SetpointLease::hold(std::uint32_t task, std::uint32_t tick, std::int32_t target_counts,
                         std::uint32_t drive, KernelRequests& requests) noexcept {
  if (drive == 0) {
    if (sent_.may_drive) {
      send(task, {false, tick, target_counts, smallest_drive}, 1, requests);
    }
    return;
  }
  const std::uint32_t change = std::max(drive, sent_.drive) - std::min(drive, sent_.drive);
  const bool due = due_at_once_ || !sent_.may_drive || tick - sent_.tick >= lease_ticks_ / renewals_per_lease;
  if (due || target_counts != sent_.target_counts || change > sent_.drive / drive_step_fraction) {
    send(task, {true, tick, target_counts, drive}, lease_ticks_, requests);
  }
}

void SetpointLease::let_go(std::uint32_t task, const ilk_snapshot_t& snapshot,
                           KernelRequests& requests) noexcept {
  if (!sent_.may_drive) {
    return;
  }
  const std::uint32_t state = snapshot.state.axis[slot_].state;
  const bool may_move = state == ILK_AXIS_MOVING || state == ILK_AXIS_ENABLED;
  const Sent nothing{false, snapshot.state.system.tick, sent_.target_counts, smallest_drive};
  if (snapshot.state.system.mode == ILK_MODE_MOTION && may_move) {
    send(task, nothing, 1, requests);
  } else {
    before_ = sent_;
    sent_ = nothing;
    due_at_once_ = false;
  }
}

void SetpointLease::send(std::uint32_t task, const Sent& sent, std::uint32_t lease_ticks,
                         KernelRequests& requests) noexcept {
  const std::uint32_t amplitude = sent.may_drive ? max_amplitude_ : 0;
  requests.add({{ILK_REQUEST_MOVE, slot_, task}, sent.target_counts, sent.drive, amplitude, lease_ticks});
  before_ = sent_;
  sent_ = sent;
  due_at_once_ = false;
}

void SetpointLease::on_unsent() noexcept {
  sent_ = before_;
  due_at_once_ = true;
}

}  // namespace interlock
