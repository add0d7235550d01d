#include "modes/biopsy/mode.hpp"

#include <algorithm>
#include <cmath>

#include "motion/realtime_channel.hpp"
#include "motion/setpoint_range.hpp"

namespace interlock {
namespace {

/** With the lease and two ticks of latency between a snapshot and its MOVE: 20 ms. */
constexpr double force_timeout_s = 0.008;
constexpr double longest_lease_s = 0.010;
/** How often the turning is planned anew (docs/steering.md). */
constexpr double steering_period_s = 0.005;
/** Of a sway of 0.2 mm at 10 Hz, and a little more. */
constexpr double fastest_sway_mm_s = 15.0;
/** A snapshot that comes later than this is heard as one that came so late. */
constexpr std::uint32_t most_missed_ticks = 20;

std::uint32_t ticks_of(double time_s, double period_s) noexcept {
  return std::max(1u, static_cast<std::uint32_t>(time_s / period_s));
}

std::uint32_t lease_ticks(const RobotPlan& plan) noexcept {
  return std::min(plan.lease_ticks(), ticks_of(longest_lease_s, plan.period_s()));
}

}  // namespace

void BiopsyMode::Guided::start(const ilk_snapshot_t& snapshot, std::uint32_t slot) noexcept {
  position = snapshot.state.axis[slot].position_counts / counts_per_unit;
  speed = 0.0;
  tracker.start(snapshot);
  aim(0.0, 0.0, 0.0);
}

void BiopsyMode::Guided::go(double desired, double time_s) noexcept {
  const RateLimits limits = rates.in_units(counts_per_unit);
  const double change = limits.acceleration * time_s;
  speed += std::clamp(std::clamp(desired, -limits.velocity, limits.velocity) - speed, -change, change);
  position += speed * time_s;
}

void BiopsyMode::Guided::aim(double offset, double offset_speed, double lease_s) noexcept {
  point.now = {(position + offset) * counts_per_unit, (speed + offset_speed) * counts_per_unit, 0.0};
  point.ahead_counts = point.now.position_counts + point.now.velocity_counts_per_s * lease_s;
}

BiopsyMode::BiopsyMode(const RobotPlan& plan)
    : HeldMode(typeid(BiopsyTask), plan),
      needle_(plan.needle),
      period_s_(plan.period_s()),
      force_timeout_ticks_(ticks_of(force_timeout_s, period_s_)),
      steering_ticks_(ticks_of(steering_period_s, period_s_)),
      lease_s_(lease_ticks(plan) * period_s_),
      force_(needle_ ? needle_->force : ForceInputs{}) {
  if (needle_) {
    const auto guided = [&](std::uint32_t slot) {
      const AxisPlan& axis = plan.axis[slot];
      return Guided{
          AxisTracker(slot, axis, lease_ticks(plan)), axis.rates, axis.counts_per_unit, 0.0, 0.0, {}};
    };
    insertion_ = guided(needle_->insertion_slot);
    rotation_ = guided(needle_->rotation_slot);
    const ilk_axis_config_t& rules = plan.axis[needle_->insertion_slot].rules;
    deepest_allowed_mm_ =
        (static_cast<double>(rules.max_counts) - rules.coast_counts) / insertion_.counts_per_unit;
  }
}

std::uint32_t BiopsyMode::prepare(std::uint32_t tick) noexcept {
  run_ = work<BiopsyTask>().run.get();
  findings_ = BiopsyFindings{};
  findings_.task = status().task;
  now_ = BiopsyNow{};
  command_ = SteeringCommand{};
  cue_mm_ = 0.0;
  steered_tick_ = run_->start_tick;
  if (!needle_) {
    end_all(TaskReason::no_path, tick);
    return 0;
  }
  return (1u << needle_->insertion_slot) | (1u << needle_->rotation_slot);
}

void BiopsyMode::see(const SeenImage& seen) noexcept {
  if (is_open() && seen.task == status().task) {
    // One of just now is of where the tip was followed to last: it has moved by a few hundredths of a
    // millimetre since at most.
    NeedleImage image = seen.image;
    image.time_s = std::min(image.time_s, (steered_tick_ - run_->start_tick) * period_s_);
    const bool taken = run_->compensator.see(image).has_value();
    now_.images += taken ? 1u : 0u;
    now_.images_refused += taken ? 0u : 1u;
  }
}

void BiopsyMode::tick(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  if (needle_) {
    force_.look(snapshot);
    HeldMode::tick(snapshot, requests);
    if (is_open() && !executes()) {
      // Images are taken while the needle rests.
      (void)plan_steering(snapshot);
    }
  }
}

void BiopsyMode::drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  for (Guided* axis : {&insertion_, &rotation_}) {
    if (executes()) {
      axis->tracker.hold(status().task, snapshot, axis->point, requests);
    } else {
      axis->tracker.let_go(status().task, snapshot, requests);
    }
  }
}

std::optional<Setpoint> BiopsyMode::setpoint(std::uint32_t slot) const noexcept {
  if (!executes() || !moves(slot)) {
    return std::nullopt;
  }
  return (slot == needle_->insertion_slot ? insertion_ : rotation_).point.now;
}

/** From the start, or on after a pause: from where the axes are, at rest. */
void BiopsyMode::begin(const ilk_snapshot_t& snapshot) noexcept {
  insertion_.start(snapshot, needle_->insertion_slot);
  rotation_.start(snapshot, needle_->rotation_slot);
  seen_tick_ = snapshot.state.system.tick;
  cue_mm_ = 0.0;
  let_go_ = false;
}

void BiopsyMode::go_on(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t tick = snapshot.state.system.tick;
  const std::uint32_t ticks = std::min(tick - seen_tick_, most_missed_ticks);
  const double time_s = ticks * period_s_;
  seen_tick_ = tick;
  if (force_.readings().age_ticks(tick) > force_timeout_ticks_) {
    fail(TaskReason::force_stale, 0, needle_->force.slot, tick);
    return;
  }
  if (!plan_steering(snapshot) || !push(snapshot, time_s) || !listen(snapshot, ticks)) {
    return;
  }
  rotation_.go(insertion_.speed > 0.0 ? command_.rotation_rad_s : 0.0, time_s);
  rotation_.aim(0.0, 0.0, lease_s_);
  for (const auto& [axis, slot] :
       {std::pair{&insertion_, needle_->insertion_slot}, std::pair{&rotation_, needle_->rotation_slot}}) {
    if (axis->tracker.off_path(snapshot, axis->point)) {
      fail(TaskReason::off_path, 0, slot, tick);
      return;
    }
  }
  if (command_.arrived) {
    finish(TaskReason::arrived, tick);
  }
}

bool BiopsyMode::plan_steering(const ilk_snapshot_t& snapshot) noexcept {
  const std::uint32_t tick = snapshot.state.system.tick;
  if (tick - steered_tick_ < steering_ticks_) {
    return true;
  }
  steered_tick_ = tick;
  const double rotation_rad =
      snapshot.state.axis[needle_->rotation_slot].position_counts / rotation_.counts_per_unit;
  const auto planned = run_->compensator.step(
      {(tick - run_->start_tick) * period_s_, std::max(0.0, depth_mm(snapshot)), rotation_rad});
  if (!planned) {
    return fails(planned.error(), tick);
  }
  command_ = *planned;
  now_.desired_rotation_rad = command_.desired_rotation_rad;
  now_.alpha = command_.alpha;
  now_.curvature_per_mm = run_->compensator.tip().curvature_per_mm;
  now_.expected_miss_mm = command_.expected_miss_mm;
  now_.reachable = command_.reachable;
  now_.tip_sd_mm = run_->compensator.tip().position_sd_mm;
  now_.images_disagree = run_->compensator.images_disagree();
  return true;
}

/** The hand's force makes the speed; never past the target's depth, nor past what the axis may. */
bool BiopsyMode::push(const ilk_snapshot_t& snapshot, double time_s) noexcept {
  const double end_mm = std::min(command_.insertion_setpoint_mm + run_->entry_mm, deepest_allowed_mm_);
  const double left_mm = std::max(0.0, end_mm - insertion_.position);
  now_.left_mm = left_mm;
  const auto desired = run_->hand.force_n(force_.readings().hand).and_then([&](double force_n) {
    const bool rests = std::abs(force_n) <= run_->hand_law.deadband_n;
    let_go_ = (let_go_ || rests) && !now_.images_disagree;
    now_.waits_for_hand = !let_go_;
    return cooperative_speed(run_->hand_law, force_n, let_go_, left_mm);
  });
  if (!desired) {
    return fails(desired.error(), snapshot.state.system.tick);
  }
  const bool waits = insertion_held_ && *desired > 0.0;
  wait_for(waits ? TaskReason::breathing : TaskReason::none);
  const double before_mm = insertion_.position;
  insertion_.go(waits ? 0.0 : *desired, time_s);
  insertion_.position = std::min(insertion_.position, std::max(before_mm, end_mm));
  return true;
}

bool BiopsyMode::listen(const ilk_snapshot_t& snapshot, std::uint32_t ticks) noexcept {
  const std::uint32_t tick = snapshot.state.system.tick;
  now_.depth_mm = depth_mm(snapshot);
  now_.speed_mm_s = insertion_.speed;
  const auto force_n = run_->needle.force_n(force_.readings().needle);
  if (!force_n) {
    return fails(force_n.error(), tick);
  }
  MembraneState heard;
  // One sample a period, those that this thread missed included: the detector counts its time by them.
  for (std::uint32_t n = 0; n < ticks; ++n) {
    const auto state = run_->detector.step({*force_n, now_.depth_mm, insertion_.speed});
    if (!state) {
      return fails(state.error(), tick);
    }
    heard = *state;
  }
  const auto records = run_->detector.records();
  findings_.membranes = static_cast<std::uint32_t>(records.size());
  for (std::size_t membrane = 0; membrane < records.size(); ++membrane) {
    findings_.found_mm[membrane] = records[membrane].value_or(-1.0);
  }
  const double before_mm = cue_mm_;
  // A needle that has to stand does not sway either; it joins the sway again without a leap.
  const double wanted_mm = insertion_held_ || now_.images_disagree ? cue_mm_ : heard.cue_offset_mm;
  const double most_mm = fastest_sway_mm_s * ticks * period_s_;
  cue_mm_ += std::clamp(wanted_mm - cue_mm_, -most_mm, most_mm);
  now_.armed = heard.armed;
  now_.rough = heard.rough;
  now_.cue = heard.cue_offset_mm != 0.0;
  insertion_.aim(cue_mm_, ticks == 0 ? 0.0 : (cue_mm_ - before_mm) / (ticks * period_s_), lease_s_);
  return true;
}

/** Ends the task; false, for whoever called. */
bool BiopsyMode::fails(const KinematicsError& error, std::uint32_t tick) noexcept {
  findings_.quantity = error.quantity;
  fail(TaskReason::steering_failed, static_cast<std::uint32_t>(error.code), needle_->insertion_slot, tick);
  return false;
}

double BiopsyMode::depth_mm(const ilk_snapshot_t& snapshot) const noexcept {
  return snapshot.state.axis[needle_->insertion_slot].position_counts / insertion_.counts_per_unit -
         run_->entry_mm;
}

void BiopsyMode::report(ControlView& view) const noexcept {
  HeldMode::report(view);
  view.biopsy = findings_;
  view.biopsy_now = now_;
  view.force = force_.readings();
}

void BiopsyMode::on_unsent(const KernelRequest& request) noexcept {
  if (needle_ && request.origin.task == status().task) {
    if (request.origin.slot == needle_->insertion_slot) {
      insertion_.tracker.on_unsent();
    } else if (request.origin.slot == needle_->rotation_slot) {
      rotation_.tracker.on_unsent();
    }
  }
}

}  // namespace interlock
