/**
 * @file
 * Where a robot gets to: random joints within given ranges, and where each of them puts the tool.
 *
 * The same seed gives the same samples on every machine. Each of the `count` draws is tried once: joints that
 * geometry refuses are counted, not drawn anew, so that the work is bounded and the share of refused joints
 * is a result.
 */
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kinematics/neuro_kinematics.hpp"
#include "kinematics/prostate_kinematics.hpp"

namespace interlock {

/** Most draws of one call. */
inline constexpr std::size_t largest_sample_count = 1'000'000;

/** Ends of the positions to draw from, joint by joint. */
template <typename Joints>
struct JointRange {
  Joints lowest;
  Joints highest;
};

/** Joints and what they do. */
template <typename Joints>
struct WorkspaceSample {
  Joints joints;
  Eigen::Vector3d position_mm; /**< of the tool in the robot's frame */
  Eigen::Vector3d approach;    /**< unit vector of its advance */
};

/** What random joints reach. */
template <typename Joints>
struct Workspace {
  std::vector<WorkspaceSample<Joints>> samples;
  std::size_t refused = 0;    /**< draws that geometry does not allow */
  Eigen::AlignedBox3d bounds; /**< around all positions; `isEmpty()` when there is none */
};

/**
 * Draws `count` joints, at most `largest_sample_count`. Positions are of the treatment point in the zFrame.
 * OUT_OF_RANGE names the joint whose range is upside down or beyond its domain.
 */
KinematicsResult<Workspace<NeuroJoints>> sample_workspace(const NeuroKinematics& kinematics,
                                                          const JointRange<NeuroJoints>& range,
                                                          std::size_t count, std::uint64_t seed);

/** The same for the prostate robot; positions are of the needle tip in the base frame. */
KinematicsResult<Workspace<ProstateJoints>> sample_workspace(const ProstateKinematics& kinematics,
                                                             const JointRange<ProstateJoints>& range,
                                                             std::size_t count, std::uint64_t seed);

}  // namespace interlock
