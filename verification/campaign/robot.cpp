#include "robot.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "interlock/kernel.h"

namespace interlock::campaign {
namespace {

constexpr std::uint64_t kMicrosecondsPerSecond = 1'000'000;
constexpr std::uint32_t kNoise = 1;
constexpr std::uint32_t kBacklash = 1;
constexpr double kNoiseChance = 0.1;
constexpr plant::Microseconds kBounce{3000};
constexpr double kPushed = 0.2;   /**< share of axes that a hand has pushed away from their switch */
constexpr double kAtSwitch = 0.5; /**< share of axes that start near their switch */
constexpr double kRevolutionsPerSecondAtFullDrive = 397.785 / 60;

/** What the plant and the configuration of an axis have to agree on. */
struct Mechanics {
  std::uint32_t speed_counts_per_s;
  std::uint32_t lag_us;
};

std::uint32_t between(plant::Random& random, std::uint32_t lowest, std::uint32_t highest) {
  return lowest + random.below(highest - lowest + 1);
}

std::uint32_t ticks_of(std::uint32_t milliseconds, std::uint32_t period_us) {
  return std::max(1u, milliseconds * 1000 / period_us);
}

/** Travel at a speed in so many microseconds, rounded up. */
std::uint32_t travel(std::uint64_t speed_counts_per_s, std::uint64_t duration_us) {
  return static_cast<std::uint32_t>(speed_counts_per_s * duration_us / kMicrosecondsPerSecond + 1);
}

/** Microseconds for a travel at a speed. */
std::uint64_t time_for(std::uint64_t counts, std::uint32_t speed_counts_per_s) {
  return counts * kMicrosecondsPerSecond / speed_counts_per_s + 1;
}

std::uint32_t largest_drive(std::uint32_t card) {
  switch (card) {
    case ILK_CARD_HIGH_FREQUENCY:
      return 397785;
    case ILK_CARD_NON_PWM:
      return 0x3FFFFFFF;
    default:
      return 0x7FFFFFFF;
  }
}

/** Speeds are less than the drive's share of full speed: some of it may be lost. */
void set_homing_speeds(ilk_axis_config_t& axis) {
  axis.home_drive = axis.unhomed_max_drive;
  axis.home_slow_drive = axis.dead_zone_drive + (axis.max_drive - axis.dead_zone_drive) / 20;
  axis.home_amplitude = axis.max_amplitude;
  axis.home_speed_counts_per_s = axis.full_speed_counts_per_s * 2 / 25;
  axis.home_slow_speed_counts_per_s = axis.full_speed_counts_per_s * 3 / 100;
}

/** What a back-off and the two edges need: the range is chosen for it. */
void set_homing_margins(plant::Random& random, ilk_axis_config_t& axis, const ilk_common_config_t& common) {
  const std::uint64_t debounce_us = std::uint64_t{common.switch_debounce_ticks + 2} * common.period_us;
  axis.switch_hysteresis_counts = between(random, 3, 5);
  axis.home_tolerance_counts =
      travel(axis.full_speed_counts_per_s / 10, debounce_us + kBounce.count()) + 2 * kNoise + 1;
  axis.home_clear_counts =
      axis.home_tolerance_counts + axis.switch_hysteresis_counts + axis.coast_counts + between(random, 1, 20);
}

void set_homing_budget(plant::Random& random, ilk_axis_config_t& axis, const ilk_common_config_t& common,
                       std::uint32_t range) {
  const std::uint32_t back_and_forth = 2 * (axis.home_clear_counts + axis.switch_hysteresis_counts +
                                            2 * axis.coast_counts + axis.noise_counts);
  const std::uint32_t way = range + 2 * axis.coast_counts + 2 * back_and_forth;
  axis.home_travel_counts = way + axis.coast_counts + axis.noise_counts + between(random, 1, range / 4);
  const std::uint64_t waiting_us =
      std::uint64_t{4 * axis.rest_ticks + 12 * common.switch_debounce_ticks} * common.period_us;
  const std::uint64_t time_us = time_for(way, axis.home_speed_counts_per_s) +
                                time_for(back_and_forth, axis.home_slow_speed_counts_per_s) + waiting_us;
  axis.home_timeout_ticks = static_cast<std::uint32_t>(time_us * 11 / 10 / common.period_us) + 2;
}

void set_watches(plant::Random& random, ilk_axis_config_t& axis, std::uint32_t period_us) {
  const std::uint32_t slowest =
      axis.limit_side == ILK_LIMIT_NONE ? axis.full_speed_counts_per_s : axis.home_slow_speed_counts_per_s;
  axis.stall_min_counts = kNoise + 2;
  const auto least_ms =
      static_cast<std::uint32_t>(time_for(axis.stall_min_counts + kBacklash + kNoise, slowest) / 1000 + 40);
  const auto reversal_ms =
      static_cast<std::uint32_t>(time_for(5 * axis.coast_counts + kBacklash + kNoise + axis.stall_min_counts,
                                          axis.full_speed_counts_per_s) /
                                     1000 +
                                 3);
  axis.stall_ticks = ticks_of(between(random, std::max(least_ms, reversal_ms), 500), period_us);
  const std::uint64_t effort_us =
      time_for(5 * axis.coast_counts + kBacklash + kNoise + 1, axis.full_speed_counts_per_s);
  axis.stall_effort_ticks = static_cast<std::uint32_t>(effort_us / period_us) + between(random, 1, 20);
  axis.reverse_counts = axis.coast_counts + kBacklash + kNoise + 2;
  axis.drift_counts = axis.reverse_counts;
  axis.rest_ticks = ticks_of(between(random, 10, 40), period_us);
  axis.max_delta_counts = 2 * travel(axis.full_speed_counts_per_s, period_us) + 2;
}

ilk_axis_config_t make_axis(plant::Random& random, const Mechanics& mechanics,
                            const ilk_common_config_t& common) {
  ilk_axis_config_t axis{};
  axis.card = between(random, ILK_CARD_PWM, ILK_CARD_HIGH_FREQUENCY);
  axis.required = random.chance(0.2) ? 1 : 0;
  axis.motor_direction = random.coin() ? 1 : 0;
  axis.direction_correction = random.coin() ? 1 : 0;
  axis.limit_side = random.below(ILK_LIMIT_COUNT);
  axis.full_speed_counts_per_s = mechanics.speed_counts_per_s;
  axis.coast_counts = travel(mechanics.speed_counts_per_s, mechanics.lag_us + 3 * common.period_us) + 4;
  axis.backlash_counts = kBacklash;
  axis.noise_counts = kNoise;
  axis.deadband_counts = between(random, 1, 4);
  axis.max_drive = axis.card == ILK_CARD_HIGH_FREQUENCY ? largest_drive(axis.card)
                                                        : between(random, 20000, largest_drive(axis.card));
  axis.dead_zone_drive = axis.max_drive / (axis.card != ILK_CARD_HIGH_FREQUENCY && random.coin() ? 6 : 50);
  axis.unhomed_max_drive = axis.dead_zone_drive + (axis.max_drive - axis.dead_zone_drive) / 10;
  axis.max_amplitude = axis.card == ILK_CARD_HIGH_FREQUENCY ? 200 : 0;
  if (axis.limit_side != ILK_LIMIT_NONE) {
    set_homing_speeds(axis);
    set_homing_margins(random, axis, common);
  }
  set_watches(random, axis, common.period_us);
  const std::uint32_t farthest = std::max(axis.home_clear_counts, axis.drift_counts);
  const std::uint32_t range = 10 * farthest + between(random, 500, 3000);
  axis.unhomed_travel_counts = range / 10;
  axis.min_counts = -static_cast<std::int32_t>(between(random, range / 4, range / 2));
  axis.max_counts = axis.min_counts + static_cast<std::int32_t>(range);
  axis.home_offset_counts = axis.limit_side == ILK_LIMIT_LOWER ? axis.min_counts : axis.max_counts;
  if (axis.limit_side != ILK_LIMIT_NONE) {
    set_homing_budget(random, axis, common, range);
  }
  return axis;
}

/** From 150 counts off either soft limit, or from the switch on. */
plant::AxisParameters make_parameters(plant::Random& random, const ilk_axis_config_t& axis,
                                      const Mechanics& mechanics) {
  plant::AxisParameters parameters;
  const auto range = static_cast<std::uint32_t>(axis.max_counts - axis.min_counts);
  parameters.start_counts = axis.min_counts + static_cast<double>(between(random, 150, range - 150));
  if (axis.limit_side != ILK_LIMIT_NONE && random.chance(kAtSwitch)) {
    parameters.start_counts = plant::position_from_switch(axis, random.below(150));
  }
  parameters.dead_zone_fraction = static_cast<double>(axis.dead_zone_drive) / axis.max_drive;
  parameters.full_speed_counts_per_s = mechanics.speed_counts_per_s;
  parameters.counts_per_revolution = mechanics.speed_counts_per_s / kRevolutionsPerSecondAtFullDrive;
  parameters.lag = plant::Microseconds(mechanics.lag_us);
  parameters.backlash_counts = kBacklash;
  parameters.noise_counts = kNoise;
  parameters.noise_chance = kNoiseChance;
  parameters.switch_bounce = kBounce;
  parameters.end_margin_counts = axis.coast_counts;
  return parameters;
}

}  // namespace

std::uint32_t met_within(std::size_t config_bit) {
  constexpr std::size_t of_system[] = {offsetof(ilk_config_t, common.pedal_channels),
                                       offsetof(ilk_config_t, common.app_timeout_ticks)};
  constexpr std::size_t of_axis[] = {offsetof(ilk_axis_config_t, card),
                                     offsetof(ilk_axis_config_t, motor_direction),
                                     offsetof(ilk_axis_config_t, limit_side)};
  constexpr std::size_t axes_at = offsetof(ilk_config_t, axis);
  const std::size_t word = config_bit / 32 * sizeof(std::uint32_t);
  const bool in_axis = word >= axes_at && word < offsetof(ilk_config_t, crc);
  const std::span<const std::size_t> at_once = in_axis ? std::span<const std::size_t>(of_axis) : of_system;
  const std::size_t place = in_axis ? (word - axes_at) % sizeof(ilk_axis_config_t) : word;
  return std::ranges::find(at_once, place) == at_once.end() ? kConfigPassTicks : 0;
}

Robot make_robot(plant::Random& random, bool keeps_word) {
  constexpr std::uint32_t periods[] = {500, 1000, 1000, 1000, 2000};
  Robot robot{};
  ilk_config_t& config = robot.config;
  ilk_common_config_t& common = config.common;
  common.version = ILK_CONFIG_VERSION;
  common.size_bytes = sizeof config;
  common.period_us = periods[random.below(std::size(periods))];
  common.pedal_channels = random.chance(0.8) ? 2 : 1;
  common.app_timeout_ticks = ticks_of(between(random, 60, 150), common.period_us);
  common.lease_max_ticks = ticks_of(between(random, 60, 150), common.period_us);
  common.pedal_debounce_ticks = ticks_of(between(random, 4, 12), common.period_us);
  common.pedal_disagree_ticks = ticks_of(between(random, 20, 50), common.period_us);
  common.power_up_ticks = ticks_of(between(random, 1, 20), common.period_us);
  common.switch_debounce_ticks = ticks_of(between(random, 4, 8), common.period_us);
  common.bad_frame_limit = between(random, 1, 5);
  common.overrun_limit = between(random, 1, 5);
  robot.plant.estop.bounce = kBounce;
  if (random.chance(0.12) && !keeps_word) {
    robot.far_coaster = random.below(ILK_SLOTS);
  }
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const Mechanics mechanics{between(random, 3000, 8000), between(random, 2, 5) * 1000};
    config.axis[slot] = make_axis(random, mechanics, common);
    robot.plant.axis[slot] = make_parameters(random, config.axis[slot], mechanics);
    if (slot == robot.far_coaster) {
      robot.plant.axis[slot].lag *= 8;
    }
  }
  config.crc = ilk_config_crc(&config);
  return robot;
}

void push_to_far_ends(Robot& robot, plant::Random& random) {
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t& axis = robot.config.axis[slot];
    plant::AxisParameters& parameters = robot.plant.axis[slot];
    if (axis.limit_side != ILK_LIMIT_NONE && random.chance(kPushed)) {
      const double beyond = parameters.end_margin_counts / 2;
      parameters.start_counts =
          axis.limit_side == ILK_LIMIT_LOWER ? axis.max_counts + beyond : axis.min_counts - beyond;
    }
  }
}

void stand_at_zero(Robot& robot) {
  for (plant::AxisParameters& axis : robot.plant.axis) {
    axis.start_counts = 0;
  }
}

}  // namespace interlock::campaign
