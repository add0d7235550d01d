#include "oracle/axis_watch.hpp"

#include <cstdlib>

namespace interlock::oracle {
namespace {

constexpr std::uint32_t kFirstJudgedEcho = 2; /**< before this tick no frame can have been answered */

}  // namespace

bool AxisWatch::is_fresh(const Observation& seen, const wire::Reading& reading) const noexcept {
  const bool new_heartbeat = !heard_ || reading.heartbeat != heartbeat_;
  return new_heartbeat && (seen.tick < kFirstJudgedEcho || reading.tick_echo == seen.tick - 2);
}

void AxisWatch::require_fault(Property property, std::string_view reason) noexcept {
  if (!faulted_ && !due_.is_due) {
    due_ = {true, property, reason};
  }
}

void AxisWatch::refer_to(const Observation& seen, std::int64_t position) noexcept {
  origin_ = position - path_;
  truth_known_ = true;
  was_inside_ = false;
  truth_offset_ = seen.truth[static_cast<std::size_t>(slot_)].position - position;
}

void AxisWatch::forget_progress() noexcept {
  driven_ticks_ = 0;
  one_target_ = true;
  progress_path_ = path_;
}

void AxisWatch::judge_rest_seen() noexcept {
  if (!rest_marked_) {
    rest_path_ = path_;
    rest_marked_ = true;
  } else if (std::abs(path_ - rest_path_) > rules_.drift) {
    require_fault(Property::kP6, "drifts while enabled and not driven");
  }
}

void AxisWatch::judge_motion_seen(const Observation& seen, std::int64_t moved) noexcept {
  const std::uint32_t ticks = seen.tick - valid_tick_;
  const bool settled = is_settled(seen.tick);
  if (std::abs(moved) > std::int64_t{rules_.max_delta} * ticks) {
    require_fault(Property::kP6, "jumps");
  }
  if (sense_ * (path_ - farthest_path_) > 0) {
    farthest_path_ = path_;
  }
  const bool driven_since_valid = sense_ != 0 && seen.tick - driven_tick_ <= ticks;
  if (!settled && driven_since_valid && sense_ * (farthest_path_ - path_) > rules_.reverse) {
    require_fault(Property::kP6, "moves against its command");
  }
  if (settled) {
    progress_path_ = path_;
  } else if (sense_ * (path_ - progress_path_) >= rules_.stall_min) {
    forget_progress();
  }
  if (driven_ticks_ >= rules_.stall_ticks) {
    require_fault(Property::kP5, "stalls");
  }
  if (settled && enabled_) {
    judge_rest_seen();
  } else {
    rest_marked_ = false;
  }
}

void AxisWatch::follow_homing(const Observation& seen) noexcept {
  if (homing_ != Homing::kSeeking) {
    return;
  }
  if (!switch_triggered_) {
    switch_seen_open_ = true;
  } else if (switch_seen_open_) {
    refer_to(seen, rules_.home_offset);
    homing_ = Homing::kResting;
  }
}

void AxisWatch::mark_press(const Observation& seen) noexcept {
  press_path_ = path_;
  truth_marked_ = true;
  truth_at_press_ = seen.truth[static_cast<std::size_t>(slot_)].position;
  free_of_press_ = false;
}

bool AxisWatch::take_in(const Observation& seen) noexcept {
  const auto slot = static_cast<std::size_t>(slot_);
  if (seen.transaction_failed || !seen.received[slot] || !wire::is_intact(seen.from_card[slot])) {
    return false;
  }
  const wire::Reading reading = wire::read(seen.from_card[slot]);
  if (!is_fresh(seen, reading)) {
    return false;
  }
  const auto difference = static_cast<std::int32_t>(reading.counter - counter_);
  switch_triggered_ = rules_.switch_end != SwitchEnd::kNone && reading.switch_triggered;
  heard_ = true;
  heartbeat_ = reading.heartbeat;
  counter_ = reading.counter;
  if (followed_ && has_axis(rules_.card)) {
    const std::int64_t moved = rules_.counter_falls ? -std::int64_t{difference} : std::int64_t{difference};
    path_ += moved;
    still_ = difference == 0 && seen.tick - valid_tick_ == 1;
    judge_motion_seen(seen, moved);
    follow_homing(seen);
  }
  followed_ = true;
  valid_tick_ = seen.tick;
  return true;
}

void AxisWatch::see(const Observation& seen, bool in_motion) noexcept {
  due_ = {};
  cleared_now_ = false;
  fault_is_new_ = seen.claim.axes[static_cast<std::size_t>(slot_)].mode == AxisMode::kFaulted && !faulted_;
  switch_triggered_ = true;
  still_ = false;
  if (rules_.card == CardKind::kNone) {
    return;
  }
  valid_ = take_in(seen);
  if (valid_) {
    bad_frames_ = 0;
  } else {
    bad_frames_++;
  }
  if (card_lost()) {
    heard_ = false;
    require_fault(Property::kP1, "its card is lost");
  }
  if (!in_motion) {
    mark_press(seen);
  }
}

bool AxisWatch::faults_now(const Observation& seen) const noexcept {
  const bool claimed = seen.claim.axes[static_cast<std::size_t>(slot_)].mode == AxisMode::kFaulted;
  return has_axis(rules_.card) && !faulted_ && (due_.is_due || claimed);
}

void AxisWatch::note_drive(const Observation& seen, bool rises) noexcept {
  const std::int32_t sense = rises ? 1 : -1;
  if (sense != sense_ || is_settled(seen.tick)) {
    farthest_path_ = path_;
    progress_path_ = path_;
  }
  sense_ = sense;
  driven_tick_ = seen.tick;
  one_target_ = has_lease_ && (driven_ticks_ == 0 || (one_target_ && counted_target_ == target_));
  counted_target_ = target_;
  driven_ticks_++;
}

void AxisWatch::note_arrival() noexcept {
  const bool counted = driven_ticks_ > 0 && one_target_ && has_lease_ && counted_target_ == target_;
  if (valid_ && counted && std::abs(target_ - position()) <= rules_.deadband) {
    forget_progress();
  }
}

}  // namespace interlock::oracle
