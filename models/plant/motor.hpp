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
double published_speed_rpm(double frequency_word, bool direction_bit);

/** The stationary side of a motor: command in, speed out. */
class Motor {
 public:
  Motor(const ilk_axis_config_t& axis, const AxisParameters& parameters);

  /** Speed in counts per second, positive towards larger positions; `warmth` from 0, cold, to 1. */
  double speed(const wire::MotorCommand& command, double warmth) const;

  /** Share of the largest drive, or of the largest amplitude, that the command makes: what warms the motor.
   */
  double effort(const wire::MotorCommand& command) const;

  /** Moves by these parameters from the next command on. */
  void take(const AxisParameters& parameters);

  /** Swaps two phases of the motor, or restores them. */
  void reverse(bool reversed) { reversed_ = reversed; }

  bool is_reversed() const { return reversed_; }

 private:
  double magnitude(const wire::MotorCommand& command, double warmth) const;

  bool high_frequency_;
  bool direction_bit_is_decreasing_;
  double max_drive_;
  double max_amplitude_;
  double dead_zone_ = 0;
  double full_speed_ = 0;
  double counts_per_revolution_;
  double load_ = 0;
  double heat_droop_ = 0;
  double resonance_words_ = 0;
  double drift_words_ = 0;
  bool reversed_ = false;
};

}  // namespace interlock::plant

#endif
