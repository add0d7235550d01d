/**
 * @file
 * What one slot allows: its card, position, limits, progress, and what was consented to.
 */
#ifndef INTERLOCK_ORACLE_AXIS_WATCH_HPP
#define INTERLOCK_ORACLE_AXIS_WATCH_HPP

#include <cstdint>
#include <string_view>

#include "oracle/finding.hpp"
#include "oracle/observation.hpp"
#include "oracle/rules.hpp"

namespace interlock::oracle {

/** What the whole robot allows at the moment of a request. */
struct Gates {
  bool may_be_in_motion = false;
  bool may_be_ready = false;
  bool pedal_released = false;
};

/** Tick counter that a card that heard the kernel has to echo now. */
struct Echo {
  bool is_judged = false; /**< not in the first two ticks: nothing can have been answered */
  std::uint32_t expected = 0;
};

/**
 * Follows one slot tick by tick: `see`, then `accept` for each accepted request, then `judge`.
 *
 * Distances are summed from differences of the counter, so a declared position never looks like motion.
 */
class AxisWatch {
 public:
  AxisWatch(const AxisRules& rules, const SystemRules& system, std::int8_t slot)
      : rules_(rules), system_(system), slot_(slot) {}

  /** Takes in the card's frame and finds out whether the axis has to fault in this tick; `in_motion` before
   * it. */
  void see(const Observation& seen, const Echo& echo, bool in_motion) noexcept;

  /** Reports a fault that has to be and is not claimed. */
  void judge_due(const Observation& seen, Findings& findings) const noexcept;

  /** An accepted request for this axis; reports when it should have been refused. */
  void accept(const Observation& seen, const Message& message, const Gates& gates,
              Findings& findings) noexcept;

  /** Remembers what was refused, to tell an applied refusal from other faults. */
  void refuse(const Observation& seen, const Message& message) noexcept;

  /** Judges what was sent to the card and what is claimed of the axis. */
  void judge(const Observation& seen, Findings& findings) noexcept;

  /** The kernel lost its memory: what it had counted, and what it had been allowed, is gone. */
  void forget(std::uint32_t tick) noexcept;

  bool card_valid() const noexcept { return valid_; }
  bool card_lost() const noexcept {
    return rules_.card != CardKind::kNone && bad_frames_ >= system_.bad_frame_limit;
  }

  /** True in the tick in which the kernel says that the axis faults. */
  bool faults_now(const Observation& seen) const noexcept;

 private:
  /** What an axis had to be faulted for in this tick. */
  struct Due {
    bool is_due = false;
    Property property = Property::kP6;
    std::string_view reason;
  };

  /** Where an axis stood when it had settled: the last reading before, and the first after. */
  struct RestMark {
    bool is_set = false;
    std::int64_t lowest = 0;
    std::int64_t highest = 0;

    /** True when the axis is farther than `allowed` from both; sets the mark when there is none. */
    bool is_left(std::int64_t path_before, std::int64_t path, std::int64_t allowed) noexcept;
  };

  enum class Homing : std::uint8_t { kNone, kSeeking, kResting };

  bool take_in(const Observation& seen, const Echo& echo) noexcept;
  void mark_press(const Observation& seen) noexcept;
  bool is_fresh(const wire::Reading& reading, const Echo& echo) const noexcept;
  void judge_motion_seen(const Observation& seen, std::int64_t moved) noexcept;
  void judge_rest_seen(bool settled, std::int64_t path_before) noexcept;
  void follow_homing(const Observation& seen) noexcept;
  void require_fault(Property property, std::string_view reason) noexcept;
  /** The drive that would explain the state of one who knows of none from this tick on: this first tick
   * counts as one without drive, while after a drive it is the second one. */
  static constexpr std::uint32_t tick_of_no_drive(std::uint32_t first) noexcept { return first - 2; }
  bool is_settled(std::uint32_t tick) const noexcept { return tick - driven_tick_ > rules_.settle_ticks; }
  /** From which reading progress is measured depends on when it was last told; what has not got any farther
   * for so long is stalled by every reading. */
  bool is_stalled() const noexcept {
    return driven_ticks_ >= rules_.stall_ticks && standing_ticks_ >= rules_.stall_ticks;
  }
  /** True of the first frame after a drive: motion that it tells may be the drive's doing. */
  bool tells_of_drive(std::uint32_t tick) const noexcept {
    return sense_ != 0 && tick - driven_tick_ <= tick - valid_tick_;
  }
  bool was_driven_in(std::uint32_t tick) const noexcept { return sense_ != 0 && driven_tick_ == tick; }
  bool lease_is_live(std::uint32_t tick) const noexcept {
    return has_lease_ && tick - lease_start_ < lease_ticks_;
  }
  std::int64_t position() const noexcept { return path_ + origin_; }
  void refer_to(const Observation& seen, std::int64_t position) noexcept;
  void forget_progress() noexcept;
  void drop_motion() noexcept;
  void end_homing_at_rest() noexcept;
  void accept_enable(const Observation& seen, const Gates& gates, Findings& findings) noexcept;
  void accept_clear(const Observation& seen, const Gates& gates, Findings& findings) noexcept;
  void accept_move(const Observation& seen, const Message& message, const Gates& gates,
                   Findings& findings) noexcept;
  void accept_home(const Observation& seen, const Gates& gates, Findings& findings) noexcept;
  void accept_position(const Observation& seen, const Message& message, const Gates& gates,
                       Findings& findings) noexcept;
  void judge_latch(const Observation& seen, Findings& findings) noexcept;
  void judge_claim(const Observation& seen, Findings& findings) noexcept;
  void judge_drive(const Observation& seen, const wire::Drive& drive, Findings& findings) const noexcept;
  void judge_consent(const Observation& seen, Findings& findings) const noexcept;
  void judge_limits(const Observation& seen, const wire::Drive& drive, Findings& findings) const noexcept;
  void judge_truth(const Observation& seen, Findings& findings) noexcept;
  void note_drive(const Observation& seen, bool rises) noexcept;
  void note_arrival() noexcept;

  const AxisRules& rules_;
  const SystemRules& system_;
  std::int8_t slot_;

  bool valid_ = false;
  bool arrived_ = false;  /**< a whole frame came, be it an old one */
  bool heard_ = false;    /**< a valid frame, since start or since the card was lost */
  bool followed_ = false; /**< a valid frame, ever */
  std::uint32_t bad_frames_ = 0;
  std::uint32_t heartbeat_ = 0;
  std::uint32_t counter_ = 0;
  std::uint32_t valid_tick_ = 0;
  bool switch_triggered_ = true;
  bool still_ = false;            /**< the counter stands where it stood in the last tick */
  bool is_first_reading_ = false; /**< since start or since the card was lost */
  bool fault_is_new_ = false;     /**< claimed in this tick for the first time */

  std::int64_t path_ = 0;       /**< counts moved upwards, net, since start */
  std::int64_t origin_ = 0;     /**< position = path + origin */
  std::int64_t press_path_ = 0; /**< path at the newest entry to MOTION */
  RestMark rest_;
  std::int64_t farthest_path_ = 0; /**< mark of reverse */
  std::int64_t progress_path_ = 0; /**< mark of stall */

  std::int32_t sense_ = 0; /**< of the newest drive: 1 rises, -1 falls, 0 never driven */
  std::uint32_t driven_tick_ = tick_of_no_drive(0); /**< of the newest drive */
  std::uint32_t driven_ticks_ = 0;                  /**< since progress */
  std::uint32_t standing_ticks_ = 0;                /**< driven ones since it got any farther */
  bool one_target_ = true; /**< all ticks counted in driven_ticks_ had the same setpoint */
  std::int32_t counted_target_ = 0;

  bool enabled_ = false;
  bool faulted_ = false;
  std::uint32_t fault_code_ = 0;
  bool cleared_now_ = false; /**< by an accepted CLEAR_FAULT of this tick */
  bool homed_ = false;
  Homing homing_ = Homing::kNone;
  bool switch_seen_open_ = false;
  Due due_;

  bool has_lease_ = false;
  std::uint32_t lease_start_ = 0;
  std::uint32_t lease_ticks_ = 0;
  std::int32_t target_ = 0;
  std::uint32_t granted_drive_ = 0;
  std::uint32_t granted_amplitude_ = 0;

  bool had_lease_ = false; /**< one that was dropped, and until when it would have lasted */
  std::uint32_t dropped_start_ = 0;
  std::uint32_t dropped_ticks_ = 0;
  bool was_refused_ = false;
  Order refused_order_ = Order::kUnknown;
  std::uint32_t refused_tick_ = 0;
  std::uint32_t refused_ticks_ = 0;

  bool truth_known_ = false; /**< true position belongs to a known position of this frame */
  std::int64_t truth_offset_ = 0;
  bool was_inside_ = false;
  bool truth_marked_ = false;
  std::int64_t truth_at_press_ = 0;
  bool free_of_press_ = false; /**< homing moved it since the press */
};

}  // namespace interlock::oracle

#endif
