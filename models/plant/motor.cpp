#include "plant/motor.hpp"

#include <algorithm>
#include <array>

namespace interlock::plant {
namespace {

constexpr std::uint32_t kSlowestWord = 1196612456u;
constexpr std::uint32_t kWordStep = 4063228u;
constexpr std::size_t kMapPoints = 24;

/** Speeds in revolutions per minute, from the slowest word on; a lower word is faster. */
using SpeedMap = std::array<double, kMapPoints>;

constexpr SpeedMap kPositiveRpm{0,      0.029,  0.164,   0.289,   0.431,   0.640,   0.963,   1.459,
                                2.660,  5.181,  11.445,  13.464,  20.955,  27.358,  36.039,  45.548,
                                58.997, 78.710, 105.850, 141.386, 188.106, 247.388, 317.394, 397.785};
constexpr SpeedMap kNegativeRpm{0,      0.054,  0.189,   0.331,   0.614,   1.095,   2.020,   3.222,
                                3.773,  6.383,  10.636,  15.308,  20.231,  27.239,  35.238,  45.333,
                                58.497, 77.516, 103.284, 138.166, 183.915, 242.763, 312.833, 391.709};

}  // namespace

double published_speed_rpm(std::uint32_t frequency_word, bool direction_bit) {
  if (frequency_word == 0 || frequency_word >= kSlowestWord) {
    return 0;
  }
  const SpeedMap& map = direction_bit ? kNegativeRpm : kPositiveRpm;
  const std::uint32_t below_slowest = kSlowestWord - frequency_word;
  const std::size_t point = below_slowest / kWordStep;
  if (point >= kMapPoints - 1) {
    return map.back();
  }
  const double fraction = static_cast<double>(below_slowest % kWordStep) / kWordStep;
  return map[point] + fraction * (map[point + 1] - map[point]);
}

Motor::Motor(const ilk_axis_config_t& axis, const AxisParameters& parameters)
    : high_frequency_(axis.card == ILK_CARD_HIGH_FREQUENCY),
      direction_bit_is_decreasing_(axis.motor_direction != 0),
      max_drive_(axis.max_drive),
      max_amplitude_(axis.max_amplitude),
      dead_zone_(parameters.dead_zone_fraction * axis.max_drive),
      full_speed_(parameters.full_speed_counts_per_s),
      counts_per_revolution_(parameters.counts_per_revolution) {}

void Motor::take(const AxisParameters& parameters) {
  dead_zone_ = parameters.dead_zone_fraction * max_drive_;
  full_speed_ = parameters.full_speed_counts_per_s;
}

double Motor::magnitude(const wire::MotorCommand& command) const {
  if (high_frequency_) {
    const double strength = std::min(1.0, command.amplitude / max_amplitude_);
    return published_speed_rpm(command.level, command.direction_bit) / 60 * counts_per_revolution_ * strength;
  }
  return std::max(0.0, (command.level - dead_zone_) / (max_drive_ - dead_zone_)) * full_speed_;
}

double Motor::speed(const wire::MotorCommand& command) const {
  if (!command.amplifier_enabled || command.level == 0) {
    return 0;
  }
  const bool decreasing = (command.direction_bit == direction_bit_is_decreasing_) != reversed_;
  return decreasing ? -magnitude(command) : magnitude(command);
}

}  // namespace interlock::plant
