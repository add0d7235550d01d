#include "steering/sweep.hpp"

#include "steering/angle.hpp"

namespace interlock {

double Sweep::direction(double rotation_rad) noexcept {
  if (rotation_rad > full_turn_rad) {
    direction_ = -1.0;
  } else if (rotation_rad < 0.0) {
    direction_ = 1.0;
  }
  return direction_;
}

}  // namespace interlock
