#include "oracle/rules.hpp"

#include <gtest/gtest.h>

#include "stage.hpp"

namespace interlock::oracle::test {
namespace {

TEST(OracleRules, P13_permit_the_stated_maxima_and_nothing_beyond) {
  EXPECT_TRUE(are_permitted(stage_rules()));
  const auto refused = [](auto change) {
    SystemRules rules = stage_rules();
    change(rules);
    return !are_permitted(rules);
  };
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.lease_max_ticks = 151; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.pedal_debounce_ticks = 51; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.pedal_disagree_ticks = 51; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.bad_frame_limit = 6; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.overrun_limit = 11; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.axes[0].stall_ticks = 501; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.axes[0].coast = 0; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.axes[0].coast = 1000; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.axes[0].unhomed_max_drive = kMaxDrive / 10 + 1; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.axes[0].unhomed_travel = 201; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.axes[0].drift = kCoast - 1; }));
  EXPECT_TRUE(refused([](SystemRules& rules) { rules.axes[0].reverse = kCoast - 1; }));
}

TEST(OracleRules, P13_scale_times_to_the_period) {
  SystemRules rules = stage_rules();
  rules.period_us = 2000;
  EXPECT_FALSE(are_permitted(rules)) << "100 ticks are now 200 ms";
  rules.app_timeout_ticks = 75;
  rules.lease_max_ticks = 75;
  rules.pedal_disagree_ticks = 25;
  EXPECT_TRUE(are_permitted(rules));
}

}  // namespace
}  // namespace interlock::oracle::test
