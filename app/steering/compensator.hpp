/**
 * @file
 * Active compensation: as the needle goes in, plans anew how to turn it so that its tip meets the target.
 *
 * Each step moves the estimated tip by what the axes did, looks at the target from there, and chooses the
 * wanted rotation and CURV's alpha by the circle that leads to it. Images correct tip, curvature and target.
 * Nothing here pushes the needle: that is the hand's, who is told how far there is to go.
 */
#pragma once

#include <optional>

#include "steering/curv_law.hpp"
#include "steering/steering_target.hpp"
#include "steering/sweep.hpp"
#include "steering/target_filter.hpp"
#include "steering/tip_estimator.hpp"

namespace interlock {

/** How alpha follows from the curvature. */
enum class ShareRule {
  averaged,  /**< by the law's own average and the estimated curvature of this needle */
  published, /**< by the published fit, which knows one needle alone */
};

/** What the compensator is made from. */
struct CompensatorParameters {
  CurvParameters curv{};
  TipBelief tip{};
  TargetBelief target{};
  ShareRule share_rule = ShareRule::averaged;
  double commit_mm = 2.0;   /**< the last plan stands from there to the target: it is too late to bend */
  double miss_mm = 1.0;     /**< a target that the needle can come so close to counts as reachable */
  double arrived_mm = 0.05; /**< ahead of the tip, at which the needle is there */
};

/** Positions of the two axes by their encoders. */
struct NeedleAxes {
  double time_s = 0.0;
  double insertion_mm = 0.0; /**< 0 where the tip is at the origin of the guide frame */
  double rotation_rad = 0.0; /**< 0 where the bevel bends the path towards -y of the guide frame */
};

/** What an image showed, in the guide frame. */
struct NeedleImage {
  double time_s = 0.0; /**< of its exposure */
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> target_mm; /**< nothing where the image does not show the target */
};

/** What the rotation has to do now. */
struct SteeringCommand {
  double rotation_rad_s = 0.0;       /**< speed for the rotation axis; 0 once arrived */
  double desired_rotation_rad = 0.0; /**< theta_d, within [0, 2 pi) */
  double alpha = 0.0;
  double expected_miss_mm = 0.0;      /**< that even the largest curvature leaves */
  bool reachable = true;              /**< false: the needle bends as far as it can and will still miss */
  double insertion_setpoint_mm = 0.0; /**< at which the tip meets the target's depth */
  bool arrived = false;               /**< stays so */
};

/** Turns the needle such that its tip ends at the target. */
class Compensator {
 public:
  /** @param axes where the axes are at the needle's contact with the tissue
   *  @param target_mm as planned, in the guide frame and ahead */
  static KinematicsResult<Compensator> create(const CompensatorParameters& parameters, const NeedleAxes& axes,
                                              const Eigen::Vector3d& target_mm);

  /**
   * One control period. A needle that was withdrawn a little bends nothing until it is as deep again; it may
   * turn meanwhile. On an error the caller stops the needle.
   */
  KinematicsResult<SteeringCommand> step(const NeedleAxes& axes) noexcept;

  /** An image has arrived; images come in the order of their exposures. A refused one counts for nothing. */
  KinematicsResult<void> see(const NeedleImage& image) noexcept;

  [[nodiscard]] const TipEstimate& tip() const noexcept { return tip_.now(); }
  [[nodiscard]] const Eigen::Vector3d& target_mm() const noexcept { return target_.target_mm(); }

  /** Whether the newest images of tip or target contradict what is believed of them: where the needle is, and
   * where it has to go, is not known well enough to push it on. */
  [[nodiscard]] bool images_disagree() const noexcept {
    return tip_.images_disagree() || target_.images_disagree();
  }

 private:
  Compensator(const CompensatorParameters& parameters, const NeedleAxes& axes, const CurvLaw& law,
              TipEstimator tip, const TargetFilter& target);

  [[nodiscard]] KinematicsResult<SteeringCommand> planned(const SteeringTarget& target,
                                                          const NeedleAxes& axes) const noexcept;
  [[nodiscard]] KinematicsResult<SteeringCommand> command(const NeedleAxes& axes) const noexcept;

  CompensatorParameters parameters_;
  CurvLaw law_;
  TipEstimator tip_;
  TargetFilter target_;
  Sweep sweep_;
  double deepest_mm_;
  double rotation_rad_;
  SteeringCommand last_;
};

}  // namespace interlock
