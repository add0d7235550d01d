/** @file Only rigid matrices become poses. */
#include "kinematics/pose.hpp"

#include <gmock/gmock.h>

#include "random_joints.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;

const RowMajor example{0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30, 0, 0, 0, 1};

RowMajor with(std::size_t index, double value) {
  RowMajor numbers = example;
  numbers[index] = value;
  return numbers;
}

TEST(Pose, is_read_row_by_row) {
  const auto pose = pose_from(example);
  ASSERT_TRUE(pose) << pose.error().message();
  EXPECT_EQ(pose->translation(), Eigen::Vector3d(10, 20, 30));
  EXPECT_EQ(*pose * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(10, 21, 30));
}

TEST(Pose, survives_writing_and_reading) {
  std::mt19937_64 generator(1);
  for (int trip = 0; trip < 1000; ++trip) {
    const Pose pose = random_pose(generator, 500.0);
    EXPECT_EQ(distance(*pose_from(row_major(pose)), pose), 0.0);
  }
}

TEST(Pose, reflection_is_refused) {
  EXPECT_EQ(pose_from(with(10, -1.0)).error().quantity, "pose_determinant");
}

TEST(Pose, rotation_is_held_to_its_tolerance_from_both_sides) {
  EXPECT_TRUE(pose_from(with(10, 1.0 + 0.4 * rigid_tolerance)));
  EXPECT_EQ(pose_from(with(10, 1.0 + 0.6 * rigid_tolerance)).error().code, Code::not_rigid);
  EXPECT_EQ(pose_from(with(2, 2.0 * rigid_tolerance)).error().quantity, "pose_orthonormality_error");
}

TEST(Pose, last_row_is_fixed) {
  for (const std::size_t index : {12U, 13U, 14U, 15U}) {
    EXPECT_EQ(pose_from(with(index, 0.5)).error().quantity, "pose_last_row_entry");
  }
}

TEST(Pose, translation_beyond_ten_metres_is_refused) {
  EXPECT_TRUE(pose_from(with(3, 10'000.0)));
  EXPECT_EQ(pose_from(with(7, -10'000.1)).error().quantity, "pose_y_mm");
}

}  // namespace
}  // namespace interlock::test
