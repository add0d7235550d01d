/**
 * @file
 * Joint positions of both robots, in the sense and sign of the published motor tables, and what programs need
 * to know about each joint.
 */
#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <string_view>

#include "kinematics/domain.hpp"
#include "robot/unit.hpp"

namespace interlock {

/** Joints of the NeuroRobot. */
struct NeuroJoints {
  double head_mm = 0.0; /**< axial slider on the side of the head */
  double feet_mm = 0.0; /**< axial slider on the side of the feet */
  double lateral_mm = 0.0;
  double insertion_mm = 0.0;
  double probe_rotation_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;

  bool operator==(const NeuroJoints&) const = default;
};

/** Joints of the prostate robot. Left is positive x; home is at +150 and -150 mm. */
struct ProstateJoints {
  double front_left_mm = 0.0;
  double front_right_mm = 0.0;
  double back_left_mm = 0.0;
  double back_right_mm = 0.0;
  double insertion_mm = 0.0;
  double rotation_rad = 0.0; /**< of the needle about its axis; turns beyond a full one count */

  bool operator==(const ProstateJoints&) const = default;
};

/** One joint: the role of the axis that moves it, and its geometric domain, which is wider than the axis'
 * soft limits. */
template <typename Joints>
struct JointField {
  std::string_view role;     /**< of its axis in the robot file: "probe_rotation" */
  std::string_view quantity; /**< name in errors: "probe_rotation_rad" */
  double Joints::* position;
  Unit unit;
  double limit; /**< the position lies within plus and minus this */
};

/** In the order of the columns of the Jacobian. */
inline constexpr std::array<JointField<NeuroJoints>, 7> neuro_joint_fields{{
    {"head", "head_mm", &NeuroJoints::head_mm, Unit::mm, length_limit_mm},
    {"feet", "feet_mm", &NeuroJoints::feet_mm, Unit::mm, length_limit_mm},
    {"lateral", "lateral_mm", &NeuroJoints::lateral_mm, Unit::mm, length_limit_mm},
    {"insertion", "insertion_mm", &NeuroJoints::insertion_mm, Unit::mm, length_limit_mm},
    {"probe_rotation", "probe_rotation_rad", &NeuroJoints::probe_rotation_rad, Unit::rad, angle_limit_rad},
    {"pitch", "pitch_rad", &NeuroJoints::pitch_rad, Unit::rad, std::numbers::pi / 2},
    {"yaw", "yaw_rad", &NeuroJoints::yaw_rad, Unit::rad, std::numbers::pi},
}};

/** In the order of the columns of the Jacobian. */
inline constexpr std::array<JointField<ProstateJoints>, 6> prostate_joint_fields{{
    {"front_left", "front_left_mm", &ProstateJoints::front_left_mm, Unit::mm, length_limit_mm},
    {"front_right", "front_right_mm", &ProstateJoints::front_right_mm, Unit::mm, length_limit_mm},
    {"back_left", "back_left_mm", &ProstateJoints::back_left_mm, Unit::mm, length_limit_mm},
    {"back_right", "back_right_mm", &ProstateJoints::back_right_mm, Unit::mm, length_limit_mm},
    {"insertion", "insertion_mm", &ProstateJoints::insertion_mm, Unit::mm, length_limit_mm},
    {"rotation", "rotation_rad", &ProstateJoints::rotation_rad, Unit::rad, angle_limit_rad},
}};

/** Nothing, when every joint is finite and within its limit; else the first that is not. */
template <typename Joints, std::size_t count>
KinematicsResult<void> check_joints(const std::array<JointField<Joints>, count>& fields,
                                    const Joints& joints) noexcept {
  for (const JointField<Joints>& field : fields) {
    const auto checked = check_range(field.quantity, joints.*field.position, -field.limit, field.limit);
    if (!checked) {
      return checked;
    }
  }
  return {};
}

}  // namespace interlock
