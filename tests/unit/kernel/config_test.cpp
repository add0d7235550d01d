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

using C = ilk_common_config_t;
using A = ilk_axis_config_t;
using Edit = std::function<void(ilk_config_t&)>;

struct Rule {
  std::string name;
  uint32_t error;
  uint32_t slot;
  Edit inside;
  Edit outside;
  uint32_t error_inside = ILK_CONFIG_ERROR_NONE;  ///< another rule that the field breaks there already
};

void PrintTo(const Rule& rule, std::ostream* stream) { *stream << rule.name; }

ilk_config_verdict_t verdict_after(const Edit& edit) {
  ilk_config_t config = standard_config();
  edit(config);
  seal(config);
  return ilk_config_validate(&config);
}

/// A rule over one common field.
Rule common(std::string name, uint32_t error, uint32_t C::* field, uint32_t inside, uint32_t outside) {
  return {std::move(name), error, ILK_SLOTS, [=](ilk_config_t& config) { config.common.*field = inside; },
          [=](ilk_config_t& config) { config.common.*field = outside; }};
}

/// A rule over one field of one axis.
template <typename Field>
Rule axis(std::string name, uint32_t error, uint32_t slot, Field A::* field, Field inside, Field outside,
          uint32_t error_inside = ILK_CONFIG_ERROR_NONE) {
  return {std::move(name),
          error,
          slot,
          [=](ilk_config_t& config) { config.axis[slot].*field = inside; },
          [=](ilk_config_t& config) { config.axis[slot].*field = outside; },
          error_inside};
}

Edit both(const Edit& first, const Edit& second) {
  return [=](ilk_config_t& config) {
    first(config);
    second(config);
  };
}

/// The rule, in a configuration that is edited otherwise, too.
Rule when(const Edit& edit, Rule rule) {
  rule.inside = both(edit, rule.inside);
  rule.outside = both(edit, rule.outside);
  return rule;
}

/// A configuration that is valid at that control period.
Edit at_period(uint32_t period_us) {
  return [=](ilk_config_t& config) {
    config.common.period_us = period_us;
    config.common.app_timeout_ticks = config.common.lease_max_ticks = 10;
    config.common.pedal_debounce_ticks = config.common.pedal_disagree_ticks = 5;
    for (uint32_t slot = 0; slot < slot::axes; ++slot) {
      A& each = config.axis[slot];
      each.stall_ticks = 400000 / period_us;
      each.stall_effort_ticks = 40000 / period_us;
      each.max_delta_counts = 16;
      each.coast_counts = 20;
      each.drift_counts = each.reverse_counts = 40;
      if (each.limit_side == ILK_LIMIT_NONE) continue;
      each.home_tolerance_counts = 20;
      each.home_clear_counts = 60;
      each.home_travel_counts = 3000;
      each.home_timeout_ticks = 10000000 / period_us;
    }
  };
}

/// Every axis with a switch allows so many ticks of debouncing.
Edit tolerant(uint32_t tolerance, uint32_t clear) {
  return [=](ilk_config_t& config) {
    for (A& each : config.axis) {
      if (each.limit_side == ILK_LIMIT_NONE) continue;
      each.home_tolerance_counts = tolerance;
      each.home_clear_counts = clear;
    }
  };
}

Edit with_common(uint32_t C::* field, uint32_t value) {
  return [=](ilk_config_t& config) { config.common.*field = value; };
}

std::vector<Rule> common_rules() {
  std::vector<Rule> rules = {
      common("version_old", ILK_CONFIG_ERROR_VERSION, &C::version, 2, 1),
      common("version_new", ILK_CONFIG_ERROR_VERSION, &C::version, 2, 3),
      common("size_long", ILK_CONFIG_ERROR_SIZE, &C::size_bytes, sizeof(ilk_config_t),
             sizeof(ilk_config_t) + 4),
      common("size_short", ILK_CONFIG_ERROR_SIZE, &C::size_bytes, sizeof(ilk_config_t),
             sizeof(ilk_config_t) - 4),
      common("channels_none", ILK_CONFIG_ERROR_PEDAL_CHANNELS, &C::pedal_channels, 1, 0),
      common("channels_three", ILK_CONFIG_ERROR_PEDAL_CHANNELS, &C::pedal_channels, 2, 3),
      common("app_timeout_short", ILK_CONFIG_ERROR_APP_TIMEOUT, &C::app_timeout_ticks, 2, 1),
      common("app_timeout_zero", ILK_CONFIG_ERROR_APP_TIMEOUT, &C::app_timeout_ticks, 2, 0),
      common("app_timeout_huge", ILK_CONFIG_ERROR_APP_TIMEOUT, &C::app_timeout_ticks, 150, 0xFFFFFFFFu),
      common("lease_short", ILK_CONFIG_ERROR_LEASE, &C::lease_max_ticks, 2, 1),
      common("debounce_zero", ILK_CONFIG_ERROR_PEDAL_DEBOUNCE, &C::pedal_debounce_ticks, 1, 0),
      common("disagree_zero", ILK_CONFIG_ERROR_PEDAL_DISAGREE, &C::pedal_disagree_ticks, 1, 0),
      common("power_up_zero", ILK_CONFIG_ERROR_POWER_UP, &C::power_up_ticks, 1, 0),
      common("switch_debounce_short", ILK_CONFIG_ERROR_SWITCH_DEBOUNCE, &C::switch_debounce_ticks, 2, 1),
      when(both(tolerant(24, 40),
                [](ilk_config_t& config) {
                  for (A& each : config.axis) each.rest_ticks *= 2;
                }),
           common("switch_debounce_long", ILK_CONFIG_ERROR_SWITCH_DEBOUNCE, &C::switch_debounce_ticks, 20,
                  21)),
      common("bad_frames_zero", ILK_CONFIG_ERROR_BAD_FRAMES, &C::bad_frame_limit, 1, 0),
      common("bad_frames_many", ILK_CONFIG_ERROR_BAD_FRAMES, &C::bad_frame_limit, 5, 6),
      common("overruns_zero", ILK_CONFIG_ERROR_OVERRUNS, &C::overrun_limit, 1, 0),
      common("overruns_many", ILK_CONFIG_ERROR_OVERRUNS, &C::overrun_limit, 10, 11),
      {"period_short", ILK_CONFIG_ERROR_PERIOD, ILK_SLOTS, at_period(125), at_period(124)},
      {"period_long", ILK_CONFIG_ERROR_PERIOD, ILK_SLOTS, at_period(2000), at_period(2001)},
      {"period_zero", ILK_CONFIG_ERROR_PERIOD, ILK_SLOTS, at_period(700), with_common(&C::period_us, 0)},
      {"no_axis", ILK_CONFIG_ERROR_NO_AXIS, ILK_SLOTS, [](ilk_config_t&) {},
       [](ilk_config_t& config) {
         for (uint32_t slot = 0; slot < slot::axes; ++slot) config.axis[slot] = {};
       }},
  };
  for (const uint32_t period : {125u, 500u, 700u, 1000u, 2000u}) {
    const std::string at = "_at_" + std::to_string(period) + "us";
    const auto longest = [&](const char* name, uint32_t error, uint32_t C::* field, uint32_t us) {
      rules.push_back(when(at_period(period), common(name + at, error, field, us / period, us / period + 1)));
    };
    longest("app_timeout", ILK_CONFIG_ERROR_APP_TIMEOUT, &C::app_timeout_ticks, 150000);
    longest("lease", ILK_CONFIG_ERROR_LEASE, &C::lease_max_ticks, 150000);
    longest("debounce", ILK_CONFIG_ERROR_PEDAL_DEBOUNCE, &C::pedal_debounce_ticks, 50000);
    longest("disagree", ILK_CONFIG_ERROR_PEDAL_DISAGREE, &C::pedal_disagree_ticks, 50000);
    longest("power_up", ILK_CONFIG_ERROR_POWER_UP, &C::power_up_ticks, 5000000);
    const auto longest_of_axis = [&](const char* name, uint32_t error, uint32_t A::* field, uint32_t us) {
      rules.push_back(when(at_period(period),
                           axis(name + at, error, slot::pwm_free, field, us / period, us / period + 1)));
    };
    longest_of_axis("stall", ILK_CONFIG_ERROR_STALL, &A::stall_ticks, 500000);
    longest_of_axis("effort", ILK_CONFIG_ERROR_STALL_EFFORT, &A::stall_effort_ticks, 200000);
    longest_of_axis("rest", ILK_CONFIG_ERROR_REST, &A::rest_ticks, 1000000);
  }
  return rules;
}

std::vector<Rule> axis_rules() {
  constexpr uint32_t s = slot::pwm_lower;
  constexpr uint32_t f = slot::pwm_free;
  constexpr uint32_t h = slot::high_frequency;
  constexpr uint32_t huge = 0xFFFFFFFFu;
  const auto field = [](const char* name, uint32_t error, uint32_t slot, uint32_t A::* which, uint32_t inside,
                        uint32_t outside, uint32_t error_inside = ILK_CONFIG_ERROR_NONE) {
    return axis<uint32_t>(name, error, slot, which, inside, outside, error_inside);
  };
  const auto place = [](const char* name, uint32_t error, uint32_t slot, int32_t A::* which, int32_t inside,
                        int32_t outside) { return axis<int32_t>(name, error, slot, which, inside, outside); };
  const auto set = [](uint32_t slot, uint32_t A::* which, uint32_t value) -> Edit {
    return [=](ilk_config_t& config) { config.axis[slot].*which = value; };
  };
  std::vector<Rule> rules = {
      field("card_unknown", ILK_CONFIG_ERROR_CARD, f, &A::card, ILK_CARD_NON_PWM, 6),
      field("card_huge", ILK_CONFIG_ERROR_CARD, f, &A::card, ILK_CARD_ANALOG, huge),
      field("required", ILK_CONFIG_ERROR_FLAG, f, &A::required, 1, 2),
      field("required_of_a_sensor", ILK_CONFIG_ERROR_FLAG, slot::sensor, &A::required, 0, 2),
      field("motor_direction", ILK_CONFIG_ERROR_FLAG, f, &A::motor_direction, 0, 2),
      field("direction_correction", ILK_CONFIG_ERROR_FLAG, f, &A::direction_correction, 1, 2),
      field("empty_slot_required", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::empty, &A::required, 0, 1),
      field("empty_slot_field", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::empty, &A::max_delta_counts, 0, 1),
      place("empty_slot_limit", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::empty, &A::max_counts, 0, 1),
      field("sensor_slot_field", ILK_CONFIG_ERROR_EMPTY_SLOT, slot::sensor, &A::motor_direction, 0, 1),
      field("limit_side", ILK_CONFIG_ERROR_LIMIT_SIDE, s, &A::limit_side, ILK_LIMIT_LOWER, 3),
      {"soft_limits_equal", ILK_CONFIG_ERROR_SOFT_LIMITS, f, [](ilk_config_t&) {},
       [](ilk_config_t& config) { config.axis[f].max_counts = config.axis[f].min_counts; }},
      {"soft_limits_crossed", ILK_CONFIG_ERROR_SOFT_LIMITS, f, [](ilk_config_t&) {},
       [](ilk_config_t& config) {
         config.axis[f].max_counts = INT32_MIN;
         config.axis[f].min_counts = INT32_MAX;
       }},
      place("max_too_far", ILK_CONFIG_ERROR_SOFT_LIMITS, f, &A::max_counts, 1 << 30, (1 << 30) + 1),
      place("min_too_far", ILK_CONFIG_ERROR_SOFT_LIMITS, f, &A::min_counts, -(1 << 30), -(1 << 30) - 1),
      place("home_offset_high", ILK_CONFIG_ERROR_HOME_OFFSET, f, &A::home_offset_counts, 1000, 1001),
      place("home_offset_low", ILK_CONFIG_ERROR_HOME_OFFSET, f, &A::home_offset_counts, -1000, -1001),
      place("home_without_room_above", ILK_CONFIG_ERROR_HOME_OFFSET, s, &A::home_offset_counts, 977, 978),
      place("home_without_room_below", ILK_CONFIG_ERROR_HOME_OFFSET, slot::non_pwm_upper,
            &A::home_offset_counts, -977, -978),
      field("coast_zero", ILK_CONFIG_ERROR_COAST, f, &A::coast_counts, 10, 0),
      field("coast_of_the_latency", ILK_CONFIG_ERROR_COAST, f, &A::coast_counts, 10, 9),
      field("coast_half_of_range", ILK_CONFIG_ERROR_COAST, f, &A::coast_counts, 999, 1000,
            ILK_CONFIG_ERROR_UNHOMED_TRAVEL),
      field("coast_huge", ILK_CONFIG_ERROR_COAST, f, &A::coast_counts, 10, huge),
      field("noise", ILK_CONFIG_ERROR_NOISE, f, &A::noise_counts, 200, 201, ILK_CONFIG_ERROR_MAX_DELTA),
      field("backlash", ILK_CONFIG_ERROR_NOISE, f, &A::backlash_counts, 200, 201, ILK_CONFIG_ERROR_STALL),
      field("backlash_huge", ILK_CONFIG_ERROR_NOISE, f, &A::backlash_counts, 1, huge),
      field("deadband_zero", ILK_CONFIG_ERROR_DEADBAND, f, &A::deadband_counts, 1, 0),
      field("deadband_half_of_range", ILK_CONFIG_ERROR_DEADBAND, f, &A::deadband_counts, 999, 1000),
      field("deadband_huge", ILK_CONFIG_ERROR_DEADBAND, f, &A::deadband_counts, 999, 0x80000000u),
      field("max_drive_zero", ILK_CONFIG_ERROR_MAX_DRIVE, f, &A::max_drive, 1000, 0),
      field("max_drive_pwm", ILK_CONFIG_ERROR_MAX_DRIVE, f, &A::max_drive, 0x7FFFFFFFu, 0x80000000u),
      field("max_drive_non_pwm", ILK_CONFIG_ERROR_MAX_DRIVE, slot::non_pwm_upper, &A::max_drive, 0x3FFFFFFFu,
            0x40000000u),
      field("max_drive_analog", ILK_CONFIG_ERROR_MAX_DRIVE, slot::analog_upper, &A::max_drive, 0x7FFFFFFFu,
            0x80000000u),
      field("max_drive_high_frequency", ILK_CONFIG_ERROR_MAX_DRIVE, h, &A::max_drive, 397785, 397786),
      field("unhomed_drive_in_the_dead_zone", ILK_CONFIG_ERROR_UNHOMED_DRIVE, f, &A::unhomed_max_drive, 11,
            10),
      field("dead_zone_huge", ILK_CONFIG_ERROR_UNHOMED_DRIVE, f, &A::dead_zone_drive, 99, huge),
      field("unhomed_drive_large", ILK_CONFIG_ERROR_UNHOMED_DRIVE, f, &A::unhomed_max_drive, 109, 110),
      when([](ilk_config_t& config) { config.axis[slot::pwm_free].unhomed_max_drive = 280; },
           field("dead_zone_wide", ILK_CONFIG_ERROR_UNHOMED_DRIVE, f, &A::dead_zone_drive, 200, 201)),
      field("amplitude_zero", ILK_CONFIG_ERROR_AMPLITUDE, h, &A::max_amplitude, 80, 0),
      field("amplitude_large", ILK_CONFIG_ERROR_AMPLITUDE, h, &A::max_amplitude, 255, 256),
      field("amplitude_elsewhere", ILK_CONFIG_ERROR_AMPLITUDE, f, &A::max_amplitude, 0, 1),
      field("home_amplitude_large", ILK_CONFIG_ERROR_AMPLITUDE, h, &A::home_amplitude, 200, 201),
      field("home_amplitude_elsewhere", ILK_CONFIG_ERROR_AMPLITUDE, s, &A::home_amplitude, 0, 1),
      when(
          [](ilk_config_t& config) {
            config.axis[h] = plain_axis(ILK_CARD_HIGH_FREQUENCY);
            config.axis[h].max_amplitude = 200;
          },
          field("home_amplitude_without_a_switch", ILK_CONFIG_ERROR_AMPLITUDE, h, &A::home_amplitude, 0, 1)),
      field("full_speed_zero", ILK_CONFIG_ERROR_SPEED, f, &A::full_speed_counts_per_s, 1, 0,
            ILK_CONFIG_ERROR_STALL),
      field("full_speed_high", ILK_CONFIG_ERROR_SPEED, f, &A::full_speed_counts_per_s, 100000000, 100000001,
            ILK_CONFIG_ERROR_MAX_DELTA),
      field("home_speed_above_full", ILK_CONFIG_ERROR_SPEED, s, &A::home_speed_counts_per_s, 5000, 5001,
            ILK_CONFIG_ERROR_HOME_TOLERANCE),
      field("home_slow_speed_zero", ILK_CONFIG_ERROR_SPEED, s, &A::home_slow_speed_counts_per_s, 500, 0),
      field("home_slow_speed_above", ILK_CONFIG_ERROR_SPEED, s, &A::home_slow_speed_counts_per_s, 1000, 1001),
      field("max_delta_of_full_speed_and_noise", ILK_CONFIG_ERROR_MAX_DELTA, f, &A::max_delta_counts, 6, 5),
      field("max_delta_large", ILK_CONFIG_ERROR_MAX_DELTA, f, &A::max_delta_counts, 1000, 1001),
      field("unhomed_travel_of_coast", ILK_CONFIG_ERROR_UNHOMED_TRAVEL, f, &A::unhomed_travel_counts, 12, 11),
      field("unhomed_travel_long", ILK_CONFIG_ERROR_UNHOMED_TRAVEL, f, &A::unhomed_travel_counts, 200, 201),
      field("home_drive_in_the_dead_zone", ILK_CONFIG_ERROR_HOME_DRIVE, s, &A::home_drive, 11, 10,
            ILK_CONFIG_ERROR_HOME_SLOW),
      field("home_drive_large", ILK_CONFIG_ERROR_HOME_DRIVE, s, &A::home_drive, 100, 101),
      field("home_slow_drive_in_the_dead_zone", ILK_CONFIG_ERROR_HOME_SLOW, s, &A::home_slow_drive, 11, 10),
      field("home_slow_drive_large", ILK_CONFIG_ERROR_HOME_SLOW, s, &A::home_slow_drive, 50, 51),
      field("hysteresis_large", ILK_CONFIG_ERROR_HYSTERESIS, s, &A::switch_hysteresis_counts, 200, 201,
            ILK_CONFIG_ERROR_HOME_CLEAR),
      field("tolerance_of_the_debounce_time_and_noise", ILK_CONFIG_ERROR_HOME_TOLERANCE, s,
            &A::home_tolerance_counts, 7, 6),
      field("tolerance_large", ILK_CONFIG_ERROR_HOME_TOLERANCE, s, &A::home_tolerance_counts, 200, 201,
            ILK_CONFIG_ERROR_HOME_CLEAR),
      field("clear_of_tolerance_hysteresis_and_coast", ILK_CONFIG_ERROR_HOME_CLEAR, s, &A::home_clear_counts,
            21, 20),
      when(both(set(s, &A::stall_min_counts, 25), set(s, &A::stall_ticks, 100)),
           field("clear_of_stall_backlash_and_noise", ILK_CONFIG_ERROR_HOME_CLEAR, s, &A::home_clear_counts,
                 28, 27)),
      field("clear_large", ILK_CONFIG_ERROR_HOME_CLEAR, s, &A::home_clear_counts, 200, 201,
            ILK_CONFIG_ERROR_HOME_TRAVEL),
      field("home_travel_of_the_whole_way", ILK_CONFIG_ERROR_HOME_TRAVEL, s, &A::home_travel_counts, 2244,
            2243),
      field("home_travel_long", ILK_CONFIG_ERROR_HOME_TRAVEL, s, &A::home_travel_counts, 8000, 8001),
      field("home_timeout_of_the_whole_way", ILK_CONFIG_ERROR_HOME_TIMEOUT, s, &A::home_timeout_ticks, 2521,
            2520),
      field("home_timeout_long", ILK_CONFIG_ERROR_HOME_TIMEOUT, s, &A::home_timeout_ticks, 600000, 600001),
      field("home_timeout_huge", ILK_CONFIG_ERROR_HOME_TIMEOUT, s, &A::home_timeout_ticks, 3000, huge),
      when(with_common(&C::switch_debounce_ticks, 2),
           field("rest_of_the_latency", ILK_CONFIG_ERROR_REST, f, &A::rest_ticks, 3, 2)),
      when(both(tolerant(12, 40), with_common(&C::switch_debounce_ticks, 5)),
           field("rest_of_the_debounce_time", ILK_CONFIG_ERROR_REST, f, &A::rest_ticks, 5, 4)),
      field("stall_ends_before_a_reversal_is_over", ILK_CONFIG_ERROR_STALL, f, &A::stall_ticks, 11, 10),
      field("stall_progress_of_noise", ILK_CONFIG_ERROR_STALL, f, &A::stall_min_counts, 2, 1),
      when(set(f, &A::stall_ticks, 100),
           field("stall_progress_large", ILK_CONFIG_ERROR_STALL, f, &A::stall_min_counts, 200, 201)),
      field("stall_ends_before_progress_at_the_slowest_drive", ILK_CONFIG_ERROR_STALL, s,
            &A::stall_min_counts, 21, 22),
      field("effort_of_five_times_coast", ILK_CONFIG_ERROR_STALL_EFFORT, f, &A::stall_effort_ticks, 11, 10),
      when(both(set(f, &A::stall_effort_ticks, 0), set(f, &A::stall_ticks, 400)),
           field("effort_of_an_axis_that_is_fast_enough", ILK_CONFIG_ERROR_STALL_EFFORT, f,
                 &A::full_speed_counts_per_s, 264, 265)),
      field("reverse_of_coast_backlash_and_noise", ILK_CONFIG_ERROR_REVERSE, f, &A::reverse_counts, 12, 11),
      field("reverse_large", ILK_CONFIG_ERROR_REVERSE, f, &A::reverse_counts, 200, 201),
      field("drift_of_coast_backlash_and_noise", ILK_CONFIG_ERROR_DRIFT, f, &A::drift_counts, 12, 11),
      field("drift_large", ILK_CONFIG_ERROR_DRIFT, f, &A::drift_counts, 200, 201),
  };
  struct Unused {
    const char* name;
    uint32_t error;
    uint32_t A::* which;
  };
  for (const auto& [name, error, which] :
       {Unused{"home_drive", ILK_CONFIG_ERROR_HOME_DRIVE, &A::home_drive},
        Unused{"home_slow_drive", ILK_CONFIG_ERROR_HOME_SLOW, &A::home_slow_drive},
        Unused{"home_travel", ILK_CONFIG_ERROR_HOME_TRAVEL, &A::home_travel_counts},
        Unused{"home_timeout", ILK_CONFIG_ERROR_HOME_TIMEOUT, &A::home_timeout_ticks},
        Unused{"home_clear", ILK_CONFIG_ERROR_HOME_CLEAR, &A::home_clear_counts},
        Unused{"home_tolerance", ILK_CONFIG_ERROR_HOME_TOLERANCE, &A::home_tolerance_counts},
        Unused{"hysteresis", ILK_CONFIG_ERROR_HYSTERESIS, &A::switch_hysteresis_counts},
        Unused{"home_speed", ILK_CONFIG_ERROR_SPEED, &A::home_speed_counts_per_s},
        Unused{"home_slow_speed", ILK_CONFIG_ERROR_SPEED, &A::home_slow_speed_counts_per_s}}) {
    rules.push_back(axis<uint32_t>(std::string(name) + "_without_a_switch", error, f, which, 0, 1));
  }
  return rules;
}

class P13_configuration_rule : public testing::TestWithParam<Rule> {};

TEST_P(P13_configuration_rule, accepts_just_inside_and_refuses_just_outside) {
  const Rule& rule = GetParam();
  EXPECT_EQ(verdict_after(rule.inside).error, rule.error_inside);
  const ilk_config_verdict_t refused = verdict_after(rule.outside);
  EXPECT_EQ(refused.error, rule.error);
  EXPECT_EQ(refused.slot, rule.slot);
}

std::string rule_name(const testing::TestParamInfo<Rule>& rule) { return rule.param.name; }

INSTANTIATE_TEST_SUITE_P(Common, P13_configuration_rule, testing::ValuesIn(common_rules()), rule_name);
INSTANTIATE_TEST_SUITE_P(Axis, P13_configuration_rule, testing::ValuesIn(axis_rules()), rule_name);

TEST(P13_configuration, the_test_configurations_are_valid) {
  const ilk_config_t standard = standard_config();
  const ilk_config_t busy = ten_axis_config();
  EXPECT_EQ(ilk_config_validate(&standard).error, uint32_t{ILK_CONFIG_ERROR_NONE});
  EXPECT_EQ(ilk_config_validate(&busy).error, uint32_t{ILK_CONFIG_ERROR_NONE});
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
