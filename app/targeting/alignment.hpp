/**
 * @file
 * What a target asks of the axes, what they can do of it, and how far the two are apart.
 *
 * Poses and points are in the scanner's RAS frame, mm.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "targeting/error_budget.hpp"
#include "targeting/registration.hpp"
#include "targeting/robot_kinematics.hpp"

namespace interlock {

/** A straight way in. */
struct EntryTarget {
  Eigen::Vector3d entry = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  double rotation_rad = 0.0; /**< of the probe about its axis */
  ImageAccuracy accuracy = {};
};

/** The setpoint of one axis, within what the kernel accepts of it once homed. */
struct AxisSetpoint {
  std::uint32_t slot = 0;
  std::int32_t counts = 0;
  bool clamped = false; /**< the aim asked for more */
};

/** What an aim asks of the robot. */
struct Alignment {
  Pose desired;                        /**< of the treatment point, as the aim asks */
  std::vector<AxisSetpoint> setpoints; /**< of the axes with a role, in the order of the robot's axes */
  Pose reachable;                      /**< where the setpoints lead: whole counts, clamped */
  Eigen::Vector3d reachable_tip = Eigen::Vector3d::Zero(); /**< A beyond the reachable treatment point */
  Deviation deviation;                                     /**< of the reachable pose from the desired one */
  /** D + insertion - C, where that is a length; of a robot that goes through an entry point alone. */
  std::optional<double> cannula_length_mm;
  KinematicsResult<ErrorBudget> error_budget; /**< of the reachable pose, or why there is none */
};

/** Whether a pose that misses the desired one by that much may take its place. */
bool is_tolerable(const Deviation& deviation, double tolerance_mm, double tolerance_deg) noexcept;

/**
 * Aligns the robot with an aim. Desired and reachable differ by the rounding to counts, and where an axis is
 * clamped. Errors are those of the kinematics; SEPARATION also where the clamped sliders would leave their
 * window.
 */
KinematicsResult<Alignment> align(const Robot& robot, const RobotKinematics& kinematics,
                                  const Registration& registration, const EntryTarget& aim);

}  // namespace interlock
