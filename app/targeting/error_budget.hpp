/**
 * @file
 * How far treatment point and tip may be from where a motion is meant to put them, and what contributes how
 * much.
 *
 * The error is where the point is less where it is meant to be, in the scanner's RAS frame, mm. To first
 * order it is a sum of independent parts of mean zero, each with a covariance:
 *
 *     encoder       J D Jᵀ; an axis rests anywhere within deadband + 1/2 count of its setpoint: variance
 *                   (deadband + 1/2)²/3 counts²
 *     play          J D Jᵀ; the tool is anywhere from where the encoder is to q counts beyond it: second
 *                   moment q²/3 counts². An axis with room to come from below (`Axis::take_up_counts`) loses
 *                   its play p but for what it may settle back: q = min(p, deadband + 1/2). Otherwise it may
 *                   come from above, and the tool is off by p each time: p²
 *     registration  σ²/N I + Σₖ wₖ vₖvₖᵀ + 2 wₖ² uₖuₖᵀ; about the principal axes aₖ of the N fiducials
 *                   wₖ = σ²/(N fₖ²), fₖ their root mean square distance from aₖ; vₖ = aₖ × r, r from their
 *                   centroid to the point; uₖ = aₖ × vₖ, along which a turn bends the way to second order
 *     calibration   s² I, s as the robot's file states it
 *     image         as whoever sets the target states it
 *
 * The trace of the registration's part is, to first order, the TRE² of J. M. Fitzpatrick, J. B. West, C. R.
 * Maurer: Predicting error in rigid-body point-based registration, IEEE Trans. Med. Imaging 17(5), 1998. The
 * error of a fiducial is the same in all directions: 3σ² = FRE² N/(N - 2), by the residual FRE.
 *
 * J carries the motion of the axes to the point: the Jacobian of the treatment point, at the tip with its
 * lever. The parts are taken for Gaussian when the ellipsoid is drawn. Bending of the needle, drag of tissue,
 * breathing and motion of the patient are in none of them.
 */
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "targeting/robot_kinematics.hpp"

namespace interlock {

/** How well a registration fits the points by which it was found. */
struct RegistrationFit {
  double residual_mm = 0.0;                  /**< FRE: root mean square over the fiducials */
  std::vector<Eigen::Vector3d> fiducials_mm; /**< in the scanner; three at least, not on one line */
};

/** What is stated of the images from which registration and target come; empty: nothing. */
struct ImageAccuracy {
  std::optional<RegistrationFit> registration;
  std::optional<Eigen::Matrix3d> target_mm2; /**< covariance of the target point, RAS */
};

/** Where a point is with a probability of 95 %. */
struct ErrorEllipsoid {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero(); /**< where the motion is meant to put it */
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d half_axes_mm = Eigen::Vector3d::Zero();   /**< the longest first */
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity(); /**< of the half axes: unit vectors, columns */
};

/** What one source contributes: half the width of its own ellipsoid in the direction of the longest half axis
 * of all. Their squares add up to the square of that half axis. */
struct ErrorContribution {
  std::string_view source; /**< "registration" */
  double treatment_mm = 0.0;
  double tip_mm = 0.0;
  std::string_view not_stated; /**< why it counts as nothing; empty: it counts */
};

/** All of it: of the treatment point, and of the tip A beyond it. */
struct ErrorBudget {
  ErrorEllipsoid treatment;
  ErrorEllipsoid tip;
  std::array<ErrorContribution, 5> contributions; /**< in the order above, the registration first */
};

/**
 * With the axes at `positions`. SINGULAR where the pose is near a singular one, the fiducials lie nearly on a
 * line, or a turn of the registration has a deviation of more than 0.25 rad; else an error of forward
 * kinematics, or OUT_OF_RANGE with fewer than three fiducials.
 */
KinematicsResult<ErrorBudget> error_budget_of(const Robot& robot, const RobotKinematics& kinematics,
                                              const Pose& scanner_from_zframe, const AxisPositions& positions,
                                              const ImageAccuracy& accuracy);

}  // namespace interlock
