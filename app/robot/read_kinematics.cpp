#include "robot/read_kinematics.hpp"

#include <algorithm>

namespace interlock {
namespace {

constexpr double farthest_mm = 1000.0;

double read_length(TableReader& table, std::string_view key) {
  return table.number_between(key, 0.001, farthest_mm);
}

/** A length that may be nothing, or lie on the other side. */
double read_offset(TableReader& table, std::string_view key) {
  return table.number_between(key, -farthest_mm, farthest_mm);
}

PointMm read_point(TableReader& table, std::string_view key) {
  const std::vector<double> point = table.numbers(key, 3);
  return {point[0], point[1], point[2]};
}

NeuroRcm read_neuro(TableReader& table) {
  NeuroRcm neuro;
  neuro.side_link_mm = read_length(table, "side_link_mm");
  neuro.top_width_mm = read_length(table, "top_width_mm");
  const double widest_mm = neuro.top_width_mm + 2.0 * neuro.side_link_mm;
  neuro.min_separation_mm = table.number_between("min_separation_mm", neuro.top_width_mm, widest_mm);
  neuro.max_separation_mm = table.number_between("max_separation_mm", neuro.min_separation_mm, widest_mm);
  neuro.home_separation_mm =
      table.number_between("home_separation_mm", neuro.min_separation_mm, neuro.max_separation_mm);
  neuro.driver_to_rcm_mm = read_length(table, "driver_to_rcm_mm");
  neuro.home_rcm_mm = read_point(table, "home_rcm_mm");
  return neuro;
}

ProstateTrapezoids read_prostate(TableReader& table) {
  constexpr double steepest_rad = 1.0;
  ProstateTrapezoids prostate;
  prostate.side_link_mm = read_length(table, "side_link_mm");
  prostate.top_width_mm = read_length(table, "top_width_mm");
  prostate.lower_height_mm = read_offset(table, "lower_height_mm");
  prostate.upper_height_mm = read_offset(table, "upper_height_mm");
  prostate.stage_distance_mm = read_length(table, "stage_distance_mm");
  prostate.needle_tip_mm = read_length(table, "needle_tip_mm");
  prostate.front_pivot_offset_mm = read_offset(table, "front_pivot_offset_mm");
  prostate.needle_height_mm = read_offset(table, "needle_height_mm");
  prostate.needle_guide_mm = read_length(table, "needle_guide_mm");
  prostate.base_to_zframe_mm = read_point(table, "base_to_zframe_mm");
  prostate.max_separation_mm = table.number_between("max_separation_mm", prostate.top_width_mm,
                                                    prostate.top_width_mm + 2.0 * prostate.side_link_mm);
  prostate.max_angulation_rad = table.number_between("max_angulation_rad", 0.0, steepest_rad);
  return prostate;
}

Kinematics read_family(TableReader& table) {
  using Read = Kinematics (*)(TableReader&);
  constexpr std::array<std::pair<std::string_view, Read>, 2> families{{
      {"neuro_rcm", [](TableReader& from) -> Kinematics { return read_neuro(from); }},
      {"prostate_trapezoids", [](TableReader& from) -> Kinematics { return read_prostate(from); }},
  }};
  return table.choice("family", families)(table);
}

std::string role_names(const Kinematics& kinematics) {
  std::string names;
  for (const KinematicRole& role : roles_of(kinematics)) {
    names += (names.empty() ? "" : ", ") + std::string(role.name);
  }
  return names;
}

}  // namespace

Kinematics read_kinematics(TableReader table) {
  Kinematics kinematics = read_family(table);
  table.refuse_unknown_keys();
  return kinematics;
}

ProbeOffsets read_probe(TableReader table) {
  ProbeOffsets probe;
  probe.treatment_to_tip_mm = read_offset(table, "treatment_to_tip_mm");
  probe.robot_to_entry_mm = read_offset(table, "robot_to_entry_mm");
  probe.cannula_to_treatment_mm = read_offset(table, "cannula_to_treatment_mm");
  probe.treatment_to_robot_at_home_mm = read_offset(table, "treatment_to_robot_at_home_mm");
  table.refuse_unknown_keys();
  return probe;
}

std::string read_role(TableReader& axis, const Robot& robot, Unit unit) {
  std::string name = axis.text("role");
  const std::span<const KinematicRole> roles = roles_of(robot.kinematics);
  const auto role = std::ranges::find(roles, name, &KinematicRole::name);
  if (role == roles.end()) {
    axis.refuse("role", '"' + name + "\" is no role of " + std::string(family_name(robot.kinematics)),
                "one of " + role_names(robot.kinematics));
  } else if (const Axis* const other = robot.with_role(name)) {
    axis.refuse("role", '"' + other->name + "\" plays \"" + name + "\" already", "each role once");
  } else if (unit != role->unit) {
    axis.refuse("role", '"' + name + "\" needs an axis in " + std::string(unit_name(role->unit)),
                "a role for an axis in " + std::string(unit_name(unit)) + ", or another unit");
  }
  return name;
}

void refuse_unplayed_roles(TableReader& table, const Robot& robot) {
  for (const KinematicRole& role : roles_of(robot.kinematics)) {
    if (!robot.with_role(role.name)) {
      table.refuse("kinematics", "no axis plays \"" + std::string(role.name) + '"',
                   "one axis for each role: " + role_names(robot.kinematics));
    }
  }
}

}  // namespace interlock
