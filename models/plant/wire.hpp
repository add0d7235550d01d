/**
 * @file
 * The card's side of spec/frames.md: what a card reads from a frame of the kernel and how it answers.
 *
 * Written from that document alone. It shares no code with the kernel, so that a slip in one of the two
 * codecs shows as a disagreement.
 */
#ifndef INTERLOCK_PLANT_WIRE_HPP
#define INTERLOCK_PLANT_WIRE_HPP

#include <array>
#include <cstdint>
#include <span>

#include "interlock/types.h"

namespace interlock::plant::wire {

inline constexpr std::size_t kFrameWords = ILK_FRAME_WORDS;

using Frame = std::array<std::uint32_t, kFrameWords>;
using FrameView = std::span<const std::uint32_t, kFrameWords>;

/** What a card makes of the drive words. Without amplifier or with level 0 the motor is not driven. */
struct MotorCommand {
  bool amplifier_enabled = false;
  bool direction_bit = false;  /**< "actual" of spec/frames.md */
  std::uint32_t level = 0;     /**< drive; on high-frequency cards the frequency word */
  std::uint32_t amplitude = 0; /**< high-frequency cards only */
};

/** Analog inputs of a card; ADC 1 is input 0. */
inline constexpr std::size_t kAnalogInputs = 4;

using AnalogReadings = std::array<std::uint16_t, kAnalogInputs>;

/** What a card tells. */
struct Report {
  bool switch_triggered = false;
  std::uint32_t counter = 0;
  AnalogReadings analog{};
  std::uint32_t heartbeat = 0;
  std::uint32_t time_us = 0;
  std::uint32_t tick_echo = 0;
  bool amplifier_on = false;
  bool watchdog_tripped = false;
  bool last_frame_bad = false;
  bool was_reset = false;
};

/** The checksum of all words but the last. */
std::uint32_t checksum(FrameView frame);

/** True when start word and checksum are right. */
bool is_sound(FrameView frame);

/** The kernel's tick counter in a frame. */
std::uint32_t tick_counter(FrameView frame);

/** The first drive word that is not zero, in the order 3, 6, 2, 4, 5, 14; 0 means zero drive. */
std::uint32_t first_drive_word(FrameView frame);

/** Reads the drive words as a card of the type `card` (ilk_card_t) does. */
MotorCommand read_command(std::uint32_t card, FrameView frame);

/** Packs a report into a frame with start word and checksum. */
Frame pack(const Report& report);

}  // namespace interlock::plant::wire

#endif
