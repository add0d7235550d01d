/**
 * @file
 * What the whole robot allows: contacts, app, bus, deadlines, consent and the latch.
 */
#ifndef INTERLOCK_ORACLE_SYSTEM_WATCH_HPP
#define INTERLOCK_ORACLE_SYSTEM_WATCH_HPP

#include <cstdint>

#include "oracle/finding.hpp"
#include "oracle/observation.hpp"
#include "oracle/rules.hpp"

namespace interlock::oracle {

/** Follows the inputs of the whole robot tick by tick and judges the mode that the kernel claims. */
class SystemWatch {
 public:
  explicit SystemWatch(const SystemRules& rules) : rules_(rules) {}

  /** Takes in contacts, deadline and age of the app, as they are before this tick's requests. */
  void see(const Observation& seen, bool any_card_valid) noexcept;

  /** Decides which modes the rules leave open, before this tick's requests. */
  void decide(const Observation& seen, bool new_fault, bool required_card_lost) noexcept;

  /** What an accepted request of the whole robot changes. */
  void accept_heartbeat(const Observation& seen, std::uint32_t holder) noexcept;
  void accept_stop() noexcept;
  void accept_reset(const Observation& seen, Findings& findings) noexcept;

  /** Compares the claimed mode with what the rules leave open, after the requests. */
  void judge(const Observation& seen, Findings& findings) noexcept;

  bool pedal_pressed() const noexcept { return pressed_; }
  bool pedal_released() const noexcept { return released_; }
  bool estop_active() const noexcept { return estop_; }
  bool app_alive() const noexcept { return app_alive_; }
  bool bus_lost() const noexcept { return bad_bus_ticks_ >= rules_.bad_frame_limit; }
  bool may_be_ready() const noexcept { return may_be_ready_; }
  bool may_be_in_motion() const noexcept { return may_be_in_motion_; }

  /** The claimed mode of the tick before. */
  Mode before() const noexcept { return before_; }

  /** Tick of the newest entry to MOTION. */
  std::uint32_t motion_since() const noexcept { return motion_since_; }

 private:
  void withdraw_consent() noexcept;
  void judge_latch(const Observation& seen, Findings& findings) const noexcept;
  void judge_motion(const Observation& seen, Findings& findings) const noexcept;

  const SystemRules& rules_;
  Mode before_ = Mode::kInit;
  std::uint32_t cause_before_ = 0;
  bool pressed_ = false;
  bool released_ = false;
  bool estop_ = false;
  bool deadline_missed_ = false;
  bool app_alive_ = false;
  bool heard_app_ = false;
  std::uint32_t heartbeat_tick_ = 0;
  bool holder_known_ = false;
  std::uint32_t holder_ = 0;
  bool holder_changed_ = false;
  std::uint32_t pressed_ticks_ = 0;
  std::uint32_t released_ticks_ = 0; /**< in READY with the app alive, since consent was last withdrawn */
  std::uint32_t disagree_ticks_ = 0;
  std::uint32_t overruns_ = 0;
  std::uint32_t bad_bus_ticks_ = 0;
  bool armed_ = false;
  bool must_lock_ = false;
  bool must_leave_ = false;
  bool required_card_lost_ = false;
  bool stopped_ = false;
  bool reset_ = false;
  bool may_be_ready_ = false;
  bool may_be_in_motion_ = false;
  std::uint32_t motion_since_ = 0;
};

}  // namespace interlock::oracle

#endif
