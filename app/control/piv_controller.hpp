/**
 * @file
 * Velocity-regulated position control of one axis: position P, velocity I, velocity V (Listing 12 of the
 * thesis), signed throughout.
 *
 * With the setpoint p, v, a, the measured position x and the measured velocity w, which is `age` old:
 *
 *     v_wanted = v + position_gain (p - x)                      position error to velocity
 *     e        = (v_wanted - a age) - w                         both sides as late as the measurement
 *     output   = v_wanted + a lead + velocity_gain e + I        feed-forward, V, I
 *     dI/dt    = integral_gain e                                bounded
 *
 * Two things differ from the listing. Nothing takes a magnitude: there a speed too high and one too low
 * raised the output alike. And the velocity that the trajectory asks for is fed forward, with what the loop's
 * latency and the motor's lag take away (`lead`), so that the loop corrects errors and does not make the
 * motion.
 *
 * The kernel drives an axis only towards its setpoint. So the output is held within 0 and full speed, or the
 * move's own ceiling, in the direction of travel: an output against it is no drive, never a reversal.
 *
 * Anti-windup is by conditional integration: while the output is held at a bound, or by the limit of its
 * rate, the integral only moves the way that leads off it. The integral has a bound of its own, which goes
 * down with the speed of a profile that comes to rest, and a new direction of travel empties it.
 *
 * The rate of the output is limited, but not where it goes to zero because it points against the travel, nor
 * where the ceiling comes down: nothing delays a stop.
 */
#pragma once

#include <limits>
#include <optional>

#include "control/control_error.hpp"
#include "control/setpoint.hpp"
#include "control/velocity_estimator.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** What the law of one axis is made from. */
struct PivRules {
  Gains gains;
  double full_speed_counts_per_s = 0.0; /**< largest output */
  double lead_s = 0.0;                  /**< from a reading until the motor has answered to it */
  double rate_counts_per_s2 = 0.0;      /**< fastest change of the output */
  double integral_counts_per_s = 0.0;   /**< largest integral */
};

/** What is known in one control tick. */
struct PivInput {
  Setpoint setpoint;                        /**< at the time of the reading */
  double position_counts = 0.0;             /**< as read */
  std::optional<VelocityEstimate> velocity; /**< without it there is no V and no I */
  int direction = 1;                        /**< of travel: the sign of target minus position */
  double elapsed_s = 0.0;                   /**< since the last update */
  double ceiling_counts_per_s = std::numeric_limits<double>::infinity(); /**< largest output of this move */
};

/** What the law asks for in one tick. */
struct PivOutput {
  double desired_counts_per_s = 0.0; /**< before bounds and rate limit; its sign may be against the travel */
  double counts_per_s = 0.0;         /**< in the direction of travel, or zero */
};

/** Proportional on position, integral and velocity terms on speed, with anti-windup. */
class PivController {
 public:
  /** Refused for gains, speeds and rates that are no numbers or beyond where they mean something. */
  static ControlResult<PivController> create(const PivRules& rules) noexcept;

  /** The output of this tick. After an error, which means zero drive, the controller begins anew. */
  ControlResult<PivOutput> update(const PivInput& input) noexcept;

  /** Begins anew: no integral, from zero output. For when the axis is not driven. */
  void reset() noexcept;

  [[nodiscard]] double integral_counts_per_s() const noexcept { return integral_; }

 private:
  explicit PivController(const PivRules& rules) noexcept : rules_(rules) {}

  void turn(int direction) noexcept;
  [[nodiscard]] double held(double desired, const PivInput& input) const noexcept;
  void integrate(double error, double desired, double elapsed_s, double bound) noexcept;

  PivRules rules_;
  int direction_ = 1;
  double integral_ = 0.0;
  double output_ = 0.0;
};

}  // namespace interlock
