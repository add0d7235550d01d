#include "trajectory/trapezoid_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace interlock {
namespace {

using Code = TrajectoryError::Code;

/** The thesis' move of the yaw axis (Figure 29) with its ramps and floor, at 833 counts a second. */
constexpr double thesis_way = 600.0;
constexpr TrapezoidRules thesis_rules{
    .cruise_velocity = 833.0, .max_acceleration = 1e5, .ramp_share = 0.3, .floor_velocity = 833.0 / 20};

TrapezoidProfile profile_of(double from, double to, const TrapezoidRules& rules) {
  return TrapezoidProfile::create(from, to, rules).value();
}

/** The velocity that Listing 11 asks for after some way, with its floor on the way down, too. */
double listing_velocity(double way, double length, const TrapezoidRules& rules) {
  const double ramp = rules.ramp_share * length;
  const double nearer_end = std::min(way, length - way);
  return std::max(rules.floor_velocity, rules.cruise_velocity * std::min(1.0, nearer_end / ramp));
}

TrapezoidRules random_rules(std::mt19937_64& generator) {
  const auto rate = [&] { return std::pow(10.0, std::uniform_real_distribution(-2.0, 3.0)(generator)); };
  const double cruise = rate();
  return {.cruise_velocity = cruise,
          .max_acceleration = rate(),
          .ramp_share = std::uniform_real_distribution(0.01, 0.5)(generator),
          .floor_velocity = cruise * std::uniform_real_distribution(0.001, 1.0)(generator)};
}

TEST(TrapezoidProfile, IsTheVelocityOfTheThesisAfterTheSameWay) {
  const TrapezoidProfile profile = profile_of(0.0, thesis_way, thesis_rules);
  EXPECT_EQ(profile.peak_velocity(), thesis_rules.cruise_velocity);
  for (double time_s = 0.0; time_s < profile.duration_s(); time_s += 1e-3) {
    const MotionState state = profile.at(time_s);
    EXPECT_NEAR(state.velocity, listing_velocity(state.position, thesis_way, thesis_rules), 1e-9) << time_s;
  }
}

TEST(TrapezoidProfile, StartsAtTheFloorAndEndsExactlyAtRest) {
  const TrapezoidProfile profile = profile_of(10.0, -3.7, thesis_rules);
  EXPECT_EQ(profile.at(-1e-9), (MotionState{10.0, 0.0, 0.0}));
  EXPECT_EQ(profile.at(0.0).velocity, -thesis_rules.floor_velocity);
  EXPECT_EQ(profile.at(profile.duration_s()), (MotionState{-3.7, 0.0, 0.0}));
  EXPECT_EQ(profile.at(std::numeric_limits<double>::infinity()), (MotionState{-3.7, 0.0, 0.0}));
  EXPECT_EQ(profile.at(std::nan("")), (MotionState{10.0, 0.0, 0.0}));
}

TEST(TrapezoidProfile, ShortMovesAreTrianglesThatKeepTheAccelerationLimit) {
  const TrapezoidRules rules{.cruise_velocity = 10, .max_acceleration = 5, .floor_velocity = 0.1};
  const TrapezoidProfile profile = profile_of(0.0, 2.0, rules);
  EXPECT_DOUBLE_EQ(profile.peak_velocity(), std::sqrt(5.0 * 1.0));
  const MotionState middle = profile.at(profile.duration_s() / 2);
  EXPECT_NEAR(middle.position, 1.0, 1e-12);
  EXPECT_NEAR(middle.velocity, profile.peak_velocity(), 1e-12);
}

TEST(TrapezoidProfile, MovesTooShortToGrowFasterAreMadeAtTheFloor) {
  const TrapezoidRules rules{.cruise_velocity = 10, .max_acceleration = 5, .floor_velocity = 0.5};
  const TrapezoidProfile profile = profile_of(1.0, 1.01, rules);
  EXPECT_EQ(profile.peak_velocity(), 0.5);
  EXPECT_NEAR(profile.duration_s(), 0.02, 1e-12);
  EXPECT_NEAR(profile.at(0.005).position, 1.0025, 1e-12);
}

TEST(TrapezoidProfile, NoWayTakesNoTime) {
  const TrapezoidProfile profile = profile_of(4.2, 4.2, thesis_rules);
  EXPECT_EQ(profile.duration_s(), 0.0);
  EXPECT_EQ(profile.at(0.0), (MotionState{4.2, 0.0, 0.0}));
}

TEST(TrapezoidProfile, PositionFollowsTheVelocityWithinAllLimits) {
  std::mt19937_64 generator(11);
  std::uniform_real_distribution place(-100.0, 100.0);
  for (int trial = 0; trial < 300; ++trial) {
    const TrapezoidRules rules = random_rules(generator);
    const double from = place(generator);
    const double to = place(generator);
    const TrapezoidProfile profile = profile_of(from, to, rules);
    // The speed only grows in the first hundred steps and only falls in the others, so that the mean speed of
    // a step lies between those at its ends.
    const double step = profile.duration_s() / 200;
    MotionState before = profile.at(0.0);
    for (int tick = 1; tick < 200; ++tick) {
      const MotionState now = profile.at(tick * step);
      const double mean = (now.position - before.position) / step;
      const auto [lower, higher] = std::minmax(before.velocity, now.velocity);
      EXPECT_GE(mean, lower - 1e-6) << trial << " at " << tick;
      EXPECT_LE(mean, higher + 1e-6) << trial << " at " << tick;
      EXPECT_LE(std::abs(now.velocity), rules.cruise_velocity * (1 + 1e-12));
      EXPECT_GE(std::abs(now.velocity), rules.floor_velocity * (1 - 1e-9));
      EXPECT_LE(std::abs(now.acceleration), rules.max_acceleration * (1 + 1e-9));
      before = now;
    }
    EXPECT_NEAR(before.position, to, std::abs(before.velocity) * step * (1 + 1e-9));
    EXPECT_EQ(profile.at(profile.duration_s()).position, to);
  }
}

TEST(TrapezoidProfile, WhatIsNoNumberOrNotPositiveIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto refused = [](double from, double to, const TrapezoidRules& rules) {
    const auto profile = TrapezoidProfile::create(from, to, rules);
    return profile ? TrajectoryError{} : profile.error();
  };
  EXPECT_EQ(refused(nan, 1, thesis_rules).code, Code::not_finite);
  EXPECT_EQ(refused(0, infinity, thesis_rules).column, "to");
  EXPECT_EQ(refused(0, 1e7, thesis_rules).code, Code::out_of_range);
  const struct {
    double TrapezoidRules::* field;
    const char* name;
  } fields[] = {{&TrapezoidRules::cruise_velocity, "cruise_velocity"},
                {&TrapezoidRules::max_acceleration, "max_acceleration"},
                {&TrapezoidRules::ramp_share, "ramp_share"},
                {&TrapezoidRules::floor_velocity, "floor_velocity"}};
  for (const auto& [field, name] : fields) {
    for (const double value : {nan, infinity, -infinity, 0.0, -1.0}) {
      TrapezoidRules rules = thesis_rules;
      rules.*field = value;
      const TrajectoryError error = refused(0, 1, rules);
      EXPECT_EQ(error.column, name) << value;
      EXPECT_EQ(error.code, std::isfinite(value) ? Code::out_of_range : Code::not_finite) << name;
    }
  }
  TrapezoidRules share = thesis_rules;
  share.ramp_share = 0.51;
  EXPECT_EQ(refused(0, 1, share).message(), "ramp_share: 0.51 is out of range; expected 0.001 to 0.5");
  TrapezoidRules floor = thesis_rules;
  floor.floor_velocity = 834;
  EXPECT_EQ(refused(0, 1, floor).code, Code::out_of_range);
}

}  // namespace
}  // namespace interlock
