#include "motion/outside_holds.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "closed_loop.hpp"

namespace interlock {
namespace {

using std::chrono::milliseconds;
using test::ClosedLoop;
using test::minute_ticks;
using test::neuro;

constexpr std::uint32_t sideways = 4;
constexpr std::int32_t deep = 1300;
constexpr StandStill insertion_waits{.all = false, .insertion = true, .needs_press = false};
constexpr StandStill all_wait{.all = true, .insertion = false, .needs_press = false};
constexpr StandStill nothing_waits{};

PathProgram insert_to(std::int32_t counts) { return {{MoveLeg{{{test::insertion, counts}}, 0.0, 0.0}}}; }

/** The robot stands ready under a held pedal, the insertion at 0. */
class OutsideHoldsOnThePlant : public testing::TestWithParam<std::uint32_t> {
 protected:
  OutsideHoldsOnThePlant() : loop_(5, GetParam()) { loop_.make_all_ready(); }

  [[nodiscard]] std::int32_t inserted() const { return loop_.state().axis[test::insertion].position_counts; }

  void run_to(std::int32_t counts) {
    for (std::uint32_t i = 0; i < minute_ticks && inserted() < counts; ++i) {
      loop_.tick();
    }
    ASSERT_GE(inserted(), counts);
  }

  void expect_rest(std::uint32_t ticks) {
    const std::int32_t before = inserted();
    for (std::uint32_t i = 0; i < ticks; ++i) {
      loop_.tick();
      ASSERT_NEAR(inserted(), before, loop_.config().axis[test::insertion].deadband_counts);
    }
  }

  ClosedLoop loop_;
};

TEST_P(OutsideHoldsOnThePlant, TheInsertionWaitsForTheBreathingGateAndGoesOnUnderTheSamePress) {
  loop_.give(1, test::along(insert_to(deep)));
  run_to(400);
  loop_.hold(insertion_waits);
  loop_.run(1000);
  EXPECT_LT(inserted(), deep / 2);
  expect_rest(8000);
  EXPECT_EQ(loop_.path().phase, TaskPhase::executing);
  EXPECT_EQ(loop_.path().reason, TaskReason::breathing);
  loop_.hold(nothing_waits);
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop_.path().phase); ++i) {
    loop_.tick();
  }
  EXPECT_EQ(loop_.path().phase, TaskPhase::done);
  EXPECT_NEAR(inserted(), deep, loop_.config().axis[test::insertion].deadband_counts);
  EXPECT_EQ(loop_.refusals(), 0u);
}

TEST_P(OutsideHoldsOnThePlant, ThePathSlowsDownAndComesUpAgainWithinTheAxisAcceleration) {
  const Axis& axis = *neuro().at_slot(test::insertion);
  const double most = axis.motion->acceleration_counts_per_s2 * neuro().period_us * 1e-6;
  loop_.give(1, test::along(insert_to(deep)));
  double before = loop_.setpoint(test::insertion)->velocity_counts_per_s;
  double fastest = 0.0;
  std::uint32_t stood = 0;
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop_.path().phase); ++i) {
    // Breaths as short as this close it at every stage of the way.
    loop_.hold(i % 500 < 250 ? nothing_waits : insertion_waits);
    loop_.tick();
    const auto point = loop_.setpoint(test::insertion);
    const double velocity = point ? point->velocity_counts_per_s : 0.0;
    ASSERT_LE(std::abs(velocity - before), 1.05 * most) << "tick " << i;
    before = velocity;
    fastest = std::max(fastest, velocity);
    stood += point && velocity == 0.0 && i % 500 > 400 ? 1u : 0u;
  }
  EXPECT_EQ(loop_.path().phase, TaskPhase::done);
  EXPECT_GT(fastest, 0.5 * axis.motion->velocity_counts_per_s);
  EXPECT_GT(stood, 300u);
}

TEST_P(OutsideHoldsOnThePlant, AGateThatIsClosedBeforehandLetsTheInsertionNotBegin) {
  loop_.hold(insertion_waits);
  loop_.give(1, test::along(insert_to(deep)));
  expect_rest(2000);
  EXPECT_EQ(loop_.path().reason, TaskReason::breathing);
}

TEST_P(OutsideHoldsOnThePlant, WithdrawalAndOtherAxesWaitForNoBreath) {
  (void)loop_.carry_out(1, test::along(insert_to(1000)), minute_ticks);
  loop_.hold(insertion_waits);
  const PathProgram back{{MoveLeg{{{test::insertion, 200}, {sideways, -400}}, 0.0, 0.0}}};
  EXPECT_EQ(loop_.carry_out(2, test::along(back), minute_ticks).phase, TaskPhase::done);
  EXPECT_EQ(loop_.carry_out(3, MoveTask{test::insertion, 100}, minute_ticks).phase, TaskPhase::done);
}

TEST_P(OutsideHoldsOnThePlant, AMoveOfTheInsertionAloneWaitsAndGoesOn) {
  loop_.give(1, MoveTask{test::insertion, deep});
  run_to(400);
  loop_.hold(insertion_waits);
  loop_.run(500);
  expect_rest(2000);
  EXPECT_EQ(loop_.move(test::insertion).phase, TaskPhase::paused);
  EXPECT_EQ(loop_.move(test::insertion).reason, TaskReason::breathing);
  loop_.hold(nothing_waits);
  run_to(deep - 100);
}

TEST_P(OutsideHoldsOnThePlant, AScanEndsMotionAndNoPressBeginsAnyUntilItIsOver) {
  loop_.give(1, test::along(insert_to(deep)));
  run_to(400);
  loop_.hold(all_wait);
  loop_.run(300);
  EXPECT_EQ(loop_.state().system.mode, static_cast<std::uint32_t>(ILK_MODE_READY));
  expect_rest(1000);
  loop_.pedal(false);
  loop_.pedal(true);
  EXPECT_EQ(loop_.state().system.mode, static_cast<std::uint32_t>(ILK_MODE_READY));
  expect_rest(1000);
  EXPECT_EQ(loop_.path().phase, TaskPhase::paused);
  EXPECT_EQ(loop_.path().reason, TaskReason::scanning);
  loop_.hold(nothing_waits);
  expect_rest(1000);
  EXPECT_EQ(loop_.path().reason, TaskReason::pedal_released) << "a pedal that is held still starts nothing";
  loop_.pedal(false);
  loop_.pedal(true);
  for (std::uint32_t i = 0; i < minute_ticks && is_open(loop_.path().phase); ++i) {
    loop_.tick();
  }
  EXPECT_EQ(loop_.path().phase, TaskPhase::done);
  EXPECT_EQ(loop_.refusals(), 0u);
}

TEST_P(OutsideHoldsOnThePlant, NoKindOfMotionBeginsDuringAScan) {
  loop_.hold(all_wait);
  loop_.give(1, MoveTask{sideways, -2000});
  loop_.give(2, test::along(insert_to(deep)));
  loop_.pedal(false);
  bool was_driven = false;
  loop_.watch([&] {
    for (const Axis& axis : neuro().axes) {
      was_driven = was_driven || loop_.outputs().command[axis.slot].drive != 0;
    }
  });
  loop_.pedal(true);
  loop_.give(3, HomeTask{.first_step = 0, .step_count = 1, .slots = {test::insertion}});
  loop_.pedal(false);
  loop_.pedal(true);
  loop_.run(2000);
  EXPECT_FALSE(was_driven);
}

INSTANTIATE_TEST_SUITE_P(Links, OutsideHoldsOnThePlant, testing::Values(0u, 2u));

TEST(BreathingGate, IsOpenForTheValidityOfItsNewestSignalByEitherClock) {
  for (const std::uint32_t tick_us : {0u, 1000u}) {
    const Moment begin{{}, 100, tick_us};
    const auto after = [&](int ms) {
      return Moment{begin.time + milliseconds(ms), begin.tick + static_cast<std::uint32_t>(ms), tick_us};
    };
    BreathingGate gate;
    EXPECT_EQ(gate.at(begin), GateState::off);
    gate.in_use = true;
    EXPECT_EQ(gate.at(begin), GateState::no_signal) << "nothing came yet";
    gate.open = true;
    gate.signal = DeadmanTimer(milliseconds(300));
    gate.signal.hold(begin);
    EXPECT_EQ(gate.at(after(299)), GateState::open);
    EXPECT_EQ(gate.at(after(300)), GateState::no_signal);
    gate.open = false;
    EXPECT_EQ(gate.at(after(299)), GateState::hold);
    gate.signal.release();
    EXPECT_EQ(gate.at(begin), GateState::no_signal) << "its source is gone";
  }
}

}  // namespace
}  // namespace interlock
