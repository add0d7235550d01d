/** @file Where a target lies for a needle's tip: closed forms, and the needle that goes there. */
#include "steering/steering_target.hpp"

#include <gmock/gmock.h>

#include "not_numbers.hpp"
#include "steering/angle.hpp"
#include "steering/tip_model.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;
using Eigen::Vector3d;

using std::numbers::pi;

TEST(SteeringTarget, turns_from_minus_y_about_the_needle) {
  EXPECT_NEAR(wrapped_rad(steering_target({0, -5, 50})->turn_rad), 0.0, 1e-12);
  EXPECT_NEAR(steering_target({5, 0, 50})->turn_rad, pi / 2, 1e-12);
  EXPECT_NEAR(steering_target({0, 5, 50})->turn_rad, pi, 1e-12);
  EXPECT_NEAR(steering_target({-5, 0, 50})->turn_rad, 3 * pi / 2, 1e-12);
}

TEST(SteeringTarget, knows_the_arc_of_a_circle) {
  Generator generator(1);
  for (int trial = 0; trial < 10'000; ++trial) {
    const double curvature = between(generator, 1e-5, 0.01);
    const double angle = between(generator, 1e-3, 1.5);
    const double beside = (1 - std::cos(angle)) / curvature;
    const double ahead = std::sin(angle) / curvature;
    if (ahead > 9000) {
      continue;
    }
    const SteeringTarget target = steering_target({0, -beside, ahead}).value();
    ASSERT_NEAR(target.curvature_per_mm / curvature, 1.0, 1e-9);
    ASSERT_NEAR(target.arc_mm * curvature / angle, 1.0, 1e-9);
    ASSERT_NEAR(target.extra_mm, target.arc_mm - ahead, 1e-9);
  }
}

TEST(SteeringTarget, leads_the_tip_to_the_target) {
  Generator generator(2);
  for (int trial = 0; trial < 10'000; ++trial) {
    const Vector3d point(between(generator, -60, 60), between(generator, -60, 60),
                         between(generator, 1, 150));
    const SteeringTarget target = steering_target(point).value();
    const Pose turned = moved_tip(Pose::Identity(), {0.0, target.turn_rad}, target.curvature_per_mm).value();
    const Pose there = moved_tip(turned, {target.arc_mm, 0.0}, target.curvature_per_mm).value();
    ASSERT_LT((there.translation() - point).norm(), 1e-9);
  }
}

TEST(SteeringTarget, needs_no_curvature_straight_ahead) {
  for (const double beside : {0.0, 5e-324, 1e-300, 1e-160, 1e-20}) {
    const SteeringTarget target = steering_target({beside, -beside, 80}).value();
    EXPECT_NEAR(target.curvature_per_mm, 0.0, 1e-20);
    EXPECT_EQ(target.arc_mm, 80.0);
    EXPECT_EQ(target.extra_mm, 0.0);
    EXPECT_GE(target.turn_rad, 0.0);
    EXPECT_LT(target.turn_rad, 2 * pi);
  }
}

TEST(SteeringTarget, says_by_how_much_a_needle_that_bends_all_out_misses) {
  Generator generator(3);
  for (int trial = 0; trial < 10'000; ++trial) {
    const double curvature = between(generator, 1e-4, 0.01);
    const double angle = between(generator, 0.01, 1.5);
    const double reach = (1 - std::cos(angle)) / curvature;
    const double ahead = std::sin(angle) / curvature;
    const double beyond = between(generator, -2.0, 2.0);
    if (ahead < 9000 && reach + beyond > 0) {
      ASSERT_NEAR(*smallest_miss_mm(reach + beyond, ahead, curvature), std::max(0.0, beyond), 1e-8);
    }
  }
  EXPECT_NEAR(*smallest_miss_mm(120.0, 500.0, 0.01), 20.0, 1e-9);
}

TEST(SteeringTarget, answers_nonsense_with_an_error) {
  for (const double value : not_numbers) {
    EXPECT_EQ(steering_target({value, 1, 50}).error().code, Code::not_finite);
    EXPECT_EQ(steering_target({1, value, 50}).error().code, Code::not_finite);
    EXPECT_EQ(steering_target({1, 1, value}).error().code, Code::not_finite);
    EXPECT_EQ(smallest_miss_mm(value, 50, 0.004).error().code, Code::not_finite);
    EXPECT_EQ(smallest_miss_mm(1, value, 0.004).error().code, Code::not_finite);
    EXPECT_EQ(smallest_miss_mm(1, 50, value).error().code, Code::not_finite);
  }
  EXPECT_EQ(steering_target({1, 1, 0}).error().code, Code::out_of_reach);
  EXPECT_EQ(steering_target({1, 1, -5}).error().code, Code::out_of_reach);
  EXPECT_EQ(steering_target({1e5, 1, 50}).error().code, Code::out_of_range);
}

}  // namespace
}  // namespace interlock::test
