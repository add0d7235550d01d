#include <algorithm>

#include "kinematics/kinematics.hpp"
#include "robot/readers.hpp"

namespace interlock {
namespace {

std::span<const Joint> joints_of(const Robot& robot) {
  return robot.kinematics ? robot.kinematics->joints() : std::span<const Joint>();
}

std::string role_names(const Robot& robot) {
  std::string names;
  for (const Joint& joint : joints_of(robot)) {
    names += (names.empty() ? "" : ", ") + std::string(joint.role);
  }
  return names;
}

TargetingLimits read_targeting(TableReader table) {
  constexpr double widest_mm = 1000.0;
  TargetingLimits limits;
  limits.tolerance_mm = table.number_between("tolerance_mm", 0.01, 100.0);
  limits.tolerance_deg = table.number_between("tolerance_deg", 0.01, 90.0);
  TableReader region = table.table("registration");
  ExpectedRegistration& expected = limits.registration;
  expected.origin_mm = region.point_mm("origin_mm");
  expected.origin_tolerance_mm = region.point_mm("origin_tolerance_mm");
  if (std::ranges::any_of(expected.origin_tolerance_mm,
                          [](double mm) { return !(mm > 0.0 && mm <= widest_mm); })) {
    region.refuse_given("origin_tolerance_mm", "a tolerance is out of range", "three numbers from 0 to 1000");
  }
  std::ranges::copy(region.numbers("rotation", expected.rotation.size()), expected.rotation.begin());
  const auto& r = expected.rotation;
  if (!pose_from({r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, r[6], r[7], r[8], 0, 0, 0, 0, 1})) {
    region.refuse("rotation", "it is no rotation", "R^T R = 1 within 0.000001, determinant 1, row by row");
  }
  expected.rotation_tolerance_deg = region.number_between("rotation_tolerance_deg", 0.1, 180.0);
  region.refuse_unknown_keys();
  table.refuse_unknown_keys();
  return limits;
}

}  // namespace

void read_kinematics(TableReader& root, Robot& robot, std::span<const KinematicsFamily> families) {
  if (!root.has("kinematics")) {
    return;
  }
  TableReader table = root.table("kinematics");
  const ReadKinematics read = table.choice("family", families);
  robot.family = table.text("family");
  robot.kinematics = read(table);
  if (table.has("calibration_mm")) {
    robot.calibration_mm = table.number_between("calibration_mm", 0.0, 100.0);
  }
  table.refuse_unknown_keys();
  TableReader probe = root.table("probe");
  robot.probe.treatment_to_tip_mm = probe.offset_mm("treatment_to_tip_mm");
  robot.probe.robot_to_entry_mm = probe.offset_mm("robot_to_entry_mm");
  robot.probe.cannula_to_treatment_mm = probe.offset_mm("cannula_to_treatment_mm");
  robot.probe.treatment_to_robot_at_home_mm = probe.offset_mm("treatment_to_robot_at_home_mm");
  probe.refuse_unknown_keys();
  robot.targeting = read_targeting(root.table("targeting"));
}

std::string read_role(TableReader& axis, const Robot& robot, const std::string& axis_name, Unit unit) {
  const bool is_given = axis.has("role");
  std::string name = is_given ? axis.text("role") : axis_name;
  const auto joint = std::ranges::find(joints_of(robot), name, &Joint::role);
  if (joint == joints_of(robot).end()) {
    if (is_given && robot.kinematics) {
      axis.refuse("role", '"' + name + "\" is no role of " + robot.family, "one of " + role_names(robot));
    } else if (is_given) {
      axis.refuse("role", '"' + name + "\" is given, but the robot has no kinematics",
                  "a [kinematics] table, or no role");
    }
    return "";
  }
  if (const Axis* const other = robot.with_role(name)) {
    axis.refuse("role", '"' + other->name + "\" plays \"" + name + "\" already", "each role once");
  } else if (unit != joint->unit) {
    axis.refuse("role", '"' + name + "\" needs an axis in " + std::string(unit_name(joint->unit)),
                "a role for an axis in " + std::string(unit_name(unit)) + ", or another unit");
  }
  return name;
}

void refuse_unplayed_roles(TableReader& table, const Robot& robot) {
  for (const Joint& joint : joints_of(robot)) {
    if (!robot.with_role(joint.role)) {
      table.refuse("kinematics", "no axis plays \"" + std::string(joint.role) + '"',
                   "one axis for each role: " + role_names(robot));
    }
  }
}

}  // namespace interlock
