#include "modes/homing/mode.hpp"

#include <utility>

#include "motion/blocking_condition.hpp"
#include "motion/realtime_channel.hpp"
#include "motion/rest_watch.hpp"

namespace interlock {
namespace {

/** After so long in MOTION a STOP is asked for again. */
constexpr std::uint32_t stop_again_ticks = 50;

constexpr std::uint32_t bit(std::uint32_t slot) noexcept { return 1u << slot; }

std::uint32_t faulted_axes(const ilk_snapshot_t& snapshot) noexcept {
  std::uint32_t mask = 0;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    mask |= snapshot.state.axis[slot].state == ILK_AXIS_FAULTED ? bit(slot) : 0u;
  }
  return mask;
}

}  // namespace

HomeMode::HomeMode(const RobotPlan& plan) : Mode(typeid(HomeTask)), plan_(plan) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    axes_[slot] = HomeAxis(slot, plan.axis[slot], plan.lease_ticks());
  }
}

void HomeMode::report(ControlView& view) const noexcept { view.tasks.of<HomeTask>() = status_; }

const HomeStepPlan& HomeMode::step() const noexcept {
  return homing().step_count == 0 ? alone_ : plan_.home_steps[homing().first_step + steps_done_];
}

bool HomeMode::names_known_steps(const HomeTask& homing) const noexcept {
  const std::size_t known = plan_.home_steps.size();
  return homing.step_count == 0 ? !homing.slots.empty() && homing.slots.front() < ILK_SLOTS
                                : homing.first_step < known && homing.step_count <= known - homing.first_step;
}

void HomeMode::set_phase(TaskPhase phase, TaskReason reason, std::uint32_t code,
                         std::uint32_t tick) noexcept {
  status_.phase = phase;
  status_.reason = reason;
  status_.code = code;
  status_.tick = tick;
}

/** Ends the task before its time, and whatever the kernel may be doing for it. */
void HomeMode::finish(TaskPhase phase, TaskReason reason, std::uint32_t code, std::uint32_t tick) noexcept {
  for (HomeAxis& axis : axes_) {
    stop_owed_ = stop_owed_ || axis.may_be_homing();
    axis.abandon();
  }
  stop_sent_ = false;
  set_phase(phase, reason, code, tick);
}

void HomeMode::fail(TaskReason reason, std::uint32_t code, std::uint32_t slot, std::uint32_t tick) noexcept {
  status_.slot = slot;
  finish(TaskPhase::aborted, reason, code, tick);
}

void HomeMode::take(const TaskReference& task, std::uint32_t tick) noexcept {
  if (is_open()) {
    finish(TaskPhase::aborted, TaskReason::cancelled, 0, tick);
  }
  const HomeTask& homing = task->work.as<HomeTask>();
  status_ = TaskStatus{task->id, TaskPhase::waiting, TaskReason::none, 0, tick};
  if (!names_known_steps(homing)) {
    set_phase(TaskPhase::refused, TaskReason::kernel_refused, ILK_VERDICT_AXIS, tick);
    return;
  }
  task_ = task;
  const bool is_alone = homing.step_count == 0;
  alone_ = is_alone ? HomeStepPlan(homing.slots.front()) : HomeStepPlan();
  involved_ = alone_.mask();
  for (std::uint32_t i = 0; i < homing.step_count; ++i) {
    involved_ |= plan_.home_steps[homing.first_step + i].mask();
  }
  homed_ = 0;
  steps_done_ = 0;
  fresh_ = true;
  slices_used_ = false;
  idle_since_ = tick;
  begin_step();
}

void HomeMode::end(std::uint32_t task, TaskReason reason, std::uint32_t tick) noexcept {
  if (status_.task == task) {
    end_all(reason, tick);
  }
}

void HomeMode::end_axis(std::uint32_t slot, TaskReason reason, std::uint32_t tick) noexcept {
  if (is_open() && slot < ILK_SLOTS && (involved_ & bit(slot)) != 0) {
    fail(reason, 0, slot, tick);
  }
}

void HomeMode::end_all(TaskReason reason, std::uint32_t tick) noexcept {
  if (is_open()) {
    finish(TaskPhase::aborted, reason, 0, tick);
  }
}

void HomeMode::tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  settle_stop(snapshot, requests);
  if (is_open()) {
    judge(snapshot);
    settle_stop(snapshot, requests);
  }
  const std::uint32_t held = status_.phase == TaskPhase::executing ? step().mask() : 0u;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if ((held & bit(slot)) != 0) {
      axes_[slot].hold(status_.task, snapshot, requests);
    } else {
      axes_[slot].let_go(status_.task, snapshot, requests);
    }
  }
}

/** Asks for STOP until MOTION has ended; until then no task begins. */
void HomeMode::settle_stop(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  stop_owed_ = stop_owed_ && snapshot.state.system.mode == ILK_MODE_MOTION;
  if (stop_owed_ && (!stop_sent_ || snapshot.state.system.tick - stop_tick_ >= stop_again_ticks)) {
    stop_sent_ = true;
    stop_tick_ = snapshot.state.system.tick;
    requests.add(KernelRequest{{ILK_REQUEST_STOP, 0, status_.task}, 0, 0, 0, 0});
  }
}

void HomeMode::judge(const ilk_snapshot_t& snapshot) noexcept {
  if (is_blocked(snapshot)) {
    return;
  }
  if (snapshot.state.system.mode == ILK_MODE_MOTION && !stop_owed_) {
    go_on(snapshot);
  } else {
    wait(snapshot);
  }
}

/** An axis of the task that cannot move ends it, and so does a fault of any other axis that is new. */
bool HomeMode::is_blocked(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t faulted = faulted_axes(snapshot) & ~involved_;
  known_faults_ = std::exchange(fresh_, false) ? faulted : known_faults_ & faulted;
  const std::uint32_t watched = involved_ | (faulted & ~known_faults_);
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if ((watched & bit(slot)) == 0) {
      continue;
    }
    if (const auto blocking = blocking_condition(snapshot, slot)) {
      fail(blocking->reason, blocking->code, slot, snapshot.state.system.tick);
      return true;
    }
  }
  return false;
}

bool HomeMode::expire_when_late(std::uint32_t tick) noexcept {
  if (tick - idle_since_ <= plan_.timeout_ticks()) {
    return false;
  }
  finish(TaskPhase::expired, TaskReason::waited_too_long, 0, tick);
  return true;
}

void HomeMode::wait(const ilk_snapshot_t& snapshot) noexcept {
  slices_used_ = slices_used_ && snapshot.state.system.mode == ILK_MODE_MOTION;
  for (HomeAxis& axis : axes_) {
    axis.drop();
  }
  const bool was_executing = status_.phase == TaskPhase::executing;
  const bool is_released = status_.reason == TaskReason::press_again && !slices_used_;
  if (was_executing || (is_released && status_.phase == TaskPhase::paused)) {
    pause(TaskReason::pedal_released, snapshot);
  } else if (is_released) {
    set_phase(TaskPhase::waiting, TaskReason::none, 0, snapshot.state.system.tick);
  }
  if (!was_executing) {
    (void)expire_when_late(snapshot.state.system.tick);
  }
}

void HomeMode::pause(TaskReason reason, const ilk_snapshot_t& snapshot) noexcept {
  if (status_.phase == TaskPhase::executing) {
    idle_since_ = snapshot.state.system.tick;
  }
  status_.left_counts = 0;
  for (const AxisCounts& each : step().axes()) {
    const std::int32_t left = axes_[each.slot].left_counts(snapshot);
    if (distance(left, 0) > distance(status_.left_counts, 0)) {
      status_.left_counts = left;
      status_.slot = each.slot;
    }
  }
  set_phase(TaskPhase::paused, reason, 0, snapshot.state.system.tick);
}

void HomeMode::go_on(const ilk_snapshot_t& snapshot) noexcept {
  if (status_.phase == TaskPhase::executing) {
    follow_step(snapshot);
  } else if (!expire_when_late(snapshot.state.system.tick) && !slices_used_) {
    status_.left_counts = 0;
    set_phase(TaskPhase::executing, TaskReason::none, 0, snapshot.state.system.tick);
    start_axes(snapshot);
  } else if (status_.phase == TaskPhase::waiting) {
    status_.reason = TaskReason::press_again;
  }
}

void HomeMode::follow_step(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  std::size_t arrived = 0;
  std::size_t used = 0;
  for (const AxisCounts& each : step().axes()) {
    switch (axes_[each.slot].watch(snapshot)) {
      case HomeProgress::going:
        break;
      case HomeProgress::arrived:
        ++arrived;
        homed_ |= step().kind() == HomeStepKind::home ? bit(each.slot) : 0u;
        break;
      case HomeProgress::slice_used:
        ++used;
        break;
      case HomeProgress::blocked:
        fail(TaskReason::blocked, snapshot.gate[each.slot], each.slot, now);
        return;
      case HomeProgress::not_homed:
        fail(TaskReason::not_homed, 0, each.slot, now);
        return;
    }
  }
  if (arrived == step().axes().size()) {
    end_step(snapshot);
  } else if (arrived + used == step().axes().size()) {
    slices_used_ = true;
    pause(TaskReason::press_again, snapshot);
  }
}

void HomeMode::end_step(const ilk_snapshot_t& snapshot) noexcept {
  ++steps_done_;
  if (steps_done_ >= homing().step_count) {
    set_phase(TaskPhase::done, TaskReason::arrived, 0, snapshot.state.system.tick);
    return;
  }
  begin_step();
  start_axes(snapshot);
}

void HomeMode::begin_step() noexcept {
  status_.step = homing().first_step + steps_done_;
  for (const AxisCounts& each : step().axes()) {
    axes_[each.slot].begin(step().kind(), each.counts);
    if (step().kind() == HomeStepKind::home && (homed_ & bit(each.slot)) != 0) {
      axes_[each.slot].skip();
    }
  }
}

void HomeMode::start_axes(const ilk_snapshot_t& snapshot) noexcept {
  for (const AxisCounts& each : step().axes()) {
    axes_[each.slot].start(snapshot);
  }
}

void HomeMode::on_unsent(const KernelRequest& request) noexcept {
  if (request.origin.task != status_.task) {
    return;
  }
  if (request.origin.kind == ILK_REQUEST_STOP) {
    stop_sent_ = false;
  } else {
    axes_[request.origin.slot].on_unsent(request);
  }
}

void HomeMode::on_verdict(const ModeOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept {
  if (!is_open() || origin.task != status_.task || origin.slot >= ILK_SLOTS) {
    return;
  }
  if (origin.kind == ILK_REQUEST_HOME) {
    axes_[origin.slot].on_home_verdict(verdict, tick);
  }
  if (origin.kind == ILK_REQUEST_MOVE && verdict == ILK_VERDICT_RANGE &&
      axes_[origin.slot].on_range_verdict(tick)) {
    return;
  }
  // MODE says only that the pedal was released between the snapshot and the request; the next snapshot
  // pauses.
  if (verdict != ILK_VERDICT_ACCEPTED && verdict != ILK_VERDICT_MODE && origin.kind != ILK_REQUEST_STOP) {
    status_.slot = origin.slot;
    finish(TaskPhase::refused, TaskReason::kernel_refused, verdict, tick);
  }
}

void HomeMode::on_verdict_lost(const ModeOrigin& origin, std::uint32_t tick) noexcept {
  if (is_open() && origin.task == status_.task && origin.kind == ILK_REQUEST_HOME) {
    fail(TaskReason::verdict_lost, 0, origin.slot, tick);
  }
}

}  // namespace interlock
