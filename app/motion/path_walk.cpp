#include "motion/path_walk.hpp"

#include <algorithm>

namespace interlock {
namespace {

Setpoint in_counts(const MotionState& state, double counts_per_unit) noexcept {
  return {state.position * counts_per_unit, state.velocity * counts_per_unit,
          state.acceleration * counts_per_unit};
}

}  // namespace

PathWalk::PathWalk(const RobotPlan& plan) : plan_(plan), lease_s_(plan.lease_ticks() * plan.period_s()) {}

const TimedTrajectory* PathWalk::trajectory() const noexcept {
  const auto* timed = leg_ == nullptr ? nullptr : std::get_if<TimedLeg>(leg_);
  return timed == nullptr ? nullptr : &timed->trajectory;
}

void PathWalk::take(const PathLeg& leg) noexcept {
  leg_ = &leg;
  const TimedTrajectory* timed = trajectory();
  trajectory_s_ = timed == nullptr ? 0.0 : timed->begin_s();
}

bool PathWalk::begin(const ilk_snapshot_t& snapshot) noexcept {
  stage_ = Stage::approach;
  approach_s_ = 0.0;
  axes_ = 0;
  double minimum_duration_s = 0.0;
  if (const TimedTrajectory* timed = trajectory()) {
    for (std::size_t axis = 0; axis < timed->axes().size(); ++axis) {
      const std::uint32_t slot = timed->axes()[axis].slot;
      approach(snapshot, slot, timed->at(axis, trajectory_s_).position * plan_.axis[slot].counts_per_unit);
    }
  } else {
    const auto& move = std::get<MoveLeg>(*leg_);
    minimum_duration_s = move.minimum_duration_s;
    for (const AxisCounts& target : move.targets) {
      approach(snapshot, target.slot, target.counts);
    }
  }
  return planner_.plan(std::span(approach_).first(axes_), minimum_duration_s);
}

void PathWalk::approach(const ilk_snapshot_t& snapshot, std::uint32_t slot, double target_counts) noexcept {
  const AxisPlan& axis = plan_.axis[slot];
  const double units_per_count = 1.0 / axis.counts_per_unit;
  const MotionState now{snapshot.state.axis[slot].position_counts * units_per_count, 0.0, 0.0};
  const RateLimits limits{axis.rates.velocity_counts_per_s * units_per_count,
                          axis.rates.acceleration_counts_per_s2 * units_per_count,
                          axis.rates.jerk_counts_per_s3 * units_per_count};
  approach_[axes_] = {now, target_counts * units_per_count, limits};
  slots_[axes_] = slot;
  ++axes_;
}

void PathWalk::advance(double time_s) noexcept {
  (stage_ == Stage::approach ? approach_s_ : trajectory_s_) += time_s;
}

bool PathWalk::at_end() const noexcept {
  const TimedTrajectory* timed = trajectory();
  if (stage_ == Stage::trajectory && timed != nullptr) {
    return trajectory_s_ >= timed->end_s();
  }
  return approach_s_ >= planner_.duration_s();
}

bool PathWalk::go_on() noexcept {
  const TimedTrajectory* timed = trajectory();
  const bool left = stage_ == Stage::approach && timed != nullptr && trajectory_s_ < timed->end_s();
  stage_ = left ? Stage::trajectory : stage_;
  return left;
}

double PathWalk::dwell_s() const noexcept {
  const auto* move = leg_ == nullptr ? nullptr : std::get_if<MoveLeg>(leg_);
  return move == nullptr ? 0.0 : move->dwell_s;
}

const PathWalk::Points& PathWalk::points() noexcept {
  const TimedTrajectory* timed = trajectory();
  if (stage_ == Stage::trajectory && timed != nullptr) {
    point_along_trajectory(*timed);
  } else {
    point_along_approach();
  }
  return points_;
}

void PathWalk::point_along_approach() noexcept {
  const auto ahead = planner_.at(approach_s_ + lease_s_);
  for (std::size_t place = 0; place < ahead.size(); ++place) {
    points_[slots_[place]].ahead_counts = ahead[place].position * plan_.axis[slots_[place]].counts_per_unit;
  }
  const auto now = planner_.at(approach_s_);
  for (std::size_t place = 0; place < now.size(); ++place) {
    points_[slots_[place]].now = in_counts(now[place], plan_.axis[slots_[place]].counts_per_unit);
  }
}

void PathWalk::point_along_trajectory(const TimedTrajectory& timed) noexcept {
  for (std::size_t axis = 0; axis < timed.axes().size(); ++axis) {
    const std::uint32_t slot = timed.axes()[axis].slot;
    const double counts_per_unit = plan_.axis[slot].counts_per_unit;
    const MotionState now = timed.at(axis, trajectory_s_);
    points_[slot] = {in_counts(now, counts_per_unit),
                     timed.at(axis, trajectory_s_ + lease_s_).position * counts_per_unit};
  }
}

}  // namespace interlock
