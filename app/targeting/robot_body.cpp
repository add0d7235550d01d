#include "targeting/robot_body.hpp"

#include <algorithm>
#include <cmath>

namespace interlock {
namespace {

using Eigen::Vector3d;

/** Height of the plate above the sliders; forward kinematics has accepted the separation. */
double rise_of(double side_link_mm, double overhang_mm) {
  return std::sqrt(std::max(0.0, side_link_mm * side_link_mm - overhang_mm * overhang_mm));
}

/** The line of the needle, by the distance from the front pivot's foot on it. */
struct NeedleLine {
  Vector3d foot_mm;
  Vector3d along;

  [[nodiscard]] Vector3d at(double length_mm) const { return foot_mm + along * length_mm; }
};

/** A pair of sliders, `left_mm` and `right_mm` along x, and what it carries at `z_mm`; gives its pivot. */
Vector3d add_stage(RobotBody& body, const ProstateTrapezoids& geometry, double left_mm, double right_mm,
                   double z_mm) {
  const double half_plate = geometry.top_width_mm / 2.0;
  const double centre = (left_mm + right_mm) / 2.0;
  const double lower = geometry.lower_height_mm;
  const double plate = lower + rise_of(geometry.side_link_mm, (left_mm - right_mm) / 2.0 - half_plate);
  const auto at = [z_mm](double x, double y) { return Vector3d(x, y, z_mm); };
  const Vector3d pivot = at(centre, plate + geometry.upper_height_mm);
  body.push_back({"rail", at(right_mm, 0.0), at(left_mm, 0.0)});
  body.push_back({"slider", at(left_mm, 0.0), at(left_mm, lower)});
  body.push_back({"slider", at(right_mm, 0.0), at(right_mm, lower)});
  body.push_back({"link", at(left_mm, lower), at(centre + half_plate, plate)});
  body.push_back({"link", at(right_mm, lower), at(centre - half_plate, plate)});
  body.push_back({"plate", at(centre - half_plate, plate), at(centre + half_plate, plate)});
  body.push_back({"arm", at(centre, plate), pivot});
  return pivot;
}

}  // namespace

KinematicsResult<RobotBody> body_of(const NeuroKinematics& kinematics, const NeuroRcm& geometry,
                                    const ProbeOffsets& probe, const NeuroJoints& joints) {
  return kinematics.zframe_from_rcm(joints).map([&](const Pose& zframe_from_rcm) {
    const Vector3d rcm = zframe_from_rcm.translation();
    const double separation = geometry.home_separation_mm + joints.head_mm - joints.feet_mm;
    const double half_plate = geometry.top_width_mm / 2.0;
    const double rail_y = rcm.y() - rise_of(geometry.side_link_mm, separation / 2.0 - half_plate);
    const double base_x = geometry.home_rcm_mm[0];
    const Vector3d head(base_x, rail_y, rcm.z() + separation / 2.0);
    const Vector3d feet(base_x, rail_y, rcm.z() - separation / 2.0);
    const Vector3d plate_head(base_x, rcm.y(), rcm.z() + half_plate);
    const Vector3d plate_feet(base_x, rcm.y(), rcm.z() - half_plate);
    const auto along_probe = [&](double mm) -> Vector3d { return zframe_from_rcm * Vector3d(0.0, 0.0, mm); };
    const double driver = -geometry.driver_to_rcm_mm;
    const double back = joints.insertion_mm + driver;
    const double treatment = back + probe.treatment_to_robot_at_home_mm;
    return RobotBody{
        {"rail", feet, head},
        {"link", head, plate_head},
        {"link", feet, plate_feet},
        {"plate", plate_feet, plate_head},
        {"lateral", Vector3d(base_x, rcm.y(), rcm.z()), rcm},
        {"arm", rcm, along_probe(driver)},
        {"guide", along_probe(driver), along_probe(driver + probe.robot_to_entry_mm)},
        {"probe", along_probe(back), along_probe(treatment + probe.treatment_to_tip_mm)},
    };
  });
}

KinematicsResult<RobotBody> body_of(const ProstateKinematics& kinematics, const ProstateTrapezoids& geometry,
                                    const ProstateJoints& joints) {
  return kinematics.base_from_needle_guide(joints).map([&](const Pose& base_from_guide) {
    const double front_z = -geometry.front_pivot_offset_mm;
    RobotBody body;
    const Vector3d front = add_stage(body, geometry, joints.front_left_mm, joints.front_right_mm, front_z);
    const Vector3d back = add_stage(body, geometry, joints.back_left_mm, joints.back_right_mm,
                                    front_z - geometry.stage_distance_mm);
    const NeedleLine needle{base_from_guide * Vector3d(0.0, 0.0, -geometry.needle_guide_mm),
                            base_from_guide.linear().col(2)};
    body.push_back({"carrier", back, front});
    body.push_back({"guide", needle.at(0.0), needle.at(geometry.needle_guide_mm)});
    body.push_back(
        {"probe", needle.at(joints.insertion_mm), needle.at(geometry.needle_tip_mm + joints.insertion_mm)});
    return body;
  });
}

}  // namespace interlock
