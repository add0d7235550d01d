// The front panel.
#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

ilk_colour_t lamp(const Bench& bench, ilk_lamp_t which) {
  return static_cast<ilk_colour_t>(bench.out().lamp[which]);
}

TEST(Lamps, pedal_is_green_in_MOTION_red_at_estop_else_off) {
  Bench bench;
  bench.tick();
  EXPECT_EQ(lamp(bench, ILK_LAMP_PEDAL), ILK_COLOUR_OFF);
  bench.to_ready();
  EXPECT_EQ(lamp(bench, ILK_LAMP_PEDAL), ILK_COLOUR_OFF);
  bench.press();
  EXPECT_EQ(lamp(bench, ILK_LAMP_PEDAL), ILK_COLOUR_GREEN);
  bench.estop_loop_closed = 0;
  bench.tick();
  EXPECT_EQ(lamp(bench, ILK_LAMP_PEDAL), ILK_COLOUR_RED);
  bench.estop_loop_closed = 1;
  bench.tick();
  EXPECT_EQ(lamp(bench, ILK_LAMP_PEDAL), ILK_COLOUR_OFF);
}

TEST(Lamps, network_is_green_while_the_app_is_alive) {
  Bench bench;
  bench.app_alive = false;
  bench.ticks(3);
  EXPECT_EQ(lamp(bench, ILK_LAMP_NETWORK), ILK_COLOUR_RED);
  bench.app_alive = true;
  bench.ticks(2);
  EXPECT_EQ(lamp(bench, ILK_LAMP_NETWORK), ILK_COLOUR_GREEN);
  bench.app_alive = false;
  bench.ticks(31);
  EXPECT_EQ(lamp(bench, ILK_LAMP_NETWORK), ILK_COLOUR_RED);
}

TEST(Lamps, controller_is_red_while_LOCKED_and_green_when_it_can_work) {
  Bench bench;
  bench.tick();
  EXPECT_EQ(lamp(bench, ILK_LAMP_CONTROLLER), ILK_COLOUR_RED);
  bench.to_ready();
  EXPECT_EQ(lamp(bench, ILK_LAMP_CONTROLLER), ILK_COLOUR_GREEN);
  bench.press();
  EXPECT_EQ(lamp(bench, ILK_LAMP_CONTROLLER), ILK_COLOUR_GREEN);
}

TEST(Lamps, stall_is_purple_for_a_stall_before_amber_for_another_fault) {
  Bench bench = motion_bench(slot::pwm_free);
  EXPECT_EQ(lamp(bench, ILK_LAMP_STALL), ILK_COLOUR_OFF);
  bench.motor[slot::pwm_lower].travelled += 100;
  bench.tick();
  EXPECT_EQ(lamp(bench, ILK_LAMP_STALL), ILK_COLOUR_AMBER);
  bench.press();
  bench.motor[slot::pwm_free].frozen = true;
  bench.keep_moving(slot::pwm_free, 50, 51);
  ASSERT_EQ(bench.fault(slot::pwm_free), ILK_FAULT_STALL);
  EXPECT_EQ(lamp(bench, ILK_LAMP_STALL), ILK_COLOUR_PURPLE);
  bench.pedal(false);
  bench.rest();
  bench.ask(clear_fault(slot::pwm_free));
  EXPECT_EQ(lamp(bench, ILK_LAMP_STALL), ILK_COLOUR_AMBER);
  bench.ask(clear_fault(slot::pwm_lower));
  EXPECT_EQ(lamp(bench, ILK_LAMP_STALL), ILK_COLOUR_OFF);
}

}  // namespace
}  // namespace interlock::kernel_test
