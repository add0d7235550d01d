/**
 * @file
 * "prostate_trapezoids" of a robot file: its keys, and its kinematics as the app knows them. The equations
 * are in the base frame, the interface in the zFrame, which stands in the base without a rotation.
 *
 * The body: for either stage a rail along x, both sliders with their lower pivots, two links, the top plate
 * and the post up to the pivot of the needle driver; the carrier between both pivots, the needle guide and
 * the needle.
 */
#include "kinematics/accepted.hpp"
#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"
#include "robot/table_reader.hpp"

namespace interlock {

using Eigen::Vector3d;

namespace {

Vector3d base_to_zframe(const ProstateTrapezoids& geometry) {
  return Vector3d(geometry.base_to_zframe_mm.data());
}

/** The line of the needle, by the distance from the front pivot's foot on it. */
struct NeedleLine {
  Vector3d foot_mm;
  Vector3d along;

  [[nodiscard]] Vector3d at(double length_mm) const { return foot_mm + along * length_mm; }
};

/** A pair of sliders, `left_mm` and `right_mm` along x, and what it carries at `z_mm`; gives its pivot.
 * Forward kinematics has accepted the separation. */
Vector3d add_stage(RobotBody& body, const ProstateTrapezoids& geometry, const Trapezoid& trapezoid,
                   double left_mm, double right_mm, double z_mm) {
  const double half_plate = geometry.top_width_mm / 2.0;
  const double centre = (left_mm + right_mm) / 2.0;
  const double lower = geometry.lower_height_mm;
  const double plate = lower + trapezoid.rise_mm(left_mm - right_mm, {}).value_or(0.0);
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

KinematicsPtr read_prostate_trapezoids(TableReader& table) {
  ProstateTrapezoids prostate;
  prostate.side_link_mm = table.length_mm("side_link_mm");
  prostate.top_width_mm = table.length_mm("top_width_mm");
  prostate.lower_height_mm = table.offset_mm("lower_height_mm");
  prostate.upper_height_mm = table.offset_mm("upper_height_mm");
  prostate.stage_distance_mm = table.length_mm("stage_distance_mm");
  prostate.needle_tip_mm = table.length_mm("needle_tip_mm");
  prostate.front_pivot_offset_mm = table.offset_mm("front_pivot_offset_mm");
  prostate.needle_height_mm = table.offset_mm("needle_height_mm");
  prostate.needle_guide_mm = table.length_mm("needle_guide_mm");
  prostate.base_to_zframe_mm = table.point_mm("base_to_zframe_mm");
  prostate.max_separation_mm = table.number_between("max_separation_mm", prostate.top_width_mm,
                                                    prostate.top_width_mm + 2.0 * prostate.side_link_mm);
  prostate.max_angulation_rad = table.number_between("max_angulation_rad", 0.0, steepest_angulation_rad);
  return accepted(table, ProstateKinematics::create(prostate));
}

std::vector<CalibratedNumber> ProstateKinematics::calibrated() const {
  return calibrated_lengths({"base_to_zframe_mm[0]", "base_to_zframe_mm[1]", "base_to_zframe_mm[2]",
                             "needle_tip_mm", "needle_height_mm", "stage_distance_mm", "side_link_mm",
                             "top_width_mm", "front_pivot_offset_mm", "upper_height_mm", "lower_height_mm"});
}

std::span<const Joint> ProstateKinematics::joints() const noexcept {
  static constexpr auto list = joints_of(prostate_joint_fields);
  return list;
}

/** The probe plays no part in the equations. */
KinematicsResult<KinematicsPtr> ProstateKinematics::with_probe(const ProbeOffsets& /*probe*/) const {
  return std::make_shared<const ProstateKinematics>(*this);
}

KinematicsResult<Pose> ProstateKinematics::zframe_from_treatment(std::span<const double> positions) const {
  return base_from_tip(named(prostate_joint_fields, positions)).map([&](Pose pose) {
    pose.pretranslate(-base_to_zframe(geometry_));
    return pose;
  });
}

KinematicsResult<Jacobian> ProstateKinematics::jacobian(std::span<const double> positions) const {
  return jacobian(named(prostate_joint_fields, positions)).map([](const ProstateJacobian& found) {
    return Jacobian(found);
  });
}

KinematicsResult<std::vector<double>> ProstateKinematics::positions_for(const Eigen::Vector3d& entry,
                                                                        const Eigen::Vector3d& target,
                                                                        double rotation_rad) const {
  const Vector3d shift = base_to_zframe(geometry_);
  return joints_for(entry + shift, target + shift, rotation_rad).map([](const ProstateJoints& joints) {
    return listed(prostate_joint_fields, joints);
  });
}

KinematicsResult<std::vector<double>> ProstateKinematics::positions_for(
    const Pose& zframe_from_treatment, const std::optional<Eigen::Vector3d>& entry) const {
  return check_on_axis(zframe_from_treatment, entry)
      .and_then([&] {
        Pose base_from_treatment = zframe_from_treatment;
        base_from_treatment.pretranslate(base_to_zframe(geometry_));
        return joints_for(base_from_treatment);
      })
      .map([](const ProstateJoints& joints) { return listed(prostate_joint_fields, joints); });
}

std::optional<double> ProstateKinematics::depth_mm(std::span<const double> /*positions*/) const {
  return std::nullopt;
}

KinematicsResult<RobotBody> ProstateKinematics::zframe_body(std::span<const double> positions) const {
  const ProstateJoints joints = named(prostate_joint_fields, positions);
  return base_from_needle_guide(joints).map([&](const Pose& base_from_guide) {
    const double front_z = -geometry_.front_pivot_offset_mm;
    RobotBody body;
    const Vector3d front =
        add_stage(body, geometry_, trapezoid_, joints.front_left_mm, joints.front_right_mm, front_z);
    const Vector3d back = add_stage(body, geometry_, trapezoid_, joints.back_left_mm, joints.back_right_mm,
                                    front_z - geometry_.stage_distance_mm);
    const NeedleLine needle{base_from_guide * Vector3d(0.0, 0.0, -geometry_.needle_guide_mm),
                            base_from_guide.linear().col(2)};
    body.push_back({"carrier", back, front});
    body.push_back({"guide", needle.at(0.0), needle.at(geometry_.needle_guide_mm)});
    body.push_back(
        {"probe", needle.at(joints.insertion_mm), needle.at(geometry_.needle_tip_mm + joints.insertion_mm)});
    for (BodyPart& part : body) {
      part.from_mm -= base_to_zframe(geometry_);
      part.to_mm -= base_to_zframe(geometry_);
    }
    return body;
  });
}

}  // namespace interlock
