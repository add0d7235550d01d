#include "kinematics/workspace.hpp"

#include <random>

#include "kinematics/domain.hpp"

namespace interlock {

namespace {

/** Between both ends. The standard's distributions may differ between libraries; this one does not. */
double draw(std::mt19937_64& generator, double lowest, double highest) {
  constexpr double unit = 0x1p-53;
  const double share = static_cast<double>(generator() >> 11U) * unit;
  return lowest + share * (highest - lowest);
}

KinematicsResult<void> check_ranges(std::span<const Joint> joints, std::span<const double> lowest,
                                    std::span<const double> highest) {
  for (std::size_t index = 0; index < joints.size(); ++index) {
    const Joint& joint = joints[index];
    const auto checked = check_range(joint.quantity, lowest[index], -joint.limit, joint.limit).and_then([&] {
      return check_range(joint.quantity, highest[index], lowest[index], joint.limit);
    });
    if (!checked) {
      return checked;
    }
  }
  return {};
}

}  // namespace

KinematicsResult<Workspace> sample_workspace(const Kinematics& kinematics, std::span<const double> lowest,
                                             std::span<const double> highest, std::size_t count,
                                             std::uint64_t seed) {
  const auto sound = check_ranges(kinematics.joints(), lowest, highest).and_then([&] {
    return check_range("sample_count", static_cast<double>(count), 0.0,
                       static_cast<double>(largest_sample_count));
  });
  if (!sound) {
    return tl::unexpected(sound.error());
  }
  std::mt19937_64 generator(seed);
  Workspace workspace;
  std::vector<double> positions(kinematics.joints().size());
  for (std::size_t number = 0; number < count; ++number) {
    for (std::size_t index = 0; index < positions.size(); ++index) {
      positions[index] = draw(generator, lowest[index], highest[index]);
    }
    if (const auto pose = kinematics.zframe_from_treatment(positions)) {
      workspace.zframe_mm.emplace_back(pose->translation());
      workspace.bounds.extend(workspace.zframe_mm.back());
    } else {
      ++workspace.refused;
    }
  }
  return workspace;
}

}  // namespace interlock
