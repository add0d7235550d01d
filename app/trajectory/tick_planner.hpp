/**
 * @file
 * Plans a synchronised move inside of a control tick: the moves of `plan_move`, but without allocating,
 * throwing or telling more of an error than that there was one.
 *
 * Every plan is one from rest or from motion to rest, jerk-limited, in the shortest time in which all axes
 * arrive together, or in a longer one. From rest the axes move in proportion, along the straight line from
 * positions to targets. Planned by Ruckig in some tens of microseconds.
 *
 * Units are those of the caller, the same for all quantities of an axis, and seconds.
 */
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "trajectory/piecewise_motion.hpp"
#include "trajectory/synchronised_plan.hpp"

namespace interlock {

class TickPlanner {
 public:
  /** Axes that a plan may have. */
  static constexpr std::size_t capacity = 10;

  /** One axis of a plan: how it moves now, where it shall come to rest, how fast it may. */
  struct AxisPath {
    MotionState now;
    double target = 0.0;
    RateLimits limits;
  };

  /** Allocates all that planning needs. */
  TickPlanner();
  ~TickPlanner();
  TickPlanner(const TickPlanner&) = delete;
  TickPlanner& operator=(const TickPlanner&) = delete;
  TickPlanner(TickPlanner&&) noexcept;
  TickPlanner& operator=(TickPlanner&&) noexcept;

  /**
   * Plans a move of at most `capacity` axes that takes at least `minimum_duration_s`. False: there is none,
   * as a number is not finite or beyond the ranges of motion_state.hpp, or Ruckig found no solution; then
   * nothing moves, `at` stays where the axes are.
   */
  [[nodiscard]] bool plan(std::span<const AxisPath> axes, double minimum_duration_s) noexcept;

  /** Until all axes are at rest; 0 before the first plan and after one that failed. */
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }

  /** The state of each axis that long after the plan's start, in the order of its axes; from the end on
   * exactly at rest at the targets. */
  [[nodiscard]] std::span<const MotionState> at(double time_s) noexcept;

 private:
  struct Workshop;

  std::unique_ptr<Workshop> workshop_;
  std::size_t axes_ = 0;
  double duration_s_ = 0.0;
  bool planned_ = false; /**< whether the last plan exists */
};

}  // namespace interlock
