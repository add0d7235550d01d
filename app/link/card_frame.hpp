/**
 * @file
 * What the app reads of a card's frame by itself: the kernel keeps it of cards with an axis alone
 * (spec/frames.md).
 */
#pragma once

#include <cstddef>
#include <cstdint>

#include "interlock/link.h"

namespace interlock::card_frame {

/** First of the words with analog inputs. */
constexpr std::size_t analog_word = 7;
constexpr std::size_t heartbeat_word = 9;
/** Timestamp of the reading in microseconds, wrapping. */
constexpr std::size_t time_word = 10;

/** Of the card's newest valid frame; of a sensor 0 while its frame is not valid. */
inline std::uint32_t heartbeat(const ilk_snapshot_t& snapshot, std::size_t slot) noexcept {
  const ilk_axis_t& axis = snapshot.state.axis[slot];
  return axis.card_valid != 0 ? snapshot.inputs.frame[slot][heartbeat_word] : axis.heartbeat;
}

/** Whether the card has given a valid frame and is not lost since. */
inline bool detected(const ilk_config_t& config, const ilk_state_t& state, std::size_t slot) noexcept {
  const std::uint32_t missed = state.axis[slot].bad_frames;
  return config.axis[slot].card != ILK_CARD_NONE && missed < state.system.tick &&
         missed < config.common.bad_frame_limit;
}

}  // namespace interlock::card_frame
