#include "control/axis_controller.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <cmath>
#include <limits>
#include <random>

#include "counted_allocations.hpp"
#include "project_robots.hpp"

namespace interlock {
namespace {

using test::neuro;
using test::prostate;

constexpr std::uint32_t period_us = 1000;

const Axis& yaw() { return *neuro().find("yaw"); }
const Axis& rotation() { return *prostate().find("rotation"); }

AxisController controller(const Axis& axis = yaw()) {
  return AxisController::create(control_rules(axis, period_us, 1000.0)).value();
}

/** What a snapshot shows of an axis that moves evenly from 0, at a tick. */
ilk_axis_t moving(double counts_per_s, std::uint32_t tick) {
  ilk_axis_t axis{};
  axis.position_counts = static_cast<std::int32_t>(std::floor(counts_per_s * tick * 1e-3));
  axis.card_time_us = tick * period_us;
  return axis;
}

Setpoint even(double counts_per_s, std::uint32_t tick) {
  return {counts_per_s * tick * 1e-3, counts_per_s, 0.0};
}

TEST(AxisController, AnAxisThatFollowsGetsTheDriveOfItsSpeed) {
  for (const double speed : {-600.0, 600.0}) {
    AxisController control = controller();
    AxisOutput output;
    for (std::uint32_t tick = 0; tick < 500; ++tick) {
      output = control.update(moving(speed, tick), tick, even(speed, tick), speed < 0 ? -2000 : 2000);
      ASSERT_FALSE(output.error);
    }
    EXPECT_NEAR(output.velocity.value().counts_per_s, speed, 20.0);
    EXPECT_NEAR(output.drive, 0.6 * yaw().drive.max, 0.05 * yaw().drive.max);
  }
}

TEST(AxisController, WithinTheDeadbandOfTheTargetThereIsNoDrive) {
  for (std::int32_t off = -3; off <= 3; ++off) {
    AxisController control = controller();
    AxisOutput output;
    for (std::uint32_t tick = 0; tick < 100; ++tick) {
      output = control.update(moving(0, tick), tick, {static_cast<double>(off), 0, 0}, off);
    }
    EXPECT_EQ(output.drive == 0, std::abs(off) <= 1) << off;
    EXPECT_TRUE(output.drive == 0 || output.drive >= yaw().drive.min) << off;
  }
}

TEST(AxisController, AnAxisAheadOfItsSetpointWaitsAndNeverTurnsBack) {
  AxisController control = controller();
  const AxisOutput output = control.update(moving(0, 0), 0, {-50, 100, 0}, 600);
  EXPECT_LT(output.piv.desired_counts_per_s, 0.0);
  EXPECT_EQ(output.drive, 0u);
}

TEST(AxisController, DriveIsNeverAboveTheBoundOfTheAxisWhateverItSees) {
  std::mt19937_64 generator(9);
  std::uniform_int_distribution<std::int32_t> count(std::numeric_limits<std::int32_t>::min(),
                                                    std::numeric_limits<std::int32_t>::max());
  std::uniform_real_distribution exponent(-3.0, 12.0);
  for (const Axis* axis : {&yaw(), &rotation()}) {
    AxisController control = controller(*axis);
    for (int trial = 0; trial < 20'000; ++trial) {
      ilk_axis_t seen{};
      seen.position_counts = count(generator);
      seen.card_time_us = static_cast<std::uint32_t>(count(generator));
      const double sign = trial % 2 == 0 ? 1.0 : -1.0;
      const Setpoint setpoint{sign * std::pow(10.0, exponent(generator)), std::pow(10.0, exponent(generator)),
                              std::pow(10.0, exponent(generator))};
      const AxisOutput output =
          control.update(seen, static_cast<std::uint32_t>(count(generator)), setpoint, count(generator));
      ASSERT_LE(output.drive, axis->drive.max);
      ASSERT_TRUE(!output.error || output.drive == 0);
    }
  }
}

TEST(AxisController, WhatIsNoNumberIsZeroDriveAndSaysWhich) {
  AxisController control = controller();
  for (std::uint32_t tick = 0; tick < 50; ++tick) {
    ASSERT_GT(control.update(moving(0, tick), tick, {100, 500, 0}, 600).drive, 0u);
  }
  const AxisOutput output = control.update(moving(0, 50), 50, {100, std::nan(""), 0}, 600);
  EXPECT_EQ(output.drive, 0u);
  ASSERT_TRUE(output.error);
  EXPECT_EQ(output.error->message(), "velocity setpoint is not a finite number");
  EXPECT_FALSE(control.update(moving(0, 51), 51, {100, 500, 0}, 600).error) << "it goes on";
}

TEST(AxisController, ALowerCeilingHoldsTheDriveAtOnceAndWindsNothingUp) {
  for (const Axis* axis : {&yaw(), &rotation()}) {
    const std::uint32_t ceiling = axis->drive.max / 4;
    const double full_speed = mapped_full_speed(*axis).value_or(1000.0);
    const Setpoint ahead{0.05 * full_speed, 0, 0};
    AxisController control = controller(*axis);
    for (std::uint32_t tick = 0; tick < 20'000; ++tick) {
      const bool held = tick >= 100;
      const AxisOutput output =
          control.update(moving(0, tick), tick, ahead, 600, held ? ceiling : axis->drive.max);
      ASSERT_LE(output.drive, held ? ceiling : axis->drive.max) << tick;
    }
    EXPECT_GE(control.update(moving(0, 20'000), 20'000, ahead, 600, ceiling).drive, ceiling - 1)
        << axis->name;
    // The error has gone: an integral from these twenty seconds would still drive the axis.
    const AxisOutput after = control.update(moving(0, 20'001), 20'001, {}, 600);
    EXPECT_NEAR(after.piv.desired_counts_per_s, 0.0, 0.05 * full_speed) << axis->name;
  }
}

TEST(AxisController, KnowsTheVelocityAtTheStartWhenItWasObserved) {
  AxisController control = controller();
  EXPECT_FALSE(control.update(moving(500, 0), 0, {}, 600).velocity);
  for (std::uint32_t tick = 1; tick < 50; ++tick) {
    control.observe(moving(500, tick), tick);
  }
  EXPECT_NEAR(control.update(moving(500, 50), 50, {}, 600).velocity.value().counts_per_s, 500.0, 30.0);
}

TEST(AxisController, ALongGapBetweenTicksDoesNotWindUp) {
  AxisController even_ticks = controller();
  AxisController with_gap = controller();
  for (std::uint32_t tick = 0; tick < 60; ++tick) {
    (void)even_ticks.update(moving(0, tick), tick, {5, 0, 0}, 600);
    (void)with_gap.update(moving(0, tick), tick + (tick == 59 ? 1'000'000 : 0), {5, 0, 0}, 600);
  }
  const AxisOutput soon = even_ticks.update(moving(0, 60), 60, {5, 0, 0}, 600);
  const AxisOutput late = with_gap.update(moving(0, 60), 1'000'060, {5, 0, 0}, 600);
  EXPECT_NEAR(late.piv.desired_counts_per_s, soon.piv.desired_counts_per_s, 5.0);
}

TEST(AxisController, AllocatesNothing) {
  AxisController control = controller();
  test::count_allocations_of(pthread_self());
  for (std::uint32_t tick = 0; tick < 1000; ++tick) {
    (void)control.update(moving(600, tick), tick, even(600, tick), 2000);
    (void)control.update(moving(600, tick), tick, {std::nan(""), 0, 0}, 2000);
    control.observe(moving(600, tick), tick);
  }
  const std::uint32_t allocations = test::counted_allocations();
  test::count_allocations_of();
  EXPECT_EQ(allocations, 0u);
}

TEST(ControlRules, EveryAxisOfBothRobotsHasSome) {
  for (const Robot* robot : {&neuro(), &prostate()}) {
    for (const Axis& axis : robot->axes) {
      const AxisControlRules rules = control_rules(axis, robot->period_us, 1000.0);
      EXPECT_TRUE(AxisController::create(rules)) << axis.name;
      EXPECT_EQ(rules.drive.max_drive, axis.drive.max);
      EXPECT_EQ(rules.deadband_counts, axis.deadband_counts);
    }
  }
}

TEST(ControlRules, TheHighFrequencyAxisHasItsFullSpeedFromThePublishedMap) {
  EXPECT_FALSE(mapped_full_speed(yaw()));
  const double full_speed = mapped_full_speed(rotation()).value();
  EXPECT_NEAR(full_speed, 138.166 / 60 * 1666.74, 1.0);
  EXPECT_EQ(control_rules(rotation(), period_us, 1.0).piv.full_speed_counts_per_s, full_speed);
}

TEST(ControlRules, AnAxisOfFrequencyInMillimetresNeedsItsOwnNumbers) {
  Axis linear = rotation();
  linear.unit = Unit::mm;
  EXPECT_FALSE(mapped_full_speed(linear));
  const auto made = AxisController::create(control_rules(linear, period_us, 1000.0));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().quantity, "counts per revolution");
}

TEST(ControlRules, AWindowThatTheEstimatorCannotHoldIsRefused) {
  AxisControlRules rules = control_rules(yaw(), period_us, 1000.0);
  for (const std::uint32_t window_us : {0u, 3'999u, 160'001u}) {
    rules.velocity.window_us = window_us;
    EXPECT_EQ(AxisController::create(rules).error().quantity, "window of the velocity") << window_us;
  }
  rules.velocity.window_us = 160'000;
  EXPECT_TRUE(AxisController::create(rules));
}

}  // namespace
}  // namespace interlock
