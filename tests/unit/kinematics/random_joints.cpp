#include "random_joints.hpp"

#include <algorithm>
#include <cmath>

namespace interlock::test {

namespace {

double between(std::mt19937_64& generator, double lowest, double highest) {
  return std::uniform_real_distribution<double>(lowest, highest)(generator);
}

template <typename Fields, typename Joints>
double largest_difference(const Fields& fields, const Joints& left, const Joints& right) {
  double largest = 0.0;
  for (const auto& field : fields) {
    largest = std::max(largest, std::abs(left.*field.position - right.*field.position));
  }
  return largest;
}

}  // namespace

NeuroJoints random_neuro_joints(std::mt19937_64& generator) {
  NeuroJoints joints;
  do {
    joints.head_mm = between(generator, -145.0, 0.0);
    joints.feet_mm = between(generator, -70.0, 75.0);
  } while (joints.head_mm - joints.feet_mm < 75.0 - 143.0 || joints.head_mm - joints.feet_mm > 146.0 - 143.0);
  joints.lateral_mm = between(generator, -49.47, 0.0);
  joints.insertion_mm = between(generator, 0.0, 40.0);
  joints.probe_rotation_rad = between(generator, -3.14, 3.14);
  joints.pitch_rad = between(generator, -0.465, 0.648);
  joints.yaw_rad = between(generator, -1.536, 0.010);
  return joints;
}

ProstateJoints random_prostate_joints(std::mt19937_64& generator) {
  ProstateJoints joints;
  do {
    joints.front_left_mm = between(generator, 43.0, 188.89);
    joints.front_right_mm = between(generator, -188.89, -43.0);
    joints.back_left_mm = between(generator, 43.0, 187.39);
    joints.back_right_mm = between(generator, -185.39, -43.0);
  } while (joints.front_left_mm - joints.front_right_mm > 308.0 ||
           joints.back_left_mm - joints.back_right_mm > 308.0);
  joints.insertion_mm = between(generator, 0.0, 168.0);
  joints.rotation_rad = between(generator, -3.14, 3.14);
  return joints;
}

Pose random_pose(std::mt19937_64& generator, double reach_mm) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation_z(between(generator, -3.14, 3.14)) * rotation_y(between(generator, -1.57, 1.57)) *
                  rotation_x(between(generator, -3.14, 3.14));
  pose.translation() << between(generator, -reach_mm, reach_mm), between(generator, -reach_mm, reach_mm),
      between(generator, -reach_mm, reach_mm);
  return pose;
}

double distance(const NeuroJoints& left, const NeuroJoints& right) {
  return largest_difference(neuro_joint_fields, left, right);
}

double distance(const ProstateJoints& left, const ProstateJoints& right) {
  return largest_difference(prostate_joint_fields, left, right);
}

double distance(const Pose& left, const Pose& right) {
  return (left.matrix() - right.matrix()).cwiseAbs().maxCoeff();
}

}  // namespace interlock::test
