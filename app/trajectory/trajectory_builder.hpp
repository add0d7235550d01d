/**
 * @file
 * Makes a trajectory row by row, and refuses the first row with which it would no longer be one that the
 * robot can follow.
 *
 * Checked: number of fields; finite numbers; times from 0 on that rise by `shortest_step_s` at least;
 * positions, those between the rows as well, within what the kernel accepts of a homed axis (its soft limits
 * less coast); velocities, given or implied, within the limit of the axis where one is known.
 */
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "robot/robot.hpp"
#include "trajectory/timed_trajectory.hpp"
#include "trajectory/trajectory_error.hpp"

namespace interlock {

/** A hundred seconds of the control loop, a quarter of an hour at 100 rows a second. */
inline constexpr std::size_t most_trajectory_rows = 100'000;

/** More than a day. */
inline constexpr double latest_time_s = 1e5;

/** Times closer than this count as repeated. */
inline constexpr double shortest_step_s = 1e-6;

/** Rounding by which a velocity may pass its limit, as a share of it. */
inline constexpr double velocity_slack = 1e-9;

/** Largest speed of axes by name, in their units per second. */
using VelocityLimits = std::map<std::string, double, std::less<>>;

/** The error of a row whose fields are not as many as the columns: names the first that is missing, or too
 * many. */
TrajectoryError wrong_columns(std::size_t line, std::size_t fields, std::span<const std::string> columns);

/** Takes rows one by one and checks each. */
class TrajectoryBuilder {
 public:
  /** Begins with the columns' names, as `read_header` describes them. A limit has to name an axis and be
   * positive. */
  static TrajectoryResult<TrajectoryBuilder> create(std::vector<std::string> columns, const Robot& robot,
                                                    const VelocityLimits& limits = {});

  /** As in the header. */
  [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }

  /** Line of the next row; the header is line 1. */
  [[nodiscard]] std::size_t line() const noexcept { return trajectory_.rows() + 2; }

  /** Goes on with a row, its time first. Errors name its line; after one the trajectory is as before. */
  TrajectoryResult<void> add(std::span<const double> row);

  /** The trajectory; EMPTY before the first row. */
  [[nodiscard]] TrajectoryResult<TimedTrajectory> finish() &&;

 private:
  /** What the rows of an axis are held against. */
  struct AxisRules {
    Axis axis;
    double max_velocity = largest_rate;
  };

  /** What an axis does on its way from the last row to the next. */
  struct Way {
    PositionRange reach;
    double top_speed = 0.0;
  };

  using Checked = TrajectoryResult<void>;

  TrajectoryBuilder() = default;

  [[nodiscard]] Checked check_numbers(std::span<const double> row) const;
  [[nodiscard]] Checked check_time(double time_s) const;
  [[nodiscard]] Checked check_state(std::size_t axis, std::span<const double> row) const;
  [[nodiscard]] Way way_to(std::size_t axis, std::span<const double> row) const;
  [[nodiscard]] Checked check_way(std::size_t axis, const Way& way) const;
  [[nodiscard]] tl::unexpected<TrajectoryError> refused(TrajectoryError::Code code, std::size_t column,
                                                        std::string problem, std::string expected) const;

  std::vector<std::string> columns_;
  std::vector<AxisRules> rules_; /**< in the order of the trajectory's axes */
  std::vector<Way> ways_;        /**< of the row that is being added, axis by axis */
  TimedTrajectory trajectory_;
};

}  // namespace interlock
