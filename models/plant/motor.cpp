#include "plant/motor.hpp"

#include <algorithm>
#include <array>

namespace interlock::plant {
namespace {

constexpr double kSlowestWord = 1196612456;
constexpr double kWordStep = 4063228;
constexpr double kWordsPerHz = 22009;  // the published relation of word and frequency
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

double published_speed_rpm(double frequency_word, bool direction_bit) {
  if (frequency_word <= 0 || frequency_word >= kSlowestWord) {
    return 0;
  }
  const SpeedMap& map = direction_bit ? kNegativeRpm : kPositiveRpm;
  const double steps = (kSlowestWord - frequency_word) / kWordStep;
  const auto point = static_cast<std::size_t>(steps);
  if (point >= kMapPoints - 1) {
    return map.back();
  }
  return map[point] + (steps - static_cast<double>(point)) * (map[point + 1] - map[point]);
}

Motor::Motor(const ilk_axis_config_t& axis, const AxisParameters& parameters)
    : high_frequency_(axis.card == ILK_CARD_HIGH_FREQUENCY),
      direction_bit_is_decreasing_(axis.motor_direction != 0),
      max_drive_(axis.max_drive),
      max_amplitude_(axis.max_amplitude),
      counts_per_revolution_(parameters.counts_per_revolution) {
  take(parameters);
}

void Motor::take(const AxisParameters& parameters) {
  dead_zone_ = parameters.dead_zone_fraction * max_drive_;
  full_speed_ = parameters.full_speed_counts_per_s;
  load_ = parameters.load_fraction;
  heat_droop_ = parameters.heat_droop_fraction;
  resonance_words_ = parameters.resonance_hz * kWordsPerHz;
  drift_words_ = parameters.resonance_drift_hz * kWordsPerHz;
}

double Motor::magnitude(const wire::MotorCommand& command, double warmth) const {
  if (high_frequency_) {
    const double word = command.level - resonance_words_ + drift_words_ * warmth;
    return published_speed_rpm(word, command.direction_bit) / 60 * counts_per_revolution_ * effort(command);
  }
  return std::max(0.0, (command.level - dead_zone_) / (max_drive_ - dead_zone_)) * full_speed_;
}

double Motor::effort(const wire::MotorCommand& command) const {
  if (!command.amplifier_enabled || command.level == 0) {
    return 0;
  }
  return std::min(1.0, high_frequency_ ? command.amplitude / max_amplitude_ : command.level / max_drive_);
}

double Motor::speed(const wire::MotorCommand& command, double warmth) const {
  if (!command.amplifier_enabled || command.level == 0) {
    return 0;
  }
  const bool decreasing = (command.direction_bit == direction_bit_is_decreasing_) != reversed_;
  const double speed = magnitude(command, warmth) * (1 - heat_droop_ * warmth);
  return decreasing ? -speed * (1 + load_) : speed * (1 - load_);
}

}  // namespace interlock::plant
