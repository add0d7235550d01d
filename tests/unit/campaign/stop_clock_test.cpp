#include "stop_clock.hpp"

#include <gtest/gtest.h>

namespace interlock::campaign {
namespace {

class StopClockTest : public testing::Test {
 protected:
  void drive(std::size_t slot, bool on) { sent.frame[slot][14] = on ? 1 : 0; }

  ilk_outputs_t sent{};
  StopClock clock;
};

TEST_F(StopClockTest, P2_stop_in_time_is_met) {
  drive(3, true);
  clock.demand(12, kNoAxis, "E-stop");
  EXPECT_EQ(clock.step(11, sent), 0u);
  drive(3, false);
  EXPECT_EQ(clock.step(12, sent), 0u);
  EXPECT_EQ(clock.met(), 1u);
}

TEST_F(StopClockTest, P2_stop_after_its_deadline_is_late_once) {
  drive(3, true);
  clock.demand(12, kNoAxis, "E-stop");
  EXPECT_EQ(clock.step(12, sent), 1u);
  EXPECT_EQ(clock.latest(), "E-stop");
  EXPECT_EQ(clock.step(13, sent), 0u);
  EXPECT_EQ(clock.met(), 0u);
}

TEST_F(StopClockTest, Demand_on_one_axis_ignores_the_others) {
  drive(3, true);
  clock.demand(12, 4, "card");
  EXPECT_EQ(clock.step(12, sent), 0u);
  clock.demand(14, 3, "card");
  EXPECT_EQ(clock.step(14, sent), 1u);
}

TEST_F(StopClockTest, Refuses_what_it_cannot_hold) {
  drive(0, true);
  for (int demand = 0; demand < 64; demand++) {
    EXPECT_TRUE(clock.demand(100, kNoAxis, "pedal"));
  }
  EXPECT_FALSE(clock.demand(100, kNoAxis, "pedal"));
}

}  // namespace
}  // namespace interlock::campaign
