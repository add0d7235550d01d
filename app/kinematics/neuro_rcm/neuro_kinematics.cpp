#include "kinematics/neuro_rcm/neuro_kinematics.hpp"

#include <cmath>

namespace interlock {

using Code = KinematicsError::Code;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr TrapezoidNames stage_names{"separation_mm", "rise_mm"};

/** Rotation of the RCM frame in the zFrame at yaw = pitch = 0. It is its own inverse. */
Matrix3d home_rotation() noexcept { return (Matrix3d() << -1, 0, 0, 0, 0, -1, 0, -1, 0).finished(); }

Matrix3d rotation_of(const NeuroJoints& joints) noexcept {
  return home_rotation() * rotation_x(joints.yaw_rad) * rotation_y(joints.pitch_rad) *
         rotation_z(joints.probe_rotation_rad);
}

/** Nothing, when an approach (unit vector in the RCM frame at home) tells yaw and pitch. */
KinematicsResult<void> check_not_singular(const Vector3d& approach) noexcept {
  return check_range("cos_pitch", std::hypot(approach.y(), approach.z()), smallest_cos_pitch,
                     1.0 + boundary_slack, Code::singular);
}

double pitch_of(const Vector3d& approach) noexcept {
  return std::atan2(approach.x(), std::hypot(approach.y(), approach.z()));
}

double yaw_of(const Vector3d& approach) noexcept { return std::atan2(-approach.y(), approach.z()); }

}  // namespace

NeuroKinematics::NeuroKinematics(const NeuroRcm& geometry, const ProbeOffsets& probe,
                                 const Trapezoid& trapezoid, double home_rise_mm) noexcept
    : geometry_(geometry),
      probe_(probe),
      trapezoid_(trapezoid),
      home_rise_mm_(home_rise_mm),
      pairs_{{{"head", "feet", geometry.home_separation_mm, geometry.min_separation_mm,
               geometry.max_separation_mm}}} {}

KinematicsResult<NeuroKinematics> NeuroKinematics::create(const NeuroRcm& geometry,
                                                          const ProbeOffsets& probe) noexcept {
  return check_lengths({{"driver_to_rcm_mm", geometry.driver_to_rcm_mm},
                        {"home_rcm_mm.x", geometry.home_rcm_mm[0]},
                        {"home_rcm_mm.y", geometry.home_rcm_mm[1]},
                        {"home_rcm_mm.z", geometry.home_rcm_mm[2]},
                        {"robot_to_entry_mm", probe.robot_to_entry_mm},
                        {"treatment_to_robot_at_home_mm", probe.treatment_to_robot_at_home_mm}})
      .and_then([&] {
        return Trapezoid::create({geometry.side_link_mm, geometry.top_width_mm, geometry.min_separation_mm,
                                  geometry.max_separation_mm});
      })
      .and_then([&](const Trapezoid& trapezoid) {
        return trapezoid.rise_mm(geometry.home_separation_mm, {"home_separation_mm", "home_rise_mm"})
            .map([&](double home_rise_mm) {
              return NeuroKinematics(geometry, probe, trapezoid, home_rise_mm);
            });
      });
}

KinematicsResult<Pose> NeuroKinematics::zframe_from_treatment(const NeuroJoints& joints) const noexcept {
  return pose_along_probe(
      joints, joints.insertion_mm + probe_.treatment_to_robot_at_home_mm - geometry_.driver_to_rcm_mm);
}

KinematicsResult<Pose> NeuroKinematics::zframe_from_entry(const NeuroJoints& joints) const noexcept {
  return pose_along_probe(joints, probe_.robot_to_entry_mm - geometry_.driver_to_rcm_mm);
}

KinematicsResult<Pose> NeuroKinematics::zframe_from_rcm(const NeuroJoints& joints) const noexcept {
  return pose_along_probe(joints, 0.0);
}

KinematicsResult<Pose> NeuroKinematics::pose_along_probe(const NeuroJoints& joints,
                                                         double offset_mm) const noexcept {
  return check_joints(neuro_joint_fields, joints)
      .and_then([&] {
        return trapezoid_.rise_mm(geometry_.home_separation_mm + joints.head_mm - joints.feet_mm,
                                  stage_names);
      })
      .map([&](double rise_mm) {
        const Vector3d rcm(geometry_.home_rcm_mm[0] + joints.lateral_mm,
                           geometry_.home_rcm_mm[1] + rise_mm - home_rise_mm_,
                           geometry_.home_rcm_mm[2] + (joints.head_mm + joints.feet_mm) / 2.0);
        Pose pose = Pose::Identity();
        pose.linear() = rotation_of(joints);
        pose.translation() = rcm + offset_mm * pose.linear().col(2);
        return pose;
      });
}

KinematicsResult<NeuroJoints> NeuroKinematics::joints_for(const Eigen::Vector3d& entry,
                                                          const Eigen::Vector3d& target,
                                                          double probe_rotation_rad) const noexcept {
  return path_length_mm(entry, target).and_then([&](double length_mm) {
    const Vector3d approach = home_rotation() * (target - entry) / length_mm;
    return check_not_singular(approach).and_then([&] {
      return solve({probe_rotation_rad, pitch_of(approach), yaw_of(approach)}, target,
                   length_mm - probe_.treatment_to_robot_at_home_mm + probe_.robot_to_entry_mm);
    });
  });
}

KinematicsResult<NeuroJoints> NeuroKinematics::joints_for(const Pose& zframe_from_treatment,
                                                          const Eigen::Vector3d& entry) const noexcept {
  return check_on_axis(zframe_from_treatment, entry).and_then([&] {
    const Vector3d ahead = zframe_from_treatment.translation() - entry;
    return joints_at_insertion(zframe_from_treatment, ahead.dot(zframe_from_treatment.linear().col(2)) -
                                                          probe_.treatment_to_robot_at_home_mm +
                                                          probe_.robot_to_entry_mm);
  });
}

KinematicsResult<NeuroJoints> NeuroKinematics::joints_at_insertion(const Pose& zframe_from_treatment,
                                                                   double insertion_mm) const noexcept {
  return check_rigid(zframe_from_treatment).and_then([&] {
    const Matrix3d rotation = home_rotation() * zframe_from_treatment.linear();
    const Vector3d approach = rotation.col(2);
    return check_not_singular(approach).and_then([&] {
      const double probe_rotation_rad = std::atan2(-rotation(0, 1), rotation(0, 0));
      return solve({probe_rotation_rad, pitch_of(approach), yaw_of(approach)},
                   zframe_from_treatment.translation(), insertion_mm);
    });
  });
}

KinematicsResult<NeuroJoints> NeuroKinematics::solve(const Angles& angles, const Vector3d& target,
                                                     double insertion_mm) const noexcept {
  NeuroJoints joints;
  joints.insertion_mm = insertion_mm;
  joints.probe_rotation_rad = angles.probe_rotation_rad;
  joints.pitch_rad = angles.pitch_rad;
  joints.yaw_rad = angles.yaw_rad;
  const double rcm_to_treatment_mm =
      insertion_mm + probe_.treatment_to_robot_at_home_mm - geometry_.driver_to_rcm_mm;
  return check_joints(neuro_joint_fields, joints)
      .and_then([&] {
        const Vector3d rcm_home(geometry_.home_rcm_mm[0], geometry_.home_rcm_mm[1], geometry_.home_rcm_mm[2]);
        const Vector3d shift = target - rcm_to_treatment_mm * rotation_of(joints).col(2) - rcm_home;
        return trapezoid_.separation_mm(shift.y() + home_rise_mm_, stage_names)
            .map([&](double separation_mm) {
              const double opening_mm = separation_mm - geometry_.home_separation_mm;
              joints.lateral_mm = shift.x();
              joints.head_mm = shift.z() + opening_mm / 2.0;
              joints.feet_mm = shift.z() - opening_mm / 2.0;
            });
      })
      .and_then([&] { return check_joints(neuro_joint_fields, joints); })
      .map([&] { return joints; });
}

KinematicsResult<NeuroJacobian> NeuroKinematics::jacobian(const NeuroJoints& joints) const noexcept {
  return zframe_from_treatment(joints).map([&](const Pose& pose) {
    const double slope = trapezoid_.slope(geometry_.home_separation_mm + joints.head_mm - joints.feet_mm);
    const Vector3d axis = pose.linear().col(2);
    const Vector3d pitch_axis = home_rotation() * rotation_x(joints.yaw_rad) * Vector3d::UnitY();
    const Vector3d yaw_axis = home_rotation() * Vector3d::UnitX();
    const Vector3d rcm_to_treatment =
        (joints.insertion_mm + probe_.treatment_to_robot_at_home_mm - geometry_.driver_to_rcm_mm) * axis;
    NeuroJacobian jacobian = NeuroJacobian::Zero();
    jacobian.col(0).head<3>() << 0.0, slope, 0.5;
    jacobian.col(1).head<3>() << 0.0, -slope, 0.5;
    jacobian.col(2).head<3>() = Vector3d::UnitX();
    jacobian.col(3).head<3>() = axis;
    jacobian.col(4).tail<3>() = axis;
    jacobian.col(5) << pitch_axis.cross(rcm_to_treatment), pitch_axis;
    jacobian.col(6) << yaw_axis.cross(rcm_to_treatment), yaw_axis;
    return jacobian;
  });
}

}  // namespace interlock
