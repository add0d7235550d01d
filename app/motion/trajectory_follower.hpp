/**
 * @file
 * Where each axis of a leg should be at any moment: a planned approach, and behind it the trajectory, if the
 * leg has one.
 *
 * Time is that of the walk: whoever walks may go more slowly than the clock, for as long as it takes, or
 * stand still and then begin anew from wherever the axes are. Velocities do not leap where a stage begins:
 * the approach begins at those of the axes, and a trajectory that begins or ends in motion is come up to, and
 * left, within the axes' rates.
 */
#pragma once

#include <array>
#include <cstdint>

#include "control/setpoint.hpp"
#include "interlock/link.h"
#include "motion/axis_plan.hpp"
#include "motion/path_program.hpp"
#include "motion/time_scaling.hpp"
#include "trajectory/tick_planner.hpp"

namespace interlock {

/** What a path demands of one axis at one moment. */
struct PathPoint {
  Setpoint now;
  double ahead_counts = 0.0; /**< where the path is a lease later */
};

/** Where each axis has to be at each time of a path. */
class TrajectoryFollower {
 public:
  /** For each slot, where its axis has to be. */
  using Points = std::array<PathPoint, ILK_SLOTS>;

  explicit TrajectoryFollower(const RobotPlan& plan);

  /** Takes a leg, to be walked from its start. It must outlive the walk. */
  void take(const PathLeg& leg) noexcept;

  /**
   * Begins, or begins anew after a pause: plans the approach from where the axes are, and how fast they move
   * by slot, to the leg's targets, or to where its trajectory is to go on. False: there is no such way.
   */
  [[nodiscard]] bool begin(const ilk_snapshot_t& snapshot,
                           const std::array<double, ILK_SLOTS>& velocities_counts_per_s) noexcept;

  /** Goes on by that time of the path, which passes at `rate` of the clock: from 0 to 1. */
  void advance(double time_s, double rate = 1.0) noexcept;

  /** Where each axis of the leg should be now, by slot; the points of others mean nothing. */
  [[nodiscard]] const Points& points() noexcept;

  /** How fast the rate may change now, 1/s. */
  struct RateChange {
    double least_per_s = 0.0;    /**< 0 or less */
    double greatest_per_s = 0.0; /**< 0 or more */
  };

  /** Within which no axis of the leg exceeds its acceleration, at the `points` as they were last asked for;
   * as good as at once while they rest. */
  [[nodiscard]] RateChange rate_change() const noexcept;

  /** Whether the approach, or the trajectory, has come to its end; the axes may lag behind. */
  [[nodiscard]] bool at_end() const noexcept;

  /** Time until the approach, or the trajectory, comes to its end; 0 or less from there on. */
  [[nodiscard]] double left_s() const noexcept;

  /** The axes have arrived at the end. Goes on to the trajectory after its approach; false: the leg is done.
   */
  [[nodiscard]] bool go_on() noexcept;

  /** Bit n: the leg moves the axis in slot n. */
  [[nodiscard]] std::uint32_t mask() const noexcept { return leg_ == nullptr ? 0 : mask_of(*leg_); }

  /** Rest at the end of the leg. */
  [[nodiscard]] double dwell_s() const noexcept;

 private:
  enum class Stage : std::uint8_t { approach, trajectory };

  [[nodiscard]] const TimedTrajectory* trajectory() const noexcept;
  void approach(const MotionState& now_counts, std::uint32_t slot, double target_counts) noexcept;
  void begin_trajectory(const TimedTrajectory& timed) noexcept;
  [[nodiscard]] Setpoint in_counts(const MotionState& state, std::uint32_t slot) noexcept;
  void point_along_approach() noexcept;
  void point_along_trajectory(const TimedTrajectory& trajectory) noexcept;

  RobotPlan plan_;
  double lease_s_ = 0.0;
  TickPlanner planner_;
  const PathLeg* leg_ = nullptr;
  Stage stage_ = Stage::approach;
  std::array<TickPlanner::AxisPath, TickPlanner::capacity> approach_{};
  std::array<std::uint32_t, TickPlanner::capacity> slots_{}; /**< of the axes of `approach_` */
  std::size_t axes_ = 0;
  double stage_s_ = 0.0;      /**< since approach or trajectory began */
  double rate_ = 1.0;         /**< at which time of the path passes */
  double trajectory_s_ = 0.0; /**< time of the trajectory's rows to which the walk has come */
  double begun_s_ = 0.0;      /**< that at which its stage began */
  TimeScaling pace_;          /**< of the trajectory's time, from rest to rest */
  Points points_{};
  std::array<MotionState, ILK_SLOTS> unscaled_{}; /**< of the points at the rate 1, in the axes' units */
};

}  // namespace interlock
