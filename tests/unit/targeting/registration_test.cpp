#include "targeting/registration.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "random_joints.hpp"

namespace interlock {
namespace {

using Code = KinematicsError::Code;

constexpr double exact = 1e-14;

double orthonormality_error(const Pose& pose) {
  return (pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

Code refusal_of(const RowMajor& numbers) { return Registration::create(numbers).error().code; }

TEST(Registration, ARigidMatrixIsTakenAsItIs) {
  std::mt19937_64 generator(1);
  for (int round = 0; round < 100; ++round) {
    const Pose pose = test::random_pose(generator, 500.0);
    EXPECT_LE(test::distance(Registration::create(row_major(pose))->scanner_from_zframe(), pose), exact);
  }
}

TEST(Registration, AlmostARotationBecomesTheNearestOne) {
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> slip(-2e-4, 2e-4);
  for (int round = 0; round < 100; ++round) {
    const Pose pose = test::random_pose(generator, 500.0);
    RowMajor rounded = row_major(pose);
    for (const std::size_t entry : {0, 1, 2, 4, 5, 6, 8, 9, 10}) {
      rounded[entry] += slip(generator);
    }
    const auto registration = Registration::create(rounded);
    ASSERT_TRUE(registration) << registration.error().message();
    EXPECT_LE(orthonormality_error(registration->scanner_from_zframe()), exact);
    EXPECT_LE(test::distance(registration->scanner_from_zframe(), pose), 4e-4);
  }
}

TEST(Registration, WhatIsNoRotationAndTranslationIsRefused) {
  EXPECT_EQ(refusal_of({1.01, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), Code::not_rigid);
  EXPECT_EQ(refusal_of({1, 0.01, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), Code::not_rigid);
  EXPECT_EQ(refusal_of({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}), Code::not_rigid);
  EXPECT_EQ(refusal_of({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 1}), Code::not_rigid);
  EXPECT_EQ(refusal_of({1, 0, 0, 20000, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), Code::out_of_range);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal_of({1, 0, 0, nan, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), Code::not_finite);
}

TEST(Registration, ItsRotationCanBeIgnored) {
  const RowMajor quarter_turn{0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1};
  const Pose pose = Registration::create(quarter_turn, true)->scanner_from_zframe();
  EXPECT_EQ(pose.linear(), Eigen::Matrix3d::Identity());
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(10.5, -20, 30));
}

}  // namespace
}  // namespace interlock
