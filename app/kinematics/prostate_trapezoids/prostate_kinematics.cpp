#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"

#include <cmath>

namespace interlock {

using Code = KinematicsError::Code;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr TrapezoidNames front_names{"front_separation_mm", "front_rise_mm"};
constexpr TrapezoidNames back_names{"back_separation_mm", "back_rise_mm"};

Matrix3d rotation_of(double yaw_rad, double pitch_rad) noexcept {
  return rotation_y(yaw_rad) * rotation_x(pitch_rad);
}

}  // namespace

/** Both pivots as the sliders hold them, and the needle's direction. */
struct ProstateKinematics::Stages {
  double front_x_mm;
  double front_y_mm;
  double right_mm; /**< X_front - X_back */
  double lower_mm; /**< Y_back - Y_front */
  double span_mm;  /**< distance of the pivots, seen from above */
  Angles angles;
};

ProstateKinematics::ProstateKinematics(const ProstateTrapezoids& geometry,
                                       const Trapezoid& trapezoid) noexcept
    : geometry_(geometry),
      trapezoid_(trapezoid),
      pairs_{{{"back_left", "back_right", 0.0, trapezoid.lengths().min_separation_mm,
               trapezoid.lengths().max_separation_mm},
              {"front_left", "front_right", 0.0, trapezoid.lengths().min_separation_mm,
               trapezoid.lengths().max_separation_mm}}} {}

KinematicsResult<ProstateKinematics> ProstateKinematics::create(const ProstateTrapezoids& geometry) noexcept {
  return check_lengths({{"lower_height_mm", geometry.lower_height_mm},
                        {"upper_height_mm", geometry.upper_height_mm},
                        {"needle_tip_mm", geometry.needle_tip_mm},
                        {"front_pivot_offset_mm", geometry.front_pivot_offset_mm},
                        {"needle_height_mm", geometry.needle_height_mm},
                        {"needle_guide_mm", geometry.needle_guide_mm},
                        {"base_to_zframe_mm.x", geometry.base_to_zframe_mm[0]},
                        {"base_to_zframe_mm.y", geometry.base_to_zframe_mm[1]},
                        {"base_to_zframe_mm.z", geometry.base_to_zframe_mm[2]}})
      .and_then(
          [&] { return check_range("stage_distance_mm", geometry.stage_distance_mm, 1.0, length_limit_mm); })
      .and_then([&] {
        return check_range("max_angulation_rad", geometry.max_angulation_rad, 0.0, steepest_angulation_rad);
      })
      .and_then([&] {
        return Trapezoid::create({geometry.side_link_mm, geometry.top_width_mm,
                                  geometry.top_width_mm + dead_centre_clearance_mm,
                                  geometry.max_separation_mm});
      })
      .map([&](const Trapezoid& trapezoid) { return ProstateKinematics(geometry, trapezoid); });
}

KinematicsResult<void> ProstateKinematics::check_angles(const Angles& angles) const noexcept {
  const double limit = geometry_.max_angulation_rad;
  return check_geometry("needle_yaw_rad", angles.yaw_rad, -limit, limit, Code::out_of_range).and_then([&] {
    return check_geometry("needle_pitch_rad", angles.pitch_rad, -limit, limit, Code::out_of_range);
  });
}

KinematicsResult<ProstateKinematics::Stages> ProstateKinematics::stages(
    const ProstateJoints& joints) const noexcept {
  const auto checked = check_joints(prostate_joint_fields, joints);
  if (!checked) {
    return tl::unexpected(checked.error());
  }
  return trapezoid_.rise_mm(joints.front_left_mm - joints.front_right_mm, front_names)
      .and_then([&](double front_rise_mm) {
        return trapezoid_.rise_mm(joints.back_left_mm - joints.back_right_mm, back_names)
            .map([&](double back_rise_mm) {
              Stages stages{};
              stages.front_x_mm = (joints.front_left_mm + joints.front_right_mm) / 2.0;
              stages.front_y_mm = geometry_.lower_height_mm + geometry_.upper_height_mm + front_rise_mm;
              stages.right_mm = stages.front_x_mm - (joints.back_left_mm + joints.back_right_mm) / 2.0;
              stages.lower_mm = back_rise_mm - front_rise_mm;
              stages.span_mm = std::hypot(geometry_.stage_distance_mm, stages.right_mm);
              stages.angles = {std::atan2(stages.right_mm, geometry_.stage_distance_mm),
                               std::atan2(stages.lower_mm, stages.span_mm), joints.rotation_rad};
              return stages;
            });
      })
      .and_then(
          [&](const Stages& stages) { return check_angles(stages.angles).map([&] { return stages; }); });
}

Pose ProstateKinematics::pose_along_needle(const Stages& stages, double rotation_rad,
                                           double length_mm) const noexcept {
  const Matrix3d rotation = rotation_of(stages.angles.yaw_rad, stages.angles.pitch_rad);
  const Vector3d front(stages.front_x_mm, stages.front_y_mm, -geometry_.front_pivot_offset_mm);
  Pose pose = Pose::Identity();
  pose.linear() = rotation * rotation_z(rotation_rad);
  pose.translation() = front + rotation * Vector3d(0.0, geometry_.needle_height_mm, length_mm);
  return pose;
}

KinematicsResult<Pose> ProstateKinematics::base_from_tip(const ProstateJoints& joints) const noexcept {
  return stages(joints).map([&](const Stages& stages) {
    return pose_along_needle(stages, joints.rotation_rad, geometry_.needle_tip_mm + joints.insertion_mm);
  });
}

KinematicsResult<Pose> ProstateKinematics::base_from_needle_guide(
    const ProstateJoints& joints) const noexcept {
  return stages(joints).map(
      [&](const Stages& stages) { return pose_along_needle(stages, 0.0, geometry_.needle_guide_mm); });
}

KinematicsResult<ProstateJoints> ProstateKinematics::joints_for(const Pose& base_from_tip) const noexcept {
  return check_rigid(base_from_tip).and_then([&] {
    const Matrix3d rotation = base_from_tip.linear();
    const Angles angles{std::atan2(rotation(0, 2), rotation(2, 2)),
                        std::atan2(-rotation(1, 2), std::hypot(rotation(0, 2), rotation(2, 2))),
                        std::atan2(rotation(1, 0), rotation(1, 1))};
    return solve(angles, base_from_tip.translation());
  });
}

KinematicsResult<ProstateJoints> ProstateKinematics::joints_for(const Eigen::Vector3d& entry,
                                                                const Eigen::Vector3d& target,
                                                                double rotation_rad) const noexcept {
  return path_length_mm(entry, target).and_then([&](double length_mm) {
    const Vector3d approach = (target - entry) / length_mm;
    return solve({std::atan2(approach.x(), approach.z()),
                  std::atan2(-approach.y(), std::hypot(approach.x(), approach.z())), rotation_rad},
                 target);
  });
}

KinematicsResult<ProstateJoints> ProstateKinematics::joints_for(const Eigen::Vector3d& target,
                                                                double rotation_rad) const noexcept {
  return check_point({"target_x_mm", "target_y_mm", "target_z_mm"}, target).and_then([&] {
    return solve({0.0, 0.0, rotation_rad}, target);
  });
}

KinematicsResult<ProstateJoints> ProstateKinematics::solve(const Angles& angles,
                                                           const Vector3d& target) const noexcept {
  const auto checked = check_angles(angles);
  if (!checked) {
    return tl::unexpected(checked.error());
  }
  const double sin_yaw = std::sin(angles.yaw_rad);
  const double cos_yaw = std::cos(angles.yaw_rad);
  const double sin_pitch = std::sin(angles.pitch_rad);
  const double cos_pitch = std::cos(angles.pitch_rad);
  const double line = geometry_.needle_height_mm;
  const double length_mm =
      (target.z() + geometry_.front_pivot_offset_mm - line * sin_pitch * cos_yaw) / (cos_yaw * cos_pitch);
  const double front_x = target.x() - (length_mm * cos_pitch + line * sin_pitch) * sin_yaw;
  const double front_y = target.y() - line * cos_pitch + length_mm * sin_pitch;
  const double back_x = front_x - geometry_.stage_distance_mm * std::tan(angles.yaw_rad);
  const double back_y = front_y + geometry_.stage_distance_mm * std::tan(angles.pitch_rad) / cos_yaw;
  const double pivot_height_mm = geometry_.lower_height_mm + geometry_.upper_height_mm;
  return trapezoid_.separation_mm(front_y - pivot_height_mm, front_names)
      .and_then([&](double front_separation) {
        return trapezoid_.separation_mm(back_y - pivot_height_mm, back_names)
            .and_then([&](double back_separation) {
              const ProstateJoints joints{
                  .front_left_mm = front_x + front_separation / 2.0,
                  .front_right_mm = front_x - front_separation / 2.0,
                  .back_left_mm = back_x + back_separation / 2.0,
                  .back_right_mm = back_x - back_separation / 2.0,
                  .insertion_mm = length_mm - geometry_.needle_tip_mm,
                  .rotation_rad = angles.rotation_rad,
              };
              return check_joints(prostate_joint_fields, joints).map([&] { return joints; });
            });
      });
}

KinematicsResult<ProstateJacobian> ProstateKinematics::jacobian(const ProstateJoints& joints) const noexcept {
  return stages(joints).map([&](const Stages& stages) {
    const double distance = geometry_.stage_distance_mm;
    const double span2 = stages.span_mm * stages.span_mm;
    const double reach2 = span2 + stages.lower_mm * stages.lower_mm;
    const double yaw_by_right = distance / span2;
    const double pitch_by_right = -stages.lower_mm * stages.right_mm / (reach2 * stages.span_mm);
    const double pitch_by_lower = stages.span_mm / reach2;

    const Matrix3d rotation = rotation_of(stages.angles.yaw_rad, stages.angles.pitch_rad);
    const Vector3d front_to_tip =
        rotation * Vector3d(0.0, geometry_.needle_height_mm, geometry_.needle_tip_mm + joints.insertion_mm);
    const Vector3d yaw_axis = Vector3d::UnitY();
    const Vector3d pitch_axis = rotation.col(0);

    ProstateJacobian jacobian = ProstateJacobian::Zero();
    // A slider moves its pivot by `x` and `y`, and through it both angles: `side` is +1 at the front, -1 at
    // the back.
    const auto fill = [&](int column, double side, double x, double y) {
      const Vector3d turn = yaw_axis * (side * x * yaw_by_right) +
                            pitch_axis * (side * (x * pitch_by_right - y * pitch_by_lower));
      const Vector3d pivot = side > 0.0 ? Vector3d(x, y, 0.0) : Vector3d::Zero();
      jacobian.col(column) << pivot + turn.cross(front_to_tip), turn;
    };
    const double front_slope = trapezoid_.slope(joints.front_left_mm - joints.front_right_mm);
    const double back_slope = trapezoid_.slope(joints.back_left_mm - joints.back_right_mm);
    fill(0, 1.0, 0.5, front_slope);
    fill(1, 1.0, 0.5, -front_slope);
    fill(2, -1.0, 0.5, back_slope);
    fill(3, -1.0, 0.5, -back_slope);
    jacobian.col(4).head<3>() = rotation.col(2);
    jacobian.col(5).tail<3>() = rotation.col(2);
    return jacobian;
  });
}

}  // namespace interlock
