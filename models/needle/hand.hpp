/**
 * @file
 * The hand that presses on the force sensor: steady in the mean, with a slow sway, a tremor and pauses.
 */
#ifndef INTERLOCK_NEEDLE_HAND_HPP
#define INTERLOCK_NEEDLE_HAND_HPP

#include "needle/noise.hpp"

namespace interlock::needle {

struct HandParameters {
  double lightest_n = 3.0; /**< each hand presses with its own force, evenly between these */
  double hardest_n = 6.0;
  double sway_share = 0.15; /**< of that force, */
  double sway_hz = 0.4;
  double tremor_n = 0.1;
  double tremor_hz = 9.0;
  double seconds_to_pause = 12.0; /**< mean; the hand then lets go, */
  double shortest_pause_s = 0.5;
  double longest_pause_s = 1.5;
  double lag_s = 0.1; /**< of letting go and pressing again */
};

class Hand {
 public:
  Hand(const HandParameters& parameters, const Noise& noise);

  /** One period later; force on the sensor, N. */
  double press(double period_s);

 private:
  HandParameters parameters_;
  Noise noise_;
  double usual_n_;
  double sway_rad_;
  double tremor_rad_;
  double time_s_ = 0.0;
  double pause_until_s_ = 0.0;
  double share_ = 0.0; /**< 0 let go, 1 pressing */
};

}  // namespace interlock::needle

#endif
