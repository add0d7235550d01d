#include "kinematics/workspace.hpp"

#include <random>

namespace interlock {

namespace {

/** Between both ends. The standard's distributions may differ between libraries; this one does not. */
double draw(std::mt19937_64& generator, double lowest, double highest) {
  constexpr double unit = 0x1p-53;
  const double share = static_cast<double>(generator() >> 11U) * unit;
  return lowest + share * (highest - lowest);
}

template <typename Fields, typename Joints>
KinematicsResult<void> check_joint_range(const Fields& fields, const JointRange<Joints>& range) {
  const auto checked = check_joints(fields, range.lowest);
  if (!checked) {
    return checked;
  }
  for (const JointField<Joints>& field : fields) {
    const auto ordered =
        check_range(field.quantity, range.highest.*field.position, range.lowest.*field.position, field.limit);
    if (!ordered) {
      return ordered;
    }
  }
  return {};
}

template <typename Fields, typename Joints, typename Forward>
KinematicsResult<Workspace<Joints>> sample(const Fields& fields, const Forward& forward,
                                           const JointRange<Joints>& range, std::size_t count,
                                           std::uint64_t seed) {
  const auto sound = check_joint_range(fields, range).and_then([&] {
    return check_range("sample_count", static_cast<double>(count), 0.0,
                       static_cast<double>(largest_sample_count));
  });
  if (!sound) {
    return tl::unexpected(sound.error());
  }
  std::mt19937_64 generator(seed);
  Workspace<Joints> workspace;
  for (std::size_t number = 0; number < count; ++number) {
    Joints joints;
    for (const JointField<Joints>& field : fields) {
      joints.*field.position = draw(generator, range.lowest.*field.position, range.highest.*field.position);
    }
    const KinematicsResult<Pose> pose = forward(joints);
    if (pose) {
      workspace.samples.push_back({joints, pose->translation(), pose->linear().col(2)});
      workspace.bounds.extend(workspace.samples.back().position_mm);
    } else {
      ++workspace.refused;
    }
  }
  return workspace;
}

}  // namespace

KinematicsResult<Workspace<NeuroJoints>> sample_workspace(const NeuroKinematics& kinematics,
                                                          const JointRange<NeuroJoints>& range,
                                                          std::size_t count, std::uint64_t seed) {
  const auto forward = [&](const NeuroJoints& joints) { return kinematics.zframe_from_treatment(joints); };
  return sample(neuro_joint_fields, forward, range, count, seed);
}

KinematicsResult<Workspace<ProstateJoints>> sample_workspace(const ProstateKinematics& kinematics,
                                                             const JointRange<ProstateJoints>& range,
                                                             std::size_t count, std::uint64_t seed) {
  const auto forward = [&](const ProstateJoints& joints) { return kinematics.base_from_tip(joints); };
  return sample(prostate_joint_fields, forward, range, count, seed);
}

}  // namespace interlock
