#include "motion/mode_manager.hpp"

namespace interlock {

void ModeManager::take(const TaskReference& task, std::uint32_t tick) noexcept {
  Mode* taker = by_kind_[task->work.index()];
  taker->take(task, tick);
  for (Mode* mode : in_turn_) {
    if (mode == taker || !mode->is_open()) {
      continue;
    }
    if (taker == &manual_) {
      manual_.end(task->id, mode == &home_ ? TaskReason::axis_homing : TaskReason::superseded, tick);
    } else {
      mode->end_all(taker == &home_ ? TaskReason::axis_homing : TaskReason::superseded, tick);
    }
  }
}

void ModeManager::end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept {
  for (Mode* mode : in_turn_) {
    mode->end(task, reason, tick);
  }
}

void ModeManager::end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept {
  for (Mode* mode : in_turn_) {
    mode->end_axis(slot, reason, tick);
  }
}

void ModeManager::end_all(TaskReason reason, std::uint32_t tick) noexcept {
  for (Mode* mode : in_turn_) {
    mode->end_all(reason, tick);
  }
}

KernelRequests ModeManager::tick(const ilk_snapshot_t& snapshot) noexcept {
  KernelRequests requests;
  for (Mode* mode : in_turn_) {
    mode->tick(snapshot, requests);
  }
  return requests;
}

TaskTable ModeManager::tasks() const noexcept {
  TaskTable tasks;
  for (const Mode* mode : in_turn_) {
    mode->report(tasks);
  }
  return tasks;
}

std::optional<Setpoint> ModeManager::setpoint(std::uint32_t slot) const noexcept {
  for (const Mode* mode : in_turn_) {
    if (const auto setpoint = mode->setpoint(slot)) {
      return setpoint;
    }
  }
  return std::nullopt;
}

void ModeManager::on_unsent(const KernelRequest& request) noexcept {
  for (Mode* mode : in_turn_) {
    mode->on_unsent(request);
  }
}

void ModeManager::on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  for (Mode* mode : in_turn_) {
    mode->on_verdict(origin, verdict, tick);
  }
}

void ModeManager::on_verdict_lost(const ModeOrigin& origin, std::uint32_t tick) noexcept {
  for (Mode* mode : in_turn_) {
    mode->on_verdict_lost(origin, tick);
  }
}

}  // namespace interlock
