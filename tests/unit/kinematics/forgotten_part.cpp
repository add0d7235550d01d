/** @file Must not compile: the family has no body for the 3D view. The test expects the compiler to name it.
 */
#include "kinematics/kinematics.hpp"

namespace interlock {

class Forgetful final : public Kinematics {
 public:
  using Positions = KinematicsResult<std::vector<double>>;

  std::span<const Joint> joints() const noexcept override { return {}; }
  KinematicsResult<KinematicsPtr> with_probe(const ProbeOffsets&) const override { return nullptr; }
  KinematicsResult<Pose> zframe_from_treatment(std::span<const double>) const override {
    return Pose::Identity();
  }
  KinematicsResult<Jacobian> jacobian(std::span<const double>) const override { return Jacobian(); }
  Positions positions_for(const Eigen::Vector3d&, const Eigen::Vector3d&, double) const override {
    return std::vector<double>();
  }
  Positions positions_for(const Pose&, const std::optional<Eigen::Vector3d>&) const override {
    return std::vector<double>();
  }
#ifdef INTERLOCK_WHOLE
  KinematicsResult<RobotBody> zframe_body(std::span<const double>) const override { return RobotBody(); }
#endif
  std::optional<double> depth_mm(std::span<const double>) const override { return std::nullopt; }
  std::vector<CalibratedNumber> calibrated() const override { return {}; }
  std::span<const SliderPair> slider_pairs() const noexcept override { return {}; }
};

KinematicsPtr read_forgetful(TableReader&);
KinematicsPtr read_forgetful(TableReader&) { return std::make_shared<const Forgetful>(); }

}  // namespace interlock
