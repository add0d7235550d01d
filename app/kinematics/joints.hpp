/**
 * @file
 * Named joints of a family in closed form, between the structure that its equations use and the list that the
 * interface takes.
 */
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "kinematics/domain.hpp"
#include "kinematics/kinematics.hpp"

namespace interlock {

/** One joint, and where the structure keeps its position. */
template <typename Joints>
struct JointField : Joint {
  double Joints::* position;
};

/** The joints of the fields, as the interface shows them. */
template <typename Joints, std::size_t count>
constexpr std::array<Joint, count> joints_of(const std::array<JointField<Joints>, count>& fields) {
  std::array<Joint, count> joints{};
  for (std::size_t index = 0; index < count; ++index) {
    joints[index] = fields[index];
  }
  return joints;
}

/** The structure of a list of positions. */
template <typename Joints, std::size_t count>
Joints named(const std::array<JointField<Joints>, count>& fields, std::span<const double> positions) {
  Joints joints;
  for (std::size_t index = 0; index < count; ++index) {
    joints.*fields[index].position = positions[index];
  }
  return joints;
}

/** The list of positions of a structure. */
template <typename Joints, std::size_t count>
std::vector<double> listed(const std::array<JointField<Joints>, count>& fields, const Joints& joints) {
  std::vector<double> positions;
  for (const JointField<Joints>& field : fields) {
    positions.push_back(joints.*field.position);
  }
  return positions;
}

/** Nothing, when every joint is finite and within its limit; else the first that is not. */
template <typename Joints, std::size_t count>
KinematicsResult<void> check_joints(const std::array<JointField<Joints>, count>& fields,
                                    const Joints& joints) noexcept {
  for (const JointField<Joints>& field : fields) {
    const auto checked = check_range(field.quantity, joints.*field.position, -field.limit, field.limit);
    if (!checked) {
      return checked;
    }
  }
  return {};
}

}  // namespace interlock
