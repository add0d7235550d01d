/**
 * @file
 * Path mode: several axes together along the legs of a program, for as long as the pedal is held.
 *
 * Coordinated moves, trajectories and draping all run here. Release of the pedal stops the axes; the next
 * press leads them, jerk-limited, back to where the leg was left, and then on. An axis that cannot keep up
 * slows the time of the path down, for all axes, so that they stay on it; while the breathing gate is closed,
 * a path that would insert stands, and then goes on. An axis that strays from its path all the same, one that
 * holds it up for seconds, an obstacle or a refusal ends the task for all axes, which then stop at once:
 * their drive is given back.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "motion/axis_tracker.hpp"
#include "motion/held_mode.hpp"
#include "motion/trajectory_follower.hpp"

namespace interlock {

class PathMode final : public HeldMode {
 public:
  explicit PathMode(const RobotPlan& plan);

  void on_unsent(const KernelRequest& request) noexcept override;
  void hold_insertion(bool held) noexcept override { insertion_held_ = held; }
  [[nodiscard]] std::optional<Setpoint> setpoint(std::uint32_t slot) const noexcept override;

 private:
  /** A program without legs is done at once. */
  [[nodiscard]] std::uint32_t prepare(std::uint32_t tick) noexcept override;
  void begin(const ilk_snapshot_t& snapshot) noexcept override;
  void go_on(const ilk_snapshot_t& snapshot) noexcept override;
  void drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept override;
  void take_up_again(const ilk_snapshot_t& snapshot) noexcept;
  void settle(const ilk_snapshot_t& snapshot) noexcept;
  void end_leg(const ilk_snapshot_t& snapshot) noexcept;
  void advance(const ilk_snapshot_t& snapshot) noexcept;
  [[nodiscard]] bool waits_for_breath() const noexcept;
  [[nodiscard]] bool strays(const ilk_snapshot_t& snapshot) noexcept;
  /** Whether the leg that runs moves the axis in `slot`. */
  [[nodiscard]] bool leg_moves(std::uint32_t slot) const noexcept {
    return ((walk_.mask() >> slot) & 1u) != 0;
  }
  [[nodiscard]] bool follows(std::uint32_t slot) const noexcept { return executes() && leg_moves(slot); }
  [[nodiscard]] const PathProgram& program() const noexcept { return *work<PathTask>().program; }

  const double period_s_;
  const std::uint32_t settle_ticks_;
  const std::uint32_t coast_ticks_;
  const std::optional<std::uint32_t> insertion_slot_;
  TrajectoryFollower walk_;
  TrajectoryFollower::Points points_{};
  std::array<AxisTracker, ILK_SLOTS> trackers_{};
  std::array<std::uint32_t, ILK_SLOTS> deadband_counts_{};
  std::array<std::int32_t, ILK_SLOTS> left_{}; /**< where each axis came to rest after it was driven last */
  std::uint32_t driven_tick_ = 0;
  bool insertion_held_ = false;
  double lag_rate_ = 1.0;     /**< at which the axis that is farthest behind lets the time of the path pass */
  double breath_rate_ = 1.0;  /**< the same of the breathing gate */
  std::uint32_t slowest_ = 0; /**< slot of the axis that is farthest behind */
  std::uint32_t alive_tick_ = 0; /**< in which the time of the path last passed */
  std::uint32_t seen_tick_ = 0;  /**< of the snapshot before, while executing */
  std::uint32_t end_tick_ = 0;   /**< since which the path is at its end and axes may lag behind */
  std::uint32_t rest_tick_ = 0;  /**< since which all axes rest there */
  bool resting_ = false;
};

}  // namespace interlock
