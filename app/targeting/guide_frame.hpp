/**
 * @file
 * Where the needle of a robot that takes biopsies would touch the skin.
 */
#pragma once

#include "targeting/robot_kinematics.hpp"

namespace interlock {

/**
 * The guide frame (motion/biopsy_run.hpp) for axes at these positions: origin where the tip touches the skin,
 * z ahead, turned as the needle is at rotation 0. Insertion and rotation play no part. Of a robot with a
 * [biopsy] table; refused where the geometry of the other axes cannot be.
 */
KinematicsResult<Pose> zframe_from_guide(const Robot& robot, const RobotKinematics& kinematics,
                                         AxisPositions positions);

}  // namespace interlock
