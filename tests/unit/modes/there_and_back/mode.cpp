#include "there_and_back/mode.hpp"

namespace interlock {

ThereAndBackMode::ThereAndBackMode(const RobotPlan& plan) : HeldMode(typeid(ThereAndBackTask), plan) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    moves_[slot] = AxisMove(slot, plan.axis[slot], plan.lease_ticks());
  }
}

std::uint32_t ThereAndBackMode::prepare(std::uint32_t /*tick*/) noexcept {
  start_counts_.reset();
  return 1u << work<ThereAndBackTask>().slot;
}

void ThereAndBackMode::begin(const ilk_snapshot_t& snapshot) noexcept {
  const auto& [slot, by_counts] = work<ThereAndBackTask>();
  if (!start_counts_) {
    start_counts_ = snapshot.state.axis[slot].position_counts;
  }
  moves_[slot].aim(*start_counts_ + (status().step == 0 ? by_counts : 0), 0);
  moves_[slot].start(snapshot);
}

void ThereAndBackMode::go_on(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t slot = work<ThereAndBackTask>().slot;
  const std::uint32_t now = snapshot.state.system.tick;
  switch (moves_[slot].watch(snapshot)) {
    case AxisMove::Progress::going:
      break;
    case AxisMove::Progress::blocked:
      fail(TaskReason::blocked, snapshot.gate[slot], slot, now);
      break;
    case AxisMove::Progress::arrived:
      set_step(status().step + 1);
      if (status().step == 2) {
        finish(TaskReason::arrived, now);
      } else {
        begin(snapshot);
      }
      break;
  }
}

void ThereAndBackMode::drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (executes() && moves(slot)) {
      moves_[slot].hold(status().task, snapshot, requests);
    } else {
      moves_[slot].let_go(status().task, snapshot, requests);
    }
  }
}

void ThereAndBackMode::on_unsent(const KernelRequest& request) noexcept {
  if (request.origin.task == status().task && moves(request.origin.slot)) {
    moves_[request.origin.slot].on_unsent();
  }
}

}  // namespace interlock
