/**
 * @file
 * A trajectory that was written down: positions of axes, and for some of them velocities, at rising times.
 *
 * It passes through every row at its time, and between two rows smoothly: position, velocity and acceleration
 * of an axis do not leap at a row, so that its jerk is finite.
 *
 * An axis without velocities follows the cubic spline through its rows. It is straight when they are two; at
 * both ends its acceleration goes on as in the next row, so that rows of a motion that was cut anywhere lead
 * along that motion. An axis with velocities follows quintics that meet these, too, and whose jerk does not
 * leap at a row either; its acceleration at both ends is 0 where the velocity is, else that of the cubic
 * which meets positions and velocities of both rows.
 *
 * Before the first row and from the last on it stands there. `TrajectoryBuilder` is the only way to one, so
 * that whoever holds a trajectory holds one that was checked as a whole.
 *
 * Units are those of the axes (mm or rad) and seconds.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "robot/unit.hpp"
#include "trajectory/piecewise_motion.hpp"

namespace interlock {

/** An axis of a trajectory; what holds between the rows as well. */
struct TrajectoryAxis {
  std::uint32_t slot = 0;
  std::string name;
  Unit unit = Unit::mm;
  PositionRange reach; /**< the positions that it passes through */
  RateLimits top;      /**< the largest magnitudes of its rates */
};

/** Rows of time and positions, and what lies between them. */
class TimedTrajectory {
 public:
  [[nodiscard]] std::size_t rows() const noexcept { return times_s_.size(); }

  /** Of the first row. */
  [[nodiscard]] double begin_s() const noexcept { return times_s_.front(); }

  /** Of the last row. */
  [[nodiscard]] double end_s() const noexcept { return times_s_.back(); }

  [[nodiscard]] double duration_s() const noexcept { return end_s() - begin_s(); }

  /** In the order of their columns. */
  [[nodiscard]] const std::vector<TrajectoryAxis>& axes() const noexcept { return axes_; }

  /** How many times as long it takes as it was written; 1 unless it was slowed down. */
  [[nodiscard]] double slowed_by() const noexcept { return slowed_by_; }

  /** The state of an axis, by its place among `axes`. A time that is no number counts as before the first
   * row. */
  [[nodiscard]] MotionState at(std::size_t axis, double time_s) const noexcept;

  /** How an axis comes to the last row; at rest when that is the only one. */
  [[nodiscard]] const MotionState& end(std::size_t axis) const noexcept { return state(rows() - 1, axis); }

  /** How an axis moves from a row to the next; from the last row on it stands. */
  [[nodiscard]] MotionPiece piece(std::size_t axis, std::size_t row) const noexcept;

  /** From a row to the next; 0 for the last row. */
  [[nodiscard]] double step_s(std::size_t row) const noexcept;

 private:
  friend class TrajectoryBuilder;

  [[nodiscard]] const MotionState& state(std::size_t row, std::size_t axis) const noexcept {
    return states_[row * axes_.size() + axis];
  }
  [[nodiscard]] MotionState& state(std::size_t row, std::size_t axis) noexcept {
    return states_[row * axes_.size() + axis];
  }

  std::vector<TrajectoryAxis> axes_;
  std::vector<double> times_s_;     /**< of the rows */
  std::vector<MotionState> states_; /**< row by row, in each the axes */
  double slowed_by_ = 1.0;
};

}  // namespace interlock
