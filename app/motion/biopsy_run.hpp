/**
 * @file
 * One biopsy: what the network thread prepares and the control thread then carries out, and what it tells.
 *
 * Depths are along the needle from the skin. The guide frame has its origin where the tip touches the skin, z
 * ahead; at rotation 0 the bevel bends the path towards -y (steering/compensator.hpp).
 */
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "motion/task.hpp"
#include "robot/biopsy.hpp"
#include "steering/compensator.hpp"
#include "steering/cooperative_insertion.hpp"
#include "steering/force_calibration.hpp"
#include "steering/membrane_detector.hpp"

namespace interlock {

/**
 * The parts of a biopsy that remember. From the moment its task is approved the control thread alone touches
 * it.
 */
struct BiopsyRun {
  std::uint32_t start_tick = 0; /**< kernel tick of its time 0 */
  double entry_mm = 0.0;        /**< insertion at which the tip is at the skin */
  CooperativeParameters hand_law;
  ForceCalibration hand;
  ForceCalibration needle;
  Compensator compensator;
  MembraneDetector detector;
};

/** Where a biopsy begins. */
struct BiopsyStart {
  std::uint32_t tick = 0;    /**< of the kernel */
  double insertion_mm = 0.0; /**< positions of the axes then */
  double rotation_rad = 0.0;
  Eigen::Vector3d target_mm = Eigen::Vector3d::Zero();
  std::span<const double> membranes_mm; /**< that are expected, increasing */
};

/** Takes all the memory that the biopsy will ever need; or what of it steering cannot work with. */
KinematicsResult<BiopsyRun> make_biopsy_run(const Biopsy& biopsy, double period_s, const BiopsyStart& start,
                                            const ForceCalibration& hand, const ForceCalibration& needle);

/** An image for the biopsy of that task; ignored by any other one. */
struct SeenImage {
  std::uint32_t task = 0;
  NeedleImage image; /**< in the time of its run */
};

/** What the newest biopsy has found. */
struct BiopsyFindings {
  std::uint32_t task = 0;
  std::string_view quantity;                             /**< that steering could not work with; a literal */
  std::uint32_t membranes = 0;                           /**< found or skipped, of those it was given */
  std::array<double, Biopsy::most_membranes> found_mm{}; /**< depth of each; below 0: skipped */

  bool operator==(const BiopsyFindings&) const = default;
};

/** What the biopsy does now; of no meaning unless one is open. */
struct BiopsyNow {
  double depth_mm = 0.0;
  double speed_mm_s = 0.0;
  double left_mm = 0.0;        /**< to the target's depth */
  bool waits_for_hand = false; /**< the hand pressed when the pedal was pressed, and has to let go first */
  bool armed = false;          /**< looks for a membrane */
  bool rough = false;          /**< the tissue is too rough for that: none is found */
  bool cue = false;
  double desired_rotation_rad = 0.0;
  double alpha = 0.0;
  double curvature_per_mm = 0.0; /**< largest, as estimated */
  double expected_miss_mm = 0.0;
  bool reachable = true;
  double tip_sd_mm = 0.0;       /**< standard deviation of where the tip is, as believed, each coordinate */
  bool images_disagree = false; /**< the newest ones contradict what is believed; insertion waits */
  std::uint32_t images = 0;
  std::uint32_t images_refused = 0;
};

}  // namespace interlock
