/**
 * @file
 * Cooperative insertion: the harder the hand presses, the faster the needle goes in; never past its setpoint.
 *
 *     speed = gain (force - deadband),   0 to `fastest_mm_s`,   at most `approach_per_s` times what is left
 *
 * The law is a proposal: what the published system did is not public.
 */
#pragma once

#include "kinematics/kinematics_error.hpp"

namespace interlock {

struct CooperativeParameters {
  double deadband_n = 1.0;  /**< a hand at rest */
  double gain_mm_s_n = 1.0; /**< mm/s for each newton above that */
  double fastest_mm_s = 5.0;
  double approach_per_s = 10.0; /**< how steeply the needle slows before its setpoint */
};

/** Nothing, when all is finite and no number is negative. */
KinematicsResult<void> check_cooperative(const CooperativeParameters& parameters) noexcept;

/**
 * Speed of insertion, mm/s. @param hand_force_n of the hand on the input sensor, positive towards the patient
 * @param pedal pressed; without it the needle stands
 * @param left_mm from here to the setpoint; the needle stands from there on
 */
KinematicsResult<double> cooperative_speed(const CooperativeParameters& parameters, double hand_force_n,
                                           bool pedal, double left_mm) noexcept;

}  // namespace interlock
