/**
 * @file
 * Mechanics of one axis: motor with lag and warmth, play before and behind the encoder, end stops and limit
 * switch.
 *
 * Positions are true positions in counts, in the frame in which the switch edge is at the home offset.
 */
#ifndef INTERLOCK_PLANT_AXIS_HPP
#define INTERLOCK_PLANT_AXIS_HPP

#include "plant/contact.hpp"
#include "plant/motor.hpp"

namespace interlock::plant {

/** A limit switch: triggered from its edge on, released some counts before it. */
class LimitSwitch {
 public:
  /** A side of `ILK_LIMIT_NONE` makes a switch that never triggers. */
  LimitSwitch(const ilk_axis_config_t& axis, const AxisParameters& parameters);

  /** Follows the axis to a position. */
  void follow(double position_counts);

  void advance(Microseconds elapsed) { contact_.advance(elapsed); }

  /** Sticks the switch, or frees it. */
  void stick(std::optional<bool> triggered) { contact_.stick(triggered); }

  /** What is read now, bounce included. */
  bool read(Random& random) { return contact_.read(random); }

  std::optional<bool> stuck() const { return contact_.stuck(); }

  /** What is read once it does not bounce. */
  bool triggered() const { return contact_.stuck().value_or(contact_.closed()); }

 private:
  double past_edge(double position_counts) const;

  ilk_limit_side_t side_;
  double edge_counts_;
  double hysteresis_counts_;
  Contact contact_;
};

/** One axis. Everything changes in `advance` only; the setters say what will act there. */
class Axis {
 public:
  Axis(const ilk_axis_config_t& axis, const AxisParameters& parameters);

  /** What the card's amplifier does from now on. */
  void drive(const wire::MotorCommand& command) {
    target_speed_ = motor_.speed(command, warmth_);
    effort_ = motor_.effort(command);
  }

  /** Gives the amplifier power, or takes it: without it no drive and no runaway moves the axis. */
  void supply(bool on) { supplied_ = on; }

  /** Lets time pass. */
  void advance(Microseconds elapsed);

  /** Blocks the axis, or frees it. */
  void jam(bool jammed) { jammed_ = jammed; }

  /** Moves the axis by hand, at an even pace; added to a push that is still under way. */
  void push(double counts, Microseconds duration);

  /** The amplifier drives the axis whatever it is told, while it has power; no speed ends it. */
  void run_away(std::optional<double> counts_per_s) { runaway_speed_ = counts_per_s; }

  /** Swaps the motor's direction, or restores it; acts with the next `drive`. */
  void reverse(bool reversed) { motor_.reverse(reversed); }

  /** Moves by these parameters from the next step on; where it stands and how fast it is stay. */
  void take(const AxisParameters& parameters);

  /** As they act now. */
  const AxisParameters& parameters() const { return parameters_; }
  /** As the plant started with them. */
  const AxisParameters& file_parameters() const { return file_parameters_; }

  /** Ends jam, push, runaway, reversal and a stuck switch. */
  void clear_faults();

  const std::string& name() const { return parameters_.name; }
  /** Of what the encoder sees. */
  double position_counts() const { return load_; }
  /** Of the tool: where the encoder is after motion to larger positions, up to the play beyond it otherwise.
   */
  double tool_counts() const { return tool_; }
  double speed_counts_per_s() const { return speed_; }
  bool is_jammed() const { return jammed_; }
  /** Nothing when it does not run away. */
  std::optional<double> runaway_counts_per_s() const { return runaway_speed_; }
  bool is_reversed() const { return motor_.is_reversed(); }

  LimitSwitch& limit_switch() { return switch_; }
  const LimitSwitch& limit_switch() const { return switch_; }

 private:
  double push_step(double elapsed_s);

  AxisParameters file_parameters_;
  AxisParameters parameters_;
  Motor motor_;
  LimitSwitch switch_;
  double lag_s_;
  double play_;
  double lowest_;
  double highest_;
  double motor_position_;
  double load_;
  double tool_;
  double speed_ = 0;
  double target_speed_ = 0;
  double effort_ = 0;
  double warmth_ = 0; /**< 0 cold, 1 warm */
  bool supplied_ = false;
  double push_left_ = 0;
  double push_speed_ = 0;
  std::optional<double> runaway_speed_;
  bool jammed_ = false;
};

}  // namespace interlock::plant

#endif
