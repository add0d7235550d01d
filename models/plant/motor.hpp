/**
 * @file
 * Speed of an unloaded motor for what the card tells it.
 */
#ifndef INTERLOCK_PLANT_MOTOR_HPP
#define INTERLOCK_PLANT_MOTOR_HPP

#include <cstdint>

#include "plant/parameters.hpp"
#include "plant/wire.hpp"

namespace interlock::plant {

/** Speed in revolutions per minute at a frequency word, by the published map for each direction. */
double published_speed_rpm(std::uint32_t frequency_word, bool direction_bit);

/** The stationary side of a motor: command in, speed out. */
class Motor {
 public:
  Motor(const ilk_axis_config_t& axis, const AxisParameters& parameters);

  /** Speed in counts per second, positive towards larger positions. */
  double speed(const wire::MotorCommand& command) const;

  /** Has that dead zone and that speed from the next command on. */
  void take(const AxisParameters& parameters);

  /** Swaps two phases of the motor, or restores them. */
  void reverse(bool reversed) { reversed_ = reversed; }

  bool is_reversed() const { return reversed_; }

 private:
  double magnitude(const wire::MotorCommand& command) const;

  bool high_frequency_;
  bool direction_bit_is_decreasing_;
  double max_drive_;
  double max_amplitude_;
  double dead_zone_;
  double full_speed_;
  double counts_per_revolution_;
  bool reversed_ = false;
};

}  // namespace interlock::plant

#endif
