/** @file What the published values and the round trips are held to, in mm and rad. */
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace interlock::test {

constexpr double reference_digits = 1e-6;
constexpr double exact = 1e-9;
constexpr int round_trips = 100'000;

inline void expect_near(const Eigen::Vector3d& actual, const Eigen::Vector3d& expected, double tolerance) {
  EXPECT_LE((actual - expected).cwiseAbs().maxCoeff(), tolerance)
      << "got " << actual.transpose() << ", expected " << expected.transpose();
}

}  // namespace interlock::test
