#include "motion/force_watch.hpp"

namespace interlock {
namespace {

/** First of the two words with analog inputs, two to a word, the odd one in the upper half. */
constexpr std::uint32_t analog_word = 7;

std::uint32_t analog(const ilk_snapshot_t& snapshot, std::uint32_t slot, std::uint32_t adc) noexcept {
  const std::uint32_t word = snapshot.inputs.frame[slot][analog_word + (adc - 1) / 2];
  return adc % 2 == 1 ? word >> 16 : word & 0xFFFFu;
}

}  // namespace

void ForceWatch::look(const ilk_snapshot_t& snapshot) noexcept {
  const ilk_axis_t& card = snapshot.state.axis[inputs_.slot];
  const bool clock_went_on = readings_.count == 0 || card.card_time_us != card_time_us_;
  if (card.card_valid == 0 || !clock_went_on) {
    return;
  }
  card_time_us_ = card.card_time_us;
  readings_.tick = snapshot.state.tick;
  readings_.hand = analog(snapshot, inputs_.slot, inputs_.hand_adc);
  readings_.needle = analog(snapshot, inputs_.slot, inputs_.needle_adc);
  readings_.last_hand[next_] = readings_.hand;
  readings_.last_needle[next_] = readings_.needle;
  next_ = (next_ + 1) % ForceReadings::kept;
  readings_.count += readings_.count != std::numeric_limits<std::uint32_t>::max() ? 1u : 0u;
}

}  // namespace interlock
