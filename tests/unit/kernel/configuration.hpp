/// Configurations with small round numbers, valid by spec/catalog.toml's rules.
#pragma once

#include <cstdint>

#include "interlock/types.h"

namespace interlock::kernel_test {

/// Slots of the standard configuration, named for what is special about their axes.
namespace slot {
inline constexpr uint32_t pwm_lower = 0;         ///< PWM, switch at the lower end
inline constexpr uint32_t pwm_free = 1;          ///< PWM, no switch
inline constexpr uint32_t non_pwm_upper = 2;     ///< NON_PWM, switch at the upper end
inline constexpr uint32_t non_pwm_inverted = 3;  ///< NON_PWM, lower switch, motor direction inverted
inline constexpr uint32_t analog_upper = 4;      ///< ANALOG, switch at the upper end
inline constexpr uint32_t high_frequency = 5;    ///< HIGH_FREQUENCY, switch at the lower end
inline constexpr uint32_t corrected_lower = 6;   ///< NON_PWM, lower switch, counter runs against the position
inline constexpr uint32_t corrected_upper = 7;   ///< PWM, upper switch, counter and motor both inverted
inline constexpr uint32_t sensor = 8;            ///< SENSOR, required
inline constexpr uint32_t empty = 9;             ///< no card
inline constexpr uint32_t axes = 8;              ///< slots 0 to 7 carry an axis
}  // namespace slot

/// Recomputes the CRC after a field was changed.
void seal(ilk_config_t& config);

/// An axis without switch, -1000 to 1000 counts.
ilk_axis_config_t plain_axis(ilk_card_t card);

/// The same axis with a switch and what homing needs.
ilk_axis_config_t switched_axis(ilk_card_t card, ilk_limit_side_t side);

/// Eight axes of every kind, a required sensor card and an empty slot.
ilk_config_t standard_config();

/// Ten axes, for busy ticks.
ilk_config_t ten_axis_config();

}  // namespace interlock::kernel_test
