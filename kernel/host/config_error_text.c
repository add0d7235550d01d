/* Generated from spec/catalog.toml by `make generate`. Do not edit. */
#include "config_error_text.h"

ilk_config_error_text_t ilk_config_error_text(uint32_t error) {
  static const ilk_config_error_text_t texts[ILK_CONFIG_ERROR_COUNT] = {
    [ILK_CONFIG_ERROR_NONE] = {"NONE", "The configuration is valid."},
    [ILK_CONFIG_ERROR_VERSION] = {"VERSION", "`version` is not the kernel's configuration version."},
    [ILK_CONFIG_ERROR_SIZE] = {"SIZE", "`size_bytes` is not the size of the kernel's configuration."},
    [ILK_CONFIG_ERROR_CRC] = {"CRC", "`crc` does not match the words before it."},
    [ILK_CONFIG_ERROR_PERIOD] = {"PERIOD", "`period_us` is not from 125 to 2000."},
    [ILK_CONFIG_ERROR_PEDAL_CHANNELS] = {"PEDAL_CHANNELS", "`pedal_channels` is not 1 or 2."},
    [ILK_CONFIG_ERROR_APP_TIMEOUT] = {"APP_TIMEOUT", "`app_timeout_ticks` is zero or more than 150 ms."},
    [ILK_CONFIG_ERROR_LEASE] = {"LEASE", "`lease_max_ticks` is zero or more than 150 ms."},
    [ILK_CONFIG_ERROR_PEDAL_DEBOUNCE] = {"PEDAL_DEBOUNCE", "`pedal_debounce_ticks` is zero or more than 50 ms."},
    [ILK_CONFIG_ERROR_PEDAL_DISAGREE] = {"PEDAL_DISAGREE", "`pedal_disagree_ticks` is zero or more than 50 ms."},
    [ILK_CONFIG_ERROR_BAD_FRAMES] = {"BAD_FRAMES", "`bad_frame_limit` is not from 1 to 5."},
    [ILK_CONFIG_ERROR_OVERRUNS] = {"OVERRUNS", "`overrun_limit` is not from 1 to 10."},
    [ILK_CONFIG_ERROR_NO_AXIS] = {"NO_AXIS", "No slot has a motor card."},
    [ILK_CONFIG_ERROR_CARD] = {"CARD", "`card` is not a known card type."},
    [ILK_CONFIG_ERROR_FLAG] = {"FLAG", "`required`, `motor_direction` or `direction_correction` is not 0 or 1."},
    [ILK_CONFIG_ERROR_EMPTY_SLOT] = {"EMPTY_SLOT", "A slot without a motor card has a field that is not zero, `card` and `required` apart; an empty slot is required."},
    [ILK_CONFIG_ERROR_LIMIT_SIDE] = {"LIMIT_SIDE", "`limit_side` is not NONE, LOWER or UPPER."},
    [ILK_CONFIG_ERROR_SOFT_LIMITS] = {"SOFT_LIMITS", "`min_counts` is not below `max_counts`, or a limit is beyond 2^30 counts."},
    [ILK_CONFIG_ERROR_HOME_OFFSET] = {"HOME_OFFSET", "`home_offset_counts` is outside the soft limits."},
    [ILK_CONFIG_ERROR_COAST] = {"COAST", "`coast_counts` is zero, or min + coast is not below max - coast."},
    [ILK_CONFIG_ERROR_DEADBAND] = {"DEADBAND", "`deadband_counts` is zero or at least half of the range."},
    [ILK_CONFIG_ERROR_MAX_DRIVE] = {"MAX_DRIVE", "`max_drive` is zero or more than the card's word can carry."},
    [ILK_CONFIG_ERROR_UNHOMED_DRIVE] = {"UNHOMED_DRIVE", "`unhomed_max_drive` is zero or more than a tenth of `max_drive`."},
    [ILK_CONFIG_ERROR_AMPLITUDE] = {"AMPLITUDE", "`max_amplitude` is not from 1 to 255 on a HIGH_FREQUENCY card, or not zero on another; or `home_amplitude` exceeds it."},
    [ILK_CONFIG_ERROR_UNHOMED_TRAVEL] = {"UNHOMED_TRAVEL", "`unhomed_travel_counts` is not above `coast_counts`, or more than a tenth of the range."},
    [ILK_CONFIG_ERROR_HOME_DRIVE] = {"HOME_DRIVE", "`home_drive` is zero or more than `unhomed_max_drive` on an axis with a switch, or not zero on one without."},
    [ILK_CONFIG_ERROR_HOME_TRAVEL] = {"HOME_TRAVEL", "`home_travel_counts` does not cover the whole range and the coasting distance, or is more than twice the range."},
    [ILK_CONFIG_ERROR_HOME_BACKOFF] = {"HOME_BACKOFF", "`home_backoff_counts` is zero or more than a tenth of the range on an axis with a switch."},
    [ILK_CONFIG_ERROR_HOME_REST] = {"HOME_REST", "`home_rest_ticks` is zero or more than `home_timeout_ticks`."},
    [ILK_CONFIG_ERROR_HOME_TIMEOUT] = {"HOME_TIMEOUT", "`home_timeout_ticks` at `home_speed_counts_per_s` does not cover the back-off, the travel and the rest, or is more than ten minutes."},
    [ILK_CONFIG_ERROR_STALL] = {"STALL", "`stall_ticks` is zero or more than 500 ms, or `stall_min_counts` is zero or not above `noise_counts`."},
    [ILK_CONFIG_ERROR_REVERSE] = {"REVERSE", "`reverse_counts` does not cover coast, backlash and noise, or is more than a tenth of the range."},
    [ILK_CONFIG_ERROR_DRIFT] = {"DRIFT", "`drift_counts` does not cover coast, backlash and noise, or is more than a tenth of the range."},
    [ILK_CONFIG_ERROR_SETTLE] = {"SETTLE", "`settle_ticks` is zero or more than 1000 ms."},
    [ILK_CONFIG_ERROR_MAX_DELTA] = {"MAX_DELTA", "`max_delta_counts` is zero or more than half of the range."},
  };
  static const ilk_config_error_text_t unknown = {"UNKNOWN", "The code is not in the catalog."};
  return error < ILK_CONFIG_ERROR_COUNT ? texts[error] : unknown;
}
