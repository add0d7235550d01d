/**
 * @file
 * The workflows of the thesis (figures 33 and 35) on the simulated hardware, unattended: home, register by a
 * random rigid registration, and for each target
 *
 * - NeuroRobot: align with the probe out, insert, confirm by a scan, retract and go there once more when the
 *   scan shows it too far off, corrected by what the scans showed; then ablate through angles and depths;
 * - prostate robot: line up with the needle out, have a hand push the needle while compensation steers it and
 *   membranes are noticed, confirm by a scan;
 * - retract, and re-orient for the removal of who lies in the scanner, where the robot's file says how.
 *
 * With `targeting_only` nothing is treated and both robots insert as the NeuroRobot does: the experiments of
 * the thesis' tables.
 *
 * The scan is the true pose of the simulated robot, or the true tip of its needle in tissue, so that the
 * error is that of the robot: homing, counts, deadbands, play, the bending of the needle; if asked for, of
 * kinematics that are not those of its file, and of a registration by fiducials that were seen where they are
 * not. Points and errors are in the scanner's RAS frame, mm.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "robot/robot.hpp"
#include "robot_rig.hpp"
#include "targeting_errors.hpp"
#include "thesis_trials.hpp"

namespace interlock {

/** What the demonstration was asked for. */
struct DemoOptions {
  std::uint64_t seed = 1;             /**< of registration, plant and random targets */
  std::size_t random_targets = 10000; /**< reached by computation alone: setpoints in whole counts */
  std::size_t rounds = 1;             /**< how often each target of the table is visited */
  double tolerance_mm = 0.05;         /**< distance from the target at which an insertion stays */
  double fiducial_sd_mm = 0.0; /**< of where fiducials are seen, each coordinate; each round registers anew */
  std::optional<Robot> true_robot; /**< whose kinematics are the true ones; nothing: the robot's */
  bool scattered = false;      /**< axes with a switch start anywhere in the half of their range before it */
  bool targeting_only = false; /**< no ablation, no biopsy */
  double dwell_s = 2.0;        /**< of each step of an ablation */
};

/** An ablation as it was carried out. */
struct DemoAblation {
  std::size_t steps = 0;
  double time_s = 0.0; /**< simulated */
};

/** What became of one target. */
struct DemoTrial {
  std::size_t target = 0; /**< from 1, in the order of the table */
  Eigen::Vector3d desired;
  std::vector<Eigen::Vector3d> reached; /**< as the scan after each insertion shows it; the last one stays */
  Eigen::Vector3d thesis_error; /**< recomputed from the printed positions, in the frame of the table */
  double time_s = 0.0;          /**< simulated, from the first move to the last scan */
  std::string refused;          /**< why it was not tried; empty: it was */
  std::optional<DemoAblation> ablation;
  std::optional<NeedleInsertion> biopsy;
  double claimed_mm = 0.0; /**< longest half axis of the ellipsoid that was to hold 95 % of the first scans */
  bool within_claim = false; /**< the first scan, for that matter */

  [[nodiscard]] Eigen::Vector3d first_error() const { return reached.front() - desired; }
  [[nodiscard]] Eigen::Vector3d error() const { return reached.back() - desired; }
};

/** How far random targets are from what whole counts reach. */
struct RandomTargets {
  std::size_t tried = 0;
  std::size_t refused = 0; /**< by the geometry, or where an axis would have to go beyond its range */
  double rms_mm = 0.0;
  double worst_mm = 0.0;
};

/** How well axes followed their setpoints in the motions of the first round, by the readings, counts. */
struct Tracking {
  double squares = 0.0;
  std::size_t samples = 0;
  double worst_counts = 0.0;
};

/** What came of all trials. */
struct DemoReport {
  std::vector<DemoTrial> trials;
  double homing_counts = 0.0; /**< farthest that an axis with a switch was from where homing said, truly */
  std::vector<Tracking> tracking; /**< of each axis */
  ErrorDistribution first_scan;   /**< as all of these in the axes of the table */
  ErrorDistribution last_scan;
  ErrorDistribution thesis;
  RandomTargets random;
};

/** Who looks on. */
struct DemoAudience {
  /** Told what is done now, for people. */
  std::function<void(const std::string&)> progress;
  /** Shown each motion of the first round but the last one of a target, with a name for files:
   * "target-3-insertion-1". */
  std::function<void(const std::string&, const MotionRecord&)> motion;
};

/** Runs the workflow. A target that cannot be had is told in its trial; an error ends the demonstration. */
DemoResult<DemoReport> run_demo(const Robot& described, const plant::Parameters& parameters,
                                const DemoOptions& options, const DemoAudience& audience);

}  // namespace interlock
