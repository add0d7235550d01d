/**
 * @file
 * "neuro_rcm" of a robot file: its keys, and its kinematics as the app knows them.
 *
 * The body: a rail along z with a slider towards the head and one towards the feet, two links to a top plate,
 * the lateral way to the remote centre of motion (RCM), the arm from there back to the needle driver, the
 * guide from the driver to the entry point, the probe. The model does not say how far the plate is from the
 * RCM across the probe; it is drawn at the height of the RCM.
 */
#include "kinematics/accepted.hpp"
#include "kinematics/neuro_rcm/neuro_kinematics.hpp"
#include "robot/table_reader.hpp"

namespace interlock {

using Eigen::Vector3d;

KinematicsPtr read_neuro_rcm(TableReader& table) {
  NeuroRcm neuro;
  neuro.side_link_mm = table.length_mm("side_link_mm");
  neuro.top_width_mm = table.length_mm("top_width_mm");
  const double widest_mm = neuro.top_width_mm + 2.0 * neuro.side_link_mm;
  neuro.min_separation_mm = table.number_between("min_separation_mm", neuro.top_width_mm, widest_mm);
  neuro.max_separation_mm = table.number_between("max_separation_mm", neuro.min_separation_mm, widest_mm);
  neuro.home_separation_mm =
      table.number_between("home_separation_mm", neuro.min_separation_mm, neuro.max_separation_mm);
  neuro.driver_to_rcm_mm = table.length_mm("driver_to_rcm_mm");
  neuro.home_rcm_mm = table.point_mm("home_rcm_mm");
  return accepted(table, NeuroKinematics::create(neuro, {}));
}

std::span<const Joint> NeuroKinematics::joints() const noexcept {
  static constexpr auto list = joints_of(neuro_joint_fields);
  return list;
}

KinematicsResult<KinematicsPtr> NeuroKinematics::with_probe(const ProbeOffsets& probe) const {
  return create(geometry_, probe).map([](const NeuroKinematics& kinematics) -> KinematicsPtr {
    return std::make_shared<const NeuroKinematics>(kinematics);
  });
}

KinematicsResult<Pose> NeuroKinematics::zframe_from_treatment(std::span<const double> positions) const {
  return zframe_from_treatment(named(neuro_joint_fields, positions));
}

KinematicsResult<Jacobian> NeuroKinematics::jacobian(std::span<const double> positions) const {
  return jacobian(named(neuro_joint_fields, positions)).map([](const NeuroJacobian& found) {
    return Jacobian(found);
  });
}

KinematicsResult<std::vector<double>> NeuroKinematics::positions_for(const Eigen::Vector3d& entry,
                                                                     const Eigen::Vector3d& target,
                                                                     double rotation_rad) const {
  return joints_for(entry, target, rotation_rad).map([](const NeuroJoints& joints) {
    return listed(neuro_joint_fields, joints);
  });
}

KinematicsResult<std::vector<double>> NeuroKinematics::positions_for(
    const Pose& zframe_from_treatment, const std::optional<Eigen::Vector3d>& entry) const {
  const auto joints =
      entry ? joints_for(zframe_from_treatment, *entry) : joints_at_insertion(zframe_from_treatment, 0.0);
  return joints.map([](const NeuroJoints& found) { return listed(neuro_joint_fields, found); });
}

std::optional<double> NeuroKinematics::depth_mm(std::span<const double> positions) const {
  return named(neuro_joint_fields, positions).insertion_mm + probe_.treatment_to_robot_at_home_mm -
         probe_.robot_to_entry_mm;
}

std::vector<CalibratedNumber> NeuroKinematics::calibrated() const {
  return calibrated_lengths({"home_rcm_mm[0]", "home_rcm_mm[1]", "home_rcm_mm[2]", "driver_to_rcm_mm",
                             "home_separation_mm", "side_link_mm", "top_width_mm"});
}

KinematicsResult<RobotBody> NeuroKinematics::zframe_body(std::span<const double> positions) const {
  const NeuroJoints joints = named(neuro_joint_fields, positions);
  return zframe_from_rcm(joints).map([&](const Pose& pose) {
    const Vector3d rcm = pose.translation();
    const double separation = geometry_.home_separation_mm + joints.head_mm - joints.feet_mm;
    const double half_plate = geometry_.top_width_mm / 2.0;
    const double rail_y = rcm.y() - trapezoid_.rise_mm(separation, {}).value_or(0.0);
    const double base_x = geometry_.home_rcm_mm[0];
    const Vector3d head(base_x, rail_y, rcm.z() + separation / 2.0);
    const Vector3d feet(base_x, rail_y, rcm.z() - separation / 2.0);
    const Vector3d plate_head(base_x, rcm.y(), rcm.z() + half_plate);
    const Vector3d plate_feet(base_x, rcm.y(), rcm.z() - half_plate);
    const auto along_probe = [&](double mm) -> Vector3d { return pose * Vector3d(0.0, 0.0, mm); };
    const double driver = -geometry_.driver_to_rcm_mm;
    const double back = joints.insertion_mm + driver;
    const double treatment = back + probe_.treatment_to_robot_at_home_mm;
    return RobotBody{
        {"rail", feet, head},
        {"link", head, plate_head},
        {"link", feet, plate_feet},
        {"plate", plate_feet, plate_head},
        {"lateral", Vector3d(base_x, rcm.y(), rcm.z()), rcm},
        {"arm", rcm, along_probe(driver)},
        {"guide", along_probe(driver), along_probe(driver + probe_.robot_to_entry_mm)},
        {"probe", along_probe(back), along_probe(treatment + probe_.treatment_to_tip_mm)},
    };
  });
}

}  // namespace interlock
