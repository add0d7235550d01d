#include "modes/homing/home_axis.hpp"

#include <algorithm>

#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

/** Whether the snapshot shows what the kernel decided in that tick: its tick counts the steps done. */
bool shows(const ilk_snapshot_t& snapshot, std::uint32_t decided_tick) noexcept {
  return static_cast<std::int32_t>(snapshot.state.system.tick - decided_tick) > 0;
}

}  // namespace

void HomeAxis::begin(HomeStepKind kind, std::int32_t counts) noexcept {
  kind_ = kind;
  counts_ = counts;
  progress_ = HomeProgress::going;
  asked_ = false;
  accepted_ = false;
  judged_ = false;
  marked_ = false;
  stopping_ = false;
  refused_ = false;
}

void HomeAxis::start(const ilk_snapshot_t& snapshot) noexcept {
  if (progress_ == HomeProgress::arrived) {
    return;
  }
  progress_ = HomeProgress::going;
  switch (kind_) {
    case HomeStepKind::home:
      break;
    case HomeStepKind::nudge:
      start_slice(snapshot);
      break;
    case HomeStepKind::move:
      if (snapshot.state.axis[slot_].homed == 0) {
        progress_ = HomeProgress::not_homed;
        break;
      }
      move_.aim(counts_, 0);
      move_.start(snapshot);
      break;
  }
}

/**
 * As far towards the end of the nudge as this press allows. A homed axis goes as one that is not: axes that
 * are nudged together keep together. Its soft limits are the end of its nudge, too.
 */
void HomeAxis::start_slice(const ilk_snapshot_t& snapshot) noexcept {
  const ilk_axis_t& axis = snapshot.state.axis[slot_];
  if (!marked_) {
    marked_ = true;
    mark_raw_ = axis.raw;
  }
  const std::int64_t position = axis.position_counts;
  const std::int64_t end = position + counts_ - travelled_counts(axis);
  const SetpointRange range = setpoint_range(plan_.rules, axis, snapshot.state.system.mode);
  const std::int64_t allowed_end = std::clamp<std::int64_t>(end, range.lowest_counts, range.highest_counts);
  ilk_axis_t as_unhomed = axis;
  as_unhomed.homed = 0;
  const SetpointRange press = setpoint_range(plan_.rules, as_unhomed, snapshot.state.system.mode);
  // Homing in the same press may have carried the axis farther than a slice: then it waits here for the next
  // one.
  const std::int64_t target =
      allowed_end > position ? std::max(position, std::min<std::int64_t>(allowed_end, press.highest_counts))
                             : std::min(position, std::max<std::int64_t>(allowed_end, press.lowest_counts));
  last_slice_ = target == end || (axis.homed != 0 && target == allowed_end);
  stopping_ = false;
  move_.aim(static_cast<std::int32_t>(target), plan_.rules.unhomed_max_drive);
  move_.start(snapshot);
}

/** By the raw counter, which neither SET_HOME nor RESTORE moves. */
std::int64_t HomeAxis::travelled_counts(const ilk_axis_t& axis) const noexcept {
  const std::int64_t counted = static_cast<std::int32_t>(axis.raw - mark_raw_);
  return plan_.rules.direction_correction != 0 ? -counted : counted;
}

std::int32_t HomeAxis::left_counts(const ilk_snapshot_t& snapshot) const noexcept {
  if (kind_ != HomeStepKind::nudge || progress_ == HomeProgress::arrived) {
    return 0;
  }
  return marked_ ? saturated(counts_ - travelled_counts(snapshot.state.axis[slot_])) : counts_;
}

HomeProgress HomeAxis::watch(const ilk_snapshot_t& snapshot) noexcept {
  if (progress_ == HomeProgress::going) {
    switch (kind_) {
      case HomeStepKind::home:
        progress_ = watch_homing(snapshot);
        break;
      case HomeStepKind::nudge:
        progress_ = watch_nudge(snapshot);
        break;
      case HomeStepKind::move:
        progress_ = watch_move(snapshot);
        break;
    }
  }
  return progress_;
}

/** Accepting a HOME takes `homed` away, so `homed` seen after it was won by it. */
HomeProgress HomeAxis::watch_homing(const ilk_snapshot_t& snapshot) noexcept {
  const ilk_axis_t& axis = snapshot.state.axis[slot_];
  if (!accepted_ || !shows(snapshot, judged_tick_)) {
    return HomeProgress::going;
  }
  if (axis.homed != 0) {
    return HomeProgress::arrived;
  }
  accepted_ = axis.state == ILK_AXIS_HOMING;
  return HomeProgress::going;
}

HomeProgress HomeAxis::watch_nudge(const ilk_snapshot_t& snapshot) noexcept {
  const ilk_axis_t& axis = snapshot.state.axis[slot_];
  if (!stopping_ && at_switch(axis)) {
    stopping_ = true;
    rest_.restart(axis.position_counts, snapshot.state.system.tick);
  }
  if (stopping_) {
    const bool rests =
        rest_.rests(axis.position_counts, plan_.rules.noise_counts, snapshot.state.system.tick);
    return rests ? HomeProgress::arrived : HomeProgress::going;
  }
  if (refused_ && shows(snapshot, refused_tick_)) {
    return HomeProgress::blocked;
  }
  switch (move_.watch(snapshot)) {
    case AxisMove::Progress::arrived:
      return last_slice_ ? HomeProgress::arrived : HomeProgress::slice_used;
    case AxisMove::Progress::blocked:
      return HomeProgress::blocked;
    case AxisMove::Progress::going:
      break;
  }
  return HomeProgress::going;
}

bool HomeAxis::leads_to_switch() const noexcept {
  return kind_ == HomeStepKind::nudge &&
         plan_.rules.limit_side == (counts_ > 0 ? ILK_LIMIT_UPPER : ILK_LIMIT_LOWER);
}

bool HomeAxis::at_switch(const ilk_axis_t& axis) const noexcept {
  return leads_to_switch() && axis.card_valid != 0 && axis.switch_triggered != 0;
}

HomeProgress HomeAxis::watch_move(const ilk_snapshot_t& snapshot) noexcept {
  switch (move_.watch(snapshot)) {
    case AxisMove::Progress::arrived:
      return HomeProgress::arrived;
    case AxisMove::Progress::blocked:
      return HomeProgress::blocked;
    case AxisMove::Progress::going:
      break;
  }
  return HomeProgress::going;
}

void HomeAxis::hold(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  if (progress_ != HomeProgress::going || stopping_) {
    let_go(task, snapshot, requests);
    return;
  }
  if (kind_ != HomeStepKind::home) {
    move_.hold(task, snapshot, requests);
    return;
  }
  const bool fresh = !judged_ || shows(snapshot, judged_tick_);
  if (!asked_ && !accepted_ && fresh) {
    asked_ = true;
    requests.add(KernelRequest{{ILK_REQUEST_HOME, slot_, task}, 0, 0, 0, 0});
  }
}

void HomeAxis::let_go(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  move_.let_go(task, snapshot, requests);
}

void HomeAxis::on_unsent(const KernelRequest& request) noexcept {
  if (request.origin.kind == ILK_REQUEST_HOME) {
    asked_ = false;
  } else {
    move_.on_unsent();
  }
}

bool HomeAxis::on_range_verdict(std::uint32_t tick) noexcept {
  refused_ = leads_to_switch();
  refused_tick_ = tick;
  return refused_;
}

void HomeAxis::on_home_verdict(std::uint32_t verdict, std::uint32_t tick) noexcept {
  asked_ = false;
  accepted_ = verdict == ILK_VERDICT_ACCEPTED;
  judged_ = true;
  judged_tick_ = tick;
}

}  // namespace interlock
