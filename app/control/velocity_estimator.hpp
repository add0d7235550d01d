/**
 * @file
 * Velocity of an axis from its encoder readings and the card's timestamps of them.
 *
 * The filter is the slope of the straight line that fits the readings of a window best (least squares), by
 * default those of the last 20 ms. It belongs to the mean time of these readings: at a steady rate it is half
 * a window late, and the estimate says how late. A reading is the whole count below the position. At 100
 * counts/s and above that leaves a deviation of 15 counts/s at most in 21 readings a millisecond apart;
 * below, where the window holds a count or two, up to 29 (at 30 counts/s), as much as the speed itself.
 *
 * Time is the card's (spec/frames.md, word 10): microseconds modulo 2^32, taken with the reading, so that a
 * late or lost frame does not look like a change of speed.
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace interlock {

inline constexpr double us_per_s = 1e6;

/** How the estimate of one axis is made. */
struct VelocityRules {
  std::uint32_t window_us = 20'000;
  double fastest_counts_per_s = 0.0; /**< a larger step than this speed explains is a jump, not motion */
  double noise_counts = 0.0;         /**< peak-to-peak noise of the counter, on top of that speed */
};

/** A velocity and how old it is. */
struct VelocityEstimate {
  double counts_per_s = 0.0;
  double age_s = 0.0; /**< from the time to which it belongs to the newest reading */

  bool operator==(const VelocityEstimate&) const = default;
};

/** Velocity of one axis from the card's timestamps. */
class VelocityEstimator {
 public:
  /** Readings that are kept at most: 20 ms at the shortest control period. */
  static constexpr std::size_t most_samples = 161;

  explicit VelocityEstimator(const VelocityRules& rules) noexcept : rules_(rules) {}

  /**
   * Takes a reading. One that is as old as the newest, or older by up to a window, is left out. A jump of
   * the counter, a clock that went back further and a gap longer than the window begin a new window.
   */
  void add(std::int32_t position_counts, std::uint32_t time_us) noexcept;

  /** The velocity; nothing until the readings cover half a window. Always finite. */
  [[nodiscard]] std::optional<VelocityEstimate> estimate() const noexcept;

  /** Forgets every reading. */
  void reset() noexcept { count_ = 0; }

 private:
  struct Sample {
    std::int32_t position_counts;
    std::uint32_t time_us;
  };

  /** By age: 0 is the newest. */
  [[nodiscard]] const Sample& sample(std::size_t age) const noexcept {
    return samples_[(next_ + most_samples - 1 - age) % most_samples];
  }
  [[nodiscard]] std::uint32_t covered_us() const noexcept;
  [[nodiscard]] bool is_jump(std::int32_t position_counts, std::uint32_t later_us) const noexcept;

  VelocityRules rules_;
  std::array<Sample, most_samples> samples_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace interlock
