#include "control/control_error.hpp"

#include <cmath>

namespace interlock {

std::string ControlError::message() const {
  return std::string(quantity) + (code == Code::not_finite ? " is not a finite number" : " is out of range");
}

ControlResult<void> require_within(std::string_view quantity, double value, double lowest,
                                   double highest) noexcept {
  if (!std::isfinite(value)) {
    return tl::unexpected(ControlError{ControlError::Code::not_finite, quantity});
  }
  if (value < lowest || value > highest) {
    return tl::unexpected(ControlError{ControlError::Code::out_of_range, quantity});
  }
  return {};
}

}  // namespace interlock
