/**
 * @file
 * The published speed map of the high-frequency motor, both ways: revolutions per minute by frequency word,
 * for each direction, linear between its 24 points (word 1196612456 - 4063228 i, 54369 Hz to 50123 Hz). A
 * lower word is faster.
 *
 * The kernel's drive for such a card is the speed of the faster direction in thousandths of a revolution per
 * minute (spec/frames.md). Whoever wants a speed in a direction goes from that speed to the word and from the
 * word to the drive.
 */
#pragma once

#include <cstdint>

namespace interlock::frequency_map {

/** The motor stands still at this word and above. */
inline constexpr std::uint32_t slowest_word = 1196612456;
inline constexpr std::uint32_t word_step = 4063228;
inline constexpr std::uint32_t points = 24;
inline constexpr std::uint32_t fastest_word = slowest_word - (points - 1) * word_step;

/** The published relation of word and frequency. */
inline constexpr double words_per_hz = 22009.0;

/** The frequency (Hz) of a frequency word. */
constexpr double hz_of(std::uint32_t word) noexcept { return word / words_per_hz; }

/** Column of the map: which of its two wave tables the card plays first. */
enum class Wave : std::uint8_t {
  positive, /**< direction bit 0 */
  negative  /**< direction bit 1 */
};

/** Of a direction of the axis: the direction bit of spec/frames.md chooses the column. */
constexpr Wave wave_of(bool motor_direction, bool decreasing) noexcept {
  return motor_direction == decreasing ? Wave::negative : Wave::positive;
}

/** Speed at a word in revolutions per minute; that of the nearest point for words outside the map. */
double rpm_at(std::uint32_t word, Wave wave) noexcept;

/**
 * Slowest word at which the motor is not faster than `rpm`, so at most one word on the slower side of it.
 * `slowest_word` for a speed that is not above 0 or no number, `fastest_word` for one beyond the map.
 */
std::uint32_t word_for(double rpm, Wave wave) noexcept;

/** Largest drive that the kernel packs as this word or as a slower one. */
std::uint32_t drive_at(std::uint32_t word) noexcept;

/** The word as which the kernel packs a drive; `slowest_word` for zero drive. */
std::uint32_t word_of(std::uint32_t drive) noexcept;

}  // namespace interlock::frequency_map
