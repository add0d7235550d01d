/**
 * @file
 * Path mode: several axes together along the legs of a program, for as long as the pedal is held.
 *
 * Coordinated moves, trajectories and draping all run here. Release of the pedal stops the axes; the next
 * press leads them, jerk-limited, back to where the leg was left, and then on. An axis that strays from its
 * path, an obstacle or a refusal ends the order for all axes, which then stop at once: their drive is given
 * back.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "motion/axis_tracker.hpp"
#include "motion/held_order.hpp"
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

  [[nodiscard]] bool is_open() const noexcept { return order_.is_open(); }
  [[nodiscard]] const PathStatus& status() const noexcept { return status_; }

  /** Where the axis in `slot` should be now; nothing unless the leg that runs moves it. */
  [[nodiscard]] std::optional<Setpoint> setpoint(std::uint32_t slot) const noexcept;

 private:
  void begin(const ilk_snapshot_t& snapshot) noexcept;
  void follow(const ilk_snapshot_t& snapshot) noexcept;
  void settle(const ilk_snapshot_t& snapshot) noexcept;
  void end_leg(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool strays(const ilk_snapshot_t& snapshot) noexcept;
  void tell() noexcept;
  [[nodiscard]] bool moves(std::uint32_t slot) const noexcept { return ((walk_.mask() >> slot) & 1u) != 0; }
  [[nodiscard]] bool follows(std::uint32_t slot) const noexcept { return order_.executes() && moves(slot); }

  const double period_s_;
  const std::uint32_t settle_ticks_;
  PathWalk walk_;
  PathWalk::Points points_{};
  std::array<AxisTracker, ILK_SLOTS> trackers_{};
  HeldOrder order_;
  const PathProgram* program_ = nullptr; /**< of the open order */
  std::uint32_t leg_ = 0;
  PathStatus status_;
  std::uint32_t seen_tick_ = 0; /**< of the snapshot before, while executing */
  std::uint32_t end_tick_ = 0;  /**< since which the path is at its end and axes may lag behind */
  std::uint32_t rest_tick_ = 0; /**< since which all axes rest there */
  bool resting_ = false;
};

}  // namespace interlock
