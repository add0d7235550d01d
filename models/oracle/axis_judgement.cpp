// What was sent to a card and what is claimed of its axis, held against what was seen and accepted.
#include <algorithm>
#include <cstdlib>

#include "oracle/axis_watch.hpp"

namespace interlock::oracle {
namespace {

/** Counts by which an axis has to be inside of its soft range before leaving it counts: it creeps to rest at
 * a switch that sits at the limit. */
constexpr std::int64_t kEntered = 3;

}  // namespace

void AxisWatch::judge_due(const Observation& seen, Findings& findings) const noexcept {
  const bool claimed = seen.claim.axes[static_cast<std::size_t>(slot_)].mode == AxisMode::kFaulted;
  if (has_axis(rules_.card) && due_.is_due && !claimed) {
    findings.report(seen.tick, due_.property, slot_, due_.reason);
  }
}

void AxisWatch::judge_latch(const Observation& seen, Findings& findings) noexcept {
  const AxisClaim& claim = seen.claim.axes[static_cast<std::size_t>(slot_)];
  const bool claimed = claim.mode == AxisMode::kFaulted;
  if (!seen.state_damaged && faulted_ && !cleared_now_) {
    if (!claimed) {
      findings.report(seen.tick, Property::kP8, slot_, "a fault was left without an accepted CLEAR_FAULT");
    } else if (fault_code_ != 0 && claim.fault != fault_code_) {
      findings.report(seen.tick, Property::kP8, slot_, "the fault was overwritten");
    }
  }
  if (claimed && !faulted_) {
    drop_motion();
    enabled_ = false;
  }
  faulted_ = claimed;
  fault_code_ = claimed ? claim.fault : 0;
}

void AxisWatch::judge_claim(const Observation& seen, Findings& findings) noexcept {
  const AxisClaim& claim = seen.claim.axes[static_cast<std::size_t>(slot_)];
  const bool refused_now = was_refused_ && refused_tick_ == seen.tick;
  const bool claims_enabled =
      claim.mode == AxisMode::kEnabled || claim.mode == AxisMode::kMoving || claim.mode == AxisMode::kHoming;
  if (claims_enabled && !enabled_) {
    findings.report(seen.tick,
                    refused_now && refused_order_ == Order::kEnable ? Property::kP11 : Property::kP1, slot_,
                    "enabled without an accepted ENABLE");
  }
  if (claim.mode == AxisMode::kHoming && homing_ == Homing::kNone) {
    findings.report(seen.tick, refused_now && refused_order_ == Order::kHome ? Property::kP11 : Property::kP1,
                    slot_, "homing without an accepted HOME");
  }
  if (claim.homed && !homed_) {
    if (homing_ != Homing::kResting) {
      const bool refused =
          refused_now && (refused_order_ == Order::kSetHome || refused_order_ == Order::kRestore);
      findings.report(seen.tick, refused ? Property::kP11 : Property::kP7, slot_,
                      "homed without switch edge or accepted SET_HOME");
    }
    homed_ = true;
  }
  homed_ = homed_ && claim.homed;
  enabled_ = enabled_ && claims_enabled;
  if (claim.mode != AxisMode::kHoming) {
    homing_ = Homing::kNone;
  }
}

void AxisWatch::judge_consent(const Observation& seen, Findings& findings) const noexcept {
  if (!valid_) {
    findings.report(seen.tick, Property::kP1, slot_, "driven without a valid card");
  }
  if (faulted_ || due_.is_due) {
    findings.report(seen.tick, due_.is_due ? due_.property : Property::kP1, slot_,
                    "driven although it is faulted");
  }
  if (!enabled_) {
    findings.report(seen.tick, Property::kP1, slot_, "driven although it is not enabled");
  }
  if (homing_ == Homing::kResting) {
    findings.report(seen.tick, Property::kP1, slot_, "driven on after the homing edge");
  }
  if (lease_is_live(seen.tick) || homing_ != Homing::kNone) {
    return;
  }
  const bool refused = was_refused_ && (refused_order_ == Order::kMove || refused_order_ == Order::kHome) &&
                       seen.tick - refused_tick_ < refused_ticks_;
  if (refused) {
    findings.report(seen.tick, Property::kP11, slot_, "driven by a refused request");
  } else if (!has_lease_ && had_lease_ && seen.tick - dropped_start_ < dropped_ticks_) {
    findings.report(seen.tick, Property::kP12, slot_, "driven by a lease that was dropped");
  } else {
    findings.report(seen.tick, Property::kP1, slot_, "driven without a live lease");
  }
}

void AxisWatch::judge_limits(const Observation& seen, const wire::Drive& drive,
                             Findings& findings) const noexcept {
  const std::int32_t sense = drive.rises ? 1 : -1;
  if (rules_.switch_end != SwitchEnd::kNone && switch_triggered_ &&
      drive.rises == (rules_.switch_end == SwitchEnd::kUpper)) {
    findings.report(seen.tick, Property::kP3, slot_, "driven towards its triggered switch");
  }
  if (homed_) {
    const std::int64_t beyond = drive.rises ? position() - (std::int64_t{rules_.soft_max} - rules_.coast)
                                            : std::int64_t{rules_.soft_min} + rules_.coast - position();
    if (beyond > 0) {
      findings.report(seen.tick, Property::kP4, slot_, "driven outward beyond a soft limit less coast");
    }
  } else if (homing_ == Homing::kNone &&
             sense * (path_ - press_path_) > rules_.unhomed_travel - rules_.coast) {
    findings.report(seen.tick, Property::kP7, slot_, "driven beyond the unhomed travel of this press");
  }
}

void AxisWatch::judge_drive(const Observation& seen, const wire::Drive& drive,
                            Findings& findings) const noexcept {
  if (!drive.well_formed) {
    findings.report(seen.tick, Property::kP16, slot_, "drive words that the card cannot mean");
    return;
  }
  std::uint32_t bound = homed_ ? rules_.max_drive : std::min(rules_.max_drive, rules_.unhomed_max_drive);
  if (homing_ != Homing::kNone) {
    bound = std::min(bound, rules_.home_drive);
  } else if (has_lease_) {
    bound = std::min(bound, granted_drive_);
  }
  if (wire::exceeds(rules_.card, drive, bound)) {
    findings.report(seen.tick, Property::kP7, slot_, "driven faster than its bound");
  }
  if (rules_.card == CardKind::kHighFrequency && drive.amplitude > rules_.max_amplitude) {
    findings.report(seen.tick, Property::kP7, slot_, "driven with more than its amplitude");
  }
  if (homing_ == Homing::kNone && has_lease_) {
    const std::int64_t way = target_ - position();
    if (std::abs(way) <= rules_.deadband || drive.rises != (way > 0)) {
      findings.report(seen.tick, Property::kP1, slot_, "driven, but not towards its setpoint");
    }
  }
  if (is_stalled()) {
    findings.report(seen.tick, Property::kP5, slot_, "driven longer than allowed without progress");
  }
  judge_limits(seen, drive, findings);
}

void AxisWatch::judge_truth(const Observation& seen, Findings& findings) noexcept {
  const Truth& truth = seen.truth[static_cast<std::size_t>(slot_)];
  const std::int64_t position = truth.position - truth_offset_;
  const bool inside = homed_ && truth_known_ && position >= rules_.soft_min && position <= rules_.soft_max;
  const bool well_inside =
      inside && position - rules_.soft_min >= kEntered && rules_.soft_max - position >= kEntered;
  if (truth.keeps_promise && homed_ && was_inside_ && !inside) {
    findings.report(seen.tick, Property::kP4, slot_, "the axis itself left its soft range");
  }
  was_inside_ = inside && (was_inside_ || well_inside);
  // What it did while it was homed does not count against the unhomed travel.
  free_of_press_ = free_of_press_ || homed_;
  if (truth.keeps_promise && !homed_ && truth_marked_ && !free_of_press_ &&
      std::abs(truth.position - truth_at_press_) > rules_.unhomed_travel) {
    findings.report(seen.tick, Property::kP7, slot_, "the axis itself went beyond its unhomed travel");
    truth_marked_ = false;
  }
}

void AxisWatch::judge(const Observation& seen, Findings& findings) noexcept {
  if (!has_axis(rules_.card)) {
    return;
  }
  const auto slot = static_cast<std::size_t>(slot_);
  judge_latch(seen, findings);
  judge_claim(seen, findings);
  if (seen.claim.mode != Mode::kMotion) {
    drop_motion();
  }
  enabled_ = enabled_ && (seen.claim.mode == Mode::kReady || seen.claim.mode == Mode::kMotion);
  if (!homed_ && (faulted_ || cleared_now_ || !truth_known_ || seen.claim.mode == Mode::kLocked)) {
    origin_ = seen.claim.axes[slot].position - path_;
  }
  if (!wire::is_zero_drive(seen.to_card[slot])) {
    const wire::Drive drive = wire::read_drive(rules_, seen.to_card[slot]);
    judge_consent(seen, findings);
    judge_drive(seen, drive, findings);
    note_drive(seen, drive.rises);
  } else {
    note_arrival();
  }
  judge_truth(seen, findings);
}

}  // namespace interlock::oracle
