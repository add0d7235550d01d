/**
 * @file
 * Where the target is, from images of it: a Kalman filter of a point that may wander.
 */
#pragma once

#include <Eigen/Core>

#include "kinematics/kinematics_error.hpp"
#include "steering/innovation_watch.hpp"

namespace interlock {

/** Standard deviations of each coordinate, but for the last. */
struct TargetBelief {
  double shift_sd_mm = 6.0; /**< of the target from where it was planned: published shifts go up to 10 mm */
  double wander_mm = 0.05;  /**< in a second, growing with its root */
  double image_sd_mm = 0.5;
  double farthest_mm = 30.0; /**< from where it was planned; an image beyond shows something else */
};

/** Follows a target through late, noisy images. */
class TargetFilter {
 public:
  /** The target was planned at `target_mm` in the guide frame, and is believed to be there at `time_s`. */
  static KinematicsResult<TargetFilter> create(const TargetBelief& belief, const Eigen::Vector3d& target_mm,
                                               double time_s) noexcept;

  /** An image of that time, which is not before the last one, shows the target; on an error it counts for
   * nothing. */
  KinematicsResult<void> see(double time_s, const Eigen::Vector3d& target_mm) noexcept;

  [[nodiscard]] const Eigen::Vector3d& target_mm() const noexcept { return target_mm_; }

  /** Whether the target has moved more than it is believed to: then it is looked for anew, and the newest
   * images have not agreed on its place yet. */
  [[nodiscard]] bool images_disagree() const noexcept { return watch_.disagrees(); }

 private:
  TargetFilter(const TargetBelief& belief, const Eigen::Vector3d& target_mm, double time_s) noexcept;

  TargetBelief belief_;
  Eigen::Vector3d planned_mm_;
  Eigen::Vector3d target_mm_;
  double variance_mm2_;
  double time_s_;
  InnovationWatch watch_;
};

}  // namespace interlock
