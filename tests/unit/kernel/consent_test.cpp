// The pedal: arming, debounce, channels, and that consent is always fresh.
#include <gtest/gtest.h>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t debounce = 5;

TEST(P9_consent, a_press_counts_after_its_debounce_time_and_not_before) {
  Bench bench;
  bench.to_ready();
  bench.arm();
  bench.pedal(true);
  bench.ticks(debounce - 1);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(P9_consent, a_bouncing_press_starts_again) {
  Bench bench;
  bench.to_ready();
  bench.arm();
  bench.pedal(true);
  bench.ticks(debounce - 1);
  bench.pedal(false);
  bench.tick();
  bench.pedal(true);
  bench.ticks(debounce - 1);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(P9_consent, a_release_arms_after_its_debounce_time_and_not_before) {
  Bench bench;
  bench.to_ready();
  bench.ticks(debounce - 1);
  EXPECT_EQ(bench.state().pedal_armed, 0u);
  bench.pedal(true);
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);

  bench.pedal(false);
  bench.ticks(debounce);
  EXPECT_EQ(bench.state().pedal_armed, 1u);
  bench.pedal(true);
  bench.ticks(debounce);
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(P9_consent, a_release_before_READY_does_not_arm) {
  Bench bench;
  bench.pedal(false);
  bench.ticks(100);
  ASSERT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  bench.pedal(true);
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P9_consent, a_pedal_held_at_power_on_moves_nothing) {
  Bench bench;
  bench.pedal(true);
  bench.ticks(50);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_PEDAL_DOWN);
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(P9_consent, each_entry_to_MOTION_needs_a_release_and_a_press) {
  Bench bench;
  bench.to_motion();
  ASSERT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
  bench.ticks(100);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.press();
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(P9_consent, disagreement_never_counts_as_the_release) {
  Bench bench;
  bench.to_motion();
  bench.ask(stop());
  for (int round = 0; round < 5; ++round) {
    bench.pedal_no_closed = 0;
    bench.pedal_nc_closed = 0;
    bench.ticks(debounce + 2);
    bench.pedal(true);
    bench.ticks(debounce + 1);
    ASSERT_EQ(bench.mode(), ILK_MODE_READY);
  }
  EXPECT_EQ(bench.state().pedal_armed, 0u);
}

TEST(P9_consent, disagreement_never_counts_as_the_press) {
  Bench bench;
  bench.to_ready();
  bench.arm();
  bench.pedal_no_closed = 1;
  bench.ticks(8);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  EXPECT_EQ(bench.state().pedal, uint32_t{ILK_PEDAL_DISAGREE});
}

TEST(P9_consent, a_contact_that_is_neither_open_nor_closed_is_a_disagreement) {
  for (const uint32_t contact : {2u, 0xFFFFFFFFu, 0x10000u}) {
    Bench bench;
    bench.to_ready();
    bench.pedal_no_closed = contact;
    bench.tick();
    EXPECT_EQ(bench.state().pedal, uint32_t{ILK_PEDAL_DISAGREE});
    bench.pedal_no_closed = 0;
    bench.pedal_nc_closed = contact;
    bench.tick();
    EXPECT_EQ(bench.state().pedal, uint32_t{ILK_PEDAL_DISAGREE});
  }
}

TEST(P9_consent, a_change_of_holder_disarms) {
  Bench bench;
  bench.to_ready();
  bench.arm();
  bench.holder = 2;
  bench.pedal(true);
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.press();
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(P9_consent, a_change_of_holder_during_the_press_disarms) {
  Bench bench;
  bench.to_ready();
  bench.arm();
  bench.pedal(true);
  bench.ticks(debounce - 2);
  bench.holder = 2;
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P9_consent, a_release_without_the_app_does_not_arm) {
  Bench bench;
  bench.to_ready();
  bench.app_alive = false;
  bench.pedal(true);
  bench.ticks(40);
  bench.pedal(false);
  bench.ticks(20);
  EXPECT_EQ(bench.state().pedal_armed, 0u);
  bench.pedal(true);
  bench.app_alive = true;
  bench.ticks(20);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P9_consent, one_channel_uses_the_normally_open_contact_alone) {
  ilk_config_t config = standard_config();
  config.pedal_channels = 1;
  seal(config);
  for (const uint32_t unused : {0u, 1u, 7u}) {
    Bench bench(config);
    bench.to_ready();
    bench.arm();
    bench.pedal_no_closed = 1;
    bench.pedal_nc_closed = unused;
    bench.ticks(debounce - 1);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    bench.tick();
    EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
    bench.pedal_no_closed = 0;
    bench.tick();
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  }
}

TEST(P9_consent, one_channel_read_wrongly_stops_and_locks) {
  ilk_config_t config = standard_config();
  config.pedal_channels = 1;
  seal(config);
  Bench bench(config);
  bench.to_motion();
  bench.pedal_no_closed = 2;
  bench.tick();
  EXPECT_NE(bench.mode(), ILK_MODE_MOTION);
  bench.ticks(8);
  EXPECT_EQ(bench.cause(), ILK_CAUSE_PEDAL);
}

TEST(P12_no_leap, entering_MOTION_again_resumes_nothing) {
  Bench bench;
  bench.to_motion();
  bench.enable_axis(slot::pwm_free);
  bench.enable_axis(slot::pwm_lower);
  bench.queue(move(slot::pwm_free, 80, 100, 20));
  bench.queue(home(slot::pwm_lower));
  bench.tick();
  bench.release();
  EXPECT_EQ(bench.axis_state(slot::pwm_free), ILK_AXIS_ENABLED);
  EXPECT_EQ(bench.axis_state(slot::pwm_lower), ILK_AXIS_ENABLED);
  bench.press();
  for (int later = 0; later < 30; ++later) {
    EXPECT_TRUE(bench.wire_is_zero());
    bench.tick();
  }
}

TEST(P12_no_leap, a_MOVE_asked_in_READY_is_refused_and_not_remembered) {
  Bench bench;
  bench.to_ready();
  bench.enable_axis(slot::pwm_free);
  bench.arm();
  bench.pedal(true);
  for (uint32_t held = 1; held < debounce; ++held) {
    EXPECT_EQ(bench.ask(move(slot::pwm_free, 50)), ILK_VERDICT_MODE);
  }
  bench.tick();
  ASSERT_EQ(bench.mode(), ILK_MODE_MOTION);
  EXPECT_TRUE(bench.wire_is_zero());
  EXPECT_EQ(bench.gate(slot::pwm_free), ILK_GATE_LEASE);
  EXPECT_EQ(bench.ask(move(slot::pwm_free, 50)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(slot::pwm_free));
}

TEST(P12_no_leap, enabling_in_MOTION_moves_nothing) {
  Bench bench;
  bench.to_motion();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) bench.queue(enable(slot));
  bench.tick();
  EXPECT_TRUE(bench.wire_is_zero());
  bench.ticks(50);
  EXPECT_TRUE(bench.wire_is_zero());
}

}  // namespace
}  // namespace interlock::kernel_test
