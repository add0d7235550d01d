/**
 * @file
 * What a robot file says about the robot's geometry: the family of its kinematics, the family's lengths, and
 * the role that each axis plays in it.
 *
 * These are plain numbers; what is computed from them is app/kinematics' business. Lengths are in mm, angles
 * in rad.
 */
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <variant>

#include "robot/unit.hpp"

namespace interlock {

/** x, y and z in mm. */
using PointMm = std::array<double, 3>;

/**
 * "neuro_rcm": a probe that turns about a remote centre of motion (RCM), which two sliders on one rail raise
 * and lower by a trapezoid linkage.
 */
struct NeuroRcm {
  double side_link_mm = 0.0;
  double top_width_mm = 0.0;
  double home_separation_mm = 0.0; /**< of the sliders, when head and feet stand at 0 */
  double driver_to_rcm_mm = 0.0;   /**< from the needle driver's reference point to the RCM */
  PointMm home_rcm_mm{};           /**< RCM in the z-frame, when all axes stand at 0 */
  double min_separation_mm = 0.0;  /**< smallest separation that the mechanism allows */
  double max_separation_mm = 0.0;  /**< largest one */

  bool operator==(const NeuroRcm&) const = default;
};

/**
 * "prostate_trapezoids": a needle guide on two trapezoid linkages, each raised and shifted by a pair of
 * sliders; the difference of the two angulates the needle.
 */
struct ProstateTrapezoids {
  double side_link_mm = 0.0;
  double top_width_mm = 0.0;
  double lower_height_mm = 0.0;       /**< from the rail to the lower pivots */
  double upper_height_mm = 0.0;       /**< from the upper pivots to the centre of the stage */
  double stage_distance_mm = 0.0;     /**< from the rear trapezoid to the front one */
  double needle_tip_mm = 0.0;         /**< from the front stage to the tip, when the insertion stands at 0 */
  double front_pivot_offset_mm = 0.0; /**< from the pivot to the centre of the front stage, along z */
  double needle_height_mm = 0.0;      /**< of the needle's line above the centre of the front stage */
  double needle_guide_mm = 0.0;       /**< from the front stage to the needle guide */
  PointMm base_to_zframe_mm{};        /**< translation of the z-frame in the robot's base */
  double max_separation_mm = 0.0;     /**< of the sliders of one pair */
  double max_angulation_rad = 0.0;    /**< of the needle, each way, about either axis */

  bool operator==(const ProstateTrapezoids&) const = default;
};

/** The parameters of the robot's family. */
using Kinematics = std::variant<NeuroRcm, ProstateTrapezoids>;

/** "neuro_rcm" or "prostate_trapezoids". */
std::string_view family_name(const Kinematics& kinematics);

/** A part that exactly one axis of the robot plays. */
struct KinematicRole {
  std::string_view name;
  Unit unit; /**< unit of its axis */
};

/** The roles of the family; each must have one axis. */
std::span<const KinematicRole> roles_of(const Kinematics& kinematics);

/** Offsets along the probe by which a target is reached, in mm; A to D of the thesis. */
struct ProbeOffsets {
  double treatment_to_tip_mm = 0.0;           /**< A */
  double robot_to_entry_mm = 0.0;             /**< B */
  double cannula_to_treatment_mm = 0.0;       /**< C */
  double treatment_to_robot_at_home_mm = 0.0; /**< D */

  bool operator==(const ProbeOffsets&) const = default;
};

}  // namespace interlock
