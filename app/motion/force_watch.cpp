#include "motion/force_watch.hpp"

#include "link/card_frame.hpp"

namespace interlock {

void ForceWatch::look(const ilk_snapshot_t& snapshot) noexcept {
  const auto& frame = snapshot.inputs.frame[inputs_.slot];
  const std::uint32_t time_us = frame[card_frame::time_word];
  const bool clock_went_on = readings_.count == 0 || time_us != card_time_us_;
  if (snapshot.state.axis[inputs_.slot].card_valid == 0 || !clock_went_on) {
    return;
  }
  card_time_us_ = time_us;
  readings_.tick = snapshot.state.system.tick;
  const std::span<const std::uint32_t, 2> words(&frame[card_frame::analog_word], 2);
  readings_.hand = analog_reading(words, inputs_.hand_adc);
  readings_.needle = analog_reading(words, inputs_.needle_adc);
  readings_.last_hand[next_] = readings_.hand;
  readings_.last_needle[next_] = readings_.needle;
  next_ = (next_ + 1) % ForceReadings::kept;
  readings_.count += readings_.count != std::numeric_limits<std::uint32_t>::max() ? 1u : 0u;
}

}  // namespace interlock
