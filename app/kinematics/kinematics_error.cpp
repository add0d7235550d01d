#include "kinematics/kinematics_error.hpp"

#include <array>
#include <charconv>

namespace interlock {

namespace {

using Code = KinematicsError::Code;

std::string text_of(double number) {
  std::array<char, 32> text{};
  const std::to_chars_result end =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, 9);
  return {text.data(), end.ptr};
}

/** What is wrong with a quantity, and what to do about it. */
struct Reason {
  std::string_view wrong;
  std::string_view next;
};

Reason reason(Code code) {
  switch (code) {
    case Code::not_finite:
      return {"is not a finite number", "give a number"};
    case Code::out_of_range:
      return {"is out of range", "choose a value within"};
    case Code::degenerate:
      return {"gives no direction", "move entry and target apart"};
    case Code::out_of_reach:
      return {"is out of reach of the links", "choose another target"};
    case Code::separation:
      return {"is outside of the window of the trapezoid", "choose other slider positions or another target"};
    case Code::singular:
      return {"leaves an angle undetermined", "choose another approach"};
    case Code::not_rigid:
      return {"shows that the matrix is no rigid pose", "give a rotation and a translation"};
    case Code::off_axis:
      return {"shows that the entry is not on the axis of the pose", "give an entry on its z axis"};
    case Code::not_converged:
      return {"is what the search came to when it was given up", "try again with another target"};
    default:
      return {"is refused", "choose a value within"};
  }
}

}  // namespace

std::string_view code_name(Code code) {
  switch (code) {
    case Code::not_finite:
      return "NOT_FINITE";
    case Code::out_of_range:
      return "OUT_OF_RANGE";
    case Code::degenerate:
      return "DEGENERATE";
    case Code::out_of_reach:
      return "OUT_OF_REACH";
    case Code::separation:
      return "SEPARATION";
    case Code::singular:
      return "SINGULAR";
    case Code::not_rigid:
      return "NOT_RIGID";
    case Code::off_axis:
      return "OFF_AXIS";
    case Code::not_converged:
      return "NOT_CONVERGED";
    case Code::absent:
      return "NO_KINEMATICS";
    default:
      return "UNKNOWN";
  }
}

std::string KinematicsError::message() const {
  if (code == Code::absent) {
    return "The robot has no kinematics, so it has no pose; move its axes one by one.";
  }
  std::string text(quantity);
  if (value) {
    text += " of " + text_of(*value);
  }
  const auto [wrong, next] = reason(code);
  text.append(" ").append(wrong).append("; allowed " + text_of(lowest) + " to " + text_of(highest));
  return text.append("; ").append(next);
}

}  // namespace interlock
