#include "trajectory/timed_trajectory.hpp"

#include <algorithm>

namespace interlock {

MotionState TimedTrajectory::at(std::size_t axis, double time_s) const noexcept {
  if (!(time_s >= begin_s())) {
    return {state(0, axis).position, 0.0, 0.0};
  }
  if (time_s >= end_s()) {
    return {end(axis).position, 0.0, 0.0};
  }
  const auto next = std::ranges::upper_bound(times_s_, time_s);
  const auto row = static_cast<std::size_t>(next - times_s_.begin()) - 1;
  return piece(axis, row).after(time_s - times_s_[row]);
}

MotionPiece TimedTrajectory::piece(std::size_t axis, std::size_t row) const noexcept {
  if (row + 1 == rows()) {
    return {{end(axis).position, 0.0, 0.0}, 0.0};
  }
  return MotionPiece::between(state(row, axis), state(row + 1, axis), step_s(row));
}

double TimedTrajectory::step_s(std::size_t row) const noexcept {
  return row + 1 == rows() ? 0.0 : times_s_[row + 1] - times_s_[row];
}

}  // namespace interlock
