// ilk_config_validate: each rule just inside and just outside, by the texts of spec/catalog.toml.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "bench.hpp"
#include "dice.hpp"

namespace interlock::kernel_test {
namespace {

using Edit = std::function<void(ilk_config_t&)>;

struct Rule {
  std::string name;
  uint32_t error;
  uint32_t slot;
  Edit inside;
  Edit outside;
};

void PrintTo(const Rule& rule, std::ostream* stream) { *stream << rule.name; }

ilk_config_verdict_t verdict_after(const Edit& edit) {
  ilk_config_t config = standard_config();
  edit(config);
  seal(config);
  return ilk_config_validate(&config);
}

/// A rule over one system field.
Rule system_rule(std::string name, ilk_config_error_t error, uint32_t ilk_config_t::* field, uint32_t inside,
                 uint32_t outside) {
  return {std::move(name), error, ILK_SLOTS, [=](ilk_config_t& config) { config.*field = inside; },
          [=](ilk_config_t& config) { config.*field = outside; }};
}

/// A rule over one field of one axis.
template <typename Field>
Rule axis_rule(std::string name, ilk_config_error_t error, uint32_t slot, Field ilk_axis_config_t::* field,
               Field inside, Field outside) {
  return {std::move(name), error, slot, [=](ilk_config_t& config) { config.axis[slot].*field = inside; },
          [=](ilk_config_t& config) { config.axis[slot].*field = outside; }};
}

Edit with_period(uint32_t period_us, uint32_t ilk_config_t::* field, uint32_t ticks) {
  return [=](ilk_config_t& config) {
    config.common.period_us = period_us;
    config.common.app_timeout_ticks = config.common.lease_max_ticks = 10;
    config.common.pedal_debounce_ticks = config.common.pedal_disagree_ticks = 5;
    for (auto& axis : config.axis) {
      axis.home_timeout_ticks = axis.home_timeout_ticks == 0 ? 0 : 100000;
    }
    config.*field = ticks;
  };
}

std::vector<Rule> system_rules() {
  using C = ilk_config_t;
  std::vector<Rule> rules = {
      system_rule("version", ILK_CONFIG_ERROR_VERSION, &C::version, 1, 2),
      system_rule("version_zero", ILK_CONFIG_ERROR_VERSION, &C::version, 1, 0),
      system_rule("size", ILK_CONFIG_ERROR_SIZE, &C::size_bytes, sizeof(C), sizeof(C) + 4),
      system_rule("size_short", ILK_CONFIG_ERROR_SIZE, &C::size_bytes, sizeof(C), sizeof(C) - 4),
      system_rule("channels_none", ILK_CONFIG_ERROR_PEDAL_CHANNELS, &C::pedal_channels, 1, 0),
      system_rule("channels_three", ILK_CONFIG_ERROR_PEDAL_CHANNELS, &C::pedal_channels, 2, 3),
      system_rule("app_timeout_zero", ILK_CONFIG_ERROR_APP_TIMEOUT, &C::app_timeout_ticks, 1, 0),
      system_rule("app_timeout_long", ILK_CONFIG_ERROR_APP_TIMEOUT, &C::app_timeout_ticks, 150, 151),
      system_rule("app_timeout_huge", ILK_CONFIG_ERROR_APP_TIMEOUT, &C::app_timeout_ticks, 150, 0xFFFFFFFFu),
      system_rule("lease_zero", ILK_CONFIG_ERROR_LEASE, &C::lease_max_ticks, 1, 0),
      system_rule("lease_long", ILK_CONFIG_ERROR_LEASE, &C::lease_max_ticks, 150, 151),
      system_rule("debounce_zero", ILK_CONFIG_ERROR_PEDAL_DEBOUNCE, &C::pedal_debounce_ticks, 1, 0),
      system_rule("debounce_long", ILK_CONFIG_ERROR_PEDAL_DEBOUNCE, &C::pedal_debounce_ticks, 50, 51),
      system_rule("disagree_zero", ILK_CONFIG_ERROR_PEDAL_DISAGREE, &C::pedal_disagree_ticks, 1, 0),
      system_rule("disagree_long", ILK_CONFIG_ERROR_PEDAL_DISAGREE, &C::pedal_disagree_ticks, 50, 51),
      system_rule("bad_frames_zero", ILK_CONFIG_ERROR_BAD_FRAMES, &C::bad_frame_limit, 1, 0),
      system_rule("bad_frames_many", ILK_CONFIG_ERROR_BAD_FRAMES, &C::bad_frame_limit, 5, 6),
      system_rule("overruns_zero", ILK_CONFIG_ERROR_OVERRUNS, &C::overrun_limit, 1, 0),
      system_rule("overruns_many", ILK_CONFIG_ERROR_OVERRUNS, &C::overrun_limit, 10, 11),
      {"period_short", ILK_CONFIG_ERROR_PERIOD, ILK_SLOTS, with_period(125, &C::overrun_limit, 3),
       with_period(124, &C::overrun_limit, 3)},
      {"period_long", ILK_CONFIG_ERROR_PERIOD, ILK_SLOTS, with_period(2000, &C::overrun_limit, 3),
       with_period(2001, &C::overrun_limit, 3)},
      {"period_zero", ILK_CONFIG_ERROR_PERIOD, ILK_SLOTS, with_period(700, &C::overrun_limit, 3),
       with_period(0, &C::overrun_limit, 3)},
      {"no_axis", ILK_CONFIG_ERROR_NO_AXIS, ILK_SLOTS, [](C&) {},
       [](C& config) {
         for (auto& axis : config.axis) axis = {};
       }},
  };
  for (const uint32_t period : {125u, 500u, 700u, 2000u}) {
    const std::string suffix = "_at_" + std::to_string(period) + "us";
    const auto scaled = [&](const char* name, ilk_config_error_t error, uint32_t C::* field,
                            uint32_t maximum_us) {
      const uint32_t most = maximum_us / period;
      rules.push_back({name + suffix, error, ILK_SLOTS, with_period(period, field, most),
                       with_period(period, field, most + 1)});
    };
    scaled("app_timeout", ILK_CONFIG_ERROR_APP_TIMEOUT, &C::app_timeout_ticks, 150000);
    scaled("lease", ILK_CONFIG_ERROR_LEASE, &C::lease_max_ticks, 150000);
    scaled("debounce", ILK_CONFIG_ERROR_PEDAL_DEBOUNCE, &C::pedal_debounce_ticks, 50000);
    scaled("disagree", ILK_CONFIG_ERROR_PEDAL_DISAGREE, &C::pedal_disagree_ticks, 50000);
  }
  return rules;
}

std::vector<Rule> axis_rules() {
  using A = ilk_axis_config_t;
  constexpr uint32_t s = slot::pwm_lower;
  constexpr uint32_t f = slot::pwm_free;
  constexpr uint32_t h = slot::high_frequency;
  const auto unsigned_rule = [](std::string name, ilk_config_error_t error, uint32_t slot,
                                uint32_t A::* field, uint32_t inside, uint32_t outside) {
    return axis_rule<uint32_t>(std::move(name), error, slot, field, inside, outside);
  };
  const auto signed_rule = [](std::string name, ilk_config_error_t error, uint32_t slot, int32_t A::* field,
                              int32_t inside, int32_t outside) {
    return axis_rule<int32_t>(std::move(name), error, slot, field, inside, outside);
  };
  return {
      unsigned_rule("card_unknown", ILK_CONFIG_ERROR_CARD, f, &A::card, ILK_CARD_NON_PWM, 6),
      unsigned_rule("card_huge", ILK_CONFIG_ERROR_CARD, f, &A::card, ILK_CARD_ANALOG, 0xFFFFFFFFu),
      unsigned_rule("required", ILK_CONFIG_ERROR_FLAG, f, &A::required, 1, 2),
      unsigned_rule("required_of_a_sensor", ILK_CONFIG_ERROR_FLAG, slot::sensor, &A::required, 0, 2),
      unsigned_rule("motor_direction", ILK_CONFIG_ERROR_FLAG, f, &A::motor_direction, 0, 2),
      unsigned_rule("direction_correction", ILK_CONFIG_ERROR_FLAG, f, &A::direction_correction, 1, 2),
      unsigned_rule("empty_slot_required", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::empty, &A::required, 0, 1),
      unsigned_rule("empty_slot_field", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::empty, &A::max_delta_counts, 0, 1),
      {"empty_slot_fields_that_cancel_in_a_crc", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::empty,
       [](ilk_config_t&) {},
       [](ilk_config_t& config) {
         config.axis[slot::empty].motor_direction = 1;
         config.axis[slot::empty].direction_correction = 0xB8BC6765u;
       }},
      signed_rule("empty_slot_limit", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::empty, &A::max_counts, 0, 1),
      unsigned_rule("sensor_slot_field", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::sensor, &A::max_drive, 0, 1),
      unsigned_rule("limit_side", ILK_CONFIG_ERROR_LIMIT_SIDE, s, &A::limit_side, ILK_LIMIT_UPPER, 3),
      {"soft_limits_equal", ILK_CONFIG_ERROR_SOFT_LIMITS, f, [](ilk_config_t&) {},
       [](ilk_config_t& config) { config.axis[f].max_counts = config.axis[f].min_counts; }},
      {"soft_limits_crossed", ILK_CONFIG_ERROR_SOFT_LIMITS, f, [](ilk_config_t&) {},
       [](ilk_config_t& config) {
         config.axis[f].max_counts = INT32_MIN;
         config.axis[f].min_counts = INT32_MAX;
       }},
      signed_rule("max_too_far", ILK_CONFIG_ERROR_SOFT_LIMITS, f, &A::max_counts, 1 << 30, (1 << 30) + 1),
      signed_rule("min_too_far", ILK_CONFIG_ERROR_SOFT_LIMITS, f, &A::min_counts, -(1 << 30), -(1 << 30) - 1),
      signed_rule("home_offset_high", ILK_CONFIG_ERROR_HOME_OFFSET, s, &A::home_offset_counts, 1000, 1001),
      signed_rule("home_offset_low", ILK_CONFIG_ERROR_HOME_OFFSET, s, &A::home_offset_counts, -1000, -1001),
      unsigned_rule("coast_zero", ILK_CONFIG_ERROR_COAST, f, &A::coast_counts, 1, 0),
      unsigned_rule("coast_huge", ILK_CONFIG_ERROR_COAST, f, &A::coast_counts, 10, 0xFFFFFFFFu),
      {"coast_half_of_range", ILK_CONFIG_ERROR_COAST, f, [](ilk_config_t&) {},
       [](ilk_config_t& config) { config.axis[f].coast_counts = 1000; }},
      unsigned_rule("deadband_zero", ILK_CONFIG_ERROR_DEADBAND, f, &A::deadband_counts, 1, 0),
      unsigned_rule("deadband_half_of_range", ILK_CONFIG_ERROR_DEADBAND, f, &A::deadband_counts, 999, 1000),
      unsigned_rule("deadband_huge", ILK_CONFIG_ERROR_DEADBAND, f, &A::deadband_counts, 999, 0x80000000u),
      unsigned_rule("max_drive_zero", ILK_CONFIG_ERROR_MAX_DRIVE, f, &A::max_drive, 1000, 0),
      unsigned_rule("max_drive_pwm", ILK_CONFIG_ERROR_MAX_DRIVE, f, &A::max_drive, 0x7FFFFFFFu, 0x80000000u),
      unsigned_rule("max_drive_non_pwm", ILK_CONFIG_ERROR_MAX_DRIVE, slot::non_pwm_upper, &A::max_drive,
                    0x3FFFFFFFu, 0x40000000u),
      unsigned_rule("max_drive_analog", ILK_CONFIG_ERROR_MAX_DRIVE, slot::analog_upper, &A::max_drive,
                    0x7FFFFFFFu, 0x80000000u),
      unsigned_rule("max_drive_high_frequency", ILK_CONFIG_ERROR_MAX_DRIVE, h, &A::max_drive, 397785, 397786),
      unsigned_rule("unhomed_drive_zero", ILK_CONFIG_ERROR_UNHOMED_DRIVE, f, &A::unhomed_max_drive, 1, 0),
      unsigned_rule("unhomed_drive_large", ILK_CONFIG_ERROR_UNHOMED_DRIVE, f, &A::unhomed_max_drive, 100,
                    101),
      unsigned_rule("unhomed_drive_huge", ILK_CONFIG_ERROR_UNHOMED_DRIVE, f, &A::unhomed_max_drive, 100,
                    0x80000001u),
      unsigned_rule("amplitude_zero", ILK_CONFIG_ERROR_AMPLITUDE, h, &A::max_amplitude, 80, 0),
      unsigned_rule("amplitude_large", ILK_CONFIG_ERROR_AMPLITUDE, h, &A::max_amplitude, 255, 256),
      unsigned_rule("amplitude_elsewhere", ILK_CONFIG_ERROR_AMPLITUDE, f, &A::max_amplitude, 0, 1),
      unsigned_rule("home_amplitude_large", ILK_CONFIG_ERROR_AMPLITUDE, h, &A::home_amplitude, 200, 201),
      unsigned_rule("home_amplitude_elsewhere", ILK_CONFIG_ERROR_AMPLITUDE, s, &A::home_amplitude, 0, 1),
      unsigned_rule("unhomed_travel_short", ILK_CONFIG_ERROR_UNHOMED_TRAVEL, f, &A::unhomed_travel_counts, 11,
                    10),
      unsigned_rule("unhomed_travel_zero", ILK_CONFIG_ERROR_UNHOMED_TRAVEL, f, &A::unhomed_travel_counts, 11,
                    0),
      unsigned_rule("unhomed_travel_long", ILK_CONFIG_ERROR_UNHOMED_TRAVEL, f, &A::unhomed_travel_counts, 200,
                    201),
      unsigned_rule("home_drive_zero", ILK_CONFIG_ERROR_HOME_DRIVE, s, &A::home_drive, 1, 0),
      unsigned_rule("home_drive_large", ILK_CONFIG_ERROR_HOME_DRIVE, s, &A::home_drive, 100, 101),
      unsigned_rule("home_drive_without_switch", ILK_CONFIG_ERROR_HOME_DRIVE, f, &A::home_drive, 0, 1),
      unsigned_rule("home_travel_short", ILK_CONFIG_ERROR_HOME_TRAVEL, s, &A::home_travel_counts, 2010, 2009),
      {"home_travel_long", ILK_CONFIG_ERROR_HOME_TRAVEL, s,
       [](ilk_config_t& config) {
         config.axis[s].home_travel_counts = 4000;
         config.axis[s].home_timeout_ticks = 10000;
       },
       [](ilk_config_t& config) {
         config.axis[s].home_travel_counts = 4001;
         config.axis[s].home_timeout_ticks = 10000;
       }},
      unsigned_rule("home_backoff_zero", ILK_CONFIG_ERROR_HOME_BACKOFF, s, &A::home_backoff_counts, 1, 0),
      unsigned_rule("home_backoff_long", ILK_CONFIG_ERROR_HOME_BACKOFF, s, &A::home_backoff_counts, 200, 201),
      unsigned_rule("home_rest_zero", ILK_CONFIG_ERROR_HOME_REST, s, &A::home_rest_ticks, 1, 0),
      unsigned_rule("home_rest_long", ILK_CONFIG_ERROR_HOME_REST, s, &A::home_rest_ticks, 20, 3001),
      unsigned_rule("home_timeout_short", ILK_CONFIG_ERROR_HOME_TIMEOUT, s, &A::home_timeout_ticks, 2220,
                    2219),
      unsigned_rule("home_timeout_long", ILK_CONFIG_ERROR_HOME_TIMEOUT, s, &A::home_timeout_ticks, 600000,
                    600001),
      unsigned_rule("home_speed_zero", ILK_CONFIG_ERROR_HOME_TIMEOUT, s, &A::home_speed_counts_per_s, 1000,
                    0),
      unsigned_rule("home_speed_slow", ILK_CONFIG_ERROR_HOME_TIMEOUT, s, &A::home_speed_counts_per_s, 739,
                    738),
      {"home_timeout_at_another_period", ILK_CONFIG_ERROR_HOME_TIMEOUT, s,
       [](ilk_config_t& config) {
         config.common.period_us = 500;
         for (auto& axis : config.axis) axis.home_timeout_ticks *= 2;
         config.axis[s].home_timeout_ticks = 4420;
       },
       [](ilk_config_t& config) {
         config.common.period_us = 500;
         for (auto& axis : config.axis) axis.home_timeout_ticks *= 2;
         config.axis[s].home_timeout_ticks = 4419;
       }},
      unsigned_rule("stall_zero", ILK_CONFIG_ERROR_STALL, f, &A::stall_ticks, 1, 0),
      unsigned_rule("stall_long", ILK_CONFIG_ERROR_STALL, f, &A::stall_ticks, 500, 501),
      unsigned_rule("stall_progress_is_noise", ILK_CONFIG_ERROR_STALL, f, &A::stall_min_counts, 2, 1),
      unsigned_rule("stall_progress_zero", ILK_CONFIG_ERROR_STALL, f, &A::stall_min_counts, 2, 0),
      {"stall_progress_zero_without_noise", ILK_CONFIG_ERROR_STALL, f,
       [](ilk_config_t& config) {
         config.axis[f].noise_counts = 0;
         config.axis[f].stall_min_counts = 1;
       },
       [](ilk_config_t& config) {
         config.axis[f].noise_counts = 0;
         config.axis[f].stall_min_counts = 0;
       }},
      unsigned_rule("reverse_small", ILK_CONFIG_ERROR_REVERSE, f, &A::reverse_counts, 12, 11),
      unsigned_rule("reverse_large", ILK_CONFIG_ERROR_REVERSE, f, &A::reverse_counts, 200, 201),
      unsigned_rule("drift_small", ILK_CONFIG_ERROR_DRIFT, f, &A::drift_counts, 12, 11),
      unsigned_rule("drift_large", ILK_CONFIG_ERROR_DRIFT, f, &A::drift_counts, 200, 201),
      {"backlash_wraps_nothing", ILK_CONFIG_ERROR_REVERSE, f, [](ilk_config_t&) {},
       [](ilk_config_t& config) { config.axis[f].backlash_counts = 0xFFFFFFFFu; }},
      unsigned_rule("settle_zero", ILK_CONFIG_ERROR_SETTLE, f, &A::rest_ticks, 1, 0),
      unsigned_rule("settle_long", ILK_CONFIG_ERROR_SETTLE, f, &A::rest_ticks, 1000, 1001),
      unsigned_rule("max_delta_zero", ILK_CONFIG_ERROR_MAX_DELTA, f, &A::max_delta_counts, 1, 0),
      unsigned_rule("max_delta_large", ILK_CONFIG_ERROR_MAX_DELTA, f, &A::max_delta_counts, 1000, 1001),
  };
}

class P13_configuration_rule : public testing::TestWithParam<Rule> {};

TEST_P(P13_configuration_rule, accepts_just_inside_and_refuses_just_outside) {
  const Rule& rule = GetParam();
  EXPECT_EQ(verdict_after(rule.inside).error, uint32_t{ILK_CONFIG_ERROR_NONE});
  const ilk_config_verdict_t refused = verdict_after(rule.outside);
  EXPECT_EQ(refused.error, rule.error);
  EXPECT_EQ(refused.slot, rule.slot);
}

std::string rule_name(const testing::TestParamInfo<Rule>& rule) { return rule.param.name; }

INSTANTIATE_TEST_SUITE_P(System, P13_configuration_rule, testing::ValuesIn(system_rules()), rule_name);
INSTANTIATE_TEST_SUITE_P(Axis, P13_configuration_rule, testing::ValuesIn(axis_rules()), rule_name);

TEST(P13_configuration, the_test_configurations_are_valid) {
  const ilk_config_t standard = standard_config();
  const ilk_config_t busy = ten_axis_config();
  EXPECT_EQ(ilk_config_validate(&standard).error, uint32_t{ILK_CONFIG_ERROR_NONE});
  EXPECT_EQ(ilk_config_validate(&busy).error, uint32_t{ILK_CONFIG_ERROR_NONE});
}

TEST(P13_configuration, a_sensor_alone_is_no_robot) {
  ilk_config_t config = standard_config();
  for (uint32_t slot = 0; slot < slot::axes; ++slot) config.axis[slot] = {};
  seal(config);
  EXPECT_EQ(ilk_config_validate(&config).error, uint32_t{ILK_CONFIG_ERROR_NO_AXIS});
}

TEST(P13_configuration, the_crc_is_the_standard_one_over_all_words_before_it) {
  const ilk_config_t config = standard_config();
  EXPECT_EQ(ilk_config_crc(&config), config.crc);
}

TEST(P13_configuration, any_wrong_bit_is_found) {
  const ilk_config_t right = standard_config();
  for (uint32_t bit = 0; bit < sizeof(ilk_config_t) * 8; ++bit) {
    auto words = std::bit_cast<std::array<uint32_t, sizeof(ilk_config_t) / 4>>(right);
    words[bit / 32] ^= 1u << bit % 32;
    const auto wrong = std::bit_cast<ilk_config_t>(words);
    ilk_state_t state;
    ASSERT_NE(ilk_init(&wrong, &state).error, uint32_t{ILK_CONFIG_ERROR_NONE}) << bit;
    ASSERT_EQ(state.system.mode, uint32_t{ILK_MODE_INIT});
  }
}

TEST(P13_configuration, random_bits_never_leave_INIT) {
  Dice dice(13);
  for (int trial = 0; trial < 2000; ++trial) {
    ilk_config_t config = standard_config();
    auto words = std::bit_cast<std::array<uint32_t, sizeof(ilk_config_t) / 4>>(config);
    const uint32_t changes = 1 + dice.below(5);
    for (uint32_t change = 0; change < changes; ++change) words[dice.below(words.size())] = dice.word();
    config = std::bit_cast<ilk_config_t>(words);
    if (dice.one_in(2)) seal(config);
    ilk_state_t state;
    const ilk_config_verdict_t verdict = ilk_init(&config, &state);
    ASSERT_EQ(verdict.error, ilk_config_validate(&config).error);
    ASSERT_EQ(state.system.mode == ILK_MODE_INIT, verdict.error != ILK_CONFIG_ERROR_NONE);
  }
}

}  // namespace
}  // namespace interlock::kernel_test
