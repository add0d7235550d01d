/** @file The random numbers have the spread that they say. */
#include "needle/noise.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace interlock::needle::test {
namespace {

TEST(Noise, is_normal_with_its_deviation) {
  Noise noise(1, 0);
  constexpr int draws = 100'000;
  double sum = 0.0;
  double squares = 0.0;
  int within_one = 0;
  for (int draw = 0; draw < draws; ++draw) {
    const double value = noise.normal(0.5);
    ASSERT_TRUE(std::isfinite(value));
    sum += value;
    squares += value * value;
    within_one += std::abs(value) < 0.5 ? 1 : 0;
  }
  EXPECT_NEAR(sum / draws, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / draws), 0.5, 0.005);
  EXPECT_NEAR(static_cast<double>(within_one) / draws, 0.6827, 0.01);
}

TEST(Noise, points_in_all_directions_alike) {
  Noise noise(2, 0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int draw = 0; draw < 30'000; ++draw) {
    const Eigen::Vector3d direction = noise.direction();
    ASSERT_NEAR(direction.norm(), 1.0, 1e-12);
    sum += direction / 30'000;
    squares += direction.cwiseAbs2() / 30'000;
  }
  EXPECT_LT(sum.norm(), 0.02);
  EXPECT_LT((squares - Eigen::Vector3d::Constant(1.0 / 3.0)).norm(), 0.02);
}

TEST(Noise, is_the_same_for_a_seed_and_another_for_another_stream) {
  Noise first(3, 0);
  Noise same(3, 0);
  Noise other(3, 1);
  const double value = first.between(2.0, 5.0);
  EXPECT_EQ(value, same.between(2.0, 5.0));
  EXPECT_NE(value, other.between(2.0, 5.0));
  EXPECT_GT(value, 2.0);
  EXPECT_LT(value, 5.0);
}

}  // namespace
}  // namespace interlock::needle::test
