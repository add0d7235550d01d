/** @file Random joints within the robots' ranges, and distances between results. */
#pragma once

#include <random>

#include "kinematics/neuro_rcm/neuro_kinematics.hpp"
#include "kinematics/pose.hpp"
#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"

namespace interlock::test {

/** Within the published axis ranges; the trapezoid's separation within its window. */
NeuroJoints random_neuro_joints(std::mt19937_64& generator);

/** Within the published axis ranges; both separations within their window. Angles may be too steep. */
ProstateJoints random_prostate_joints(std::mt19937_64& generator);

/** Random rotation and translation within `reach_mm`. */
Pose random_pose(std::mt19937_64& generator, double reach_mm);

/** Largest difference of any joint, mm or rad. */
double distance(const NeuroJoints& left, const NeuroJoints& right);
double distance(const ProstateJoints& left, const ProstateJoints& right);

/** Largest difference of any entry of the matrices. */
double distance(const Pose& left, const Pose& right);

}  // namespace interlock::test
