#include "trajectory/trajectory_error.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace interlock {

std::string_view code_name(TrajectoryError::Code code) {
  switch (code) {
    case TrajectoryError::Code::not_finite:
      return "NOT_FINITE";
    case TrajectoryError::Code::out_of_range:
      return "OUT_OF_RANGE";
    case TrajectoryError::Code::too_fast:
      return "TOO_FAST";
    case TrajectoryError::Code::too_much_acceleration:
      return "TOO_MUCH_ACCELERATION";
    case TrajectoryError::Code::too_much_jerk:
      return "TOO_MUCH_JERK";
    case TrajectoryError::Code::empty:
      return "EMPTY";
    case TrajectoryError::Code::too_large:
      return "TOO_LARGE";
    case TrajectoryError::Code::bad_header:
      return "BAD_HEADER";
    case TrajectoryError::Code::unknown_axis:
      return "UNKNOWN_AXIS";
    case TrajectoryError::Code::repeated_axis:
      return "REPEATED_AXIS";
    case TrajectoryError::Code::wrong_unit:
      return "WRONG_UNIT";
    case TrajectoryError::Code::wrong_columns:
      return "WRONG_COLUMNS";
    case TrajectoryError::Code::not_a_number:
      return "NOT_A_NUMBER";
    case TrajectoryError::Code::unsorted_times:
      return "UNSORTED_TIMES";
    case TrajectoryError::Code::no_path:
      return "NO_PATH";
    case TrajectoryError::Code::no_solution:
      return "NO_SOLUTION";
    default:
      return "UNKNOWN";
  }
}

std::string TrajectoryError::message() const {
  std::string place = line == 0 ? "" : "line " + std::to_string(line);
  if (!column.empty()) {
    place += (place.empty() ? "" : ", ") + column;
  }
  return place + (place.empty() ? "" : ": ") + problem + "; expected " + expected;
}

TrajectoryResult<void> check_within(std::string_view column, double value, double lowest, double highest) {
  const std::string range = number_text(lowest) + " to " + number_text(highest);
  if (!std::isfinite(value)) {
    return tl::unexpected(TrajectoryError{TrajectoryError::Code::not_finite, 0, std::string(column),
                                          "not a finite number", range});
  }
  if (value < lowest || value > highest) {
    return tl::unexpected(TrajectoryError{TrajectoryError::Code::out_of_range, 0, std::string(column),
                                          number_text(value) + " is out of range", range});
  }
  return {};
}

std::string number_text(double number) {
  std::array<char, 32> text{};
  const std::to_chars_result end =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, 12);
  return {text.data(), end.ptr};
}

}  // namespace interlock
