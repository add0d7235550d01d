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

std::string_view reason(Code code) {
  switch (code) {
    case Code::not_finite:
      return "is not a finite number";
    case Code::out_of_range:
      return "is out of range";
    case Code::degenerate:
      return "is too short to give a direction; move entry and target apart";
    case Code::out_of_reach:
      return "is out of reach of the links; move the target";
    case Code::separation:
      return "is outside of the window of the trapezoid; move the target";
    case Code::singular:
      return "is singular: an angle is undetermined; choose another approach";
    case Code::not_rigid:
      return "shows that the matrix is no rigid pose";
    case Code::off_axis:
      return "shows that the entry is not on the axis of the pose; give an entry on its z axis";
    default:
      return "is not known";
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
    default:
      return "UNKNOWN";
  }
}

std::string KinematicsError::message() const {
  std::string text(quantity);
  if (value) {
    text += " of " + text_of(*value);
  }
  text += ' ';
  text += reason(code);
  return text + "; allowed " + text_of(lowest) + " to " + text_of(highest);
}

}  // namespace interlock
