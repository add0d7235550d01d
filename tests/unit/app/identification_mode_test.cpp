// An axis measured under the held pedal, by the real kernel core on the real plant.
#include <gtest/gtest.h>

#include <algorithm>

#include "closed_loop.hpp"
#include "counted_allocations.hpp"
#include "modes/identification/mode.hpp"
#include "plant/parameters.hpp"

namespace interlock {
namespace {

using test::ClosedLoop;
using test::minute_ticks;
using test::neuro;

constexpr std::uint32_t longest_ticks = 3 * minute_ticks;

/** A motor of which the robot's file knows nothing. */
struct HiddenMotor {
  double dead_zone;
  double full_speed_counts_per_s;
  std::uint32_t lag_us;
  double backlash_counts;
};

constexpr HiddenMotor hidden_motor{0.06, 800, 8000, 3};

const Axis& measured_axis() { return *neuro().find("probe_rotation"); }

plant::Parameters plant_with_hidden(const HiddenMotor& motor) {
  plant::Parameters plant = plant::default_parameters(test::config_of(neuro()));
  plant::AxisParameters& axis = plant.axis[measured_axis().slot];
  axis.dead_zone_fraction = motor.dead_zone;
  axis.full_speed_counts_per_s = motor.full_speed_counts_per_s;
  axis.lag = plant::Microseconds(motor.lag_us);
  axis.backlash_counts = motor.backlash_counts;
  return plant;
}

/** With ticks of latency of the link. */
class IdentificationModeTest : public testing::TestWithParam<std::uint32_t> {
 protected:
  IdentificationModeTest() : loop_(23, GetParam(), neuro(), plant_with_hidden(hidden_motor)) {
    loop_.make_ready(measured_axis().slot);
  }

  [[nodiscard]] IdentificationTask task() const {
    return {measured_axis().slot, measuring_range(loop_.config().axis[measured_axis().slot],
                                                  measured_axis().lowest_setpoint_counts(),
                                                  measured_axis().highest_setpoint_counts())};
  }
  [[nodiscard]] TaskStatus status() const { return loop_.status(typeid(IdentificationTask)); }
  [[nodiscard]] std::uint32_t drive() const { return loop_.outputs().command[measured_axis().slot].drive; }

  void run_to_end() {
    for (std::uint32_t i = 0; i < longest_ticks && is_open(status().phase); ++i) {
      loop_.tick();
    }
  }

  /** The bounds of docs/tuning.md. */
  void expect_hidden() {
    const MeasuredAxis& found = loop_.measured();
    ASSERT_EQ(status().phase, TaskPhase::done);
    EXPECT_EQ(status().reason, TaskReason::measured);
    EXPECT_NEAR(found.dead_zone_drive, hidden_motor.dead_zone * measured_axis().drive.max,
                0.003 * measured_axis().drive.max);
    EXPECT_NEAR(found.full_speed_counts_per_s, hidden_motor.full_speed_counts_per_s,
                0.006 * hidden_motor.full_speed_counts_per_s);
    EXPECT_NEAR(found.lag_s, hidden_motor.lag_us * 1e-6, 0.002);
    EXPECT_NEAR(found.backlash_counts, hidden_motor.backlash_counts, 0.75);
    EXPECT_EQ(found.noise_counts, 1u);
    ASSERT_TRUE(found.coast_counts);
    EXPECT_GE(*found.coast_counts, 5u);
    EXPECT_LE(*found.coast_counts, measured_axis().mechanics.coast_counts);
    EXPECT_EQ(loop_.refusals(), 0u);
  }

  ClosedLoop loop_;
};

TEST_P(IdentificationModeTest, AMotorThatNobodyDescribedIsMeasuredWithinTheStatedBounds) {
  loop_.give(1, task());
  run_to_end();
  expect_hidden();
  loop_.run(2 + GetParam());
  EXPECT_EQ(drive(), 0u);
}

TEST_P(IdentificationModeTest, AMoveThatWasInterruptedIsMeasuredAgain) {
  loop_.give(1, task());
  for (const std::uint32_t ticks : {2500u, 7000u, 333u, 1400u, 641u, 127u}) {
    loop_.run(ticks);
    ASSERT_EQ(status().phase, TaskPhase::executing);
    loop_.happen(plant::command::PressPedal{false});
    loop_.run(15 + GetParam());
    EXPECT_EQ(drive(), 0u);
    EXPECT_EQ(status().phase, TaskPhase::paused);
    loop_.pedal(true);
  }
  run_to_end();
  expect_hidden();
}

TEST_P(IdentificationModeTest, TheAxisStaysWithinItsRangeFromItsFirstMoveOn) {
  const MeasuringRange range = task().range;
  const auto coast = static_cast<std::int32_t>(measured_axis().mechanics.coast_counts);
  ASSERT_LT(range.lowest_counts, range.highest_counts);
  std::int32_t lowest = range.middle_counts();
  std::int32_t highest = range.middle_counts();
  loop_.watch([&] {
    const std::int32_t position = loop_.state().axis[measured_axis().slot].position_counts;
    if (status().step != 0) {
      lowest = std::min(lowest, position);
      highest = std::max(highest, position);
    }
  });
  loop_.give(1, task());
  run_to_end();
  ASSERT_EQ(status().phase, TaskPhase::done);
  EXPECT_GE(lowest, range.lowest_counts - coast);
  EXPECT_LE(highest, range.highest_counts + coast);
  EXPECT_GE(highest - lowest, 2 * range.way_counts) << "it was moved";
}

TEST_P(IdentificationModeTest, AStopEndsItWithinTheLatencyOfTheLink) {
  loop_.give(1, task());
  for (std::uint32_t i = 0; i < minute_ticks && drive() == 0; ++i) {
    loop_.tick();
  }
  ASSERT_GT(drive(), 0u);
  loop_.stop();
  loop_.run(2 + GetParam());
  EXPECT_EQ(drive(), 0u);
  EXPECT_EQ(status().phase, TaskPhase::aborted);
}

TEST_P(IdentificationModeTest, ATickAllocatesNothing) {
  IdentificationMode mode{RobotPlan(neuro(), loop_.config())};
  const TaskReference given = test::task_of(1, task());
  ilk_snapshot_t snapshot{};
  snapshot.state = loop_.state();
  ASSERT_EQ(snapshot.state.system.mode, static_cast<std::uint32_t>(ILK_MODE_MOTION));
  mode.take(given, snapshot.state.system.tick);
  test::count_allocations_of(pthread_self());
  ilk_axis_t& axis = snapshot.state.axis[measured_axis().slot];
  std::uint32_t driven = 0;
  for (std::uint32_t i = 0; i < minute_ticks && mode.is_open(); ++i) {
    KernelRequests requests;
    ++snapshot.state.system.tick;
    mode.tick(snapshot, requests);
    for (const KernelRequest& request : requests.all()) {
      snapshot.command[measured_axis().slot].drive =
          request.amplitude == 0 && request.drive == 1 ? 0 : request.drive;
      axis.setpoint_counts = request.target_counts;
    }
    if (snapshot.command[measured_axis().slot].drive != 0) {
      ++driven;
      axis.position_counts += axis.setpoint_counts > axis.position_counts ? 1 : -1;
    }
  }
  const std::uint32_t allocated = test::counted_allocations();
  test::count_allocations_of();
  EXPECT_EQ(allocated, 0u);
  EXPECT_GT(driven, 1000u) << "it was at work";
}

TEST_P(IdentificationModeTest, AnAxisThatStandsWhereItHasToMoveEndsItBeforeItIsAStall) {
  loop_.happen(plant::command::JamAxis{measured_axis().slot, true});
  loop_.give(1, task());
  run_to_end();
  EXPECT_EQ(status().phase, TaskPhase::aborted);
  EXPECT_EQ(status().reason, TaskReason::axis_stands);
  EXPECT_EQ(status().slot, measured_axis().slot);
  EXPECT_NE(loop_.state().axis[measured_axis().slot].state, static_cast<std::uint32_t>(ILK_AXIS_FAULTED));
}

INSTANTIATE_TEST_SUITE_P(Latencies, IdentificationModeTest, testing::Values(2u, 10u));

TEST(IdentificationOfTheInsertion, WaitsForTheBreathingGateAndMeasuresOnceItOpens) {
  ClosedLoop loop(23, 1);
  loop.make_all_ready();
  const Axis& axis = *neuro().at_slot(test::insertion);
  const auto status = [&] { return loop.status(typeid(IdentificationTask)); };
  loop.hold({.all = false, .insertion = true, .needs_press = false});
  loop.give(1, IdentificationTask{
                   axis.slot, measuring_range(loop.config().axis[axis.slot], axis.lowest_setpoint_counts(),
                                              axis.highest_setpoint_counts())});
  const std::int32_t begin = loop.state().axis[axis.slot].position_counts;
  for (int tick = 0; tick < 2000; ++tick) {
    loop.tick();
    ASSERT_EQ(loop.outputs().command[axis.slot].drive, 0u);
  }
  EXPECT_EQ(status().reason, TaskReason::breathing);
  EXPECT_NEAR(loop.state().axis[axis.slot].position_counts, begin, 1);
  loop.hold({});
  for (std::uint32_t i = 0; i < longest_ticks && is_open(status().phase); ++i) {
    loop.tick();
  }
  EXPECT_EQ(status().reason, TaskReason::measured);
  EXPECT_EQ(loop.refusals(), 0u);
}

}  // namespace
}  // namespace interlock
