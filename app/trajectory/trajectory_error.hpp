/**
 * @file
 * Why there is no trajectory. Every function of this folder either answers or returns one of these; none
 * throws.
 */
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace interlock {

/** The first thing wrong with a trajectory, or with what it should be made of. */
struct TrajectoryError {
  /** Kinds of refusal. */
  enum class Code {
    not_finite,   /**< NaN or infinity came in */
    out_of_range, /**< a number beyond its limits: soft limits less coast, or where it means something */
    too_fast,     /**< a velocity, given or between rows, above the axis' rate */
    too_much_acceleration, /**< an acceleration between rows above it */
    too_much_jerk,         /**< a jerk between rows above it */
    empty,                 /**< no text, or no row below the header */
    too_large,             /**< more rows or bytes than a trajectory may have */
    bad_header,            /**< a column that is no time, position or velocity */
    unknown_axis,          /**< the robot has no axis of that name */
    repeated_axis,         /**< a second column for the same */
    wrong_unit,            /**< not the unit of the axis */
    wrong_columns,         /**< a row with more or fewer fields than the header */
    not_a_number,          /**< a field that is no number */
    unsorted_times,        /**< a time that does not follow the one before */
    no_path,               /**< an axis without rates for a motion along a path */
    no_solution,           /**< the planner found no motion */
  };

  Code code = Code::not_finite;
  std::size_t line = 0; /**< of the text, from 1; 0: no particular line */
  std::string column;   /**< as in the header: "yaw [rad]"; or the name of the quantity; empty: all of it */
  std::string problem;  /**< what was found */
  std::string expected; /**< what belongs there instead */

  /** One line for people: "line 3, yaw [rad]: -2 is out of range; expected -1.52048253330 to
   * -0.00502638853983". */
  [[nodiscard]] std::string message() const;

  bool operator==(const TrajectoryError&) const = default;
};

/** For programs: "NOT_FINITE", "UNKNOWN_AXIS" and so on. */
std::string_view code_name(TrajectoryError::Code code);

/** A value, or why there is no trajectory. */
template <typename Value>
using TrajectoryResult = tl::expected<Value, TrajectoryError>;

/** Nothing, when `value` is finite and within both ends; `column` names it in the error. */
TrajectoryResult<void> check_within(std::string_view column, double value, double lowest, double highest);

/** A number as errors show it: twelve digits, as short as they get. */
std::string number_text(double number);

}  // namespace interlock
