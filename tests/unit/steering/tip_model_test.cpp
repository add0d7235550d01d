/** @file The tip model against closed forms and against the simulated needle, which is written without it. */
#include "steering/tip_model.hpp"

#include <gmock/gmock.h>

#include "needle/needle.hpp"
#include "not_numbers.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;
using Eigen::Vector3d;

double distance(const Pose& left, const Pose& right) {
  return (left.matrix() - right.matrix()).cwiseAbs().maxCoeff();
}

TEST(TipModel, draws_a_circle_without_rotation) {
  Generator generator(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double curvature = between(generator, 1e-6, 0.02);
    const int steps = std::uniform_int_distribution(1, 50)(generator);
    Pose tip = Pose::Identity();
    double way = 0.0;
    for (int step = 0; step < steps; ++step) {
      const double insertion = between(generator, 0.0, 5.0);
      tip = moved_tip(tip, {insertion, 0.0}, curvature).value();
      way += insertion;
    }
    const double angle = curvature * way;
    const double sagitta = 2 * std::pow(std::sin(angle / 2), 2) / curvature;
    const Vector3d expected(0.0, -sagitta, std::sin(angle) / curvature);
    ASSERT_LT((tip.translation() - expected).norm(), 1e-9);
    ASSERT_LT((tip.linear() - rotation_x(angle)).norm(), 1e-9);
  }
}

TEST(TipModel, is_exact_whatever_the_step) {
  Generator generator(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const NeedleMotion motion{between(generator, 0.0, 50.0), between(generator, -100.0, 100.0)};
    const double curvature = between(generator, 0.0, 0.02);
    const int pieces = std::uniform_int_distribution(2, 400)(generator);
    Pose tip = Pose::Identity();
    for (int piece = 0; piece < pieces; ++piece) {
      tip = moved_tip(tip, {motion.insertion_mm / pieces, motion.rotation_rad / pieces}, curvature).value();
    }
    ASSERT_LT(distance(tip, moved_tip(Pose::Identity(), motion, curvature).value()), 1e-9);
  }
}

// A needle that spins evenly goes along a helix: about an axis tilted by atan(k / tau) from the way ahead, of
// radius k / (k^2 + tau^2), where tau is the rotation for each millimetre.
TEST(TipModel, goes_straight_at_full_spin_within_the_ripple) {
  Generator generator(3);
  for (int trial = 0; trial < 50; ++trial) {
    const double curvature = between(generator, 0.001, 0.005);
    const double tau = between(generator, 2.0, 6.0);
    const double radius = curvature / (curvature * curvature + tau * tau);
    const Vector3d axis = Vector3d(curvature, 0.0, tau).normalized();
    Pose tip = Pose::Identity();
    for (int step = 0; step < 2000; ++step) {
      tip = moved_tip(tip, {0.05, 0.05 * tau}, curvature).value();
      const Vector3d beside = tip.translation() - axis.dot(tip.translation()) * axis;
      ASSERT_LE(beside.norm(), 2 * radius + 1e-9);
    }
    ASSERT_LE(tip.translation().head<2>().norm(), 100.0 * curvature / tau + 2 * radius);
  }
}

TEST(TipModel, agrees_with_the_simulated_needle) {
  Generator generator(4);
  constexpr double step_s = 0.001;
  double worst = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    needle::NeedleParameters parameters;
    parameters.curvature_per_mm = between(generator, 0.001, 0.005);
    parameters.lag_s = 0.0;
    needle::Needle needle(parameters, needle::Noise(1, 0));
    Pose tip = Pose::Identity();
    for (int step = 0; step < 10'000; ++step) {
      const double speed = between(generator, 0.0, 10.0);
      const double spin = between(generator, -15.0, 15.0);
      needle.advance(speed, spin, step_s);
      tip = moved_tip(tip, {step_s * speed, step_s * spin}, parameters.curvature_per_mm).value();
    }
    worst = std::max(worst, (needle.tip_mm() - tip.translation()).norm());
    ASSERT_LT((needle.ahead() - tip.linear().col(2)).norm(), 1e-6);
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(TipModel, is_smooth_where_the_series_takes_over) {
  for (const double angle : {1e-12, 1e-6, 9.9e-4, 1.01e-3, 1e-2}) {
    const Vector3d rotation = angle * Vector3d(0.6, 0.0, 0.8);
    const Vector3d translation(1.0, 2.0, 3.0);
    const Pose half = exponential(translation / 2, rotation / 2);
    EXPECT_LT(distance(half * half, exponential(translation, rotation)), 1e-14) << angle;
  }
}

TEST(TipModel, stays_rigid) {
  Generator generator(5);
  Pose tip = Pose::Identity();
  for (int step = 0; step < 100'000; ++step) {
    tip = tip * exponential({0, 0, 0.005}, tip_rotation({0.005, between(generator, -0.02, 0.02)}, 0.004));
  }
  EXPECT_TRUE(check_rigid(tip, 1e-10));
}

TEST(TipModel, answers_nonsense_with_an_error) {
  const Pose start = Pose::Identity();
  for (const double value : not_numbers) {
    EXPECT_EQ(moved_tip(start, {value, 0.0}, 0.004).error().code, Code::not_finite);
    EXPECT_EQ(moved_tip(start, {1.0, value}, 0.004).error().code, Code::not_finite);
    EXPECT_EQ(moved_tip(start, {1.0, 0.0}, value).error().code, Code::not_finite);
    Pose broken = start;
    broken.translation().y() = value;
    EXPECT_EQ(moved_tip(broken, {1.0, 0.0}, 0.004).error().code, Code::not_finite);
  }
  EXPECT_EQ(moved_tip(start, {-0.1, 0.0}, 0.004).error().quantity, "insertion_mm");
  EXPECT_EQ(moved_tip(start, {1.0, 0.0}, -0.004).error().quantity, "curvature_per_mm");
}

}  // namespace
}  // namespace interlock::test
