/** @file A hand presses within its forces and pauses now and then. */
#include "needle/hand.hpp"

#include <gmock/gmock.h>

namespace interlock::needle::test {
namespace {

TEST(Hand, presses_within_its_forces_and_lets_go_now_and_then) {
  const HandParameters parameters;
  int pauses = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Hand hand(parameters, Noise(seed, 0));
    bool pressing = false;
    double largest_n = 0.0;
    for (int tick = 0; tick < 60'000; ++tick) {
      const double force_n = hand.press(0.001);
      ASSERT_GT(force_n, -0.2);
      largest_n = std::max(largest_n, force_n);
      pauses += pressing && force_n < 0.5 ? 1 : 0;
      pressing = pressing ? force_n >= 0.5 : force_n > 2.0;
    }
    EXPECT_GT(largest_n, parameters.lightest_n);
    EXPECT_LT(largest_n, parameters.hardest_n * (1.0 + parameters.sway_share) + parameters.tremor_n);
  }
  // Twenty minutes with one pause in about twelve seconds, each of which takes a second.
  EXPECT_GT(pauses, 60);
  EXPECT_LT(pauses, 120);
}

}  // namespace
}  // namespace interlock::needle::test
