#include <algorithm>
#include <cmath>

#include "robot/readers.hpp"

namespace interlock {
namespace {

constexpr std::array<std::pair<std::string_view, ilk_card_t>, 5> cards{{
    {"pwm", ILK_CARD_PWM},
    {"non-pwm", ILK_CARD_NON_PWM},
    {"analog-input", ILK_CARD_ANALOG},
    {"high-frequency", ILK_CARD_HIGH_FREQUENCY},
    {"unspecified", ILK_CARD_NONE},
}};

constexpr std::array<std::pair<std::string_view, Motor>, 4> motors{{
    {"shinsei", Motor::shinsei},
    {"piezo", Motor::piezo},
    {"dti", Motor::dti},
    {"unspecified", Motor::unspecified},
}};

constexpr std::array<std::pair<std::string_view, Unit>, 2> units{{{"mm", Unit::mm}, {"rad", Unit::rad}}};

constexpr std::array<std::pair<std::string_view, ilk_limit_side_t>, 3> limit_sides{{
    {"none", ILK_LIMIT_NONE},
    {"lower", ILK_LIMIT_LOWER},
    {"upper", ILK_LIMIT_UPPER},
}};

SoftLimits read_soft_limits(TableReader table) {
  SoftLimits limits;
  constexpr std::int64_t farthest = std::int64_t{1} << 30;
  limits.min_counts = static_cast<std::int32_t>(table.integer_between("min_counts", -farthest, farthest));
  limits.max_counts = static_cast<std::int32_t>(table.integer_between("max_counts", -farthest, farthest));
  table.refuse_unknown_keys();
  return limits;
}

DriveBounds read_drive(TableReader table, bool has_amplitude) {
  DriveBounds drive;
  drive.max = table.integer<std::uint32_t>("max");
  drive.min = static_cast<std::uint32_t>(table.integer_between("min", 0, drive.max));
  drive.dead_zone = static_cast<std::uint32_t>(table.integer_between("dead_zone", 0, drive.max));
  drive.unhomed_max = table.integer<std::uint32_t>("unhomed_max");
  if (has_amplitude) {
    drive.max_amplitude = table.integer<std::uint32_t>("max_amplitude");
    if (table.has("resonance_hz")) {
      constexpr double most_hz = 1000.0;
      drive.resonance_hz = table.number_between("resonance_hz", -most_hz, most_hz);
    }
  }
  table.refuse_unknown_keys();
  return drive;
}

Gains read_gains(TableReader table) {
  constexpr double largest = 1e4;
  Gains gains;
  gains.position_per_s = table.number_between("position_per_s", 0.0, largest);
  gains.velocity = table.number_between("velocity", 0.0, largest);
  gains.integral_per_s = table.number_between("integral_per_s", 0.0, largest);
  table.refuse_unknown_keys();
  return gains;
}

Mechanics read_mechanics(TableReader table, std::uint32_t period_us) {
  Mechanics mechanics;
  mechanics.coast_counts = table.integer<std::uint32_t>("coast_counts");
  mechanics.backlash_counts = table.integer<std::uint32_t>("backlash_counts");
  mechanics.noise_counts = table.integer<std::uint32_t>("noise_counts");
  mechanics.max_delta_counts = table.integer<std::uint32_t>("max_delta_counts");
  mechanics.rest_ticks = table.ticks("rest_ms", period_us);
  mechanics.full_speed_counts_per_s = table.integer<std::uint32_t>("full_speed_counts_per_s");
  if (table.has("tool_play_counts")) {
    constexpr std::int64_t most = 10000;
    mechanics.tool_play_counts =
        static_cast<std::uint32_t>(table.integer_between("tool_play_counts", 0, most));
  }
  table.refuse_unknown_keys();
  return mechanics;
}

StallRule read_stall(TableReader table, std::uint32_t period_us) {
  StallRule stall;
  stall.driven_ticks = table.ticks("driven_ms", period_us);
  stall.effort_ticks = table.has("effort_ms") ? table.ticks("effort_ms", period_us) : 0;
  stall.min_counts = table.integer<std::uint32_t>("min_counts");
  table.refuse_unknown_keys();
  return stall;
}

RunawayRule read_runaway(TableReader table) {
  RunawayRule runaway;
  runaway.reverse_counts = table.integer<std::uint32_t>("reverse_counts");
  runaway.drift_counts = table.integer<std::uint32_t>("drift_counts");
  table.refuse_unknown_keys();
  return runaway;
}

Homing read_homing(TableReader table, std::uint32_t period_us, bool has_amplitude) {
  Homing homing;
  homing.drive = table.integer<std::uint32_t>("drive");
  if (has_amplitude) {
    homing.amplitude = static_cast<std::uint32_t>(table.integer_between("amplitude", 1, 255));
  }
  homing.slow_drive = table.integer<std::uint32_t>("slow_drive");
  homing.speed_counts_per_s = table.integer<std::uint32_t>("speed_counts_per_s");
  homing.slow_speed_counts_per_s = table.integer<std::uint32_t>("slow_speed_counts_per_s");
  homing.travel_counts = table.integer<std::uint32_t>("travel_counts");
  homing.clear_counts = table.integer<std::uint32_t>("clear_counts");
  homing.tolerance_counts = table.integer<std::uint32_t>("tolerance_counts");
  homing.hysteresis_counts = table.integer<std::uint32_t>("hysteresis_counts");
  homing.timeout_ticks = table.ticks("timeout_ms", period_us);
  table.refuse_unknown_keys();
  return homing;
}

/** Refuses a scale that takes the soft limits beyond where motion is planned. */
void refuse_far_limits(TableReader& table, const Axis& axis) {
  const auto& [lowest, highest] = axis.soft_limits;
  const double farthest =
      std::max(std::abs(static_cast<double>(lowest)), std::abs(static_cast<double>(highest)));
  if (farthest > position_limit * axis.counts_per_unit) {
    table.refuse_given("counts_per_unit", "the soft limits lie farther than 1e6 mm or rad from zero",
                       "at least " + text_of(farthest / position_limit));
  }
}

std::optional<Homing> read_optional_homing(TableReader& table, const Axis& axis, std::uint32_t period_us) {
  if (axis.limit != ILK_LIMIT_NONE) {
    return read_homing(table.table("homing"), period_us, axis.card == ILK_CARD_HIGH_FREQUENCY);
  }
  if (table.has("homing")) {
    table.refuse("homing", "the axis has no switch to home at",
                 "no homing table, or limit = \"lower\" or \"upper\"");
  }
  return std::nullopt;
}

double read_rate(TableReader& table, std::string_view key, const std::string& unit, double counts_per_unit) {
  const double lowest = smallest_rate * counts_per_unit;
  const double highest = std::min(largest_rate * counts_per_unit, 1e9);
  const double rate = table.number(key);
  if (!(rate >= lowest && rate <= highest)) {
    table.refuse_given(
        key, "no motion is planned with that rate",
        text_of(lowest) + " to " + text_of(highest) + ": 1e-6 to 1e6 " + unit + ", and 1e9 counts at most");
    return 1.0;
  }
  return rate;
}

/** Refuses limits that are reached at once, for which Ruckig does not always find a plan, and plans too long.
 */
void refuse_unplannable(TableReader& table, const MotionRates& motion, const SoftLimits& limits) {
  const double velocity = motion.velocity_counts_per_s;
  const double acceleration = motion.acceleration_counts_per_s2;
  const double jerk = motion.jerk_counts_per_s3;
  const double range = static_cast<double>(limits.max_counts) - limits.min_counts;
  // From rest to the velocity: with a time at the largest acceleration, or too short for one.
  const bool accelerates_fully = velocity * jerk >= acceleration * acceleration;
  const double ramp_s =
      accelerates_fully ? velocity / acceleration + acceleration / jerk : 2 * std::sqrt(velocity / jerk);
  const double cruise_s = range / velocity;
  if (cruise_s + 2 * ramp_s > longest_plan_s) {
    const bool slow_ramp = accelerates_fully && velocity / acceleration > acceleration / jerk;
    table.refuse_given(cruise_s > 2 * ramp_s ? "velocity_counts_per_s"
                       : slow_ramp           ? "acceleration_counts_per_s2"
                                             : "jerk_counts_per_s3",
                       "the whole range takes " + text_of(cruise_s + 2 * ramp_s) + " s",
                       "rates with which it takes " + text_of(longest_plan_s) + " s at most");
  }
  if (velocity < shortest_ramp_s * acceleration) {
    table.refuse_given("acceleration_counts_per_s2", "it reaches velocity_counts_per_s in less than 1 ms",
                       "at most " + text_of(velocity / shortest_ramp_s));
  }
  if (acceleration < shortest_ramp_s * jerk) {
    table.refuse_given("jerk_counts_per_s3", "it reaches acceleration_counts_per_s2 in less than 1 ms",
                       "at most " + text_of(acceleration / shortest_ramp_s));
  }
}

MotionRates read_motion(TableReader table, const Axis& axis) {
  const std::string unit(unit_name(axis.unit));
  MotionRates motion;
  motion.velocity_counts_per_s = read_rate(table, "velocity_counts_per_s", unit + "/s", axis.counts_per_unit);
  motion.acceleration_counts_per_s2 =
      read_rate(table, "acceleration_counts_per_s2", unit + "/s^2", axis.counts_per_unit);
  motion.jerk_counts_per_s3 = read_rate(table, "jerk_counts_per_s3", unit + "/s^3", axis.counts_per_unit);
  motion.following_error_counts = table.integer<std::uint32_t>("following_error_counts");
  if (motion.velocity_counts_per_s > axis.mechanics.full_speed_counts_per_s) {
    table.refuse_given("velocity_counts_per_s", "the axis cannot go that fast",
                       "mechanics.full_speed_counts_per_s at most, better less");
  }
  refuse_unplannable(table, motion, axis.soft_limits);
  table.refuse_unknown_keys();
  return motion;
}

}  // namespace

Axis read_axis(TableReader table, const Robot& robot) {
  Axis axis;
  axis.name = table.identifier("name");
  table.rename("axis." + axis.name);
  axis.slot = static_cast<std::uint32_t>(table.integer_between("slot", 0, ILK_SLOTS - 1));
  refuse_twins(table, robot, axis.name, axis.slot);
  axis.title = table.text("title");
  axis.card = table.choice("card", cards);
  axis.required = table.has("required") && table.boolean("required");
  axis.motor = table.choice("motor", motors);
  axis.encoder_resolution =
      static_cast<std::uint32_t>(table.integer_between("encoder_resolution", 1, 1'000'000'000));
  axis.unit = table.choice("unit", units);
  axis.role = read_role(table, robot, axis.name, axis.unit);
  axis.counts_per_unit = table.number_between("counts_per_unit", 1e-9, 1e9);
  axis.motor_direction = static_cast<std::uint32_t>(table.integer_between("motor_direction", 0, 1));
  axis.direction_correction = static_cast<std::uint32_t>(table.integer_between("direction_correction", 0, 1));
  axis.limit = table.choice("limit", limit_sides);
  axis.home_offset_counts = table.integer<std::int32_t>("home_offset_counts");
  axis.deadband_counts = table.integer<std::uint32_t>("deadband_counts");
  axis.unhomed_travel_counts = table.integer<std::uint32_t>("unhomed_travel_counts");
  axis.soft_limits = read_soft_limits(table.table("soft_limits"));
  refuse_far_limits(table, axis);
  axis.drive = read_drive(table.table("drive"), axis.card == ILK_CARD_HIGH_FREQUENCY);
  axis.gains = read_gains(table.table("gains"));
  axis.mechanics = read_mechanics(table.table("mechanics"), robot.period_us);
  axis.stall = read_stall(table.table("stall"), robot.period_us);
  axis.runaway = read_runaway(table.table("runaway"));
  axis.homing = read_optional_homing(table, axis, robot.period_us);
  if (table.has("motion")) {
    axis.motion = read_motion(table.table("motion"), axis);
  }
  table.refuse_unknown_keys();
  return axis;
}

}  // namespace interlock
