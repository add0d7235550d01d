/**
 * @file
 * The newest readings of the force sensor, and how old they are.
 *
 * A reading is new when the kernel found the card's frame valid in this tick and the card's own clock went
 * on: a frame that is repeated, late or of a card that stands still tells nothing new (spec/frames.md).
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "interlock/link.h"

namespace interlock {

/** Where the two forces of a needle robot are read. */
struct ForceInputs {
  std::uint32_t slot = 0;
  std::uint32_t hand_adc = 1; /**< 1 to 4 */
  std::uint32_t needle_adc = 1;

  bool operator==(const ForceInputs&) const = default;
};

/** Reading of the analog input `adc`, 1 to 4, in the two words of a frame that have them (spec/frames.md):
 * two to a word, the odd one in the upper half. */
constexpr std::uint32_t analog_reading(std::span<const std::uint32_t, 2> words, std::uint32_t adc) noexcept {
  const std::uint32_t word = words[(adc - 1) / 2];
  return adc % 2 == 1 ? word >> 16 : word & 0xFFFFu;
}

/** In counts of the converter. */
struct ForceReadings {
  /** For zeroing: the newest ones, in no order. */
  static constexpr std::size_t kept = 128;

  std::uint32_t count = 0; /**< readings since the start, saturating */
  std::uint32_t tick = 0;  /**< of the newest one */
  std::uint32_t hand = 0;
  std::uint32_t needle = 0;
  std::array<std::uint32_t, kept> last_hand{};
  std::array<std::uint32_t, kept> last_needle{};

  /** Age at that tick; the longest of all before the first reading. */
  [[nodiscard]] std::uint32_t age_ticks(std::uint32_t now) const noexcept {
    return count == 0 ? std::numeric_limits<std::uint32_t>::max() : now - tick;
  }

  [[nodiscard]] std::span<const std::uint32_t> recent_hand() const noexcept { return recent(last_hand); }
  [[nodiscard]] std::span<const std::uint32_t> recent_needle() const noexcept { return recent(last_needle); }

 private:
  [[nodiscard]] std::span<const std::uint32_t> recent(
      const std::array<std::uint32_t, kept>& last) const noexcept {
    return {last.data(), count < kept ? count : kept};
  }
};

/** Follows both forces from snapshot to snapshot. */
class ForceWatch {
 public:
  explicit ForceWatch(const ForceInputs& inputs) noexcept : inputs_(inputs) {}

  /** Takes in one snapshot. */
  void look(const ilk_snapshot_t& snapshot) noexcept;

  [[nodiscard]] const ForceReadings& readings() const noexcept { return readings_; }

 private:
  ForceInputs inputs_;
  ForceReadings readings_;
  std::uint32_t card_time_us_ = 0;
  std::size_t next_ = 0; /**< place of the next reading among those that are kept */
};

}  // namespace interlock
