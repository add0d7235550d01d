// What a path demands of its axes from tick to tick keeps to their rates, wherever it is begun and however
// often it is left.
#include "motion/trajectory_follower.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "robot_fixture.hpp"
#include "trajectory/trajectory_builder.hpp"

namespace interlock {
namespace {

using test::neuro;
using test::neuro_config;

constexpr double tick_s = 0.001;
constexpr double rounding = 1.001;

/** Rows that are slowed down to what the yaw can do, so that some limit is met exactly. */
std::optional<TimedTrajectory> drawn(std::mt19937_64& random) {
  std::uniform_int_distribution<int> count(2, 6);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  const bool with_velocities = share(random) > 0.0;
  std::vector<std::string> columns{"time [s]", "yaw [rad]"};
  if (with_velocities) {
    columns.emplace_back("yaw [rad/s]");
  }
  TrajectoryBuilder builder = TrajectoryBuilder::create(columns, neuro(), Timing::slowed_to_fit).value();
  double time_s = 0.0;
  for (int n = count(random); n > 0; --n) {
    std::vector<double> row{time_s, -0.75 + 0.2 * share(random)};
    if (with_velocities) {
      row.push_back(share(random));
    }
    EXPECT_TRUE(builder.add(row));
    time_s += 0.05 + 0.3 * std::abs(share(random));
  }
  auto finished = std::move(builder).finish();
  return finished ? std::optional(*std::move(finished)) : std::nullopt;
}

/** Follows what a path demands of the yaw, tick by tick. */
class Demand {
 public:
  explicit Demand(const MotionRates& rates) : rates_(rates) {}

  void begin(const Setpoint& now) { before_ = now; }

  void see(const Setpoint& now) {
    ASSERT_LE(std::abs(now.velocity_counts_per_s), rates_.velocity_counts_per_s * rounding);
    ASSERT_LE(std::abs(now.acceleration_counts_per_s2), rates_.acceleration_counts_per_s2 * rounding);
    const double jerk = (now.acceleration_counts_per_s2 - before_.acceleration_counts_per_s2) / tick_s;
    ASSERT_LE(std::abs(jerk), rates_.jerk_counts_per_s3 * rounding);
    const double gained = (now.velocity_counts_per_s - before_.velocity_counts_per_s) / tick_s;
    ASSERT_LE(std::abs(gained), rates_.acceleration_counts_per_s2 * rounding);
    const double gone = (now.position_counts - before_.position_counts) / tick_s;
    ASSERT_LE(std::abs(gone), rates_.velocity_counts_per_s * rounding);
    before_ = now;
  }

 private:
  MotionRates rates_;
  Setpoint before_;
};

// As many as INTERLOCK_PATHS says.
TEST(TrajectoryFollower, NoTickAsksForMoreThanTheRatesWhereverTheTrajectoryIsTakenUp) {
  const char* const asked = std::getenv("INTERLOCK_PATHS");
  const int paths = asked == nullptr ? 300 : std::atoi(asked);
  const RobotPlan plan(neuro(), neuro_config());
  const MotionRates& rates = plan.axis[test::yaw].rates;
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int taken_up = 0;
  int walked = 0;
  while (walked < paths) {
    const auto trajectory = drawn(random);
    if (!trajectory) {
      continue;
    }
    ++walked;
    const PathLeg leg = TimedLeg{*trajectory};
    TrajectoryFollower walk(plan);
    walk.take(leg);
    ilk_snapshot_t snapshot = test::ready_view().snapshot;
    Demand demand(rates);
    double left_after_s = share(random) < 0.7 ? share(random) * 1.5 * trajectory->duration_s() : 1e9;
    for (bool through = false; !through;) {
      ASSERT_TRUE(walk.begin(snapshot, {}));
      demand.begin({static_cast<double>(snapshot.state.axis[test::yaw].position_counts), 0.0, 0.0});
      bool left = false;
      bool on_trajectory = false;
      do {
        while (!left && !walk.at_end()) {
          walk.advance(tick_s);
          const Setpoint now = walk.points()[test::yaw].now;
          demand.see(now);
          if (testing::Test::HasFatalFailure()) {
            FAIL() << "path " << walked << (taken_up > 0 ? ", taken up" : "");
          }
          left_after_s -= on_trajectory ? tick_s : 0.0;
          left = left_after_s < 0.0;
          snapshot.state.axis[test::yaw].position_counts =
              static_cast<std::int32_t>(std::llround(now.position_counts));
        }
        // From the approach, which ends at rest.
        on_trajectory = true;
      } while (!left && walk.go_on());
      taken_up += left ? 1 : 0;
      left_after_s = 1e9;
      through = !left;
    }
    const double end = *neuro().at_slot(test::yaw)->to_counts(trajectory->end(0).position);
    ASSERT_NEAR(snapshot.state.axis[test::yaw].position_counts, end, 1.0);
  }
  EXPECT_GT(taken_up, paths / 4);
}

}  // namespace
}  // namespace interlock
