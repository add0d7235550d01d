/**
 * @file
 * Numbers of a robot's kinematics from poses that were measured on it.
 *
 * The tool's pose by tracker is  F · K(q; p),  F the zFrame in the tracker's frame, K forward kinematics of
 * the positions q with the numbers p: those that the family names (`Kinematics::calibrated`) and the zero of
 * each axis with a switch. F (unless it is known) and p minimise the sum of squared misses of points and
 * directions, each by its standard deviation (Levenberg-Marquardt of Eigen). A deviation that nobody states
 * is estimated from the misses: sum of squares by degrees of freedom.
 *
 * With J the derivative of the normalised misses, (JᵀJ)⁻¹ is the covariance of F and p; it grows by
 * chi-square by degrees of freedom where that is above 1. An interval of 95 % is Student's t times the
 * deviation.
 *
 * A number is fitted when the poses leave every fitted one a deviation of at most half of its plausible
 * error; tried in the order of the family. Any other is held at the file's value, with the reason.
 *
 * Source of the model: B. W. Mooring, Z. S. Roth, M. R. Driels: Fundamentals of Manipulator Calibration,
 * 1991; of the deviations: any text on non-linear least squares.
 */
#pragma once

#include "calibration/pose_table.hpp"
#include "kinematics/pose.hpp"

namespace interlock {

/** How the poses were measured, and what must stay. */
struct CalibrationOptions {
  bool in_zframe = false;        /**< measured in the robot's zFrame; else in a frame to be found */
  std::optional<double> sd_mm;   /**< of a point along each coordinate, unless the table has it */
  std::optional<double> sd_rad;  /**< of a direction about each axis across it, likewise */
  std::vector<std::string> hold; /**< names of numbers that are not fitted */
};

/** A number that was fitted; in its unit of the file. */
struct FittedNumber {
  std::string name; /**< "kinematics.side_link_mm" */
  std::string unit; /**< "mm", "rad" or "counts" */
  double was = 0.0;
  double is = 0.0; /**< the file has six digits of it, or a whole count */
  double sd = 0.0;
  double interval_95 = 0.0; /**< half width */
};

/** A number that stays as the file has it. */
struct HeldNumber {
  std::string name;
  std::string why;
};

/** How far a measured pose is from the fitted kinematics. */
struct PoseMiss {
  std::uint32_t line = 0;
  double distance_mm = 0.0;
  double normalised = 0.0; /**< by the median of all, and by what the fit leaves it; 1: as usual */
  bool outlier = false;    /**< a Gaussian miss is as large once in 100,000 poses */
};

/** What came out. */
struct Calibration {
  std::vector<FittedNumber> fitted;
  std::vector<HeldNumber> held;
  std::vector<PoseMiss> misses; /**< of all poses, the largest normalised one first */
  Pose tracker_from_zframe = Pose::Identity();
  double was_rms_mm = 0.0;           /**< distance of points with the file's numbers and the best frame */
  double is_rms_mm = 0.0;            /**< with the fitted ones */
  std::optional<double> was_rms_rad; /**< of directions */
  std::optional<double> is_rms_rad;
  std::size_t degrees_of_freedom = 0;
  /** Where the poses do not go, for people: axes that hardly move in them, or move with others. Nothing that
   * was found is known there. */
  std::vector<std::string> gaps;
  double point_sd_mm = 0.0; /**< along each coordinate: misses by degrees of freedom */
  /** What the robot's file should state (error_budget.hpp): standard deviation of the treatment point along
   * each coordinate, at poses like those measured. Its square is the mean variance that the uncertainty of
   * frame and numbers leaves, and that of the misses, less the tracker's where that is stated. */
  double calibration_mm = 0.0;
  /** Text of the robot's file with `fitted` and `calibration_mm` in it. With the zero of an axis move its
   * soft limits and the setpoints of homing and draping, so that they stay where they are on the machine. */
  std::string changed_file;
};

/**
 * Fits the numbers of `robot`, which was read from `text`. `table` names the measured poses in errors.
 *
 * Refused: a robot without kinematics, a name in `hold` that no number has, too few poses (with the number
 * needed), poses that fix no frame, are a mirror image, or fit far better than the stated deviation, ones
 * from which a number cannot be changed by its plausible error within the domain of the kinematics, and a
 * table that the kinematics misses by more than 20 mm.
 */
tl::expected<Calibration, RobotError> calibrate(const Robot& robot, std::string_view text,
                                                const std::vector<MeasuredPose>& poses,
                                                const std::string& table, const CalibrationOptions& options);

}  // namespace interlock
