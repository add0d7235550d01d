#include "motion/held_mode.hpp"

#include "motion/blocking_condition.hpp"
#include "motion/realtime_channel.hpp"
#include "motion/setpoint_range.hpp"

namespace interlock {

HeldMode::HeldMode(const std::type_info& tasks, const RobotPlan& plan) noexcept
    : Mode(tasks), timeout_ticks_(plan.timeout_ticks()), confirmation_ticks_(plan.confirmation_ticks()) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    tolerances_[slot] = rest_tolerance_counts(plan.axis[slot].rules);
  }
}

void HeldMode::set_phase(TaskPhase phase, TaskReason reason, std::uint32_t code,
                         std::uint32_t tick) noexcept {
  status_.phase = phase;
  status_.reason = reason;
  status_.code = code;
  status_.tick = tick;
}

void HeldMode::take(const TaskReference& task, std::uint32_t tick) noexcept {
  task_ = task;
  status_ = TaskStatus{task->id, TaskPhase::waiting, TaskReason::none, 0, tick};
  idle_since_ = tick;
  needs_release_ = false;
  axes_ = prepare(tick);
  kept_.fill(std::nullopt);
  for (const AxisCounts& each : task->rests_on) {
    if (each.slot < ILK_SLOTS && !moves(each.slot)) {
      kept_[each.slot] = each.counts;
    }
  }
}

void HeldMode::end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept {
  if (status_.task == task) {
    end_all(reason, tick);
  }
}

void HeldMode::await_confirmation(const ilk_snapshot_t& snapshot) noexcept {
  idle_since_ = snapshot.state.system.tick;
  set_phase(TaskPhase::paused, TaskReason::unconfirmed, 0, idle_since_);
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (moves(slot)) {
      kept_[slot] = snapshot.state.axis[slot].position_counts;
    }
  }
}

void HeldMode::let_move(std::uint32_t axes) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (((axes >> slot) & 1u) != 0) {
      kept_[slot].reset();
    }
  }
}

/** A pedal that is held may have been pressed before anybody had looked. */
void HeldMode::confirm(std::uint32_t task, std::uint32_t tick) noexcept {
  if (status_.task == task && status_.phase == TaskPhase::paused &&
      status_.reason == TaskReason::unconfirmed) {
    set_phase(TaskPhase::paused, TaskReason::pedal_released, 0, tick);
    needs_release_ = true;
    idle_since_ = tick;
  }
}

void HeldMode::end_all(TaskReason reason, std::uint32_t tick) noexcept {
  if (is_open()) {
    set_phase(TaskPhase::aborted, reason, 0, tick);
  }
}

/** Axes that a later part moves count as well: what could not be carried out whole is not begun. */
void HeldMode::end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept {
  if (is_open() && moves(slot)) {
    fail(reason, 0, slot, tick);
  }
}

void HeldMode::fail(TaskReason reason, std::uint32_t code, std::uint32_t slot, std::uint32_t tick) noexcept {
  status_.slot = slot;
  set_phase(TaskPhase::aborted, reason, code, tick);
}

void HeldMode::tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  if (is_open() && !is_blocked(snapshot) && !is_undermined(snapshot)) {
    judge(snapshot);
  }
  drive(snapshot, requests);
}

void HeldMode::report(ControlView& view) const noexcept { view.tasks.of(tasks()) = status_; }

/** Goes on, pauses or expires. */
void HeldMode::judge(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  const bool held = snapshot.state.system.mode == ILK_MODE_MOTION;
  needs_release_ = needs_release_ && held;
  if (executes()) {
    if (held) {
      go_on(snapshot);
      return;
    }
    set_phase(TaskPhase::paused, TaskReason::pedal_released, 0, now);
    idle_since_ = now;
  } else if (status_.reason == TaskReason::unconfirmed && now - idle_since_ <= confirmation_ticks_) {
    return;
  } else if (now - idle_since_ > timeout_ticks_) {
    set_phase(TaskPhase::expired, TaskReason::waited_too_long, 0, now);
  } else if (held && !needs_release_) {
    set_phase(TaskPhase::executing, TaskReason::none, 0, now);
    begin(snapshot);
  } else if (status_.phase == TaskPhase::waiting) {
    status_.reason = needs_release_ ? TaskReason::press_again : TaskReason::none;
  }
}

bool HeldMode::is_blocked(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (!moves(slot)) {
      continue;
    }
    const ilk_axis_t& axis = snapshot.state.axis[slot];
    if (const auto blocking = blocking_condition(snapshot, slot)) {
      fail(blocking->reason, blocking->code, slot, now);
      return true;
    }
    if (axis.state == ILK_AXIS_HOMING || axis.homed == 0) {
      const bool homing = axis.state == ILK_AXIS_HOMING;
      fail(homing ? TaskReason::axis_homing : TaskReason::not_homed, 0, slot, now);
      return true;
    }
  }
  return false;
}

/** Whether an axis was moved that the rest of the task takes to be where it was. */
bool HeldMode::is_undermined(const ilk_snapshot_t& snapshot) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    const std::int32_t position = snapshot.state.axis[slot].position_counts;
    if (kept_[slot] && distance(position, *kept_[slot]) > tolerances_[slot]) {
      fail(TaskReason::moved_away, 0, slot, snapshot.state.system.tick);
      return true;
    }
  }
  return false;
}

void HeldMode::on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  const bool routine = verdict == ILK_VERDICT_ACCEPTED || verdict == ILK_VERDICT_MODE;
  if (!routine && origin.task == status_.task && is_open()) {
    status_.slot = origin.slot;
    set_phase(TaskPhase::refused, TaskReason::kernel_refused, verdict, tick);
  }
}

}  // namespace interlock
