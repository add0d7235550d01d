#include "http/held_lease.hpp"

#include <gtest/gtest.h>

#include "interlock/sim_bus.h"

namespace interlock::web {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

constexpr HeldLease::TimePoint start{};

ControlView view_of(std::uint32_t clock) {
  ControlView view;
  view.attached = true;
  view.snapshot.clock = clock;
  view.snapshot.period_us = 1000;
  view.snapshot.state.system.tick = UINT32_MAX - 100;
  return view;
}

TEST(HeldLease, IsNeverOverdueUnlessHeld) {
  HeldLease lease(milliseconds(500));
  EXPECT_FALSE(lease.overdue(view_of(ILK_CLOCK_REAL), start + hours(1)));
  lease.hold(view_of(ILK_CLOCK_REAL), start);
  lease.release();
  EXPECT_FALSE(lease.overdue(view_of(ILK_CLOCK_REAL), start + hours(1)));
}

TEST(HeldLease, IsOverdueAfterItsPatienceOfTheRealClock) {
  HeldLease lease(milliseconds(500));
  lease.hold(view_of(ILK_CLOCK_REAL), start);
  EXPECT_FALSE(lease.overdue(view_of(ILK_CLOCK_REAL), start + milliseconds(499)));
  EXPECT_TRUE(lease.overdue(view_of(ILK_CLOCK_REAL), start + milliseconds(500)));
}

TEST(HeldLease, CountsKernelTicksInTheSimulatedClock) {
  HeldLease lease(milliseconds(500));
  ControlView view = view_of(ILK_CLOCK_SIM);
  lease.hold(view, start);
  view.snapshot.state.system.tick += 499;
  EXPECT_FALSE(lease.overdue(view, start + hours(1)));
  view.snapshot.state.system.tick += 1;
  EXPECT_TRUE(lease.overdue(view, start));
}

TEST(HeldLease, RenewalStartsThePatienceAnew) {
  HeldLease lease(milliseconds(500));
  lease.hold(view_of(ILK_CLOCK_REAL), start);
  lease.hold(view_of(ILK_CLOCK_REAL), start + milliseconds(400));
  EXPECT_FALSE(lease.overdue(view_of(ILK_CLOCK_REAL), start + milliseconds(800)));
}

TEST(HeldLease, FallsBackToTheWallClockWithoutAKernel) {
  HeldLease lease(milliseconds(500));
  ControlView view = view_of(ILK_CLOCK_SIM);
  lease.hold(view, start);
  view.attached = false;
  EXPECT_TRUE(lease.overdue(view, start + milliseconds(500)));
}

}  // namespace
}  // namespace interlock::web
