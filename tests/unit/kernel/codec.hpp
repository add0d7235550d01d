/// Card frames as spec/frames.md defines them, written for the tests: a second reading of that text.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interlock/types.h"

namespace interlock::kernel_test {

using Frame = std::array<uint32_t, ILK_FRAME_WORDS>;

inline constexpr uint32_t start_word = 0xFEFEFE01u;

/// Words of an incoming frame.
namespace incoming {
inline constexpr std::size_t start = 0;
inline constexpr std::size_t pairs = 2;
inline constexpr std::size_t encoder = 3;
inline constexpr std::size_t adc_1_2 = 7;
inline constexpr std::size_t adc_3_4 = 8;
inline constexpr std::size_t heartbeat = 9;
inline constexpr std::size_t time_us = 10;
inline constexpr std::size_t tick_echo = 11;
inline constexpr std::size_t status = 12;
inline constexpr uint32_t switch_open_bit = 0x00080000u;
inline constexpr uint32_t status_was_reset = 8;
}  // namespace incoming

/// Words of an outgoing frame.
namespace outgoing {
inline constexpr std::size_t tick = 13;
inline constexpr std::size_t amplifier = 14;
}  // namespace outgoing

uint32_t checksum(std::span<const uint32_t> frame);
void write_checksum(std::span<uint32_t> frame);
bool start_and_checksum_right(std::span<const uint32_t> frame);

/// Zero drive: every wave, frequency, amplitude, level and amplifier word is zero.
bool drive_words_zero(std::span<const uint32_t> frame);

/// The direction that the signal words ask for, NONE when the frame does not drive.
ilk_direction_t wire_direction(const ilk_axis_config_t& axis, std::span<const uint32_t> frame);

/// Frequency word of a high-frequency drive.
uint32_t high_frequency_word(uint32_t drive);

/// The whole outgoing frame of a command.
Frame pack(const ilk_axis_config_t& axis, const ilk_command_t& command, uint32_t tick);

/// CRC-32 (IEEE 802.3, reflected), bit by bit.
uint32_t crc32_of_words(std::span<const uint32_t> words);

}  // namespace interlock::kernel_test
