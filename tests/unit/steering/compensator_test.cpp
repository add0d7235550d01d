/** @file What the compensator commands, one situation at a time; insertion_test.cpp has whole insertions. */
#include "steering/compensator.hpp"

#include <gmock/gmock.h>

#include "../app/counted_allocations.hpp"
#include "not_numbers.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;
using Eigen::Vector3d;

using std::numbers::pi;

Compensator towards(const Vector3d& target_mm, const CompensatorParameters& parameters = {}) {
  return Compensator::create(parameters, NeedleAxes{}, target_mm).value();
}

TEST(Compensator, spins_evenly_towards_a_target_straight_ahead) {
  Compensator compensator = towards({0, 0, 100});
  const SteeringCommand command = compensator.step({0.001, 0.0, 0.0}).value();
  EXPECT_EQ(command.alpha, 0.0);
  EXPECT_DOUBLE_EQ(command.rotation_rad_s, CurvParameters{}.fastest_rad_s);
  EXPECT_TRUE(command.reachable);
  EXPECT_FALSE(command.arrived);
  EXPECT_DOUBLE_EQ(command.insertion_setpoint_mm, 100.0);
}

TEST(Compensator, turns_the_bevel_towards_a_target_beside) {
  Compensator compensator = towards({4, 0, 100});
  const SteeringCommand command = compensator.step({0.001, 0.0, 0.3}).value();
  EXPECT_NEAR(command.desired_rotation_rad, pi / 2, 1e-9);
  EXPECT_GT(command.alpha, 0.0);
  EXPECT_LT(command.alpha, 1.0);
  EXPECT_TRUE(command.reachable);
  EXPECT_GT(command.insertion_setpoint_mm, 100.0);
}

TEST(Compensator, bends_all_out_and_says_so_when_the_target_is_out_of_reach) {
  Compensator compensator = towards({40, 0, 100});
  const SteeringCommand command = compensator.step({0.001, 0.0, 0.0}).value();
  EXPECT_EQ(command.alpha, 1.0);
  EXPECT_FALSE(command.reachable);
  EXPECT_NEAR(command.expected_miss_mm, *smallest_miss_mm(40, 100, 0.0041), 1e-9);
  Compensator nearly = towards({22, 0, 100});
  EXPECT_EQ(nearly.step({0.001, 0.0, 0.0})->alpha, 1.0);
  EXPECT_TRUE(nearly.step({0.002, 0.0, 0.0})->reachable);
}

TEST(Compensator, takes_alpha_by_the_rule_it_is_given) {
  CompensatorParameters parameters;
  parameters.share_rule = ShareRule::published;
  const double desired = steering_target({4, 0, 100})->curvature_per_mm;
  Compensator published = towards({4, 0, 100}, parameters);
  Compensator averaged = towards({4, 0, 100});
  EXPECT_NEAR(published.step({0.001, 0.0, 0.0})->alpha, published_share(desired, 0.0041)->alpha, 1e-9);
  const double alpha = averaged.step({0.001, 0.0, 0.0})->alpha;
  EXPECT_NEAR(*CurvLaw::create({})->curvature_share(alpha) * 0.0041, desired, 1e-9);
}

TEST(Compensator, turns_to_and_fro_within_one_turn) {
  Compensator compensator = towards({0, 0, 100});
  EXPECT_GT(compensator.step({0.001, 0.0, 6.0})->rotation_rad_s, 0.0);
  EXPECT_LT(compensator.step({0.002, 0.0, 6.3})->rotation_rad_s, 0.0);
  EXPECT_LT(compensator.step({0.003, 0.0, 1.0})->rotation_rad_s, 0.0);
  EXPECT_GT(compensator.step({0.004, 0.0, -0.1})->rotation_rad_s, 0.0);
}

TEST(Compensator, aims_at_the_target_that_an_image_shows) {
  Compensator compensator = towards({0, 0, 100});
  ASSERT_TRUE(compensator.step({0.001, 0.0, 0.0}));
  ASSERT_TRUE(compensator.see({0.0005, Vector3d::Zero(), Vector3d(0, 6, 100)}));
  const SteeringCommand command = compensator.step({0.002, 0.0, 0.0}).value();
  EXPECT_NEAR(command.desired_rotation_rad, pi, 0.1);
  EXPECT_GT(command.alpha, 0.5);
}

TEST(Compensator, takes_all_of_an_image_or_nothing) {
  Compensator compensator = towards({0, 0, 100});
  ASSERT_TRUE(compensator.step({1.0, 5.0, 0.0}));
  const Pose before = compensator.tip().guide_from_tip;
  EXPECT_FALSE(compensator.see({0.5, {0, 0, 2.5}, Vector3d(0, 40, 100)}));
  EXPECT_FALSE(compensator.see({0.5, {0, 30, 2.5}, Vector3d(0, 4, 100)}));
  EXPECT_EQ(compensator.tip().guide_from_tip.matrix(), before.matrix());
  EXPECT_EQ(compensator.target_mm(), Vector3d(0, 0, 100));
  EXPECT_TRUE(compensator.see({0.5, {0, 0, 2.5}, Vector3d(0, 4, 100)}));
}

TEST(Compensator, is_there_once_and_for_all) {
  Compensator compensator = towards({0, 0, 20});
  EXPECT_FALSE(compensator.step({1.0, 19.9, 0.0})->arrived);
  const SteeringCommand command = compensator.step({2.0, 19.96, 0.0}).value();
  EXPECT_TRUE(command.arrived);
  EXPECT_EQ(command.rotation_rad_s, 0.0);
  EXPECT_TRUE(compensator.step({3.0, 15.0, 0.0})->arrived);
}

TEST(Compensator, keeps_its_last_plan_close_to_the_target) {
  // Almost where a needle that does not turn goes by itself.
  Compensator compensator = towards({0.1, -5.1, 49.65});
  SteeringCommand kept;
  for (int tick = 1; tick <= 49'500; ++tick) {
    const double way_mm = 0.001 * tick;
    const SteeringCommand command = compensator.step({way_mm, way_mm, 0.0}).value();
    if (tick <= 48'500) {
      kept = command;
    } else {
      ASSERT_EQ(command.alpha, kept.alpha);
      ASSERT_EQ(command.desired_rotation_rad, kept.desired_rotation_rad);
    }
  }
  EXPECT_GT(kept.alpha, 0.0);
}

TEST(Compensator, bends_nothing_while_the_needle_is_withdrawn) {
  Compensator compensator = towards({3, 0, 100});
  ASSERT_TRUE(compensator.step({1.0, 30.0, 0.0}));
  const Vector3d deepest = compensator.tip().guide_from_tip.translation();
  ASSERT_TRUE(compensator.step({2.0, 25.0, 0.0}));
  ASSERT_TRUE(compensator.step({3.0, 30.0, 0.0}));
  EXPECT_LT((compensator.tip().guide_from_tip.translation() - deepest).norm(), 1e-12);
  ASSERT_TRUE(compensator.step({4.0, 31.0, 0.0}));
  EXPECT_NEAR((compensator.tip().guide_from_tip.translation() - deepest).norm(), 1.0, 1e-3);
}

TEST(Compensator, allocates_nothing_after_it_is_made) {
  Compensator compensator = towards({4, 2, 100});
  count_allocations_of(pthread_self());
  bool all_well = true;
  for (int tick = 1; tick <= 5000; ++tick) {
    const double time_s = 0.005 * tick;
    all_well =
        compensator.step({time_s, 4.0 * time_s, std::fmod(10.0 * time_s, 6.0)}).has_value() && all_well;
    if (tick % 400 == 0) {
      const Vector3d shown = compensator.tip().guide_from_tip.translation() - Vector3d(0, 0, 4);
      all_well = compensator.see({time_s - 1.0, shown, Vector3d(4, 2, 100)}).has_value() && all_well;
    }
  }
  const std::uint32_t allocations = counted_allocations();
  count_allocations_of();
  EXPECT_TRUE(all_well);
  EXPECT_EQ(allocations, 0u);
}

TEST(Compensator, answers_nonsense_with_an_error) {
  Compensator compensator = towards({0, 0, 100});
  ASSERT_TRUE(compensator.step({1.0, 5.0, 0.0}));
  for (const double value : not_numbers) {
    EXPECT_EQ(compensator.step({value, 5.0, 0.0}).error().code, Code::not_finite);
    EXPECT_EQ(compensator.step({2.0, value, 0.0}).error().code, Code::not_finite);
    EXPECT_EQ(compensator.step({2.0, 5.0, value}).error().code, Code::not_finite);
    EXPECT_EQ(compensator.see({0.5, {value, 0, 0}, Vector3d(0, 0, 100)}).error().code, Code::not_finite);
    EXPECT_EQ(compensator.see({0.5, {0, 0, 5}, Vector3d(0, value, 100)}).error().code, Code::not_finite);
    EXPECT_EQ(Compensator::create({}, {}, {value, 0, 100}).error().code, Code::not_finite);
    EXPECT_EQ(Compensator::create({.commit_mm = value}, {}, {0, 0, 100}).error().code, Code::not_finite);
  }
  EXPECT_EQ(Compensator::create({}, {}, {0, 0, -100}).error().code, Code::out_of_reach);
  EXPECT_TRUE(compensator.step({2.0, 5.0, 0.0}));
}

}  // namespace
}  // namespace interlock::test
