/**
 * @file
 * Path mode: several axes together along the legs of a program, for as long as the pedal is held.
 *
 *     waiting -> executing <-> paused -> done, or refused, aborted, expired
 *
 * Coordinated moves, trajectories and draping all run here. Release of the pedal stops the axes; the next
 * press leads them, jerk-limited, back to where the leg was left, and then on. An axis that strays from its
 * path, an obstacle or a refusal ends the order for all axes, which then stop at once: their drive is given
 * back.
 */
#pragma once

#include <array>
#include <cstdint>

#include "motion/axis_tracker.hpp"
#include "motion/mode.hpp"
#include "motion/path_walk.hpp"

namespace interlock {

class PathMode final : public Mode {
 public:
  explicit PathMode(const RobotPlan& plan);

  /** Takes an order; an open one is replaced. A program without legs is done at once. */
  void take(const PathOrder& order, std::uint32_t tick) noexcept;

  void end(std::uint32_t proposal, OrderReason reason, std::uint32_t tick) noexcept override;
  void end_all(OrderReason reason, std::uint32_t tick) noexcept override;
  void end_axis(std::uint32_t slot, OrderReason reason, std::uint32_t tick) noexcept override;
  void tick(const ilk_snapshot_t& snapshot, Wishes& wishes) noexcept override;
  void on_unsent(const Wish& wish) noexcept override;
  void on_verdict(const WishOrigin& origin, std::uint32_t verdict, std::uint32_t tick) noexcept override;
  void on_verdict_lost(const WishOrigin& origin, std::uint32_t tick) noexcept override;

  [[nodiscard]] bool is_open() const noexcept { return interlock::is_open(status_.order.phase); }
  [[nodiscard]] const PathStatus& status() const noexcept { return status_; }

 private:
  void set_phase(OrderPhase phase, OrderReason reason, std::uint32_t code, std::uint32_t tick) noexcept;
  void fail(OrderReason reason, std::uint32_t code, std::uint32_t slot, std::uint32_t tick) noexcept;
  void judge(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool meets_obstacle(const ilk_snapshot_t& snapshot) noexcept;
  void go(const ilk_snapshot_t& snapshot) noexcept;
  void begin(const ilk_snapshot_t& snapshot) noexcept;
  void follow(const ilk_snapshot_t& snapshot) noexcept;
  void settle(const ilk_snapshot_t& snapshot) noexcept;
  void end_leg(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool strays(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool waited_too_long(std::uint32_t tick) const noexcept;
  [[nodiscard]] bool moves(std::uint32_t slot) const noexcept { return ((walk_.mask() >> slot) & 1u) != 0; }

  const double period_s_;
  const std::uint32_t patience_ticks_;
  const std::uint32_t settle_ticks_;
  PathWalk walk_;
  PathWalk::Points points_{};
  std::array<AxisTracker, ILK_SLOTS> trackers_{};
  PathOrder order_;
  PathStatus status_;
  std::uint32_t involved_ = 0;  /**< bit n: the order moves the axis in slot n */
  std::uint32_t seen_tick_ = 0; /**< of the snapshot before, while executing */
  std::uint32_t end_tick_ = 0;  /**< since which the path is at its end and axes may lag behind */
  std::uint32_t rest_tick_ = 0; /**< since which all axes rest there */
  bool resting_ = false;
  std::uint32_t idle_since_ = 0; /**< tick since which the order does not execute */
};

}  // namespace interlock
