/**
 * @file
 * The oracle's own reading of spec/frames.md: what a card was told and what it told.
 *
 * Written from that document alone; it shares no code with the kernel or with the plant.
 */
#ifndef INTERLOCK_ORACLE_WIRE_HPP
#define INTERLOCK_ORACLE_WIRE_HPP

#include <cstdint>
#include <span>

#include "oracle/rules.hpp"

namespace interlock::oracle::wire {

/** 32 or 64 words. */
using FrameView = std::span<const std::uint32_t>;

/** True when start word and checksum are right. */
bool is_intact(FrameView frame) noexcept;

/** What a motor card tells, of an intact frame. */
struct Reading {
  std::uint32_t counter = 0;
  std::uint32_t heartbeat = 0;
  std::uint32_t tick_echo = 0;
  bool switch_triggered = false;
};

Reading read(FrameView frame) noexcept;

/** The kernel's tick, in a frame to a card. */
std::uint32_t tick_counter(FrameView frame) noexcept;

/** True when all words that can drive something are zero. */
bool is_zero_drive(FrameView frame) noexcept;

/** What the drive words of a frame command. */
struct Drive {
  bool well_formed = false;    /**< words that this card can mean, amplifier on */
  bool rises = false;          /**< towards larger positions */
  std::uint32_t magnitude = 0; /**< drive; of high-frequency cards the frequency word */
  std::uint32_t amplitude = 0; /**< high-frequency cards */
};

/** Reads a frame that is not zero drive. */
Drive read_drive(const AxisRules& axis, FrameView frame) noexcept;

/** The frequency word of a high-frequency drive; a lower word is faster. */
std::uint32_t frequency_word(std::uint32_t drive) noexcept;

/** True when the drive is faster than the bound, in the card's own sense. */
bool exceeds(CardKind card, const Drive& drive, std::uint32_t bound) noexcept;

}  // namespace interlock::oracle::wire

#endif
