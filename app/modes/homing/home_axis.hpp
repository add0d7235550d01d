/**
 * @file
 * One axis within a home step: at its switch, by a distance, or to a position.
 */
#pragma once

#include <cstdint>

#include "interlock/link.h"
#include "motion/axis_move.hpp"
#include "motion/axis_plan.hpp"
#include "motion/kernel_request.hpp"
#include "motion/rest_watch.hpp"

namespace interlock {

/** How far an axis has come in its step. */
enum class HomeProgress : std::uint8_t {
  going,
  arrived,
  slice_used, /**< the travel that one press of the pedal allows is used up */
  blocked,    /**< a limit held the axis back for too long; the snapshot's gate says which */
  not_homed   /**< a position is no place for an axis that is not homed */
};

/** Homes one axis, from the first request to rest. */
class HomeAxis {
 public:
  HomeAxis() = default;
  HomeAxis(std::uint32_t slot, const AxisPlan& plan, std::uint32_t lease_ticks) noexcept
      : slot_(slot), plan_(plan), move_(slot, plan, lease_ticks) {}

  /** A step begins: forgets the one before. `counts`: distance of a nudge, position of a move. */
  void begin(HomeStepKind kind, std::int32_t counts) noexcept;

  /** The step asks nothing of the axis. */
  void skip() noexcept { progress_ = HomeProgress::arrived; }

  /** MOTION has begun, or the step has, in MOTION. */
  void start(const ilk_snapshot_t& snapshot) noexcept;

  /** MOTION has ended: the kernel dropped what was under way. */
  void drop() noexcept { accepted_ = false; }

  /** The task has ended: what the kernel still does for it is no longer looked at. */
  void abandon() noexcept { asked_ = accepted_ = false; }

  /** Looks how far the axis has come; only in MOTION, after `start`. */
  HomeProgress watch(const ilk_snapshot_t& snapshot) noexcept;

  /** Requests for what keeps the axis going. */
  void hold(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept;

  /** Gives back a lease. What the kernel does by itself, homing, only the end of MOTION ends. */
  void let_go(std::uint32_t task, const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept;

  /** A request that the link did not take. */
  void on_unsent(const KernelRequest& request) noexcept;

  /** The kernel judged the HOME of this step. */
  void on_home_verdict(std::uint32_t verdict, std::uint32_t tick) noexcept;

  /** Whether RANGE may say that a nudge has met its switch, which a snapshot of that tick decides. */
  bool on_range_verdict(std::uint32_t tick) noexcept;

  /** Whether the kernel may be homing the axis for this step. */
  [[nodiscard]] bool may_be_homing() const noexcept {
    return asked_ || (accepted_ && progress_ == HomeProgress::going);
  }

  [[nodiscard]] HomeProgress progress() const noexcept { return progress_; }

  /** What a nudge still has to go, signed; 0 for the other kinds and where nothing is left. */
  [[nodiscard]] std::int32_t left_counts(const ilk_snapshot_t& snapshot) const noexcept;

 private:
  HomeProgress watch_homing(const ilk_snapshot_t& snapshot) noexcept;
  HomeProgress watch_nudge(const ilk_snapshot_t& snapshot) noexcept;
  HomeProgress watch_move(const ilk_snapshot_t& snapshot) noexcept;
  void start_slice(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] std::int64_t travelled_counts(const ilk_axis_t& axis) const noexcept;
  [[nodiscard]] bool leads_to_switch() const noexcept;
  [[nodiscard]] bool at_switch(const ilk_axis_t& axis) const noexcept;

  std::uint32_t slot_ = 0;
  AxisPlan plan_;
  AxisMove move_;
  HomeStepKind kind_ = HomeStepKind::home;
  HomeProgress progress_ = HomeProgress::arrived;
  std::int32_t counts_ = 0;

  bool asked_ = false;            /**< a HOME is on its way or not yet judged */
  bool accepted_ = false;         /**< the kernel took the HOME in `judged_tick_`, in this press */
  bool judged_ = false;           /**< a verdict came in this step */
  std::uint32_t judged_tick_ = 0; /**< of the newest verdict */

  bool marked_ = false;        /**< the nudge has begun at `mark_raw_` */
  std::uint32_t mark_raw_ = 0; /**< reading from which its distance is measured */
  bool last_slice_ = false;    /**< this press reaches the end of the nudge */
  bool stopping_ = false;      /**< the switch was met */
  bool refused_ = false;       /**< a renewal was refused by RANGE at `refused_tick_` */
  std::uint32_t refused_tick_ = 0;
  RestWatch rest_;
};

}  // namespace interlock
