/**
 * @file
 * The velocity profile of the thesis (Listing 11): one axis, from rest to rest.
 *
 * The velocity is a trapezoid over the way, not over time. With s the way travelled of L, and r the way of a
 * ramp:
 *
 *     v(s) = max(v_floor, v_peak s / r)         0 <= s <= r
 *     v(s) = v_peak                             r <= s <= L - r
 *     v(s) = v(L - s)                           L - r <= s <= L
 *
 * so that the axis starts at the floor, grows exponentially in time, and the answer at any time is a closed
 * form. Two things differ from the listing: the ramp down has the floor, too (without it the last count takes
 * for ever), and the acceleration has a limit. It is largest at the end of a ramp, v_peak² / r; where the
 * share of the way is too short for it the ramps grow, and in a short move they meet: the trapezoid is a
 * triangle of lower peak. A peak below the floor is the floor.
 *
 * Units are those of the axis (mm or rad) and seconds.
 */
#pragma once

#include "trajectory/piecewise_motion.hpp"
#include "trajectory/trajectory_error.hpp"

namespace interlock {

/** A smaller share of the way would be a jump. */
inline constexpr double smallest_ramp_share = 1e-3;

/** Bounds of the profile. */
struct TrapezoidRules {
  double cruise_velocity = 0.0;
  double max_acceleration = 0.0;
  double ramp_share = 0.3;     /**< of the way, for each ramp: `smallest_ramp_share` to 0.5, a triangle */
  double floor_velocity = 0.0; /**< at which the axis starts and arrives: at most the cruise velocity.
                                  The thesis: a twentieth of it */
};

/** A motion that speeds up, cruises and slows down. */
class TrapezoidProfile {
 public:
  /**
   * From one position to another, either way; equal ones give a profile that takes no time. Refused unless
   * positions are within `position_limit` and all rates from `smallest_rate` to `largest_rate`.
   */
  static TrajectoryResult<TrapezoidProfile> create(double from, double to, const TrapezoidRules& rules);

  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }

  /** Largest speed, not signed. */
  [[nodiscard]] double peak_velocity() const noexcept { return peak_; }

  /**
   * The state that long after the start: at rest at the start before 0 and for a time that is no number, at
   * rest exactly at the end from the duration on.
   */
  [[nodiscard]] MotionState at(double time_s) const noexcept;

 private:
  TrapezoidProfile(double from, double to, const TrapezoidRules& rules) noexcept;

  [[nodiscard]] MotionState first_half(double time_s) const noexcept;

  double from_;
  double to_;
  double way_;
  double floor_;
  double peak_;
  double ramp_;        /**< way of each ramp */
  double floor_end_s_; /**< when the floor ends */
  double ramp_end_s_;  /**< when the first ramp ends */
  double duration_s_;
};

}  // namespace interlock
