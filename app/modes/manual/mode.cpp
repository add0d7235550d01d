#include "modes/manual/mode.hpp"

#include <algorithm>

#include "motion/blocking_condition.hpp"
#include "motion/realtime_channel.hpp"

namespace interlock {

ManualMode::ManualMode(const RobotPlan& plan) noexcept
    : Mode(typeid(MoveTask)), timeout_ticks_(plan.timeout_ticks()), insertion_slot_(plan.insertion_slot) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    jobs_[slot].move = AxisMove(slot, plan.axis[slot], plan.lease_ticks());
  }
}

void ManualMode::set_phase(std::uint32_t slot, TaskPhase phase, TaskReason reason, std::uint32_t code,
                           std::uint32_t tick) noexcept {
  TaskStatus& status = moves_[slot];
  status.phase = phase;
  status.reason = reason;
  status.code = code;
  status.tick = tick;
}

void ManualMode::take(const TaskReference& task, std::uint32_t tick) noexcept {
  const MoveTask& move = task->work.as<MoveTask>();
  if (move.slot >= ILK_SLOTS) {
    return;
  }
  Job& job = jobs_[move.slot];
  job.move.aim(move.target_counts, move.drive.value_or(0));
  job.target_counts = move.target_counts;
  job.idle_since = tick;
  moves_[move.slot] = TaskStatus{task->id, TaskPhase::waiting, TaskReason::none, 0, tick, move.slot};
}

bool ManualMode::is_open() const noexcept {
  return std::ranges::any_of(moves_, [](const TaskStatus& each) { return interlock::is_open(each.phase); });
}

void ManualMode::report(ControlView& view) const noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    view.tasks.move(slot) = moves_[slot];
  }
}

void ManualMode::end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (moves_[slot].task == task && interlock::is_open(moves_[slot].phase)) {
      set_phase(slot, TaskPhase::aborted, reason, 0, tick);
    }
  }
}

void ManualMode::end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept {
  if (slot < ILK_SLOTS && interlock::is_open(moves_[slot].phase)) {
    set_phase(slot, TaskPhase::aborted, reason, 0, tick);
  }
}

void ManualMode::end_all(TaskReason reason, std::uint32_t tick) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (interlock::is_open(moves_[slot].phase)) {
      set_phase(slot, TaskPhase::aborted, reason, 0, tick);
    }
  }
}

void ManualMode::tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (interlock::is_open(moves_[slot].phase)) {
      judge(slot, snapshot);
    }
    if (moves_[slot].phase == TaskPhase::executing) {
      jobs_[slot].move.hold(moves_[slot].task, snapshot, requests);
    } else {
      jobs_[slot].move.let_go(moves_[slot].task, snapshot, requests);
    }
  }
}

void ManualMode::judge(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  if (const auto blocking = blocking_condition(snapshot, slot)) {
    set_phase(slot, TaskPhase::aborted, blocking->reason, blocking->code, now);
  } else if (snapshot.state.axis[slot].state == ILK_AXIS_HOMING) {
    set_phase(slot, TaskPhase::aborted, TaskReason::axis_homing, 0, now);
  } else if (snapshot.state.system.mode == ILK_MODE_MOTION && !waits_for_breath(slot, snapshot)) {
    follow(slot, snapshot);
  } else {
    pause_or_expire(slot, snapshot);
  }
}

bool ManualMode::waited_too_long(std::uint32_t slot, std::uint32_t tick) const noexcept {
  return tick - jobs_[slot].idle_since > timeout_ticks_;
}

/** A single axis has no path along which it could slow down: it stops as by the release of the pedal. */
bool ManualMode::waits_for_breath(std::uint32_t slot, const ilk_snapshot_t& snapshot) const noexcept {
  return insertion_held_ && slot == insertion_slot_ &&
         jobs_[slot].target_counts > snapshot.state.axis[slot].position_counts;
}

void ManualMode::pause_or_expire(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  const bool was_executing = moves_[slot].phase == TaskPhase::executing;
  if (was_executing) {
    set_phase(slot, TaskPhase::paused, TaskReason::none, 0, now);
    jobs_[slot].idle_since = now;
  } else if (waited_too_long(slot, now)) {
    set_phase(slot, TaskPhase::expired, TaskReason::waited_too_long, 0, now);
    return;
  }
  const bool released = moves_[slot].phase == TaskPhase::paused;
  moves_[slot].reason = snapshot.state.system.mode == ILK_MODE_MOTION ? TaskReason::breathing
                        : released                                    ? TaskReason::pedal_released
                                                                      : TaskReason::none;
}

void ManualMode::follow(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  Job& job = jobs_[slot];
  if (moves_[slot].phase != TaskPhase::executing) {
    if (waited_too_long(slot, now)) {
      set_phase(slot, TaskPhase::expired, TaskReason::waited_too_long, 0, now);
      return;
    }
    set_phase(slot, TaskPhase::executing, TaskReason::none, 0, now);
    job.move.start(snapshot);
    return;
  }
  switch (job.move.watch(snapshot)) {
    case AxisMove::Progress::going:
      break;
    case AxisMove::Progress::arrived:
      set_phase(slot, TaskPhase::done, TaskReason::arrived, 0, now);
      break;
    case AxisMove::Progress::blocked:
      set_phase(slot, TaskPhase::aborted, TaskReason::blocked, snapshot.gate[slot], now);
      break;
  }
}

void ManualMode::on_unsent(const KernelRequest& request) noexcept {
  const std::uint32_t slot = request.origin.slot;
  if (slot < ILK_SLOTS && moves_[slot].task == request.origin.task) {
    jobs_[slot].move.on_unsent();
  }
}

void ManualMode::on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  // MODE says only that the pedal was released between the snapshot and the request; the next snapshot
  // pauses.
  if (verdict == ILK_VERDICT_ACCEPTED || verdict == ILK_VERDICT_MODE) {
    return;
  }
  const std::uint32_t slot = origin.slot;
  if (slot < ILK_SLOTS && moves_[slot].task == origin.task && interlock::is_open(moves_[slot].phase)) {
    set_phase(slot, TaskPhase::refused, TaskReason::kernel_refused, verdict, tick);
  }
}

}  // namespace interlock
