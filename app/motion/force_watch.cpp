#include "motion/force_watch.hpp"

namespace interlock {
namespace {

/** First of the words of a frame with analog inputs. */
constexpr std::size_t analog_word = 7;

}  // namespace

void ForceWatch::look(const ilk_snapshot_t& snapshot) noexcept {
  const ilk_axis_t& card = snapshot.state.axis[inputs_.slot];
  const bool clock_went_on = readings_.count == 0 || card.card_time_us != card_time_us_;
  if (card.card_valid == 0 || !clock_went_on) {
    return;
  }
  card_time_us_ = card.card_time_us;
  readings_.tick = snapshot.state.system.tick;
  const std::span<const std::uint32_t, 2> words(&snapshot.inputs.frame[inputs_.slot][analog_word], 2);
  readings_.hand = analog_reading(words, inputs_.hand_adc);
  readings_.needle = analog_reading(words, inputs_.needle_adc);
  readings_.last_hand[next_] = readings_.hand;
  readings_.last_needle[next_] = readings_.needle;
  next_ = (next_ + 1) % ForceReadings::kept;
  readings_.count += readings_.count != std::numeric_limits<std::uint32_t>::max() ? 1u : 0u;
}

}  // namespace interlock
