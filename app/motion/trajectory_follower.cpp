#include "motion/trajectory_follower.hpp"

#include <algorithm>
#include <cmath>

namespace interlock {

TrajectoryFollower::TrajectoryFollower(const RobotPlan& plan)
    : plan_(plan), lease_s_(plan.lease_ticks() * plan.period_s()) {}

const TimedTrajectory* TrajectoryFollower::trajectory() const noexcept {
  const auto* timed = leg_ == nullptr ? nullptr : std::get_if<TimedLeg>(leg_);
  return timed == nullptr ? nullptr : &timed->trajectory;
}

void TrajectoryFollower::take(const PathLeg& leg) noexcept {
  leg_ = &leg;
  const TimedTrajectory* timed = trajectory();
  trajectory_s_ = timed == nullptr ? 0.0 : timed->begin_s();
}

bool TrajectoryFollower::begin(const ilk_snapshot_t& snapshot,
                               const std::array<double, ILK_SLOTS>& velocities_counts_per_s) noexcept {
  stage_ = Stage::approach;
  stage_s_ = 0.0;
  rate_ = 1.0;
  axes_ = 0;
  double minimum_duration_s = 0.0;
  const auto now = [&](std::uint32_t slot) {
    const double position = snapshot.state.axis[slot].position_counts;
    return MotionState{position, velocities_counts_per_s[slot], 0.0};
  };
  if (const TimedTrajectory* timed = trajectory()) {
    for (std::size_t axis = 0; axis < timed->axes().size(); ++axis) {
      const std::uint32_t slot = timed->axes()[axis].slot;
      approach(now(slot), slot, timed->at(axis, trajectory_s_).position * plan_.axis[slot].counts_per_unit);
    }
  } else {
    const auto& move = std::get<MoveLeg>(*leg_);
    minimum_duration_s = move.minimum_duration_s;
    for (const AxisCounts& target : move.targets) {
      approach(now(target.slot), target.slot, target.counts);
    }
  }
  return planner_.plan(std::span(approach_).first(axes_), minimum_duration_s);
}

void TrajectoryFollower::approach(const MotionState& now_counts, std::uint32_t slot,
                                  double target_counts) noexcept {
  const AxisPlan& axis = plan_.axis[slot];
  const MotionState now{now_counts.position / axis.counts_per_unit,
                        now_counts.velocity / axis.counts_per_unit, 0.0};
  approach_[axes_] = {now, target_counts / axis.counts_per_unit, axis.rates.in_units(axis.counts_per_unit)};
  slots_[axes_] = slot;
  ++axes_;
}

/** As slowly as the slowest axis needs to come up to its velocity there within acceleration and jerk, and to
 * come to rest at the last row. */
void TrajectoryFollower::begin_trajectory(const TimedTrajectory& timed) noexcept {
  stage_ = Stage::trajectory;
  stage_s_ = 0.0;
  begun_s_ = trajectory_s_;
  pace_ = pace_along(timed, begun_s_, [this](std::uint32_t slot) {
    return plan_.axis[slot].rates.in_units(plan_.axis[slot].counts_per_unit);
  });
}

void TrajectoryFollower::advance(double time_s, double rate) noexcept {
  stage_s_ += time_s;
  rate_ = rate;
  const TimedTrajectory* timed = trajectory();
  if (stage_ == Stage::trajectory && timed != nullptr) {
    trajectory_s_ = at_end() ? timed->end_s() : begun_s_ + pace_.passed_s(stage_s_);
  }
}

bool TrajectoryFollower::at_end() const noexcept { return left_s() <= 0.0; }

double TrajectoryFollower::left_s() const noexcept {
  return (stage_ == Stage::trajectory ? pace_.duration_s() : planner_.duration_s()) - stage_s_;
}

bool TrajectoryFollower::go_on() noexcept {
  const TimedTrajectory* timed = trajectory();
  const bool left = stage_ == Stage::approach && timed != nullptr && trajectory_s_ < timed->end_s();
  if (left) {
    begin_trajectory(*timed);
  }
  return left;
}

double TrajectoryFollower::dwell_s() const noexcept {
  const auto* move = leg_ == nullptr ? nullptr : std::get_if<MoveLeg>(leg_);
  return move == nullptr ? 0.0 : move->dwell_s;
}

const TrajectoryFollower::Points& TrajectoryFollower::points() noexcept {
  const TimedTrajectory* timed = trajectory();
  if (stage_ == Stage::trajectory && timed != nullptr) {
    point_along_trajectory(*timed);
  } else {
    point_along_approach();
  }
  return points_;
}

// At the rate p a path with velocity v and acceleration a has the acceleration a p^2 + v p'.
TrajectoryFollower::RateChange TrajectoryFollower::rate_change() const noexcept {
  constexpr double at_once_per_s = 1e6;
  RateChange change{-at_once_per_s, at_once_per_s};
  const std::uint32_t moved = mask();
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    const MotionState& path = unscaled_[slot];
    if (((moved >> slot) & 1u) == 0 || path.velocity == 0.0) {
      continue;
    }
    const double speed = std::abs(path.velocity);
    const double limit = plan_.axis[slot].rates.in_units(plan_.axis[slot].counts_per_unit).acceleration;
    const double along = std::copysign(1.0, path.velocity) * path.acceleration * rate_ * rate_;
    change.least_per_s = std::max(change.least_per_s, std::min(0.0, (-limit - along) / speed));
    change.greatest_per_s = std::min(change.greatest_per_s, std::max(0.0, (limit - along) / speed));
  }
  return change;
}

/** As the clock sees it. */
Setpoint TrajectoryFollower::in_counts(const MotionState& state, std::uint32_t slot) noexcept {
  unscaled_[slot] = state;
  const double counts_per_unit = plan_.axis[slot].counts_per_unit;
  return {state.position * counts_per_unit, state.velocity * counts_per_unit * rate_,
          state.acceleration * counts_per_unit * rate_ * rate_};
}

void TrajectoryFollower::point_along_approach() noexcept {
  const auto ahead = planner_.at(stage_s_ + lease_s_);
  for (std::size_t place = 0; place < ahead.size(); ++place) {
    points_[slots_[place]].ahead_counts = ahead[place].position * plan_.axis[slots_[place]].counts_per_unit;
  }
  const auto now = planner_.at(stage_s_);
  for (std::size_t place = 0; place < now.size(); ++place) {
    points_[slots_[place]].now = in_counts(now[place], slots_[place]);
  }
}

void TrajectoryFollower::point_along_trajectory(const TimedTrajectory& timed) noexcept {
  const double pace = pace_.pace(stage_s_);
  const double pace_per_s = pace_.pace_per_s(stage_s_);
  const double ahead_s = begun_s_ + pace_.passed_s(stage_s_ + lease_s_);
  for (std::size_t axis = 0; axis < timed.axes().size(); ++axis) {
    const std::uint32_t slot = timed.axes()[axis].slot;
    const double counts_per_unit = plan_.axis[slot].counts_per_unit;
    const MotionState there = timed.at(axis, trajectory_s_);
    const MotionState now{there.position, pace * there.velocity,
                          pace * pace * there.acceleration + pace_per_s * there.velocity};
    points_[slot] = {in_counts(now, slot), timed.at(axis, ahead_s).position * counts_per_unit};
  }
}

}  // namespace interlock
