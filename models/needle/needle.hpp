/**
 * @file
 * A flexible needle with a bevelled tip in tissue: it goes where its bevel pushes it.
 *
 * The tip has a way ahead and, square to it, a direction in which tissue bends its path to a circle. Turning
 * the needle turns that direction; the shaft follows the tip. This is written without the app's tip model: a
 * turn by halves before and after a piece of circle.
 *
 * Guide frame: origin at the planned entry, z ahead; at rotation 0 the bevel bends the path towards -y.
 */
#ifndef INTERLOCK_NEEDLE_NEEDLE_HPP
#define INTERLOCK_NEEDLE_NEEDLE_HPP

#include <Eigen/Core>

#include "needle/noise.hpp"

namespace interlock::needle {

struct NeedleParameters {
  double curvature_per_mm = 0.0041; /**< of the circle without rotation */
  double bevel_rad = 0.0;           /**< angle of the bevel when the encoder says 0 */
  double torsion_play_rad = 0.0;    /**< by which hub and tip may differ before the tip turns, either way */
  double windup_rad_per_mm =
      0.0; /**< and as much more for each mm in tissue, whose friction winds the shaft */
  Eigen::Vector2d entry_mm{0.0, 0.0}; /**< where it really enters, x and y */
  Eigen::Vector2d tilt_rad{0.0, 0.0}; /**< slope of its way ahead there, towards x and y */
  double wander_rad = 0.0; /**< by which tissue turns the way ahead, normal, about x and y alike: after a
                              millimetre, growing with the root of the depth */
  double lag_s = 0.005;    /**< of both axes' speeds, as in models/plant/prostate.toml */
  double insertion_counts_per_mm = 1666.67; /**< published motor table */
  double rotation_counts_per_rad = 265.27;  /**< published motor table */
};

class Needle {
 public:
  Needle(const NeedleParameters& parameters, const Noise& noise);

  /** One period: the axes' speeds follow what is wanted; an insertion below 0 leaves the tip where it is. */
  void advance(double wanted_insertion_mm_s, double wanted_rotation_rad_s, double period_s);

  /** The axes have moved the needle: so far ahead, not below 0, while it turned by so much. */
  void move(double way_mm, double turned_rad);

  const Eigen::Vector3d& tip_mm() const { return tip_mm_; }
  const Eigen::Vector3d& ahead() const { return ahead_; }
  double insertion_mm() const { return insertion_mm_; }
  double insertion_mm_s() const { return insertion_mm_s_; }

  /** What the encoders say, in whole counts. */
  double seen_insertion_mm() const;
  double seen_rotation_rad() const;

 private:
  void turn(double angle_rad);
  void go(double way_mm);
  void wander(double way_mm);
  void point(const Eigen::Vector3d& ahead);

  NeedleParameters parameters_;
  Noise noise_;
  double wound_rad_ = 0.0; /**< hub ahead of the tip */
  Eigen::Vector3d tip_mm_;
  Eigen::Vector3d ahead_;
  Eigen::Vector3d bend_;
  double insertion_mm_ = 0.0;
  double rotation_rad_ = 0.0;
  double insertion_mm_s_ = 0.0;
  double rotation_rad_s_ = 0.0;
};

}  // namespace interlock::needle

#endif
