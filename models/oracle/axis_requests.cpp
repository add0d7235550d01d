// What accepted requests give an axis, and when they should have been refused.
#include <cstdlib>

#include "oracle/axis_watch.hpp"

namespace interlock::oracle {

void AxisWatch::drop_motion() noexcept {
  if (lease_ticks_ > 0 && has_lease_) {
    had_lease_ = true;
    dropped_start_ = lease_start_;
    dropped_ticks_ = lease_ticks_;
  }
  has_lease_ = false;
  homing_ = Homing::kNone;
}

void AxisWatch::refuse(const Observation& seen, const Message& message) noexcept {
  was_refused_ = true;
  refused_order_ = message.order;
  refused_tick_ = seen.tick;
  refused_ticks_ = message.order == Order::kMove ? message.lease_ticks : 1;
}

void AxisWatch::accept_enable(const Observation& seen, const Gates& gates, Findings& findings) noexcept {
  if (!gates.may_be_ready && !gates.may_be_in_motion) {
    findings.report(seen.tick, Property::kP1, slot_, "ENABLE accepted outside of READY and MOTION");
  }
  if (faulted_) {
    findings.report(seen.tick, Property::kP8, slot_, "ENABLE accepted on a faulted axis");
  }
  if (!valid_) {
    findings.report(seen.tick, Property::kP1, slot_, "ENABLE accepted without a valid card");
  }
  enabled_ = true;
}

void AxisWatch::accept_clear(const Observation& seen, const Gates& gates, Findings& findings) noexcept {
  if (!faulted_) {
    findings.report(seen.tick, Property::kP11, slot_, "CLEAR_FAULT accepted without a fault");
  }
  if (!valid_ || fault_is_new_) {
    findings.report(seen.tick, Property::kP8, slot_, "CLEAR_FAULT accepted while its cause is present");
  }
  if (!gates.pedal_released) {
    findings.report(seen.tick, Property::kP8, slot_,
                    "CLEAR_FAULT accepted although the pedal is not released");
  }
  faulted_ = false;
  cleared_now_ = true;
  enabled_ = false;
  drop_motion();
  forget_progress();
}

/** When the counter has rested is the kernel's word: an accepted request shows that homing has just ended. */
void AxisWatch::end_homing_at_rest() noexcept {
  if (homing_ == Homing::kResting) {
    homing_ = Homing::kNone;
    homed_ = true;
  }
}

void AxisWatch::accept_move(const Observation& seen, const Message& message, const Gates& gates,
                            Findings& findings) noexcept {
  if (!gates.may_be_in_motion) {
    findings.report(seen.tick, Property::kP12, slot_, "MOVE accepted outside of MOTION");
  }
  if (faulted_ || !enabled_) {
    findings.report(seen.tick, Property::kP1, slot_, "MOVE accepted on an axis that is not enabled");
  }
  end_homing_at_rest();
  if (homing_ != Homing::kNone) {
    findings.report(seen.tick, Property::kP11, slot_, "MOVE accepted during homing");
  }
  if (message.lease_ticks == 0 || message.lease_ticks > system_.lease_max_ticks) {
    findings.report(seen.tick, Property::kP1, slot_, "MOVE accepted with a lease out of bounds");
  }
  if (message.drive > (homed_ ? rules_.max_drive : rules_.unhomed_max_drive) ||
      (rules_.card == CardKind::kHighFrequency && message.amplitude > rules_.max_amplitude)) {
    findings.report(seen.tick, Property::kP7, slot_, "MOVE accepted with a drive out of bounds");
  }
  const std::int64_t target = message.target;
  if (homed_ && (target < std::int64_t{rules_.soft_min} + rules_.coast ||
                 target > std::int64_t{rules_.soft_max} - rules_.coast)) {
    findings.report(seen.tick, Property::kP4, slot_, "MOVE accepted to beyond a soft limit");
  }
  if (!homed_ && std::abs(target - origin_ - press_path_) > rules_.unhomed_travel - rules_.coast) {
    findings.report(seen.tick, Property::kP7, slot_, "MOVE accepted to beyond the unhomed travel");
  }
  has_lease_ = true;
  lease_start_ = seen.tick;
  lease_ticks_ = message.lease_ticks;
  target_ = message.target;
  granted_drive_ = message.drive;
  granted_amplitude_ = message.amplitude;
}

void AxisWatch::accept_home(const Observation& seen, const Gates& gates, Findings& findings) noexcept {
  if (!gates.may_be_in_motion) {
    findings.report(seen.tick, Property::kP12, slot_, "HOME accepted outside of MOTION");
  }
  if (faulted_ || !enabled_) {
    findings.report(seen.tick, Property::kP1, slot_, "HOME accepted on an axis that is not enabled");
  }
  end_homing_at_rest();
  if (homing_ != Homing::kNone) {
    findings.report(seen.tick, Property::kP11, slot_, "HOME accepted during homing");
  }
  if (rules_.switch_end == SwitchEnd::kNone) {
    findings.report(seen.tick, Property::kP11, slot_, "HOME accepted without a switch");
  }
  drop_motion();
  homing_ = Homing::kSeeking;
  switch_seen_open_ = valid_ && !switch_triggered_;
  homed_ = false;
  free_of_press_ = true;
}

void AxisWatch::accept_position(const Observation& seen, const Message& message, const Gates& gates,
                                Findings& findings) noexcept {
  const bool sets_home = message.order == Order::kSetHome;
  const std::int32_t position = sets_home ? 0 : message.target;
  if (!gates.may_be_ready || !gates.pedal_released) {
    findings.report(seen.tick, Property::kP11, slot_,
                    "a position declared outside of READY or with the pedal down");
  }
  if (faulted_ || !valid_) {
    findings.report(seen.tick, Property::kP11, slot_,
                    "a position declared on a faulted axis or without a card");
  }
  if (is_first_reading_) {
    findings.report(seen.tick, Property::kP11, slot_, "a position declared on the first reading of a card");
  } else if (was_driven_in(seen.tick - 1)) {
    findings.report(seen.tick, Property::kP11, slot_, "a position declared in the tick in which drive ended");
  } else if (!still_) {
    findings.report(seen.tick, Property::kP11, slot_, "a position declared on an axis that is not at rest");
  }
  if (position < rules_.soft_min || position > rules_.soft_max) {
    findings.report(seen.tick, Property::kP4, slot_, "a position declared outside of the soft limits");
  }
  drop_motion();
  refer_to(seen, position);
  homed_ = sets_home;
}

void AxisWatch::accept(const Observation& seen, const Message& message, const Gates& gates,
                       Findings& findings) noexcept {
  if (!has_axis(rules_.card)) {
    findings.report(seen.tick, Property::kP11, slot_, "a request accepted for a slot without an axis");
    return;
  }
  // A fault is raised before requests are judged.
  faulted_ = faulted_ || (fault_is_new_ && !cleared_now_);
  switch (message.order) {
    case Order::kEnable:
      accept_enable(seen, gates, findings);
      break;
    case Order::kDisable:
      if (faulted_) {
        findings.report(seen.tick, Property::kP11, slot_, "DISABLE accepted on a faulted axis");
      }
      end_homing_at_rest();
      enabled_ = false;
      drop_motion();
      break;
    case Order::kClearFault:
      accept_clear(seen, gates, findings);
      break;
    case Order::kMove:
      accept_move(seen, message, gates, findings);
      break;
    case Order::kHome:
      accept_home(seen, gates, findings);
      break;
    case Order::kSetHome:
    case Order::kRestore:
      accept_position(seen, message, gates, findings);
      break;
    case Order::kHeartbeat:
    case Order::kStop:
    case Order::kReset:
    case Order::kUnknown:
    default:
      break;
  }
}

}  // namespace interlock::oracle
