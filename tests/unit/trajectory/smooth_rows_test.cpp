// What lies between the rows of a trajectory: it meets them, nothing of it leaps, and what it asks of an axis
// is known exactly.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "project_robots.hpp"
#include "trajectory/trajectory_csv.hpp"

namespace interlock {
namespace {

using Code = TrajectoryError::Code;
using test::neuro;

struct Row {
  double time_s = 0.0;
  double position = 0.0;
  double velocity = 0.0;
};

constexpr double jerk_step_s = 1e-5;

RateLimits limits_of(const char* axis) {
  const Axis& found = *neuro().find(axis);
  return found.motion->in_units(found.counts_per_unit);
}

TrajectoryResult<TimedTrajectory> yaw_through(const std::vector<Row>& rows, bool with_velocities,
                                              Timing timing = Timing::as_written) {
  std::vector<std::string> columns{"time [s]", "yaw [rad]"};
  if (with_velocities) {
    columns.emplace_back("yaw [rad/s]");
  }
  TrajectoryBuilder builder = TrajectoryBuilder::create(columns, neuro(), timing).value();
  for (const auto& [time_s, position, velocity] : rows) {
    const std::vector<double> row =
        with_velocities ? std::vector{time_s, position, velocity} : std::vector{time_s, position};
    EXPECT_TRUE(builder.add(row));
  }
  return std::move(builder).finish();
}

/** The rates that many samples of a trajectory show; the jerk by what the acceleration gains. */
RateLimits sampled(const TimedTrajectory& trajectory) {
  RateLimits seen;
  const auto see = [](double& most, double value) { most = std::max(most, std::abs(value)); };
  for (std::size_t row = 0; row + 1 < trajectory.rows(); ++row) {
    const MotionPiece piece = trajectory.piece(0, row);
    constexpr int samples = 200;
    for (int n = 0; n <= samples; ++n) {
      const double time_s = trajectory.step_s(row) * n / samples;
      const MotionState state = piece.after(time_s);
      see(seen.velocity, state.velocity);
      see(seen.acceleration, state.acceleration);
      const double gain =
          piece.after(time_s + jerk_step_s).acceleration - piece.after(time_s - jerk_step_s).acceleration;
      see(seen.jerk, gain / (2 * jerk_step_s));
    }
  }
  return seen;
}

std::vector<Row> drawn(std::mt19937_64& random) {
  std::uniform_int_distribution<int> count(1, 9);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::uniform_real_distribution<double> exponent(-2.0, 0.7);
  const double pace = std::pow(10.0, exponent(random));
  const double width = 0.4 * std::abs(share(random));
  std::vector<Row> rows;
  double time_s = 0.0;
  for (int n = count(random); n > 0; --n) {
    rows.push_back({time_s, -0.75 + width * share(random), width / pace * share(random)});
    time_s += pace * (0.3 + std::abs(share(random)));
  }
  return rows;
}

TEST(BetweenRows, NothingLeapsAtARow) {
  std::mt19937_64 random(31);
  for (int trial = 0; trial < 300; ++trial) {
    for (const bool with_velocities : {false, true}) {
      const std::vector<Row> rows = drawn(random);
      const auto trajectory = yaw_through(rows, with_velocities, Timing::slowed_to_fit);
      if (!trajectory) {
        ASSERT_EQ(trajectory.error().code, Code::out_of_range) << trajectory.error().message();
        continue;
      }
      const double slowed = trajectory->slowed_by();
      const RateLimits& top = trajectory->axes()[0].top;
      for (std::size_t row = 0; row < rows.size(); ++row) {
        const MotionState leaves = trajectory->piece(0, row).after(0.0);
        ASSERT_NEAR(leaves.position, rows[row].position, 1e-12);
        if (row + 1 < rows.size() && with_velocities) {
          ASSERT_NEAR(leaves.velocity * slowed, rows[row].velocity, 1e-9);
        }
        if (row > 0 && row + 1 < rows.size()) {
          const MotionState arrives = trajectory->piece(0, row - 1).after(trajectory->step_s(row - 1));
          ASSERT_NEAR(arrives.position, leaves.position, 1e-12);
          ASSERT_NEAR(arrives.velocity, leaves.velocity, 1e-9 * (1 + top.velocity));
          ASSERT_NEAR(arrives.acceleration, leaves.acceleration, 1e-9 * (1 + top.acceleration));
        }
      }
    }
  }
}

// As many as INTERLOCK_PATHS says.
TEST(BetweenRows, WhatIsAcceptedKeepsEveryRateAndWhatKeepsThemIsAccepted) {
  const char* const asked = std::getenv("INTERLOCK_PATHS");
  const int paths = asked == nullptr ? 2000 : std::atoi(asked);
  const RateLimits limits = limits_of("yaw");
  std::mt19937_64 random(37);
  int accepted = 0;
  int slowed = 0;
  for (int trial = 0; trial < paths; ++trial) {
    const bool with_velocities = trial % 2 == 0;
    const std::vector<Row> rows = drawn(random);
    const auto fitted = yaw_through(rows, with_velocities, Timing::slowed_to_fit);
    const auto written = yaw_through(rows, with_velocities);
    if (!fitted) {
      ASSERT_FALSE(written);
      ASSERT_EQ(fitted.error().code, Code::out_of_range) << fitted.error().message();
      continue;
    }
    const RateLimits seen = sampled(*fitted);
    ASSERT_LE(seen.velocity, limits.velocity * 1.001);
    ASSERT_LE(seen.acceleration, limits.acceleration * 1.001);
    ASSERT_LE(seen.jerk, limits.jerk * 1.001);
    // What is said of them is what there is.
    const RateLimits& top = fitted->axes()[0].top;
    ASSERT_GE(seen.velocity, top.velocity * 0.99 - 1e-9);
    ASSERT_GE(seen.acceleration, top.acceleration * 0.99 - 1e-9);
    ASSERT_GE(seen.jerk, top.jerk * 0.97 - 1e-6);
    ASSERT_EQ(written.has_value(), fitted->slowed_by() == 1.0);
    accepted += written ? 1 : 0;
    if (fitted->slowed_by() > 1.0) {
      ++slowed;
      const double fullest = std::max(
          {top.velocity / limits.velocity, top.acceleration / limits.acceleration, top.jerk / limits.jerk});
      ASSERT_NEAR(fullest, 1.0, 1e-9) << "slower than needed";
      ASSERT_NEAR(fitted->duration_s(), (rows.back().time_s - rows.front().time_s) * fitted->slowed_by(),
                  1e-9);
    }
  }
  EXPECT_GT(accepted, paths / 10);
  EXPECT_GT(slowed, paths / 10);
}

TEST(BetweenRows, RowsOfASmoothMotionLeadAlongIt) {
  const auto angle = [](double time_s) { return 2 * std::numbers::pi * 0.5 * time_s + 0.4; };
  for (const bool with_velocities : {false, true}) {
    std::vector<Row> rows;
    for (int n = 0; n <= 100; ++n) {
      const double time_s = 0.05 * n;
      rows.push_back(
          {time_s, -0.75 + 0.1 * std::sin(angle(time_s)), 0.1 * std::numbers::pi * std::cos(angle(time_s))});
    }
    const TimedTrajectory trajectory = yaw_through(rows, with_velocities).value();
    for (double time_s = 0.0; time_s < 5.0; time_s += 0.0037) {
      EXPECT_NEAR(trajectory.at(0, time_s).position, -0.75 + 0.1 * std::sin(angle(time_s)), 2e-4) << time_s;
    }
    EXPECT_LT(trajectory.axes()[0].top.acceleration, 0.1 * std::numbers::pi * std::numbers::pi * 1.2);
  }
}

TEST(BetweenRows, ARowWithoutVelocityAtAnEndIsRest) {
  const TimedTrajectory trajectory = yaw_through({{0, -0.9, 0}, {1, -0.7, 0.2}, {2, -0.5, 0}}, true).value();
  EXPECT_EQ(trajectory.piece(0, 0).after(0.0), (MotionState{-0.9, 0.0, 0.0}));
  EXPECT_EQ(trajectory.end(0), (MotionState{-0.5, 0.0, 0.0}));
}

TEST(BetweenRows, AReversalInAnInstantIsNoReversalInAnInstant) {
  std::string zigzag = "time [s],yaw [rad]\n";
  for (int n = 0; n < 20; ++n) {
    zigzag += std::to_string(n * 0.1) + (n % 2 == 0 ? ",-0.7\n" : ",-0.75\n");
  }
  const auto refused = read_trajectory(zigzag, neuro());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::too_much_acceleration) << refused.error().message();
  const TimedTrajectory slowed = read_trajectory(zigzag, neuro(), Timing::slowed_to_fit).value();
  EXPECT_GT(slowed.slowed_by(), 1.0);
  EXPECT_NEAR(slowed.at(0, slowed.duration_s() / 2).position, -0.725, 0.03);
}

TEST(BetweenRows, ARefusalNamesAxisTimeValueAndLimit) {
  // 4 Hz of 15 counts: 9,475 counts/s^2 where 6,000 are the rate, 238,127 counts/s^3 where 120,000 are.
  const Axis& yaw = *neuro().find("yaw");
  std::ostringstream text;
  text << "time [s],yaw [rad]\n";
  for (int n = 0; n <= 200; ++n) {
    text << n * 0.01 << ',' << -0.7 + 15 / yaw.counts_per_unit * std::sin(2 * std::numbers::pi * 4 * n * 0.01)
         << '\n';
  }
  const auto refused = read_trajectory(text.str(), neuro());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().code, testing::AnyOf(Code::too_much_acceleration, Code::too_much_jerk));
  EXPECT_THAT(refused.error().message(),
              testing::MatchesRegex(
                  "line [0-9]+, yaw \\[rad\\]: [0-9.]+ rad/s\\^[23] at [0-9.]+ s(, on the way from the row "
                  "before,)? is too much (acceleration|jerk); expected [0-9.]+ rad/s\\^[23] at most, "
                  "either way; slowed down to fit, it would take 1.[0-9]+ times as long"));
  const TimedTrajectory slowed = read_trajectory(text.str(), neuro(), Timing::slowed_to_fit).value();
  EXPECT_NEAR(slowed.slowed_by(), std::sqrt(9475.0 / 6000.0), 0.1);
}

TEST(BetweenRows, AVelocityThatIsTooFastInTheFirstRowIsOfThatRow) {
  const auto refused = read_trajectory("time [s],yaw [rad],yaw [rad/s]\n0,-1,0.9\n0.5,-0.8,0\n", neuro());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::too_fast);
  EXPECT_EQ(refused.error().line, 2u);
}

TEST(BetweenRows, NoVelocityIsSoLargeThatNothingIsKnownOfTheWay) {
  for (const char* velocity : {"1e308", "-1e307", "1e150", "1000001"}) {
    for (const Timing timing : {Timing::as_written, Timing::slowed_to_fit}) {
      const std::string text =
          std::string("time [s],yaw [rad],yaw [rad/s]\n0,-0.5,0\n1,-0.6,") + velocity + "\n2,-0.5,0\n";
      const auto refused = read_trajectory(text, neuro(), timing);
      ASSERT_FALSE(refused) << velocity;
      EXPECT_EQ(refused.error().code, Code::out_of_range);
      EXPECT_EQ(refused.error().line, 3u);
      EXPECT_EQ(refused.error().column, "yaw [rad/s]");
    }
  }
  const auto fast =
      read_trajectory("time [s],yaw [rad],yaw [rad/s]\n0,-0.5,0\n1,-0.6,1e6\n2,-0.5,0\n", neuro());
  ASSERT_FALSE(fast);
  EXPECT_THAT(fast.error().code,
              testing::AnyOf(Code::too_fast, Code::too_much_acceleration, Code::too_much_jerk));
}

TEST(BetweenRows, WhatWouldTakeMoreThanADayWhenSlowedDownIsRefused) {
  const auto refused = read_trajectory("time [s],yaw [rad]\n0,-1\n0.000001,-0.5\n1,-0.9\n99999,-0.5\n",
                                       neuro(), Timing::slowed_to_fit);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::out_of_range) << refused.error().message();
}

}  // namespace
}  // namespace interlock
