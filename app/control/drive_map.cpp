#include "control/drive_map.hpp"

#include <algorithm>
#include <cmath>

#include "control/frequency_map.hpp"

namespace interlock {
namespace {

using frequency_map::Wave;
using frequency_map::wave_of;

constexpr double seconds_per_minute = 60.0;
constexpr double fastest = 1e9;
constexpr double slowest = 1e-3;

/** A speed is measured as the mean of 20 ms, of an axis that follows its drive after two ticks and its lag.
 */
constexpr double measured_late_s = 0.015;
constexpr double settled_s = 0.1;
constexpr double follow_s = 0.3;
constexpr double slowest_rpm = 10.0;
constexpr double least_share = 0.3;
constexpr double most_shift_words = 600.0 * frequency_map::words_per_hz;

/** A frequency word moved by so much, within the map. */
std::uint32_t shifted(double word, double by) noexcept {
  return static_cast<std::uint32_t>(
      std::clamp<double>(word + by, frequency_map::fastest_word, frequency_map::slowest_word));
}

bool has_motor(ilk_card_t card) noexcept {
  return card == ILK_CARD_PWM || card == ILK_CARD_NON_PWM || card == ILK_CARD_ANALOG ||
         card == ILK_CARD_HIGH_FREQUENCY;
}

}  // namespace

ControlResult<DriveMap> DriveMap::create(const DriveMapRules& rules) noexcept {
  if (!has_motor(rules.card)) {
    return tl::unexpected(ControlError{ControlError::Code::out_of_range, "card"});
  }
  const double max_drive = rules.max_drive;
  const bool linear = rules.card != ILK_CARD_HIGH_FREQUENCY;
  return require_within("largest drive", max_drive, 1, max_drive)
      .and_then([&] { return require_within("smallest drive", rules.min_drive, 0, max_drive); })
      .and_then([&] { return require_within("dead zone", rules.dead_zone_drive, 0, max_drive - 1); })
      .and_then([&] {
        return linear
                   ? require_within("full speed", rules.full_speed_counts_per_s, slowest, fastest)
                   : require_within("counts per revolution", rules.counts_per_revolution, slowest, fastest);
      })
      .map([&] { return DriveMap(rules); });
}

std::uint32_t DriveMap::drive(double counts_per_s) const noexcept {
  if (!std::isfinite(counts_per_s) || counts_per_s == 0.0) {
    return 0;
  }
  const double max_drive = rules_.max_drive;
  const double linear = rules_.dead_zone_drive + std::abs(counts_per_s) / rules_.full_speed_counts_per_s *
                                                     (max_drive - rules_.dead_zone_drive);
  const double desired = rules_.card == ILK_CARD_HIGH_FREQUENCY ? frequency_drive(counts_per_s) : linear;
  return static_cast<std::uint32_t>(std::clamp(desired, static_cast<double>(rules_.min_drive), max_drive) +
                                    0.5);
}

double DriveMap::speed(std::uint32_t drive, int direction) const noexcept {
  const std::uint32_t bounded = std::min(drive, rules_.max_drive);
  const bool decreasing = direction < 0;
  const double linear = std::max(0.0, bounded - rules_.dead_zone_drive) /
                        (rules_.max_drive - rules_.dead_zone_drive) * rules_.full_speed_counts_per_s;
  const double magnitude =
      rules_.card == ILK_CARD_HIGH_FREQUENCY ? frequency_speed(bounded, decreasing) : linear;
  return decreasing ? -magnitude : magnitude;
}

void DriveMap::follow(std::uint32_t drive, std::optional<double> counts_per_s, double elapsed_s) noexcept {
  if (rules_.card != ILK_CARD_HIGH_FREQUENCY || drive == 0) {
    driven_words_.reset();
    return;
  }
  const double word = frequency_map::word_of(drive);
  if (!driven_words_) {
    driven_words_ = word;
    driven_s_ = 0.0;
  }
  *driven_words_ += elapsed_s / (measured_late_s + elapsed_s) * (word - *driven_words_);
  driven_s_ += elapsed_s;
  if (!counts_per_s || driven_s_ < settled_s) {
    return;
  }
  const double rpm = std::abs(*counts_per_s) / rules_.counts_per_revolution * seconds_per_minute;
  const Wave wave = wave_of(rules_.motor_direction, *counts_per_s < 0);
  const double expected_rpm = frequency_map::rpm_at(shifted(*driven_words_, -shift_words_), wave);
  // Slower, the map is so flat that noise of the speed would move it far; much slower, something holds the
  // axis.
  if (expected_rpm < slowest_rpm || rpm < expected_rpm * least_share) {
    return;
  }
  const double wanted = std::clamp(*driven_words_ - frequency_map::word_for(rpm, wave),
                                   stated_words() - most_shift_words, stated_words() + most_shift_words);
  shift_words_ += elapsed_s / (follow_s + elapsed_s) * (wanted - shift_words_);
}

double DriveMap::stated_words() const noexcept { return rules_.resonance_hz * frequency_map::words_per_hz; }

double DriveMap::full_speed() const noexcept {
  return std::min(speed(rules_.max_drive, 1), -speed(rules_.max_drive, -1));
}

double DriveMap::frequency_drive(double counts_per_s) const noexcept {
  const double rpm = std::abs(counts_per_s) / rules_.counts_per_revolution * seconds_per_minute;
  const Wave wave = wave_of(rules_.motor_direction, counts_per_s < 0);
  return frequency_map::drive_at(shifted(frequency_map::word_for(rpm, wave), shift_words_));
}

double DriveMap::frequency_speed(std::uint32_t drive, bool decreasing) const noexcept {
  const double rpm = frequency_map::rpm_at(shifted(frequency_map::word_of(drive), -shift_words_),
                                           wave_of(rules_.motor_direction, decreasing));
  return rpm / seconds_per_minute * rules_.counts_per_revolution;
}

}  // namespace interlock
