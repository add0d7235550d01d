#include "tuning/step_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>

#include "trajectory/trapezoid_profile.hpp"

namespace interlock {
namespace {

/** 833 counts a second of an axis that makes 1000: the thesis' yaw, a count every 1200 us. */
constexpr double cruise_share = 5.0 / 6.0;
constexpr double move_s = 0.6;
constexpr double floor_share = 0.05;
/** Full speed within a tenth of a second at the fastest: only short moves meet this limit. */
constexpr double full_speed_rise_s = 0.1;
/** Readings before the start, from which the velocity is known at the start. */
constexpr double observed_s = 0.05;

/** The move of a run: everything that is fixed before the first tick. */
struct Plan {
  std::int32_t target_counts;
  TrapezoidProfile profile;
  AxisController controller;
  std::deque<std::uint32_t> drives_on_their_way; /**< oldest first: one for each tick of lateness */
};

std::string reachable(const Axis& axis) {
  return std::to_string(axis.lowest_setpoint_counts()) + " to " +
         std::to_string(axis.highest_setpoint_counts());
}

Gains tried(const Gains& file, const AskedGains& asked) {
  return {.position_per_s = asked.position_per_s.value_or(file.position_per_s),
          .velocity = asked.velocity.value_or(file.velocity),
          .integral_per_s = asked.integral_per_s.value_or(file.integral_per_s)};
}

RigResult<Plan> plan(const Axis& axis, std::uint32_t period_us, const StepOptions& options, double full_speed,
                     std::int32_t from_counts) {
  const std::int64_t target =
      std::int64_t{from_counts} + options.move_counts.value_or(default_move(axis, from_counts, full_speed));
  if (target < axis.lowest_setpoint_counts() || target > axis.highest_setpoint_counts()) {
    return tl::unexpected("the move ends at " + std::to_string(target) + " counts; " + axis.name +
                          " reaches " + reachable(axis));
  }
  const double cruise = options.cruise_counts_per_s.value_or(cruise_share * full_speed);
  const TrapezoidRules rules{.cruise_velocity = cruise,
                             .max_acceleration = full_speed / full_speed_rise_s,
                             .floor_velocity = floor_share * cruise};
  const auto profile = TrapezoidProfile::create(from_counts, static_cast<double>(target), rules);
  if (!profile) {
    return tl::unexpected(profile.error().message());
  }
  if (profile->duration_s() > longest_profile_s) {
    return tl::unexpected("the move would take " + number_text(profile->duration_s()) +
                          " s; expected at most " + number_text(longest_profile_s));
  }
  AxisControlRules rules_of_axis = control_rules(axis, period_us, full_speed);
  rules_of_axis.piv.gains = tried(axis.gains, options.gains);
  const auto controller = AxisController::create(rules_of_axis);
  if (!controller) {
    return tl::unexpected(controller.error().message());
  }
  return Plan{static_cast<std::int32_t>(target), *profile, *controller,
              std::deque<std::uint32_t>(options.late_ticks, 0)};
}

Setpoint setpoint_at(const TrapezoidProfile& profile, double time_s) {
  const MotionState state = profile.at(time_s);
  return {state.position, state.velocity, state.acceleration};
}

/** Of the readings' frame from the plant's, for an axis at rest: a reading is the count below the position.
 */
double frame_offset(const StepRig& rig) {
  return rig.axis().position_counts - std::floor(rig.true_position_counts());
}

/** One tick of the move: reading, control, request. */
RigResult<StepRow> follow(StepRig& rig, Plan& move, double offset_counts, double time_s) {
  StepRow row;
  row.time_s = time_s;
  row.true_position_counts = rig.true_position_counts() + offset_counts;
  row.true_velocity_counts_per_s = rig.true_speed_counts_per_s();
  if (const RigResult<void> ticked = rig.tick(); !ticked) {
    return tl::unexpected(ticked.error() + ", " + std::to_string(time_s) + " s after the start");
  }
  row.position_counts = rig.axis().position_counts;
  row.setpoint = setpoint_at(move.profile, time_s);
  const AxisOutput output =
      move.controller.update(rig.axis(), rig.tick_count(), row.setpoint, move.target_counts);
  if (output.error) {
    return tl::unexpected(output.error->message());
  }
  if (output.velocity) {
    row.estimated_velocity_counts_per_s = output.velocity->counts_per_s;
  }
  row.drive = output.drive;
  move.drives_on_their_way.push_back(output.drive);
  rig.move(move.target_counts, move.drives_on_their_way.front());
  move.drives_on_their_way.pop_front();
  return row;
}

RigResult<void> observe(StepRig& rig, Plan& move, std::size_t ticks) {
  for (std::size_t n = 0; n < ticks; ++n) {
    if (RigResult<void> ticked = rig.tick(); !ticked) {
      return ticked;
    }
    move.controller.observe(rig.axis(), rig.tick_count());
  }
  return {};
}

}  // namespace

std::int32_t default_move(const Axis& axis, std::int32_t from_counts, double full_speed_counts_per_s) {
  const bool up = axis.limit != ILK_LIMIT_UPPER;
  const std::int32_t end = up ? axis.highest_setpoint_counts() : axis.lowest_setpoint_counts();
  const double way = (static_cast<double>(end) - from_counts) / 2;
  const double longest = move_s * full_speed_counts_per_s;
  return static_cast<std::int32_t>(std::clamp(way, -longest, longest));
}

RigResult<StepRun> run_step(const Robot& robot, const ilk_config_t& config,
                            const plant::Parameters& parameters, const StepOptions& options) {
  const Axis* const axis = robot.find(options.axis);
  if (axis == nullptr) {
    return tl::unexpected(robot.name + " has no axis \"" + options.axis + "\"");
  }
  const double full_speed = options.full_speed_counts_per_s.value_or(
      mapped_full_speed(*axis).value_or(parameters.axis[axis->slot].full_speed_counts_per_s));
  StepRig rig(config, parameters, options.seed, axis->slot);
  if (const RigResult<void> ready = rig.make_ready(); !ready) {
    return tl::unexpected(ready.error() + ", before the move");
  }
  const std::int32_t from_counts = rig.axis().position_counts;
  RigResult<Plan> move = plan(*axis, config.common.period_us, options, full_speed, from_counts);
  if (!move) {
    return tl::unexpected(move.error());
  }
  const double period_s = config.common.period_us * 1e-6;
  if (const auto observed = observe(rig, *move, static_cast<std::size_t>(observed_s / period_s)); !observed) {
    return tl::unexpected(observed.error());
  }
  const double offset_counts = frame_offset(rig);
  StepRun run{.axis = axis->name,
              .from_counts = from_counts,
              .target_counts = move->target_counts,
              .deadband_counts = axis->deadband_counts,
              .max_drive = axis->drive.max,
              .period_s = period_s,
              .peak_counts_per_s = move->profile.peak_velocity(),
              .duration_s = move->profile.duration_s(),
              .rows = {}};
  const auto ticks = static_cast<std::size_t>((run.duration_s + after_profile_s) / period_s);
  run.rows.reserve(ticks);
  for (std::size_t n = 0; n < ticks; ++n) {
    const RigResult<StepRow> row = follow(rig, *move, offset_counts, static_cast<double>(n) * period_s);
    if (!row) {
      return tl::unexpected(row.error());
    }
    run.rows.push_back(*row);
  }
  return run;
}

}  // namespace interlock
