/** @file Both robots as the project's files describe them; the reference values were computed for these. */
#pragma once

#include <string>

#include "kinematics/neuro_rcm/neuro_kinematics.hpp"
#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"
#include "robot/robot_file.hpp"

namespace interlock::test {

inline constexpr double degree = std::numbers::pi / 180.0;

/** The project's robot file. */
inline const Robot& robot_named(const std::string& name) {
  static const Robot neuro = load_robot(INTERLOCK_ROBOTS "/neuro.toml").value();
  static const Robot prostate = load_robot(INTERLOCK_ROBOTS "/prostate.toml").value();
  return name == neuro.name ? neuro : prostate;
}

/** The calibration of the thesis. */
inline NeuroRcm neuro_geometry() {
  return dynamic_cast<const NeuroKinematics&>(*robot_named("neuro").kinematics).geometry();
}

inline ProbeOffsets neuro_probe() { return robot_named("neuro").probe; }

inline NeuroKinematics neuro() { return NeuroKinematics::create(neuro_geometry(), neuro_probe()).value(); }

/** Of the project's robot file: the angulated robot with its 18G needle. */
inline ProstateTrapezoids prostate_geometry() {
  return dynamic_cast<const ProstateKinematics&>(*robot_named("prostate").kinematics).geometry();
}

/** The robot of the thesis: the needle stays parallel to z. */
inline ProstateTrapezoids thesis_prostate_geometry() {
  ProstateTrapezoids geometry = prostate_geometry();
  geometry.needle_tip_mm = 259.075;
  geometry.front_pivot_offset_mm = 0.0;
  geometry.max_angulation_rad = 0.0;
  return geometry;
}

inline ProstateKinematics prostate() { return ProstateKinematics::create(prostate_geometry()).value(); }

}  // namespace interlock::test
