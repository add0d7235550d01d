/** @file A family that no code knows: a rail that turns, and a tool that slides on it. All of it is here. */
#include <cmath>

#include "kinematics/accepted.hpp"
#include "kinematics/joints.hpp"
#include "kinematics/path.hpp"

namespace interlock {
namespace {

struct PolarJoints {
  double turn_rad = 0.0;
  double reach_mm = 0.0;
};

constexpr std::array<JointField<PolarJoints>, 2> fields{{
    {{"turn", "turn_rad", Unit::rad, angle_limit_rad}, &PolarJoints::turn_rad},
    {{"reach", "reach_mm", Unit::mm, length_limit_mm}, &PolarJoints::reach_mm},
}};

class Polar final : public Kinematics {
 public:
  explicit Polar(double height_mm) : height_mm_(height_mm) {}

  std::span<const Joint> joints() const noexcept override {
    static constexpr auto list = joints_of(fields);
    return list;
  }
  KinematicsResult<KinematicsPtr> with_probe(const ProbeOffsets& /*probe*/) const override {
    return std::make_shared<const Polar>(*this);
  }
  KinematicsResult<Pose> zframe_from_treatment(std::span<const double> positions) const override {
    const PolarJoints joints = named(fields, positions);
    return check_joints(fields, joints).map([&] {
      Pose pose = Pose::Identity();
      pose.linear() = rotation_z(joints.turn_rad) * rotation_y(std::numbers::pi / 2.0);
      pose.translation() = joints.reach_mm * pose.linear().col(2) + height_mm_ * Eigen::Vector3d::UnitZ();
      return pose;
    });
  }
  KinematicsResult<Jacobian> jacobian(std::span<const double> positions) const override {
    return zframe_from_treatment(positions).map([&](const Pose& pose) {
      const Eigen::Vector3d along = pose.linear().col(2);
      Jacobian jacobian = Jacobian::Zero(6, 2);
      jacobian.col(0) << positions[1] * Eigen::Vector3d::UnitZ().cross(along), Eigen::Vector3d::UnitZ();
      jacobian.col(1).head<3>() = along;
      return jacobian;
    });
  }
  KinematicsResult<std::vector<double>> positions_for(const Eigen::Vector3d& entry,
                                                      const Eigen::Vector3d& target,
                                                      double /*rotation_rad*/) const override {
    return path_length_mm(entry, target)
        .and_then([&](double) {
          return check_geometry("target_z_mm", target.z(), height_mm_, height_mm_,
                                KinematicsError::Code::out_of_reach);
        })
        .map([&] {
          return std::vector{std::atan2(target.y(), target.x()), std::hypot(target.x(), target.y())};
        });
  }
  KinematicsResult<std::vector<double>> positions_for(
      const Pose& zframe_from_treatment, const std::optional<Eigen::Vector3d>& entry) const override {
    return check_on_axis(zframe_from_treatment, entry).and_then([&] {
      const Eigen::Vector3d target = zframe_from_treatment.translation();
      return positions_for(target - zframe_from_treatment.linear().col(2), target, 0.0);
    });
  }
  KinematicsResult<RobotBody> zframe_body(std::span<const double> positions) const override {
    return zframe_from_treatment(positions).map([&](const Pose& pose) {
      return RobotBody{{"probe", height_mm_ * Eigen::Vector3d::UnitZ(), pose.translation()}};
    });
  }
  std::optional<double> depth_mm(std::span<const double> /*positions*/) const override {
    return std::nullopt;
  }
  std::vector<CalibratedNumber> calibrated() const override { return calibrated_lengths({"height_mm"}); }
  std::span<const SliderPair> slider_pairs() const noexcept override { return {}; }

 private:
  double height_mm_;
};

}  // namespace

KinematicsPtr read_polar(TableReader& table) {
  return std::make_shared<const Polar>(table.offset_mm("height_mm"));
}

}  // namespace interlock
