/**
 * @file
 * When an axis has come to rest.
 */
#pragma once

#include <cstdint>
#include <cstdlib>

namespace interlock {

/** Distance between two positions, which cannot overflow. */
inline std::uint64_t distance(std::int32_t a, std::int32_t b) noexcept {
  return static_cast<std::uint64_t>(std::llabs(static_cast<std::int64_t>(a) - b));
}

/** Counts the ticks since which an axis moved no more than its counter's noise. */
class RestWatch {
 public:
  /** The axis moves, or is only now looked at. */
  void restart(std::int32_t position_counts, std::uint32_t tick) noexcept {
    position_counts_ = position_counts;
    since_ = tick;
  }

  /** Whether the axis has rested for 50 ticks. */
  [[nodiscard]] bool rests(std::int32_t position_counts, std::uint32_t noise_counts,
                           std::uint32_t tick) noexcept {
    constexpr std::uint32_t rest_ticks = 50;
    if (distance(position_counts, position_counts_) > noise_counts) {
      restart(position_counts, tick);
    }
    return tick - since_ >= rest_ticks;
  }

 private:
  std::int32_t position_counts_ = 0;
  std::uint32_t since_ = 0;
};

}  // namespace interlock
