#include "control/axis_controller.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace interlock {
namespace {

constexpr double full_speed_rise_s = 0.05;
constexpr double integral_share = 0.5;
/** After a longer gap the integral does not make up for the ticks that were missed. */
constexpr std::uint32_t most_elapsed_ticks = 10;
constexpr std::uint32_t fewest_periods = 4;

DriveMapRules drive_rules(const Axis& axis, double full_speed_counts_per_s) {
  return {.card = axis.card,
          .motor_direction = axis.motor_direction != 0,
          .max_drive = axis.drive.max,
          .min_drive = floor_drive(axis.drive),
          .dead_zone_drive = static_cast<double>(axis.drive.dead_zone),
          .full_speed_counts_per_s = full_speed_counts_per_s,
          .counts_per_revolution = axis.unit == Unit::rad ? 2 * std::numbers::pi * axis.counts_per_unit : 0.0,
          .resonance_hz = axis.drive.resonance_hz};
}

}  // namespace

std::optional<double> mapped_full_speed(const Axis& axis) {
  if (axis.card != ILK_CARD_HIGH_FREQUENCY || axis.unit != Unit::rad) {
    return std::nullopt;
  }
  const ControlResult<DriveMap> map = DriveMap::create(drive_rules(axis, 0.0));
  return map ? std::optional(map->full_speed()) : std::nullopt;
}

AxisControlRules control_rules(const Axis& axis, std::uint32_t period_us, double full_speed_counts_per_s) {
  const double full = mapped_full_speed(axis).value_or(full_speed_counts_per_s);
  const Mechanics& mechanics = axis.mechanics;
  const std::uint32_t at_rest = mechanics.backlash_counts + mechanics.noise_counts;
  const double coast = mechanics.coast_counts - std::min(mechanics.coast_counts, at_rest);
  return {.period_us = period_us,
          .deadband_counts = axis.deadband_counts,
          .velocity = {.fastest_counts_per_s = mechanics.max_delta_counts * us_per_s / period_us,
                       .noise_counts = static_cast<double>(mechanics.noise_counts)},
          .piv = {.gains = axis.gains,
                  .full_speed_counts_per_s = full,
                  .lead_s = coast / full,
                  .rate_counts_per_s2 = full / full_speed_rise_s,
                  .integral_counts_per_s = integral_share * full},
          .drive = drive_rules(axis, full)};
}

ControlResult<AxisController> AxisController::create(const AxisControlRules& rules) noexcept {
  const double period = rules.period_us;
  const double window = rules.velocity.window_us;
  return require_within("control period", period, 1.0, us_per_s)
      .and_then([&] {
        return require_within("window of the velocity", window, fewest_periods * period,
                              (VelocityEstimator::most_samples - 1) * period);
      })
      .and_then([&] { return PivController::create(rules.piv); })
      .and_then([&](const PivController& piv) {
        return DriveMap::create(rules.drive).map([&](const DriveMap& map) {
          return AxisController(rules, piv, map);
        });
      });
}

AxisOutput AxisController::update(const ilk_axis_t& axis, std::uint32_t tick, const Setpoint& setpoint,
                                  std::int32_t target_counts, std::uint32_t ceiling_drive) noexcept {
  const double elapsed = elapsed_s(tick);
  last_tick_ = tick;
  estimator_.add(axis.position_counts, axis.card_time_us);
  AxisOutput output;
  output.velocity = estimator_.estimate();
  map_.follow(std::exchange(last_drive_, 0),
              output.velocity ? std::optional(output.velocity->counts_per_s) : std::nullopt, elapsed);
  const std::int64_t way = std::int64_t{target_counts} - axis.position_counts;
  const int direction = way < 0 ? -1 : 1;
  const ControlResult<PivOutput> piv =
      piv_.update({.setpoint = setpoint,
                   .position_counts = static_cast<double>(axis.position_counts),
                   .velocity = output.velocity,
                   .direction = direction,
                   .elapsed_s = elapsed,
                   .ceiling_counts_per_s = direction * map_.speed(ceiling_drive, direction)});
  if (!piv) {
    output.error = piv.error();
    return output;
  }
  output.piv = *piv;
  if (std::abs(way) <= rules_.deadband_counts) {
    piv_.reset();
    return output;
  }
  output.drive = std::min(map_.drive(piv->counts_per_s), ceiling_drive);
  last_drive_ = output.drive;
  return output;
}

void AxisController::observe(const ilk_axis_t& axis, std::uint32_t tick) noexcept {
  last_tick_ = tick;
  estimator_.add(axis.position_counts, axis.card_time_us);
  map_.follow(0, std::nullopt, 0.0);
  last_drive_ = 0;
  piv_.reset();
}

double AxisController::elapsed_s(std::uint32_t tick) const noexcept {
  const std::uint32_t ticks = last_tick_ ? std::min(tick - *last_tick_, most_elapsed_ticks) : 1;
  return ticks * static_cast<double>(rules_.period_us) / us_per_s;
}

}  // namespace interlock
