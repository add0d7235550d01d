#include "oracle/system_watch.hpp"

#include <limits>

namespace interlock::oracle {
namespace {

void count(std::uint32_t& ticks, bool goes_on) {
  if (!goes_on) {
    ticks = 0;
  } else if (ticks < std::numeric_limits<std::uint32_t>::max()) {
    ticks++;
  }
}

}  // namespace

void SystemWatch::see(const Observation& seen, bool any_card_valid) noexcept {
  const bool one_channel = rules_.pedal_channels == 1;
  pressed_ = seen.pedal_normally_open == Contact::kClosed &&
             (one_channel || seen.pedal_normally_closed == Contact::kOpen);
  released_ = seen.pedal_normally_open == Contact::kOpen &&
              (one_channel || seen.pedal_normally_closed == Contact::kClosed);
  estop_ = seen.estop_loop != Contact::kClosed;
  deadline_missed_ = seen.deadlines_missed;
  if (seen.app_attached) {
    heard_app_ = false;
  }
  app_alive_ = heard_app_ && seen.tick - heartbeat_tick_ < rules_.app_timeout_ticks;
  count(disagree_ticks_, !pressed_ && !released_);
  count(overruns_, seen.deadlines_missed);
  count(bad_bus_ticks_, seen.transaction_failed || !any_card_valid);
  count(pressed_ticks_, pressed_);
  if (before_ == Mode::kReady && app_alive_ && released_) {
    count(released_ticks_, true);
    armed_ = armed_ || released_ticks_ >= rules_.pedal_debounce_ticks;
  } else {
    released_ticks_ = 0;
  }
}

void SystemWatch::decide(const Observation& seen, bool new_fault, bool required_card_lost) noexcept {
  required_card_lost_ = required_card_lost;
  stopped_ = false;
  reset_ = false;
  holder_changed_ = false;
  must_lock_ = estop_ || bus_lost() || disagree_ticks_ > rules_.pedal_disagree_ticks ||
               overruns_ >= rules_.overrun_limit;
  must_leave_ = must_lock_ || !pressed_ || !app_alive_ || new_fault || required_card_lost;
  const bool consent = armed_ && pressed_ticks_ >= rules_.pedal_debounce_ticks;
  const bool enters =
      before_ == Mode::kReady && consent && pressed_ && app_alive_ && !must_lock_ && !required_card_lost;
  may_be_in_motion_ = (before_ == Mode::kMotion && !must_leave_) || enters;
  may_be_ready_ = !must_lock_ && (before_ == Mode::kReady || before_ == Mode::kMotion);
  if (before_ != Mode::kMotion) {
    motion_since_ = seen.tick;
  }
}

void SystemWatch::accept_heartbeat(const Observation& seen, std::uint32_t holder) noexcept {
  heard_app_ = true;
  heartbeat_tick_ = seen.tick;
  holder_changed_ = holder_changed_ || (holder_known_ && holder != holder_);
  if (holder_changed_) {
    withdraw_consent();
    may_be_in_motion_ = false;
  }
  holder_known_ = true;
  holder_ = holder;
}

void SystemWatch::accept_stop() noexcept {
  stopped_ = true;
  may_be_in_motion_ = false;
}

void SystemWatch::accept_reset(const Observation& seen, Findings& findings) noexcept {
  if (!released_) {
    findings.report(seen.tick, Property::kP8, kNoAxis, "RESET accepted although the pedal is not released");
  }
  if (must_lock_ || bad_bus_ticks_ > 0 || !app_alive_) {
    findings.report(seen.tick, Property::kP8, kNoAxis, "RESET accepted although a cause is present");
  }
  if (seen.configuration_damage_ticks > rules_.crc_slice_ticks) {
    findings.report(seen.tick, Property::kP8, kNoAxis, "RESET accepted with a damaged configuration");
  }
  if (before_ == Mode::kReady || before_ == Mode::kMotion) {
    findings.report(seen.tick, Property::kP11, kNoAxis, "RESET accepted although nothing is locked");
  }
  reset_ = true;
  may_be_ready_ = true;
}

void SystemWatch::withdraw_consent() noexcept {
  armed_ = false;
  released_ticks_ = 0;
}

void SystemWatch::judge_latch(const Observation& seen, Findings& findings) const noexcept {
  const Mode now = seen.claim.mode;
  if (before_ == Mode::kInit) {
    if (now != Mode::kInit && now != Mode::kLocked) {
      findings.report(seen.tick, Property::kP13, kNoAxis, "left INIT otherwise than into LOCKED");
    }
    return;
  }
  if (now == Mode::kInit) {
    findings.report(seen.tick, Property::kP13, kNoAxis, "went back to INIT");
  }
  if (must_lock_ && now != Mode::kLocked) {
    findings.report(seen.tick, Property::kP2, kNoAxis, "a cause is present and nothing is locked");
  }
  if (before_ != Mode::kLocked) {
    return;
  }
  if (now == Mode::kMotion || (now == Mode::kReady && !reset_)) {
    findings.report(seen.tick, Property::kP8, kNoAxis, "LOCKED was left without an accepted RESET");
  }
  if (now == Mode::kLocked && !reset_ && !seen.state_damaged && seen.claim.first_cause != cause_before_) {
    findings.report(seen.tick, Property::kP8, kNoAxis, "the first cause was overwritten");
  }
}

void SystemWatch::judge_motion(const Observation& seen, Findings& findings) const noexcept {
  if (seen.claim.mode != Mode::kMotion) {
    return;
  }
  if (before_ == Mode::kReady && (!armed_ || pressed_ticks_ < rules_.pedal_debounce_ticks)) {
    findings.report(seen.tick, Property::kP9, kNoAxis, "MOTION without a release and a fresh press");
  }
  if (!pressed_) {
    findings.report(seen.tick, Property::kP2, kNoAxis,
                    "MOTION although the pedal is not pressed on every channel");
  }
  if (!app_alive_) {
    findings.report(seen.tick, Property::kP10, kNoAxis, "MOTION although the app is silent");
  }
  if (holder_changed_) {
    findings.report(seen.tick, Property::kP9, kNoAxis, "MOTION goes on under another holder");
  }
  if (stopped_) {
    findings.report(seen.tick, Property::kP2, kNoAxis, "MOTION goes on after STOP");
  }
  if (required_card_lost_) {
    findings.report(seen.tick, Property::kP2, kNoAxis, "MOTION without a required card");
  } else if (before_ == Mode::kMotion && must_leave_ && pressed_ && app_alive_ && !must_lock_) {
    findings.report(seen.tick, Property::kP2, kNoAxis, "MOTION goes on after a new fault");
  }
}

void SystemWatch::judge(const Observation& seen, Findings& findings) noexcept {
  if (!are_permitted(rules_) && seen.claim.mode != Mode::kInit) {
    findings.report(seen.tick, Property::kP13, kNoAxis,
                    "left INIT with a configuration that is not permitted");
  }
  if (seen.configuration_damage_ticks > rules_.crc_slice_ticks && seen.claim.mode != Mode::kLocked) {
    findings.report(seen.tick, Property::kP13, kNoAxis, "goes on with a changed configuration");
  }
  judge_latch(seen, findings);
  judge_motion(seen, findings);
  if (seen.claim.mode == Mode::kReady && before_ != Mode::kReady) {
    withdraw_consent();
  }
  before_ = seen.claim.mode;
  cause_before_ = seen.claim.first_cause;
}

}  // namespace interlock::oracle
