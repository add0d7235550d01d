#include "http/bench_pedal.hpp"

#include <gtest/gtest.h>

#include "interlock/sim_bus.h"

namespace interlock::web {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

constexpr BenchPedal::TimePoint start{};

ControlView view_of(std::uint32_t clock) {
  ControlView view;
  view.attached = true;
  view.snapshot.clock = clock;
  view.snapshot.period_us = 1000;
  view.snapshot.state.tick = UINT32_MAX - 100;
  return view;
}

TEST(BenchPedal, IsNeverOverdueUnlessHeld) {
  BenchPedal pedal;
  EXPECT_FALSE(pedal.overdue(view_of(ILK_CLOCK_REAL), start + hours(1)));
  pedal.hold(view_of(ILK_CLOCK_REAL), start);
  pedal.release();
  EXPECT_FALSE(pedal.overdue(view_of(ILK_CLOCK_REAL), start + hours(1)));
}

TEST(BenchPedal, IsOverdueAfterHalfASecondOfTheRealClock) {
  BenchPedal pedal;
  pedal.hold(view_of(ILK_CLOCK_REAL), start);
  EXPECT_FALSE(pedal.overdue(view_of(ILK_CLOCK_REAL), start + milliseconds(499)));
  EXPECT_TRUE(pedal.overdue(view_of(ILK_CLOCK_REAL), start + milliseconds(500)));
}

TEST(BenchPedal, CountsKernelTicksInTheSimulatedClock) {
  BenchPedal pedal;
  ControlView view = view_of(ILK_CLOCK_SIM);
  pedal.hold(view, start);
  view.snapshot.state.tick += 499;
  EXPECT_FALSE(pedal.overdue(view, start + hours(1)));
  view.snapshot.state.tick += 1;
  EXPECT_TRUE(pedal.overdue(view, start));
}

TEST(BenchPedal, RenewalStartsTheHalfSecondAnew) {
  BenchPedal pedal;
  pedal.hold(view_of(ILK_CLOCK_REAL), start);
  pedal.hold(view_of(ILK_CLOCK_REAL), start + milliseconds(400));
  EXPECT_FALSE(pedal.overdue(view_of(ILK_CLOCK_REAL), start + milliseconds(800)));
}

TEST(BenchPedal, FallsBackToTheWallClockWithoutAKernel) {
  BenchPedal pedal;
  ControlView view = view_of(ILK_CLOCK_SIM);
  pedal.hold(view, start);
  view.attached = false;
  EXPECT_TRUE(pedal.overdue(view, start + milliseconds(500)));
}

}  // namespace
}  // namespace interlock::web
