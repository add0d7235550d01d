/**
 * @file
 * A trajectory that was written down: positions of axes, and for some of them velocities, at rising times.
 *
 * Between two rows an axis with velocities follows the cubic that meets positions and velocities of both
 * (Hermite); one without goes straight. Before the first row and from the last on it stands there. Times are
 * those of the rows. `TrajectoryBuilder` is the only way to one, so that whoever holds a trajectory holds one
 * that was checked as a whole.
 *
 * Units are those of the axes (mm or rad) and seconds.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "robot/unit.hpp"
#include "trajectory/piecewise_motion.hpp"

namespace interlock {

/** An axis of a trajectory. */
struct TrajectoryAxis {
  std::uint32_t slot = 0;
  std::string name;
  Unit unit = Unit::mm;
  std::size_t position_place = 0;            /**< in a row */
  std::optional<std::size_t> velocity_place; /**< in a row, if velocities are given */
  PositionRange reach;    /**< the positions that it passes through, those between the rows as well */
  double top_speed = 0.0; /**< between the rows as well */
};

/** Rows of time and positions, and what lies between them. */
class TimedTrajectory {
 public:
  [[nodiscard]] std::size_t rows() const noexcept { return numbers_.size() / row_size_; }

  /** Of the first row. */
  [[nodiscard]] double begin_s() const noexcept { return time_s(0); }

  /** Of the last row. */
  [[nodiscard]] double end_s() const noexcept { return time_s(rows() - 1); }

  [[nodiscard]] double duration_s() const noexcept { return end_s() - begin_s(); }

  /** In the order of their columns. */
  [[nodiscard]] const std::vector<TrajectoryAxis>& axes() const noexcept { return axes_; }

  /** The state of an axis, by its place among `axes`. A time that is no number counts as before the first
   * row. */
  [[nodiscard]] MotionState at(std::size_t axis, double time_s) const noexcept;

  /** How an axis moves from a row to the next; from the last row on it stands. */
  [[nodiscard]] CubicSegment piece(std::size_t axis, std::size_t row) const noexcept;

  /** How fast an axis, by its place among `axes`, comes to the last row; 0 when that is the only one. */
  [[nodiscard]] double last_velocity(std::size_t axis) const noexcept;

  /** From a row to the next; 0 for the last row. */
  [[nodiscard]] double step_s(std::size_t row) const noexcept;

 private:
  friend class TrajectoryBuilder;

  [[nodiscard]] std::span<const double> row(std::size_t index) const noexcept {
    return std::span(numbers_).subspan(index * row_size_, row_size_);
  }
  [[nodiscard]] double time_s(std::size_t index) const noexcept { return row(index).front(); }

  std::vector<TrajectoryAxis> axes_;
  std::size_t row_size_ = 1;
  std::vector<double> numbers_; /**< row by row, each with its time first */
};

/** The motion of an axis from one row to a later one. */
CubicSegment piece_between(const TrajectoryAxis& axis, std::span<const double> from,
                           std::span<const double> to) noexcept;

}  // namespace interlock
