#include "oracle/axis_watch.hpp"

#include <algorithm>
#include <cstdlib>

namespace interlock::oracle {

bool AxisWatch::is_fresh(const wire::Reading& reading, const Echo& echo) const noexcept {
  const bool new_heartbeat = !heard_ || reading.heartbeat != heartbeat_;
  return new_heartbeat && (!echo.is_judged || reading.tick_echo == echo.expected);
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
  standing_ticks_ = 0;
  one_target_ = true;
  progress_path_ = path_;
}

bool AxisWatch::RestMark::is_left(std::int64_t path_before, std::int64_t path,
                                  std::int64_t allowed) noexcept {
  // Which of two readings is the mark is left open: only what is too far from both is drift by any reading.
  if (!is_set) {
    is_set = true;
    lowest = std::min(path_before, path);
    highest = std::max(path_before, path);
  }
  return path - highest > allowed || lowest - path > allowed;
}

void AxisWatch::judge_rest_seen(bool settled, std::int64_t path_before) noexcept {
  const bool rests = enabled_ && settled;
  rest_.is_set = rest_.is_set && rests;
  if (rests && rest_.is_left(path_before, path_, rules_.drift)) {
    require_fault(Property::kP6, "drifts while enabled and not driven");
  }
}

void AxisWatch::judge_motion_seen(const Observation& seen, std::int64_t moved) noexcept {
  const std::uint32_t ticks = seen.tick - valid_tick_;
  const bool of_drive = tells_of_drive(seen.tick);
  const bool settled = is_settled(seen.tick) && !of_drive;
  if (std::abs(moved) > std::int64_t{rules_.max_delta} * ticks) {
    require_fault(Property::kP6, "jumps");
  }
  if (sense_ * (path_ - farthest_path_) > 0) {
    farthest_path_ = path_;
    standing_ticks_ = 0;
  }
  if (of_drive && sense_ * (farthest_path_ - path_) > rules_.reverse) {
    require_fault(Property::kP6, "moves against its command");
  }
  // By a damaged deadband the axis may have arrived: its stall is counted from the end of the damage.
  if (seen.configuration_damage_ticks > 0 ||
      (!settled && sense_ * (path_ - progress_path_) >= rules_.stall_min)) {
    forget_progress();
  }
  if (is_stalled()) {
    require_fault(Property::kP5, "stalls");
  }
  judge_rest_seen(settled, path_ - moved);
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

bool AxisWatch::take_in(const Observation& seen, const Echo& echo) noexcept {
  const auto slot = static_cast<std::size_t>(slot_);
  arrived_ = !seen.transaction_failed && seen.received[slot] && wire::is_intact(seen.from_card[slot]);
  if (!arrived_) {
    return false;
  }
  const wire::Reading reading = wire::read(seen.from_card[slot]);
  if (!is_fresh(reading, echo)) {
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
  } else {
    // Nothing tells what the axis did meanwhile: it is measured anew from here.
    farthest_path_ = path_;
    progress_path_ = path_;
    rest_ = {};
  }
  is_first_reading_ = !followed_;
  followed_ = true;
  valid_tick_ = seen.tick;
  return true;
}

void AxisWatch::see(const Observation& seen, const Echo& echo, bool in_motion) noexcept {
  due_ = {};
  cleared_now_ = false;
  fault_is_new_ = seen.claim.axes[static_cast<std::size_t>(slot_)].mode == AxisMode::kFaulted && !faulted_;
  switch_triggered_ = true;
  still_ = false;
  if (rules_.card == CardKind::kNone) {
    return;
  }
  valid_ = take_in(seen, echo);
  if (valid_) {
    bad_frames_ = 0;
  } else {
    bad_frames_++;
  }
  if (card_lost()) {
    heard_ = false;
    followed_ = false;
    require_fault(Property::kP1, "its card is lost");
  }
  if (!in_motion) {
    mark_press(seen);
  }
}

void AxisWatch::forget(std::uint32_t tick) noexcept {
  due_ = {};
  // To one who knows nothing the frame of this tick is the card's first, were it an old one.
  bad_frames_ = arrived_ ? 0 : 1;
  heard_ = arrived_;
  followed_ = valid_;
  faulted_ = false;
  fault_code_ = 0;
  enabled_ = false;
  homed_ = false;
  truth_known_ = false;
  sense_ = 0;
  driven_tick_ = tick_of_no_drive(tick);
  rest_ = {};
  drop_motion();
  had_lease_ = false;
  forget_progress();
}

bool AxisWatch::faults_now(const Observation& seen) const noexcept {
  const bool claimed = seen.claim.axes[static_cast<std::size_t>(slot_)].mode == AxisMode::kFaulted;
  return has_axis(rules_.card) && !faulted_ && claimed;
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
  standing_ticks_++;
}

void AxisWatch::note_arrival() noexcept {
  const bool counted = driven_ticks_ > 0 && one_target_ && has_lease_ && counted_target_ == target_;
  if (valid_ && counted && std::abs(target_ - position()) <= rules_.deadband) {
    forget_progress();
  }
}

}  // namespace interlock::oracle
