#include "configuration.hpp"

#include <array>
#include <bit>
#include <span>

#include "codec.hpp"

namespace interlock::kernel_test {

void seal(ilk_config_t& config) {
  const auto words = std::bit_cast<std::array<uint32_t, sizeof(ilk_config_t) / 4>>(config);
  config.crc = crc32_of_words(std::span(words).first(words.size() - 1));
}

ilk_axis_config_t plain_axis(ilk_card_t card) {
  ilk_axis_config_t axis{};
  axis.card = card;
  axis.motor_direction = 1;
  axis.limit_side = ILK_LIMIT_NONE;
  axis.min_counts = -1000;
  axis.max_counts = 1000;
  axis.coast_counts = 10;
  axis.backlash_counts = 1;
  axis.noise_counts = 1;
  axis.deadband_counts = 2;
  axis.dead_zone_drive = 10;
  axis.max_drive = 1000;
  axis.unhomed_max_drive = 100;
  axis.unhomed_travel_counts = 101;
  axis.full_speed_counts_per_s = 5000;
  axis.stall_ticks = 50;
  axis.stall_effort_ticks = 20;
  axis.stall_min_counts = 2;
  axis.reverse_counts = 20;
  axis.drift_counts = 20;
  axis.rest_ticks = 10;
  axis.max_delta_counts = 8;
  return axis;
}

ilk_axis_config_t switched_axis(ilk_card_t card, ilk_limit_side_t side) {
  ilk_axis_config_t axis = plain_axis(card);
  axis.limit_side = side;
  axis.home_offset_counts = side == ILK_LIMIT_LOWER ? -980 : 980;
  axis.home_drive = 50;
  axis.home_slow_drive = 20;
  axis.home_travel_counts = 2401;
  axis.home_timeout_ticks = 3000;
  axis.home_clear_counts = 30;
  axis.home_tolerance_counts = 8;
  axis.switch_hysteresis_counts = 2;
  axis.home_speed_counts_per_s = 1000;
  axis.home_slow_speed_counts_per_s = 500;
  return axis;
}

ilk_config_t standard_config() {
  ilk_config_t config{};
  config.common.version = ILK_CONFIG_VERSION;
  config.common.size_bytes = sizeof(ilk_config_t);
  config.common.period_us = 1000;
  config.common.pedal_channels = 2;
  config.common.app_timeout_ticks = 30;
  config.common.lease_max_ticks = 20;
  config.common.pedal_debounce_ticks = 5;
  config.common.pedal_disagree_ticks = 8;
  config.common.power_up_ticks = 10;
  config.common.switch_debounce_ticks = 3;
  config.common.bad_frame_limit = 3;
  config.common.overrun_limit = 3;
  config.axis[slot::pwm_lower] = switched_axis(ILK_CARD_PWM, ILK_LIMIT_LOWER);
  config.axis[slot::pwm_free] = plain_axis(ILK_CARD_PWM);
  config.axis[slot::non_pwm_upper] = switched_axis(ILK_CARD_NON_PWM, ILK_LIMIT_UPPER);
  config.axis[slot::non_pwm_inverted] = switched_axis(ILK_CARD_NON_PWM, ILK_LIMIT_LOWER);
  config.axis[slot::non_pwm_inverted].motor_direction = 0;
  config.axis[slot::analog_upper] = switched_axis(ILK_CARD_ANALOG, ILK_LIMIT_UPPER);
  config.axis[slot::high_frequency] = switched_axis(ILK_CARD_HIGH_FREQUENCY, ILK_LIMIT_LOWER);
  config.axis[slot::high_frequency].max_amplitude = 200;
  config.axis[slot::high_frequency].home_amplitude = 80;
  config.axis[slot::corrected_lower] = switched_axis(ILK_CARD_NON_PWM, ILK_LIMIT_LOWER);
  config.axis[slot::corrected_lower].direction_correction = 1;
  config.axis[slot::corrected_upper] = switched_axis(ILK_CARD_PWM, ILK_LIMIT_UPPER);
  config.axis[slot::corrected_upper].direction_correction = 1;
  config.axis[slot::corrected_upper].motor_direction = 0;
  config.axis[slot::sensor].card = ILK_CARD_SENSOR;
  config.axis[slot::sensor].required = 1;
  seal(config);
  return config;
}

ilk_config_t ten_axis_config() {
  ilk_config_t config = standard_config();
  config.axis[slot::sensor] = switched_axis(ILK_CARD_PWM, ILK_LIMIT_UPPER);
  config.axis[slot::empty] = plain_axis(ILK_CARD_NON_PWM);
  seal(config);
  return config;
}

}  // namespace interlock::kernel_test
