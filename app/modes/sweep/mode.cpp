#include "modes/sweep/mode.hpp"

#include <cmath>

#include "control/frequency_map.hpp"
#include "motion/realtime_channel.hpp"
#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

/** Twenty lags of the motor on the plant: then its speed is that of the frequency. */
constexpr double motor_settle_s = 0.1;

}  // namespace

SweepMode::SweepMode(const RobotPlan& plan)
    : HeldMode(typeid(SweepTask), plan),
      plan_(plan),
      settle_ticks_(static_cast<std::uint32_t>(motor_settle_s / plan.period_s())) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    leases_[slot] = SetpointLease(slot, plan.axis[slot], plan.lease_ticks());
  }
}

std::uint32_t SweepMode::prepare(std::uint32_t /*tick*/) noexcept {
  sweep_ = work<SweepTask>();
  speeds_ = {};
  upwards_ = true;
  turning_ = false;
  driven_ticks_ = 0;
  measured_ticks_ = 0;
  measured_counts_ = 0.0;
  return 1u << sweep_.slot;
}

void SweepMode::drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  const bool drives = executes() && !turning_;
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (drives && slot == sweep_.slot) {
      const std::uint32_t drive = frequency_map::drive_at(sweep_.steps.word(status().step));
      leases_[slot].hold(status().task, snapshot.state.system.tick, target_counts(snapshot), drive, requests);
    } else {
      leases_[slot].let_go(status().task, snapshot, requests);
    }
  }
}

/** From the start, or where the pedal was released: the way that the axis went is not ended by a pause. */
void SweepMode::begin(const ilk_snapshot_t& snapshot) noexcept {
  seen_tick_ = snapshot.state.system.tick;
  seen_counts_ = snapshot.state.axis[sweep_.slot].position_counts;
  steady_ticks_ = 0;
  leases_[sweep_.slot].renew_at_once();
}

void SweepMode::go_on(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t now = snapshot.state.system.tick;
  const ilk_axis_t& axis = snapshot.state.axis[sweep_.slot];
  const ilk_axis_config_t& rules = plan_.axis[sweep_.slot].rules;
  if (turning_) {
    if (rest_.rests(axis.position_counts, rules.noise_counts, now)) {
      turning_ = false;
      upwards_ = !upwards_;
      begin(snapshot);
    }
    return;
  }
  measure(axis, now - seen_tick_);
  seen_tick_ = now;
  seen_counts_ = axis.position_counts;
  if (driven_ticks_ >= sweep_.steps.dwell_ticks) {
    end_step(now);
  }
  if (is_open() && distance(axis.position_counts, target_counts(snapshot)) <= rules.coast_counts) {
    turning_ = true;
    rest_.restart(axis.position_counts, now);
  }
}

void SweepMode::measure(const ilk_axis_t& axis, std::uint32_t ticks) noexcept {
  driven_ticks_ += ticks;
  if (steady_ticks_ >= settle_ticks_) {
    measured_ticks_ += ticks;
    measured_counts_ += static_cast<double>(distance(axis.position_counts, seen_counts_));
  }
  steady_ticks_ += ticks;
}

void SweepMode::end_step(std::uint32_t tick) noexcept {
  if (measured_ticks_ != 0) {
    speeds_[status().step] = static_cast<float>(measured_counts_ / (measured_ticks_ * plan_.period_s()));
  }
  driven_ticks_ = 0;
  steady_ticks_ = 0;
  measured_ticks_ = 0;
  measured_counts_ = 0.0;
  set_step(status().step + 1);
  if (status().step == sweep_.steps.count) {
    finish(TaskReason::swept, tick);
  }
}

std::int32_t SweepMode::target_counts(const ilk_snapshot_t& snapshot) const noexcept {
  const SetpointRange range = setpoint_range(plan_.axis[sweep_.slot].rules, snapshot.state.axis[sweep_.slot],
                                             snapshot.state.system.mode);
  return upwards_ ? range.highest_counts : range.lowest_counts;
}

void SweepMode::report(ControlView& view) const noexcept {
  HeldMode::report(view);
  view.sweep_speeds = speeds_;
}

void SweepMode::on_unsent(const KernelRequest& request) noexcept {
  if (request.origin.task == status().task && request.origin.slot < ILK_SLOTS) {
    leases_[request.origin.slot].on_unsent();
  }
}

}  // namespace interlock
