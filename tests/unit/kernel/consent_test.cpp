// The pedal: arming, debounce, channels; and the number of each consent.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "bench.hpp"

namespace interlock::kernel_test {
namespace {

constexpr uint32_t axis = slot::pwm_free;
constexpr uint32_t debounce = 5;

void hold(Bench& bench, uint32_t ticks) {
  bench.pedal(true);
  bench.ticks(ticks);
}

TEST(P9_consent, MOTION_begins_in_the_tick_in_which_the_press_completes_and_not_before) {
  Bench bench = ready_bench();
  hold(bench, debounce - 1);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
  bench.pedal(false);
  bench.tick();
  hold(bench, debounce - 1);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY) << "a bouncing press starts again";
  bench.tick();
  EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
}

TEST(P9_consent, a_release_arms_after_its_debounce_time_and_not_before) {
  for (const uint32_t released : {debounce - 1, debounce}) {
    Bench bench = ready_bench();
    hold(bench, debounce);
    ASSERT_EQ(bench.ask(stop()), ILK_VERDICT_ACCEPTED);
    bench.pedal(false);
    bench.ticks(released);
    EXPECT_EQ(bench.system().pedal_armed, released == debounce ? 1u : 0u);
    hold(bench, 50);
    EXPECT_EQ(bench.mode(), released == debounce ? ILK_MODE_MOTION : ILK_MODE_READY);
  }
}

TEST(P9_consent, a_release_before_READY_does_not_arm) {
  Bench bench;
  bench.ticks(100);
  ASSERT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
  hold(bench, 50);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P9_consent, a_pedal_held_at_power_on_moves_nothing) {
  Bench bench;
  hold(bench, 50);
  EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_PEDAL_DOWN);
  bench.ticks(50);
  EXPECT_EQ(bench.mode(), ILK_MODE_LOCKED);
  EXPECT_TRUE(bench.wire_is_zero());
}

struct Disarm {
  const char* name;
  std::function<void(Bench&)> act;
};

const Disarm disarms[] = {
    {"STOP", [](Bench& bench) { bench.queue(stop()); }},
    {"change_of_holder", [](Bench& bench) { bench.holder = 2; }},
    {"new_attachment",
     [](Bench& bench) {
       bench.link_generation = 2;
       bench.last_sequence = 0;
     }},
    {"a_lock_and_RESET",
     [](Bench& bench) {
       const bool held = bench.pedal_no_closed == 1;
       bench.pedal(false);
       bench.estop_loop_closed = 0;
       bench.tick();
       bench.estop_loop_closed = 1;
       EXPECT_EQ(bench.ask(reset()), ILK_VERDICT_ACCEPTED);
       bench.pedal(held);
     }},
    {"silence_of_the_app",
     [](Bench& bench) {
       const bool held = bench.pedal_no_closed == 1;
       bench.pedal(false);
       bench.app_alive = false;
       bench.ticks(30);
       bench.app_alive = true;
       bench.pedal(held);
     }},
};

class P9_disarm : public testing::TestWithParam<Disarm> {};

INSTANTIATE_TEST_SUITE_P(By, P9_disarm, testing::ValuesIn(disarms),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(P9_disarm, an_armed_pedal_must_be_released_again) {
  for (const uint32_t held : {0u, debounce - 1}) {
    Bench bench = ready_bench();
    hold(bench, held);
    bench.pedal(held != 0);
    GetParam().act(bench);
    hold(bench, 50);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY) << held;
    EXPECT_EQ(bench.system().pedal_armed, 0u);
    bench.press();
    EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
  }
}

TEST(P9_consent, a_pedal_that_stays_up_is_armed_anew_after_the_debounce_time_from_STOP_or_a_new_holder) {
  for (const uint32_t holder : {1u, 2u}) {
    for (const uint32_t released : {debounce - 1, debounce}) {
      Bench bench = ready_bench();
      bench.holder = holder;
      EXPECT_EQ(bench.ask(holder == 1 ? stop() : disable(axis)), ILK_VERDICT_ACCEPTED);
      bench.ticks(released);
      hold(bench, 50);
      EXPECT_EQ(bench.mode(), released == debounce ? ILK_MODE_MOTION : ILK_MODE_READY);
    }
  }
}

TEST(P9_consent, a_release_without_the_app_does_not_arm_when_it_comes_back) {
  Bench bench = ready_bench();
  bench.app_alive = false;
  hold(bench, 40);
  bench.pedal(false);
  bench.ticks(20);
  bench.app_alive = true;
  hold(bench, 20);
  EXPECT_EQ(bench.mode(), ILK_MODE_READY);
}

TEST(P9_consent, disagreement_counts_neither_as_the_release_nor_as_the_press) {
  for (const uint32_t closed : {0u, 1u}) {
    Bench bench = ready_bench();
    bench.pedal_no_closed = bench.pedal_nc_closed = closed;
    bench.ticks(8);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    hold(bench, debounce);
    bench.ask(stop());
    for (int round = 0; round < 5; ++round) {
      bench.pedal_no_closed = bench.pedal_nc_closed = closed;
      bench.ticks(debounce + 2);
      hold(bench, debounce + 1);
      ASSERT_EQ(bench.mode(), ILK_MODE_READY);
    }
    EXPECT_EQ(bench.system().pedal_armed, 0u);
  }
}

TEST(P9_consent, a_contact_that_is_neither_open_nor_closed_is_a_disagreement) {
  for (const uint32_t contact : {2u, 0xFFFFFFFFu, 0x10000u}) {
    for (uint32_t Bench::* which : {&Bench::pedal_no_closed, &Bench::pedal_nc_closed}) {
      for (const bool pressed : {false, true}) {
        Bench bench = ready_bench();
        bench.pedal(pressed);
        bench.*which = contact;
        bench.tick();
        EXPECT_EQ(bench.system().pedal, uint32_t{ILK_PEDAL_DISAGREE});
      }
    }
  }
}

TEST(P9_consent, one_channel_uses_the_normally_open_contact_alone) {
  ilk_config_t config = standard_config();
  config.common.pedal_channels = 1;
  seal(config);
  for (const uint32_t unused : {0u, 1u, 7u}) {
    Bench bench = ready_bench(config);
    bench.pedal_no_closed = 1;
    bench.pedal_nc_closed = unused;
    bench.ticks(debounce - 1);
    EXPECT_EQ(bench.mode(), ILK_MODE_READY);
    bench.tick();
    EXPECT_EQ(bench.mode(), ILK_MODE_MOTION);
    bench.pedal_no_closed = 2;
    bench.tick();
    EXPECT_NE(bench.mode(), ILK_MODE_MOTION) << "read wrongly, it stops";
    bench.ticks(8);
    EXPECT_EQ(bench.cause(), ILK_CAUSE_PEDAL) << "and locks";
  }
}

// --- The number

ilk_request_t with_consent(ilk_request_t request, uint32_t consent) {
  request.consent = consent;
  return request;
}

TEST(P12_no_leap, each_press_has_another_number_that_lives_in_MOTION_only) {
  Bench bench = ready_bench();
  std::set<uint32_t> numbers;
  for (int round = 0; round < 50; ++round) {
    EXPECT_EQ(bench.system().consent, 0u);
    bench.press();
    const uint32_t number = bench.system().consent;
    EXPECT_NE(number, 0u);
    numbers.insert(number);
    bench.ticks(3);
    EXPECT_EQ(bench.system().consent, number);
    bench.release();
  }
  EXPECT_EQ(numbers.size(), 50u);
}

TEST(P12_no_leap, another_start_gives_another_number_at_the_same_tick) {
  std::set<uint32_t> numbers;
  for (const uint32_t nonce : {1u, 2u, 0x80000000u, 0xFFFFFFFFu}) {
    Bench bench;
    bench.boot_nonce = nonce;
    bench.to_motion();
    numbers.insert(bench.system().consent);
  }
  EXPECT_EQ(numbers.size(), 4u);
}

TEST(P12_no_leap, no_MOTION_begins_in_tick_0_whose_number_another_tick_has) {
  for (const uint32_t early : {0u, 1u}) {
    Bench bench = ready_bench();
    bench.damage_state().system.tick = 0u - debounce + 1u - early;
    bench.damage_state().system.frames_sent = 0;
    bench.reseal();
    hold(bench, debounce);
    EXPECT_EQ(bench.mode(), early == 0 ? ILK_MODE_READY : ILK_MODE_MOTION);
    EXPECT_EQ(bench.now(), 0u - early);
    hold(bench, 2 * debounce);
    EXPECT_EQ(bench.mode(), early == 0 ? ILK_MODE_READY : ILK_MODE_MOTION) << "the next try needs a release";
  }
}

TEST(P12_no_leap, no_number_is_zero_and_none_comes_twice_even_where_nonce_and_tick_are_equal) {
  Bench first = ready_bench();
  first.press();
  const uint32_t tick = first.now();
  Bench bench = ready_bench();
  bench.boot_nonce = tick;
  bench.press();
  ASSERT_EQ(bench.now(), tick);
  const uint32_t number = bench.system().consent;
  EXPECT_NE(number, 0u);
  bench.release();
  for (int round = 0; round < 50; ++round) {
    bench.press();
    EXPECT_NE(bench.system().consent, number);
    bench.release();
  }
}

TEST(P12_no_leap, orders_for_another_press_are_refused_and_equality_is_the_only_comparison) {
  Bench bench = motion_bench(axis);
  bench.enable_axis(slot::pwm_lower);
  const uint32_t earlier = bench.system().consent;
  EXPECT_EQ(bench.ask(move(axis, 50)), ILK_VERDICT_ACCEPTED);
  bench.release();
  bench.press();
  const uint32_t now = bench.system().consent;
  for (const uint32_t wrong : {earlier, now + 1, now - 1, ~now, 0xFFFFFFFFu}) {
    EXPECT_EQ(bench.ask(with_consent(move(axis, 50), wrong)), ILK_VERDICT_CONSENT);
    EXPECT_EQ(bench.ask(with_consent(home(slot::pwm_lower), wrong)), ILK_VERDICT_CONSENT);
    EXPECT_TRUE(bench.wire_is_zero());
  }
  EXPECT_EQ(bench.ask(with_consent(move(axis, 50), now)), ILK_VERDICT_ACCEPTED);
  EXPECT_EQ(bench.ask(with_consent(home(slot::pwm_lower), now)), ILK_VERDICT_ACCEPTED);
  EXPECT_TRUE(bench.driven(axis));
}

TEST(P12_no_leap, an_order_without_a_number_is_refused) {
  Bench bench = motion_bench(axis);
  ilk_request_t request = move(axis, 50);
  request.sequence = ++bench.last_sequence;
  bench.queue_record(with_crc(request));
  bench.tick();
  EXPECT_EQ(bench.verdict(0), ILK_VERDICT_CONSENT);
}

TEST(P12_no_leap, an_order_of_before_a_restart_is_refused_after_it_at_the_very_same_tick) {
  const auto number = [](uint32_t nonce) {
    Bench bench = ready_bench();
    bench.boot_nonce = nonce;
    bench.enable_axis(axis);
    bench.press();
    return bench;
  };
  const uint32_t before = number(17).system().consent;
  Bench after = number(18);
  EXPECT_EQ(after.ask(with_consent(move(axis, 50), before)), ILK_VERDICT_CONSENT);
}

TEST(P12_no_leap, an_order_given_while_the_pedal_goes_down_is_refused_and_not_remembered) {
  Bench bench = ready_bench();
  bench.enable_axis(axis);
  bench.pedal(true);
  for (uint32_t held = 1; held < debounce; ++held) EXPECT_EQ(bench.ask(move(axis, 50)), ILK_VERDICT_MODE);
  EXPECT_EQ(bench.ask(with_consent(move(axis, 50), 1)), ILK_VERDICT_CONSENT) << "nobody knows it before";
  ASSERT_EQ(bench.mode(), ILK_MODE_MOTION);
  EXPECT_EQ(bench.gate(axis), ILK_GATE_LEASE);
  bench.ticks(20);
  EXPECT_TRUE(bench.wire_is_zero());
}

TEST(P12_no_leap, enabling_in_MOTION_moves_nothing) {
  Bench bench;
  bench.to_motion();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) bench.queue(enable(slot));
  bench.ticks(50);
  EXPECT_TRUE(bench.wire_is_zero());
}

}  // namespace
}  // namespace interlock::kernel_test
