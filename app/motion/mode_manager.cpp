#include "motion/mode_manager.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "motion/realtime_channel.hpp"

namespace interlock {

namespace {

Modes homing_last(Modes modes) {
  std::ranges::partition(modes, [](const auto& each) { return !each->homes(); });
  return modes;
}

}  // namespace

ModeManager::ModeManager(Modes modes, LinkageWatch linkages)
    : modes_(homing_last(std::move(modes))), linkages_(std::move(linkages)) {
  if (modes_.size() > TaskTable::most_kinds) {
    throw std::length_error("a robot has at most 16 modes");
  }
}

Mode* ModeManager::find(const std::type_info& tasks) const noexcept {
  const auto found = std::ranges::find_if(modes_, [&](const auto& each) { return each->tasks() == tasks; });
  return found == modes_.end() ? nullptr : found->get();
}

void ModeManager::take(const TaskReference& task, std::uint32_t tick) noexcept {
  Mode* taker = find(task->work.type());
  if (taker == nullptr) {
    return;
  }
  taker->take(task, tick);
  if (pedal_held_) {
    taker->await_press();
  }
  for (const auto& mode : modes_) {
    if (mode.get() == taker || !mode->is_open()) {
      continue;
    }
    const bool homing = taker->yields() ? mode->homes() : taker->homes();
    const TaskReason reason = homing ? TaskReason::axis_homing : TaskReason::superseded;
    if (taker->yields()) {
      taker->end(task->id, reason, tick);
    } else {
      mode->end_all(reason, tick);
    }
  }
}

void ModeManager::confirm(std::uint32_t task, std::uint32_t tick) noexcept {
  for (const auto& mode : modes_) {
    mode->confirm(task, tick);
  }
}

void ModeManager::end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept {
  for (const auto& mode : modes_) {
    mode->end(task, reason, tick);
  }
}

void ModeManager::end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept {
  for (const auto& mode : modes_) {
    mode->end_axis(slot, reason, tick);
  }
}

void ModeManager::end_all(TaskReason reason, std::uint32_t tick) noexcept {
  for (const auto& mode : modes_) {
    mode->end_all(reason, tick);
  }
}

KernelRequests ModeManager::tick(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t strained = linkages_.see(snapshot.state);
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if ((strained >> slot & 1u) != 0) {
      end_axis(slot, TaskReason::linkage_strained, snapshot.state.system.tick);
    }
  }
  KernelRequests requests;
  seen_ = snapshot;
  if (still_.all && snapshot.state.system.mode == ILK_MODE_MOTION) {
    requests.add({{ILK_REQUEST_STOP, 0, 0}});
    seen_.state.system.mode = ILK_MODE_READY;
  }
  pedal_held_ = seen_.state.system.mode == ILK_MODE_MOTION;
  for (const auto& mode : modes_) {
    mode->tick(seen_, requests);
  }
  return requests;
}

void ModeManager::hold(StandStill still) noexcept {
  still_ = still;
  for (const auto& mode : modes_) {
    mode->hold_insertion(still.insertion);
  }
}

void ModeManager::see(const SeenImage& seen) noexcept {
  for (const auto& mode : modes_) {
    mode->see(seen);
  }
}

void ModeManager::report(ControlView& view) const noexcept {
  for (const auto& mode : modes_) {
    mode->report(view);
  }
  for (TaskStatus& status : view.tasks) {
    const bool waits = status.phase == TaskPhase::waiting || status.phase == TaskPhase::paused;
    if (still_.all && waits && status.reason != TaskReason::unconfirmed) {
      status.reason = TaskReason::scanning;
    } else if (still_.needs_press && status.reason == TaskReason::breathing) {
      status.reason = TaskReason::gate_turned_off;
    }
  }
}

std::optional<Setpoint> ModeManager::setpoint(std::uint32_t slot) const noexcept {
  for (const auto& mode : modes_) {
    if (const auto setpoint = mode->setpoint(slot)) {
      return setpoint;
    }
  }
  return std::nullopt;
}

void ModeManager::on_unsent(const KernelRequest& request) noexcept {
  for (const auto& mode : modes_) {
    mode->on_unsent(request);
  }
}

void ModeManager::on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  for (const auto& mode : modes_) {
    mode->on_verdict(origin, verdict, tick);
  }
}

void ModeManager::on_verdict_lost(const ModeOrigin& origin, std::uint32_t tick) noexcept {
  for (const auto& mode : modes_) {
    mode->on_verdict_lost(origin, tick);
  }
}

}  // namespace interlock
