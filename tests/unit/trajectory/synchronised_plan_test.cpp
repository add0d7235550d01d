#include "trajectory/synchronised_plan.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include "trajectory/tick_planner.hpp"

namespace interlock {
namespace {

using Code = TrajectoryError::Code;
using testing::HasSubstr;

constexpr PositionRange anywhere{-1000.0, 1000.0};

AxisTarget target_of(std::string name, const MotionState& now, double position,
                     const PositionRange& allowed = anywhere) {
  return {{std::move(name), now, {.velocity = 10.0, .acceleration = 40.0, .jerk = 400.0}}, position, allowed};
}

/** Axes at their limits at most, as a plan that is being followed leaves them, with targets anywhere. */
class RandomTargets {
 public:
  explicit RandomTargets(std::uint64_t seed) : generator_(seed) {}

  std::vector<AxisTarget> next() {
    std::vector<AxisTarget> targets(3);
    for (AxisTarget& target : targets) {
      const double velocity = between(0.1, 100.0);
      const double acceleration = velocity * between(0.5, 50.0);
      target.axis.limits = {velocity, acceleration, acceleration * between(1.0, 100.0)};
      target.axis.now = {100 * share(), 0.9 * share() * target.axis.limits.velocity,
                         0.9 * share() * target.axis.limits.acceleration};
      target.position = near_ ? target.axis.now.position + 1e-9 * share() : 100 * share();
      target.allowed = {-position_limit, position_limit};
    }
    near_ = !near_;
    return targets;
  }

 private:
  double share() { return std::uniform_real_distribution(-1.0, 1.0)(generator_); }
  double between(double lowest, double highest) {
    return std::exp(std::uniform_real_distribution(std::log(lowest), std::log(highest))(generator_));
  }

  std::mt19937_64 generator_;
  bool near_ = false; /**< every other time the targets are where the axes are */
};

/** A state that leads to more speed than allowed even when the acceleration ends as fast as it may. */
bool overshoots(const PlannedAxis& axis) {
  const double rise = axis.now.acceleration * std::abs(axis.now.acceleration) / (2 * axis.limits.jerk);
  return std::abs(axis.now.velocity + rise) > axis.limits.velocity;
}

/** Walks along a motion and expects it to hang together, and to keep the limits of the axis. */
void expect_kept(const PiecewiseMotion& motion, const PlannedAxis& axis) {
  constexpr int steps = 100;
  const double step = motion.duration_s() / steps;
  const PositionRange reach = motion.reach();
  MotionState before = motion.at(0.0);
  for (int tick = 1; tick < steps; ++tick) {
    const MotionState now = motion.at(tick * step);
    EXPECT_LE(std::abs(now.velocity), axis.limits.velocity * (1 + 1e-6) + 1e-8);
    EXPECT_LE(std::abs(now.acceleration), axis.limits.acceleration * (1 + 1e-6) + 1e-8);
    EXPECT_LE(std::abs(now.acceleration - before.acceleration), axis.limits.jerk * step * (1 + 1e-6) + 1e-7);
    EXPECT_LE(std::abs(now.velocity - before.velocity), axis.limits.acceleration * step * (1 + 1e-6) + 1e-7);
    EXPECT_GE(now.position, reach.lowest - 1e-9);
    EXPECT_LE(now.position, reach.highest + 1e-9);
    before = now;
  }
}

TEST(PlanMove, AxesFromRestArriveTogetherAlongAStraightLine) {
  const std::vector targets{target_of("yaw", {0.0}, 2.0), target_of("insertion", {5.0}, 35.0)};
  const auto plan = plan_move(targets);
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_GT(plan->duration_s, 3.0);
  for (double time_s = 0.0; time_s < plan->duration_s; time_s += 0.01) {
    const double yaw = plan->axes[0].at(time_s).position;
    const double insertion = plan->axes[1].at(time_s).position;
    EXPECT_NEAR(yaw / 2.0, (insertion - 5.0) / 30.0, 1e-6) << time_s;
  }
  EXPECT_EQ(plan->axes[0].at(plan->duration_s), (MotionState{2.0, 0.0, 0.0}));
  EXPECT_EQ(plan->axes[1].at(1e9), (MotionState{35.0, 0.0, 0.0}));
}

TEST(PlanMove, KeepsAllLimitsFromAnyStateAndEndsExactlyAtTheTargets) {
  RandomTargets random(21);
  int planned = 0;
  constexpr int trials = 600;
  for (int trial = 0; trial < trials; ++trial) {
    const std::vector<AxisTarget> targets = random.next();
    const auto plan = plan_move(targets);
    if (!plan) {
      EXPECT_EQ(plan.error().code, Code::no_solution) << plan.error().message();
      continue;
    }
    ++planned;
    for (std::size_t place = 0; place < targets.size(); ++place) {
      const PiecewiseMotion& motion = plan->axes[place];
      EXPECT_EQ(motion.at(0.0), targets[place].axis.now);
      EXPECT_EQ(motion.at(plan->duration_s + 1e-6), (MotionState{targets[place].position, 0.0, 0.0}));
      if (!overshoots(targets[place].axis)) {
        expect_kept(motion, targets[place].axis);
      }
    }
  }
  EXPECT_EQ(planned, trials);
}

TEST(PlanMove, GoesOnFromTheStateInWhichAnEarlierPlanLeftTheAxes) {
  const std::vector targets{target_of("yaw", {0.0}, 8.0), target_of("pitch", {1.0}, -2.0)};
  const auto first = plan_move(targets).value();
  const double turn_s = first.duration_s / 3;
  const std::vector others{target_of("yaw", first.axes[0].at(turn_s), -3.0),
                           target_of("pitch", first.axes[1].at(turn_s), 4.0)};
  const auto second = plan_move(others);
  ASSERT_TRUE(second) << second.error().message();
  for (std::size_t place = 0; place < 2; ++place) {
    EXPECT_EQ(second->axes[place].at(0.0), first.axes[place].at(turn_s));
    expect_kept(second->axes[place], others[place].axis);
  }
  EXPECT_EQ(second->axes[0].at(second->duration_s).position, -3.0);
}

TEST(PlanMove, TakesAsLongAsItIsTold) {
  const std::vector targets{target_of("yaw", {0.0}, 1.0), target_of("pitch", {0.0}, 0.5)};
  const auto plan = plan_move(targets, 12.5);
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_NEAR(plan->duration_s, 12.5, 1e-9);
  EXPECT_LT(plan->axes[1].at(6.0).position, 0.5);
}

TEST(PlanMove, AxesThatAreThereStayThere) {
  const std::vector targets{target_of("yaw", {3.0}, 3.0), target_of("pitch", {0.0}, 0.0)};
  const auto plan = plan_move(targets);
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_EQ(plan->duration_s, 0.0);
  EXPECT_EQ(plan->axes[0].at(0.0), (MotionState{3.0, 0.0, 0.0}));
  EXPECT_EQ(plan->axes[0].reach(), (PositionRange{3.0, 3.0}));
}

TEST(PlanMove, AxesThatAreThereUpToRoundingStayThere) {
  const RateLimits counts{20'000, 200'000, 1'000'000};
  const RateLimits slow{600, 6000, 120'000};
  const std::vector targets{
      AxisTarget{{"insertion", {-88.6, 1e-12, 1e-9}, counts}, -88.6 + 1e-12, anywhere},
      AxisTarget{{"yaw", {-24.677526332859685, 2.8879631433412193e-08, 3.713226359557991e-05}, slow},
                 -24.677526332859671,
                 anywhere}};
  const auto plan = plan_move(targets);
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_EQ(plan->duration_s, 0.0);
  EXPECT_EQ(plan->axes[0].at(0.0), (MotionState{-88.6 + 1e-12, 0.0, 0.0}));

  TickPlanner planner;
  const std::array paths{TickPlanner::AxisPath{targets[0].axis.now, targets[0].position, counts},
                         TickPlanner::AxisPath{targets[1].axis.now, targets[1].position, slow}};
  ASSERT_TRUE(planner.plan(paths, 0.0));
  EXPECT_EQ(planner.duration_s(), 0.0);
  EXPECT_EQ(planner.at(0.0)[1], (MotionState{targets[1].position, 0.0, 0.0}));
}

TEST(PlanMove, AStateBeyondALimitByRoundingIsAtTheLimit) {
  const RateLimits limits{20'000, 200'000, 1'000'000};
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double share : {1.0, 1 + 1e-15, 1 + 1e-9}) {
    const double speed = std::nextafter(20'000 * share, infinity);
    const double acceleration = std::nextafter(200'000 * share, infinity);
    // At full speed, at full acceleration, and on the last piece before full speed.
    for (const MotionState& now :
         {MotionState{3000, speed, 0}, MotionState{3000, -speed, 0}, MotionState{3000, 0, acceleration},
          MotionState{3000, 0, -acceleration}, MotionState{3000, 15'000 + (speed - 20'000), 100'000}}) {
      for (const double position : {-387.19726112219689, 3000.0, 32382.527818825347, 900'000.0}) {
        const std::vector targets{
            AxisTarget{{"insertion", now, limits}, position, {-position_limit, position_limit}}};
        const auto plan = plan_move(targets);
        ASSERT_TRUE(plan) << plan.error().message();
        EXPECT_NEAR(plan->axes[0].at(0.0).velocity, now.velocity, limits.acceleration * 1e-8);
        expect_kept(plan->axes[0], targets[0].axis);
      }
    }
  }
}

TEST(PlanMove, StatesThatEarlierPlansLeftBesideALimitHavePlans) {
  const RateLimits fast{20'000, 200'000, 1'000'000};
  const RateLimits usual{3333, 30'000, 600'000};
  const std::vector<std::tuple<MotionState, double, RateLimits>> refused_once{
      {{3229.5240036036084, 19999.999999999996, 0.0}, -10597.031817819878, fast},
      {{-53607.883953443583, -19999.999999999996, 0.0}, -4260.4806483961311, fast},
      {{346.14115425017508, -749.99999999999989, -29999.999999999996}, 346.14115424991314, usual},
      {{-166.71265062283015, -667.15597478122163, -29999.999577192528}, -166.71265062283015, usual},
      {{-10.467528345386215, -0.0001223302440767944, -5.4184184573019678},
       -10.467528345386215,
       {600, 6000, 120'000}}};
  for (const auto& [now, position, limits] : refused_once) {
    const std::vector targets{
        AxisTarget{{"insertion", now, limits}, position, {-position_limit, position_limit}}};
    const auto plan = plan_move(targets);
    ASSERT_TRUE(plan) << now.position << ": " << plan.error().message();
    expect_kept(plan->axes[0], targets[0].axis);
    TickPlanner planner;
    EXPECT_TRUE(planner.plan(std::array{TickPlanner::AxisPath{now, position, limits}}, 0.0));
  }
}

TEST(PlanMove, AnAxisFasterThanItsLimitsIsBrakedFirst) {
  const AxisTarget target = target_of("yaw", {0.0, 11.0, 0.0}, 20.0);
  const auto plan = plan_move(std::vector{target});
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_EQ(plan->axes[0].at(0.0), target.axis.now);
  EXPECT_LT(plan->axes[0].at(0.05).velocity, 11.0);
  EXPECT_LE(plan->axes[0].at(plan->duration_s / 3).velocity, 10.0 + 1e-8);
}

TEST(PlanMove, EveryWayOfWholeCountsHasAPlan) {
  const double unit = 1.0 / 39.3663;
  const RateLimits limits{500 * unit, 5000 * unit, 100'000 * unit};
  TickPlanner planner;
  for (int from = -1200; from <= 0; from += 7) {
    for (int counts = 1; counts <= 60; ++counts) {
      AxisTarget target = target_of("insertion", {from * unit}, (from + counts) * unit);
      target.axis.limits = limits;
      const auto plan = plan_move(std::vector{target});
      ASSERT_TRUE(plan) << from << ' ' << counts << ": " << plan.error().message();
      const std::array path{TickPlanner::AxisPath{target.axis.now, target.position, limits}};
      ASSERT_TRUE(planner.plan(path, 0.0)) << from << ' ' << counts;
      ASSERT_NEAR(planner.duration_s(), plan->duration_s, 1e-9);
    }
  }
}

TEST(PlanMove, AnAxisTooFastToStayWithinItsPositionsIsRefused) {
  const PositionRange allowed{-1.0, 1.0};
  const std::vector outwards{target_of("yaw", {0.9, 9.0, 0.0}, 0.5, allowed)};
  const auto plan = plan_move(outwards);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, Code::out_of_range);
  EXPECT_EQ(plan.error().column, "yaw on its way");
  EXPECT_TRUE(plan_move(std::vector{target_of("yaw", {0.9, -9.0, 0.0}, -0.5, {-2.0, 1.0})}));
}

TEST(PlanMove, AnAxisOutsideOfItsPositionsMayComeBackIn) {
  const PositionRange allowed{-1.0, 1.0};
  EXPECT_TRUE(plan_move(std::vector{target_of("yaw", {1.5}, 0.5, allowed)}));
  const auto outside = plan_move(std::vector{target_of("yaw", {0.5}, 1.5, allowed)});
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().message(), "yaw target: 1.5 is out of range; expected -1 to 1");
}

TEST(PlanMove, WhatIsNoNumberOrNotPositiveIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const AxisTarget& target, double minimum_duration_s = 0.0) {
    const auto plan = plan_move(std::vector{target}, minimum_duration_s);
    return plan ? TrajectoryError{} : plan.error();
  };
  EXPECT_EQ(refused(target_of("yaw", {nan}, 0.0)).column, "yaw position");
  EXPECT_EQ(refused(target_of("yaw", {0.0, nan}, 0.0)).column, "yaw velocity");
  EXPECT_EQ(refused(target_of("yaw", {0.0, 0.0, nan}, 0.0)).column, "yaw acceleration");
  EXPECT_EQ(refused(target_of("yaw", {0.0}, nan)).column, "yaw target");
  EXPECT_EQ(refused(target_of("yaw", {0.0}, 0.0, {2.0, -2.0})).column, "yaw lowest position");
  AxisTarget target = target_of("yaw", {0.0}, 1.0);
  target.axis.limits.jerk = 0.0;
  EXPECT_EQ(refused(target).message(), "yaw jerk limit: 0 is out of range; expected 1e-06 to 1000000");
  EXPECT_EQ(refused(target_of("yaw", {0.0}, 1.0), -1.0).column, "minimum duration [s]");
  EXPECT_EQ(refused(target_of("yaw", {0.0}, 1.0), 7601.0).code, Code::out_of_range);
  EXPECT_EQ(plan_move({}).error().code, Code::empty);
}

TEST(PlanMove, RuckigsRefusalsAreErrorsInWords) {
  AxisTarget target = target_of("yaw", {0.0}, 900.0);
  target.axis.limits.velocity = 0.01;
  const auto plan = plan_move(std::vector{target, target_of("pitch", {0.0}, 1.0)});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, Code::no_solution);
  EXPECT_THAT(plan.error().message(), HasSubstr("takes too long; expected 7600 s at most"));
}

TEST(PlanStop, EveryAxisComesToRestBySelfWithinItsLimits) {
  RandomTargets random(22);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<PlannedAxis> axes;
    for (const AxisTarget& target : random.next()) {
      axes.push_back(target.axis);
    }
    const auto plan = plan_stop(axes);
    ASSERT_TRUE(plan) << plan.error().message();
    for (std::size_t place = 0; place < axes.size(); ++place) {
      const PiecewiseMotion& motion = plan->axes[place];
      EXPECT_EQ(motion.at(0.0), axes[place].now);
      const MotionState end = motion.at(motion.duration_s());
      EXPECT_EQ(end.velocity, 0.0);
      EXPECT_EQ(end.acceleration, 0.0);
      EXPECT_NEAR(motion.at(motion.duration_s() * (1 - 1e-9)).position, end.position, 1e-5);
      const double fastest_s = std::abs(axes[place].now.velocity) / axes[place].limits.acceleration;
      EXPECT_GE(motion.duration_s(), fastest_s * (1 - 1e-9));
      if (!overshoots(axes[place])) {
        expect_kept(motion, axes[place]);
      }
    }
  }
}

TEST(PlanStop, TellsHowFarItLeads) {
  const PlannedAxis axis{"yaw", {1.0, 8.0, 0.0}, {.velocity = 10.0, .acceleration = 40.0, .jerk = 400.0}};
  const auto plan = plan_stop(std::vector{axis});
  ASSERT_TRUE(plan);
  const PositionRange reach = plan->axes[0].reach();
  EXPECT_EQ(reach.lowest, 1.0);
  EXPECT_NEAR(reach.highest, 1.0 + 8.0 / 2 * (8.0 / 40.0 + 40.0 / 400.0), 1e-9);
  EXPECT_EQ(plan_stop({}).error().code, Code::empty);
}

}  // namespace
}  // namespace interlock
