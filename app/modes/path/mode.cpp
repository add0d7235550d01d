#include "modes/path/mode.hpp"

#include <algorithm>

namespace interlock {
namespace {

/** For axes that lag behind the end of their path; the slowest settling seen on the plant takes a tenth. Also
 * for the time of a path that an axis holds up. */
constexpr double settle_s = 5.0;

/** Shares of the following error: up to the first an axis is behind its path as axes are, at the second the
 * path waits for it. */
constexpr double usual_lag = 0.25;
constexpr double longest_lag = 0.75;
/** Within which the time of the path follows the axis that is farthest behind: fast enough for a motor that
 * gives up at full speed, and back so slowly that a count more or less does not shake the others. */
constexpr double slowing_s = 0.015;
constexpr double recovering_s = 0.1;
/** After a pause an axis coasts for less. */
constexpr double coast_s = 0.2;
/** Below it the time of the path stands. */
constexpr double least_rate = 0.02;

}  // namespace

PathMode::PathMode(const RobotPlan& plan)
    : HeldMode(typeid(PathTask), plan),
      period_s_(plan.period_s()),
      settle_ticks_(static_cast<std::uint32_t>(settle_s / plan.period_s())),
      coast_ticks_(static_cast<std::uint32_t>(coast_s / plan.period_s())),
      insertion_slot_(plan.insertion_slot),
      walk_(plan) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    deadband_counts_[slot] = plan.axis[slot].rules.deadband_counts;
    trackers_[slot] = AxisTracker(slot, plan.axis[slot], plan.lease_ticks());
  }
}

std::uint32_t PathMode::prepare(std::uint32_t tick) noexcept {
  if (program().legs.empty()) {
    finish(TaskReason::arrived, tick);
  } else {
    walk_.take(program().legs.front());
  }
  return program().mask();
}

void PathMode::drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  driven_tick_ = executes() ? now : driven_tick_;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS && now - driven_tick_ <= coast_ticks_; ++slot) {
    left_[slot] = snapshot.state.axis[slot].position_counts;
  }
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (follows(slot)) {
      trackers_[slot].hold(status().task, snapshot, points_[slot], requests);
    } else {
      trackers_[slot].let_go(status().task, snapshot, requests);
    }
  }
}

std::optional<Setpoint> PathMode::setpoint(std::uint32_t slot) const noexcept {
  return slot < ILK_SLOTS && follows(slot) ? std::optional(points_[slot].now) : std::nullopt;
}

/** Begins the leg, or goes on with it after a pause. */
void PathMode::begin(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  take_up_again(snapshot);
  for (std::size_t leg = status().step; leg < program().legs.size(); ++leg) {
    let_move(mask_of(program().legs[leg]));
  }
  std::array<double, ILK_SLOTS> velocities{};
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    velocities[slot] = trackers_[slot].velocity_counts_per_s();
  }
  if (!walk_.begin(snapshot, velocities)) {
    end_all(TaskReason::no_path, now);
    return;
  }
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    trackers_[slot].start(snapshot);
  }
  points_ = walk_.points();
  lag_rate_ = 1.0;
  breath_rate_ = 1.0;
  alive_tick_ = now;
  seen_tick_ = now;
  end_tick_ = now;
  resting_ = false;
}

/** A push upwards in a pause carries the tool along, and the way back down from there opens its play: the leg
 * that took it up is made again. */
void PathMode::take_up_again(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t before = status().step == 0 ? 0 : status().step - 1;
  const auto* below = std::get_if<MoveLeg>(&program().legs[before]);
  if (below == nullptr || !below->takes_up_play || before == status().step) {
    return;
  }
  const bool is_pushed = std::ranges::any_of(below->targets, [&](const AxisCounts& target) {
    const ilk_axis_t& axis = snapshot.state.axis[target.slot];
    return axis.position_counts - left_[target.slot] >
           static_cast<std::int32_t>(deadband_counts_[target.slot]);
  });
  if (is_pushed) {
    set_step(before);
    walk_.take(program().legs[before]);
  }
}

void PathMode::go_on(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  const bool was_at_end = walk_.at_end();
  advance(snapshot);
  if (strays(snapshot)) {
    return;
  }
  if (!was_at_end) {
    end_tick_ = now;
  } else {
    settle(snapshot);
  }
}

/** Whether what comes next leads the insertion deeper while it may not advance. */
bool PathMode::waits_for_breath() const noexcept {
  return insertion_held_ && insertion_slot_ && leg_moves(*insertion_slot_) &&
         points_[*insertion_slot_].ahead_counts > points_[*insertion_slot_].now.position_counts;
}

/** The time of the path passes as fast as the axis allows that is farthest behind, and stands while the
 * insertion may not advance: it slows down to that, and comes up again, within the axes' accelerations. */
void PathMode::advance(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  const double passed_s = (now - seen_tick_) * period_s_;
  double lag = 0.0;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (const double its = leg_moves(slot) ? trackers_[slot].lag(snapshot, points_[slot]) : 0.0; its > lag) {
      lag = its;
      slowest_ = slot;
    }
  }
  const double allowed = std::clamp((longest_lag - lag) / (longest_lag - usual_lag), 0.0, 1.0);
  const double share = std::min(1.0, passed_s / (allowed < lag_rate_ ? slowing_s : recovering_s));
  lag_rate_ += (allowed - lag_rate_) * share;
  const bool waits = waits_for_breath();
  const auto change = walk_.rate_change();
  breath_rate_ = waits ? std::max(0.0, std::min(breath_rate_, lag_rate_) + change.least_per_s * passed_s)
                       : std::min(1.0, breath_rate_ + change.greatest_per_s * passed_s);
  const double rate = std::min(lag_rate_, breath_rate_);
  walk_.advance(passed_s * rate, rate);
  points_ = walk_.points();
  wait_for(waits ? TaskReason::breathing : TaskReason::none);
  seen_tick_ = now;
  alive_tick_ = waits || rate > least_rate || walk_.at_end() ? now : alive_tick_;
}

bool PathMode::strays(const ilk_snapshot_t& snapshot) noexcept {
  if (snapshot.state.system.tick - alive_tick_ > settle_ticks_) {
    fail(TaskReason::off_path, 0, slowest_, snapshot.state.system.tick);
    return true;
  }
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (leg_moves(slot) && trackers_[slot].off_path(snapshot, points_[slot])) {
      fail(TaskReason::off_path, 0, slot, snapshot.state.system.tick);
      return true;
    }
  }
  return false;
}

/** At the end of the path: all axes come to rest, and rest for as long as the leg says. */
void PathMode::settle(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  std::uint32_t late = ILK_SLOTS;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    AxisTracker& tracker = trackers_[slot];
    const bool is_there =
        resting_ ? tracker.stays(snapshot, points_[slot]) : tracker.arrived(snapshot, points_[slot]);
    if (leg_moves(slot) && !is_there) {
      late = slot;
    }
  }
  if (late != ILK_SLOTS) {
    resting_ = false;
    if (now - end_tick_ > settle_ticks_) {
      fail(TaskReason::goal_late, snapshot.gate[late], late, now);
    }
    return;
  }
  if (!resting_) {
    resting_ = true;
    rest_tick_ = now;
  }
  end_tick_ = now;
  if ((now - rest_tick_) * period_s_ >= walk_.dwell_s()) {
    end_leg(snapshot);
  }
}

void PathMode::end_leg(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  resting_ = false;
  end_tick_ = now;
  if (walk_.go_on()) {
    return;
  }
  if (status().step + 1 == program().legs.size()) {
    finish(TaskReason::arrived, now);
    return;
  }
  set_step(status().step + 1);
  const PathLeg& next = program().legs[status().step];
  walk_.take(next);
  if (const auto* move = std::get_if<MoveLeg>(&next); move != nullptr && move->needs_confirmation) {
    await_confirmation(snapshot);
  } else {
    begin(snapshot);
  }
}

void PathMode::on_unsent(const KernelRequest& request) noexcept {
  if (request.origin.slot < ILK_SLOTS && request.origin.task == status().task) {
    trackers_[request.origin.slot].on_unsent();
  }
}

}  // namespace interlock
