/**
 * @file
 * Makes a trajectory of rows, and refuses it at the first row with which it would no longer be one that the
 * robot can follow.
 *
 * Checked of each row: number of fields; finite numbers; times from 0 on that rise by `shortest_step_s` at
 * least; positions within what the kernel accepts of a homed axis (its soft limits less coast); velocities
 * within `largest_rate`, so that all that follows from them is finite. Checked of all that lies between the
 * rows, exactly, by its polynomials: the same of positions; velocity, acceleration and jerk within the rates
 * of the axis.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>
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

/** Rounding by which a step may fall short of the shortest, as a share of it. */
inline constexpr double time_slack = 0.999;

/** Rounding by which a rate may pass its limit, as a share of it. */
inline constexpr double rate_slack = 1e-9;

/** What becomes of rows that ask for more than the rates of an axis. */
enum class Timing : std::uint8_t {
  as_written,    /**< they are refused */
  slowed_to_fit, /**< all times from the first row on are made longer, in the same proportion, until they fit
                  */
};

/** The error of a row whose fields are not as many as the columns: names the first that is missing, or too
 * many. */
TrajectoryError wrong_columns(std::size_t line, std::size_t fields, std::span<const std::string> columns);

/** Takes rows one by one and checks each. */
class TrajectoryBuilder {
 public:
  /** Begins with the columns' names, as `read_header` describes them. */
  static TrajectoryResult<TrajectoryBuilder> create(std::vector<std::string> columns, const Robot& robot,
                                                    Timing timing = Timing::as_written);

  /** As in the header. */
  [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }

  /** Line of the next row; the header is line 1. */
  [[nodiscard]] std::size_t line() const noexcept { return line_of(trajectory_.rows()); }

  /** Goes on with a row, its time first. Errors name its line; after one the trajectory is as before. */
  TrajectoryResult<void> add(std::span<const double> row);

  /** The trajectory; EMPTY before the first row, and else what is wrong between the rows. */
  [[nodiscard]] TrajectoryResult<TimedTrajectory> finish() &&;

 private:
  /** What the rows of an axis are held against. */
  struct AxisRules {
    Axis axis;
    RateLimits limits;
    std::size_t position_place = 0;            /**< in a row */
    std::optional<std::size_t> velocity_place; /**< in a row, if velocities are given */
  };

  using Checked = TrajectoryResult<void>;
  struct RateRule;
  static const std::array<RateRule, 3> rate_rules;

  TrajectoryBuilder() = default;

  [[nodiscard]] static std::size_t line_of(std::size_t row) noexcept { return row + 2; }
  [[nodiscard]] Checked check_numbers(std::span<const double> row) const;
  [[nodiscard]] Checked check_time(double time_s) const;
  [[nodiscard]] Checked check_state(const AxisRules& rules, std::span<const double> row) const;
  void smooth(std::size_t axis);
  void look_between_rows();
  void look_at_way(std::size_t axis, std::size_t row);
  void look_at_rate(std::size_t axis, std::size_t row, const RateRule& rule, const MotionPiece& piece);
  [[nodiscard]] Checked judge();
  [[nodiscard]] Checked slow_down();
  [[nodiscard]] tl::unexpected<TrajectoryError> refused(TrajectoryError::Code code, std::size_t row,
                                                        std::size_t column, std::string problem,
                                                        std::string expected) const;

  std::vector<std::string> columns_;
  Timing timing_ = Timing::as_written;
  std::vector<AxisRules> rules_;            /**< in the order of the trajectory's axes */
  std::optional<TrajectoryError> outside_;  /**< the first position between rows that is out of range */
  std::optional<TrajectoryError> too_fast_; /**< of all rates the one that is farthest beyond its limit */
  double slowness_ = 1.0;                   /**< how many times as long it has to take for that one */
  TimedTrajectory trajectory_;
};

}  // namespace interlock
