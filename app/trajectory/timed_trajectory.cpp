#include "trajectory/timed_trajectory.hpp"

#include <algorithm>
#include <ranges>

namespace interlock {

MotionState TimedTrajectory::at(std::size_t axis, double time_s) const noexcept {
  const TrajectoryAxis& moved = axes_[axis];
  if (!(time_s >= begin_s())) {
    return {row(0)[moved.position_place], 0.0, 0.0};
  }
  if (time_s >= end_s()) {
    return {row(rows() - 1)[moved.position_place], 0.0, 0.0};
  }
  const auto indices = std::views::iota(std::size_t{0}, rows());
  const auto next = *std::ranges::upper_bound(indices, time_s, {},
                                              [this](std::size_t index) { return this->time_s(index); });
  return piece_between(moved, row(next - 1), row(next)).after(time_s - this->time_s(next - 1));
}

CubicSegment TimedTrajectory::piece(std::size_t axis, std::size_t index) const noexcept {
  const TrajectoryAxis& moved = axes_[axis];
  if (index + 1 == rows()) {
    return {{row(index)[moved.position_place], 0.0, 0.0}, 0.0};
  }
  return piece_between(moved, row(index), row(index + 1));
}

double TimedTrajectory::last_velocity(std::size_t axis) const noexcept {
  if (rows() == 1) {
    return 0.0;
  }
  const std::size_t before = rows() - 2;
  return piece(axis, before).after(step_s(before)).velocity;
}

double TimedTrajectory::step_s(std::size_t index) const noexcept {
  return index + 1 == rows() ? 0.0 : time_s(index + 1) - time_s(index);
}

CubicSegment piece_between(const TrajectoryAxis& axis, std::span<const double> from,
                           std::span<const double> to) noexcept {
  const double duration_s = to.front() - from.front();
  const double start = from[axis.position_place];
  const double end = to[axis.position_place];
  if (const auto velocity = axis.velocity_place) {
    return CubicSegment::between(start, from[*velocity], end, to[*velocity], duration_s);
  }
  return CubicSegment::line(start, end, duration_s);
}

}  // namespace interlock
