/**
 * @file
 * Sweeps of frequency: the band of an axis, the frequencies between two ends, and the checks that a sweep
 * meets before anybody may approve it.
 */
#pragma once

#include <optional>
#include <tl/expected.hpp>

#include "control/frequency_map.hpp"
#include "motion/mailbox.hpp"
#include "proposals/move_check.hpp"

namespace interlock {

/** Frequencies that the kernel packs for an axis: a lower one turns it faster. */
struct FrequencyBand {
  double lowest_hz = 0.0;  /**< that of the largest drive */
  double highest_hz = 0.0; /**< that of the smallest drive that moves the axis */
};

/** The published sweep: 0x48000000 down to 0x40000000 in steps of 1 000 000, a second each. */
inline constexpr FrequencyBand published_sweep{frequency_map::hz_of(0x40000000),
                                               frequency_map::hz_of(0x48000000)};
inline constexpr double published_sweep_step_hz = 1e6 / frequency_map::words_per_hz;
inline constexpr double published_sweep_dwell_s = 1.0;

/** Of the robot file's bounds on drive; empty for an axis without a high-frequency card. */
std::optional<FrequencyBand> frequency_band(const Axis& axis) noexcept;

/**
 * The frequencies from one to the other, both in Hz and above 0, as far as whole steps lead.
 *
 * @return empty when they are more than `FrequencySteps::most`, or a step is not above 0
 */
std::optional<FrequencySteps> frequency_steps(double from_hz, double to_hz, double step_hz,
                                              std::uint32_t dwell_ticks) noexcept;

/** The whole band of the axis, from its slowest frequency on, in published steps of a second each. */
std::optional<FrequencySteps> whole_band(const Axis& axis, std::uint32_t period_us) noexcept;

/**
 * Judges a sweep against the newest view: CONFIG_MISMATCH, MODE, FAULTED, DISABLED, BUSY while homing,
 * NOT_HOMED, then DRIVE for frequencies outside of the band, which it names.
 */
void check_sweep(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                 const SweepTask& sweep, CheckList& checks);

}  // namespace interlock
