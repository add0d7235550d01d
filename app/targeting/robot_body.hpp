/**
 * @file
 * What a robot looks like where its axes stand: straight parts between points, as long as the lengths of its
 * kinematics say, for pictures. Thickness is no part of the model.
 *
 * NeuroRobot (zFrame, mm): a rail along z with a slider towards the head and one towards the feet, two links
 * to a top plate, the lateral way to the remote centre of motion (RCM), the arm from there back to the needle
 * driver, the guide from the driver to the entry point, the probe. The model does not say how far the plate
 * is from the RCM across the probe; it is drawn at the height of the RCM.
 *
 * Prostate robot (base frame, mm): for either stage a rail along x, both sliders with their lower pivots, two
 * links, the top plate and the post up to the pivot of the needle driver; the carrier between both pivots,
 * the needle guide and the needle.
 */
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "kinematics/neuro_kinematics.hpp"
#include "kinematics/prostate_kinematics.hpp"

namespace interlock {

/** One straight part. */
struct BodyPart {
  std::string_view
      name; /**< "rail", "slider", "link", "plate", "lateral", "arm", "guide", "carrier", "probe" */
  Eigen::Vector3d from_mm;
  Eigen::Vector3d to_mm; /**< of guide and probe: the end that points at the patient */
};

/** All parts of a robot; the probe, or needle, is the last. */
using RobotBody = std::vector<BodyPart>;

/** In the zFrame. Refused where forward kinematics refuses the joints. */
KinematicsResult<RobotBody> body_of(const NeuroKinematics& kinematics, const NeuroRcm& geometry,
                                    const ProbeOffsets& probe, const NeuroJoints& joints);

/** In the base frame. */
KinematicsResult<RobotBody> body_of(const ProstateKinematics& kinematics, const ProstateTrapezoids& geometry,
                                    const ProstateJoints& joints);

}  // namespace interlock
