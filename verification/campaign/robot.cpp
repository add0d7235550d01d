#include "robot.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "interlock/kernel.h"

namespace interlock::campaign {
namespace {

constexpr std::uint32_t kMicrosecondsPerSecond = 1'000'000;
constexpr std::uint32_t kMaxSettleMs = 40;
constexpr double kPushed = 0.2; /**< share of axes that a hand has pushed away from their switch */
constexpr double kRevolutionsPerSecondAtFullDrive = 397.785 / 60;

/** What the plant and the configuration of an axis have to agree on. */
struct Mechanics {
  std::uint32_t speed_counts_per_s;
  std::uint32_t lag_us;
  std::uint32_t backlash = 1;
  std::uint32_t noise = 1;
};

std::uint32_t between(plant::Random& random, std::uint32_t lowest, std::uint32_t highest) {
  return lowest + random.below(highest - lowest + 1);
}

std::uint32_t ticks_of(std::uint32_t milliseconds, std::uint32_t period_us) {
  return std::max(1u, milliseconds * 1000 / period_us);
}

/** Travel at full speed in so many microseconds, rounded up. */
std::uint32_t travel(std::uint32_t speed_counts_per_s, std::uint32_t duration_us) {
  return speed_counts_per_s * (duration_us / 100) / (kMicrosecondsPerSecond / 100) + 1;
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

void set_homing(ilk_axis_config_t& axis, std::uint32_t range, std::uint32_t speed_counts_per_s,
                std::uint32_t period_us) {
  axis.home_drive = axis.unhomed_max_drive;
  axis.home_amplitude = axis.max_amplitude;
  axis.home_travel_counts = range + axis.coast_counts;
  axis.home_backoff_counts = range / 10;
  axis.home_rest_ticks = 10;
  axis.home_speed_counts_per_s =
      speed_counts_per_s / 20;  // dead zone: a tenth of the drive is less than that speed
  const std::uint32_t seconds =
      (axis.home_travel_counts + axis.home_backoff_counts) / axis.home_speed_counts_per_s + 2;
  axis.home_timeout_ticks = seconds * (kMicrosecondsPerSecond / period_us);
}

ilk_axis_config_t make_axis(plant::Random& random, const Mechanics& mechanics, std::uint32_t period_us) {
  ilk_axis_config_t axis{};
  const std::uint32_t range = between(random, 1500, 6000);
  axis.card = between(random, ILK_CARD_PWM, ILK_CARD_HIGH_FREQUENCY);
  axis.required = random.chance(0.2) ? 1 : 0;
  axis.motor_direction = random.coin() ? 1 : 0;
  axis.direction_correction = random.coin() ? 1 : 0;
  axis.limit_side = random.below(ILK_LIMIT_COUNT);
  axis.min_counts = -static_cast<std::int32_t>(between(random, range / 4, range / 2));
  axis.max_counts = axis.min_counts + static_cast<std::int32_t>(range);
  axis.home_offset_counts = axis.limit_side == ILK_LIMIT_LOWER ? axis.min_counts : axis.max_counts;
  axis.coast_counts = travel(mechanics.speed_counts_per_s, mechanics.lag_us + 3 * period_us) + 4;
  axis.backlash_counts = mechanics.backlash;
  axis.noise_counts = mechanics.noise;
  axis.deadband_counts = between(random, 1, 4);
  axis.max_drive = axis.card == ILK_CARD_HIGH_FREQUENCY ? largest_drive(axis.card)
                                                        : between(random, 20000, largest_drive(axis.card));
  axis.unhomed_max_drive = axis.max_drive / 10;
  axis.max_amplitude = axis.card == ILK_CARD_HIGH_FREQUENCY ? 200 : 0;
  axis.unhomed_travel_counts = range / 10;
  axis.stall_ticks = ticks_of(between(random, 50, 500), period_us);
  axis.stall_min_counts = 3;
  axis.reverse_counts = axis.coast_counts + mechanics.backlash + mechanics.noise + 2;
  axis.drift_counts = axis.reverse_counts;
  axis.settle_ticks = ticks_of(kMaxSettleMs, period_us);
  axis.max_delta_counts = 2 * travel(mechanics.speed_counts_per_s, period_us) + 2;
  if (axis.limit_side != ILK_LIMIT_NONE) {
    set_homing(axis, range, mechanics.speed_counts_per_s, period_us);
  }
  return axis;
}

plant::AxisParameters make_parameters(plant::Random& random, const ilk_axis_config_t& axis,
                                      const Mechanics& mechanics) {
  plant::AxisParameters parameters;
  parameters.start_counts =
      static_cast<double>(axis.min_counts) +
      between(random, 150, static_cast<std::uint32_t>(axis.max_counts - axis.min_counts) - 150);
  parameters.full_speed_counts_per_s = mechanics.speed_counts_per_s;
  parameters.counts_per_revolution = mechanics.speed_counts_per_s / kRevolutionsPerSecondAtFullDrive;
  parameters.lag = plant::Microseconds(mechanics.lag_us);
  parameters.backlash_counts = mechanics.backlash;
  parameters.noise_counts = mechanics.noise;
  return parameters;
}

oracle::AxisRules rules_of(const ilk_axis_config_t& axis) {
  constexpr oracle::CardKind kinds[] = {oracle::CardKind::kNone,          oracle::CardKind::kPwm,
                                        oracle::CardKind::kNonPwm,        oracle::CardKind::kAnalog,
                                        oracle::CardKind::kHighFrequency, oracle::CardKind::kSensor};
  constexpr oracle::SwitchEnd ends[] = {oracle::SwitchEnd::kNone, oracle::SwitchEnd::kLower,
                                        oracle::SwitchEnd::kUpper};
  const auto signed_of = [](std::uint32_t counts) { return static_cast<std::int32_t>(counts); };
  return {.card = kinds[axis.card],
          .required = axis.required != 0,
          .motor_direction = axis.motor_direction != 0,
          .counter_falls = axis.direction_correction != 0,
          .switch_end = ends[axis.limit_side],
          .soft_min = axis.min_counts,
          .soft_max = axis.max_counts,
          .home_offset = axis.home_offset_counts,
          .coast = signed_of(axis.coast_counts),
          .deadband = signed_of(axis.deadband_counts),
          .max_drive = axis.max_drive,
          .unhomed_max_drive = axis.unhomed_max_drive,
          .home_drive = axis.home_drive,
          .max_amplitude = axis.max_amplitude,
          .unhomed_travel = signed_of(axis.unhomed_travel_counts),
          .stall_min = signed_of(axis.stall_min_counts),
          .stall_ticks = axis.stall_ticks,
          .reverse = signed_of(axis.reverse_counts),
          .drift = signed_of(axis.drift_counts),
          .settle_ticks = axis.settle_ticks,
          .max_delta = signed_of(axis.max_delta_counts)};
}

oracle::SystemRules rules_of(const ilk_config_t& config) {
  oracle::SystemRules rules;
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    rules.axes[slot] = rules_of(config.axis[slot]);
  }
  rules.period_us = config.period_us;
  rules.pedal_channels = config.pedal_channels;
  rules.app_timeout_ticks = config.app_timeout_ticks;
  rules.lease_max_ticks = config.lease_max_ticks;
  rules.pedal_debounce_ticks = config.pedal_debounce_ticks;
  rules.pedal_disagree_ticks = config.pedal_disagree_ticks;
  rules.bad_frame_limit = config.bad_frame_limit;
  rules.overrun_limit = config.overrun_limit;
  rules.crc_slice_ticks = kConfigPassTicks;
  return rules;
}

}  // namespace

std::uint32_t met_within(std::size_t config_bit) {
  constexpr std::size_t of_system[] = {offsetof(ilk_config_t, pedal_channels),
                                       offsetof(ilk_config_t, app_timeout_ticks)};
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

std::optional<std::size_t> slot_of_card_word(std::size_t config_bit) {
  const std::size_t word = config_bit / 32 * sizeof(std::uint32_t);
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const std::size_t axis_at = offsetof(ilk_config_t, axis) + slot * sizeof(ilk_axis_config_t);
    if (word == axis_at + offsetof(ilk_axis_config_t, card)) {
      return slot;
    }
  }
  return std::nullopt;
}

Robot make_robot(plant::Random& random, bool keeps_word) {
  constexpr std::uint32_t periods[] = {500, 1000, 1000, 1000, 2000};
  Robot robot{};
  ilk_config_t& config = robot.config;
  config.version = ILK_CONFIG_VERSION;
  config.size_bytes = sizeof config;
  config.period_us = periods[random.below(std::size(periods))];
  config.pedal_channels = random.chance(0.8) ? 2 : 1;
  config.app_timeout_ticks = ticks_of(between(random, 60, 150), config.period_us);
  config.lease_max_ticks = ticks_of(between(random, 60, 150), config.period_us);
  config.pedal_debounce_ticks = ticks_of(between(random, 4, 12), config.period_us);
  config.pedal_disagree_ticks = ticks_of(between(random, 20, 50), config.period_us);
  config.bad_frame_limit = between(random, 1, 5);
  config.overrun_limit = between(random, 1, 5);
  if (random.chance(0.12) && !keeps_word) {
    robot.far_coaster = random.below(ILK_SLOTS);
  }
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const Mechanics mechanics{between(random, 1500, 4000), between(random, 2, 5) * 1000};
    config.axis[slot] = make_axis(random, mechanics, config.period_us);
    robot.plant.axis[slot] = make_parameters(random, config.axis[slot], mechanics);
    if (slot == robot.far_coaster) {
      robot.plant.axis[slot].lag *= 8;
    }
  }
  config.crc = ilk_config_crc(&config);
  robot.rules = rules_of(config);
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

}  // namespace interlock::campaign
