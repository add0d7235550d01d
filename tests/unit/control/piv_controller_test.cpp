#include "control/piv_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace interlock {
namespace {

constexpr double tick_s = 1e-3;

constexpr PivRules rules{.gains = {.position_per_s = 15.0, .velocity = 0.3, .integral_per_s = 4.0},
                         .full_speed_counts_per_s = 1000.0,
                         .lead_s = 0.01,
                         .rate_counts_per_s2 = 20'000.0,
                         .integral_counts_per_s = 500.0};

PivController piv_controller(const PivRules& with = rules) { return PivController::create(with).value(); }

/** An axis that stands at 0 or moves evenly, and should be elsewhere or move otherwise. */
PivInput input(double position_setpoint, double velocity_setpoint, double velocity, int direction = 1) {
  return {.setpoint = {position_setpoint, velocity_setpoint, 0.0},
          .position_counts = 0.0,
          .velocity = VelocityEstimate{velocity, 0.01},
          .direction = direction,
          .elapsed_s = tick_s};
}

TEST(PivController, MirroredErrorsGiveMirroredOutputs) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution position(-100.0, 100.0);
  std::uniform_real_distribution speed(-1200.0, 1200.0);
  for (int trial = 0; trial < 200; ++trial) {
    PivController upwards = piv_controller();
    PivController downwards = piv_controller();
    for (int tick = 0; tick < 50; ++tick) {
      const double p = position(generator);
      const double v = speed(generator);
      const double w = speed(generator);
      const PivOutput up = upwards.update(input(p, v, w, 1)).value();
      const PivOutput down = downwards.update(input(-p, -v, -w, -1)).value();
      ASSERT_EQ(up.counts_per_s, -down.counts_per_s);
      ASSERT_EQ(up.desired_counts_per_s, -down.desired_counts_per_s);
    }
  }
}

TEST(PivController, ASpeedThatIsTooHighLowersTheOutputAndOneTooLowRaisesIt) {
  for (const int direction : {1, -1}) {
    const auto output = [&](double velocity) {
      return piv_controller().update(input(0, direction * 500, direction * velocity, direction)).value();
    };
    const double even = direction * output(500).desired_counts_per_s;
    EXPECT_EQ(even, 500.0);
    EXPECT_LT(direction * output(600).desired_counts_per_s, even);
    EXPECT_GT(direction * output(400).desired_counts_per_s, even);
  }
}

TEST(PivController, AnOutputAgainstTheTravelIsZeroDriveAtOnce) {
  PivController piv = piv_controller();
  for (int tick = 0; tick < 100; ++tick) {
    (void)piv.update(input(10, 800, 500));
  }
  ASSERT_GT(piv.update(input(10, 800, 500)).value().counts_per_s, 900.0);
  const PivOutput ahead = piv.update(input(-200, 800, 1000)).value();
  EXPECT_LT(ahead.desired_counts_per_s, 0.0);
  EXPECT_EQ(ahead.counts_per_s, 0.0);
}

TEST(PivController, NoOutputIsEverAgainstTheTravelTooFastOrTooSudden) {
  std::mt19937_64 generator(2);
  std::uniform_real_distribution wild(-3000.0, 3000.0);
  for (int trial = 0; trial < 300; ++trial) {
    PivController piv = piv_controller();
    const int direction = trial % 2 == 0 ? 1 : -1;
    double before = 0.0;
    for (int tick = 0; tick < 100; ++tick) {
      PivInput now = input(wild(generator), wild(generator), wild(generator), direction);
      now.setpoint.acceleration_counts_per_s2 = 10 * wild(generator);
      const double output = piv.update(now).value().counts_per_s;
      ASSERT_GE(output * direction, 0.0);
      ASSERT_LE(output * direction, rules.full_speed_counts_per_s);
      ASSERT_LE(output * direction - before, rules.rate_counts_per_s2 * tick_s * (1 + 1e-12));
      if (output != 0.0) {
        ASSERT_GE(output * direction - before, -rules.rate_counts_per_s2 * tick_s * (1 + 1e-12));
      }
      before = output * direction;
    }
  }
}

TEST(PivController, DoesNotWindUpWhileItsOutputIsHeld) {
  const auto seconds = [](double time_s) { return static_cast<int>(time_s / tick_s); };
  for (const double position_error : {200.0, -200.0}) {
    PivController piv = piv_controller();
    for (int tick = 0; tick < seconds(60); ++tick) {
      (void)piv.update(input(position_error, 0, 0));
    }
    EXPECT_LE(std::abs(piv.integral_counts_per_s()), 1.0) << "after a minute at " << position_error;
    // It follows at once: a speed that fits its setpoint needs no more than that speed.
    const PivOutput after = piv.update(input(0, 500, 500)).value();
    EXPECT_NEAR(after.desired_counts_per_s, 500.0, 1.0);
  }
}

TEST(PivController, TheIntegralHasABoundOfItsOwn) {
  PivRules slow = rules;
  slow.integral_counts_per_s = 50.0;
  PivController piv = piv_controller(slow);
  for (int tick = 0; tick < 10'000; ++tick) {
    (void)piv.update(input(0, 500, 200));
    ASSERT_LE(piv.integral_counts_per_s(), 50.0);
  }
  EXPECT_EQ(piv.integral_counts_per_s(), 50.0);
}

TEST(PivController, TheIntegralTakesWhatTheFeedForwardLacks) {
  // A motor that makes four fifths of what is asked of it.
  PivController piv = piv_controller();
  double velocity = 0.0;
  for (int tick = 0; tick < 5000; ++tick) {
    velocity = 0.8 * piv.update(input(0, 500, velocity)).value().counts_per_s;
  }
  EXPECT_NEAR(velocity, 500.0, 1.0);
}

TEST(PivController, AChangeOfDirectionAndAResetEmptyTheIntegral) {
  PivController piv = piv_controller();
  const auto wind = [&] {
    for (int tick = 0; tick < 200; ++tick) {
      (void)piv.update(input(0, 500, 400, 1));
    }
    ASSERT_GT(piv.integral_counts_per_s(), 10.0);
  };
  wind();
  (void)piv.update(input(0, -500, -500, -1));
  EXPECT_EQ(piv.integral_counts_per_s(), 0.0);
  wind();
  piv.reset();
  EXPECT_EQ(piv.integral_counts_per_s(), 0.0);
}

/** A motor that makes three fifths of what it should. */
TEST(PivController, WhatTheMotorLacksIsMadeUpForInProportionToTheProfile) {
  PivController piv = piv_controller();
  for (int tick = 0; tick < 5000; ++tick) {
    (void)piv.update(input(0, 500, 0.6 * 500));
  }
  EXPECT_GT(piv.integral_counts_per_s(), 400.0) << "at full pace";
  for (const double pace : {300.0, 100.0, 10.0}) {
    (void)piv.update(input(0, pace, pace));
    EXPECT_LE(piv.integral_counts_per_s(), 0.02 * 1000 + pace) << "an axis would pass its target by the rest";
  }
  const double left = piv.integral_counts_per_s();
  for (int tick = 0; tick < 100; ++tick) {
    (void)piv.update(input(2, 0, 0));
  }
  EXPECT_GT(piv.integral_counts_per_s(), left)
      << "what holds an axis that should stand elsewhere is still overcome";
}

TEST(PivController, WithoutAVelocityItFollowsByPositionAlone) {
  PivController piv = piv_controller();
  PivInput blind = input(2, 500, 0);
  blind.velocity.reset();
  for (int tick = 0; tick < 1000; ++tick) {
    EXPECT_EQ(piv.update(blind).value().desired_counts_per_s, 500.0 + 2 * 15.0);
  }
  EXPECT_EQ(piv.integral_counts_per_s(), 0.0);
}

TEST(PivController, WhatIsNoNumberIsAnErrorAndLeavesNothingBehind) {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double PivInput::*> own{&PivInput::position_counts, &PivInput::elapsed_s};
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    std::vector<PivInput> inputs(7, input(0, 500, 400));
    inputs[0].setpoint.position_counts = bad;
    inputs[1].setpoint.velocity_counts_per_s = bad;
    inputs[2].setpoint.acceleration_counts_per_s2 = bad;
    inputs[3].velocity->counts_per_s = bad;
    inputs[4].velocity->age_s = bad;
    inputs[5].*own[0] = bad;
    inputs[6].*own[1] = bad;
    for (const PivInput& each : inputs) {
      PivController piv = piv_controller();
      for (int tick = 0; tick < 100; ++tick) {
        (void)piv.update(input(0, 500, 400));
      }
      const auto refused = piv.update(each);
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().code,
                std::isfinite(bad) ? ControlError::Code::out_of_range : ControlError::Code::not_finite);
      EXPECT_EQ(piv.integral_counts_per_s(), 0.0);
      EXPECT_LE(piv.update(input(0, 500, 400)).value().counts_per_s, rules.rate_counts_per_s2 * tick_s);
    }
  }
}

TEST(PivController, RefusesRulesThatMeanNothingByName) {
  const auto refused = [](auto change) {
    PivRules bad = rules;
    change(bad);
    const auto made = PivController::create(bad);
    return made ? std::string() : made.error().message();
  };
  EXPECT_EQ(refused([](PivRules& bad) { bad.gains.position_per_s = -1; }), "position gain is out of range");
  EXPECT_EQ(refused([](PivRules& bad) { bad.gains.velocity = std::nan(""); }),
            "velocity gain is not a finite number");
  EXPECT_EQ(refused([](PivRules& bad) { bad.gains.integral_per_s = 1e5; }), "integral gain is out of range");
  EXPECT_EQ(refused([](PivRules& bad) { bad.full_speed_counts_per_s = 0; }), "full speed is out of range");
  EXPECT_EQ(refused([](PivRules& bad) { bad.lead_s = -0.1; }), "lead is out of range");
  EXPECT_EQ(refused([](PivRules& bad) { bad.rate_counts_per_s2 = INFINITY; }), "rate is not a finite number");
  EXPECT_EQ(refused([](PivRules& bad) { bad.integral_counts_per_s = -1; }), "integral is out of range");
}

}  // namespace
}  // namespace interlock
