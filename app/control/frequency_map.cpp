#include "control/frequency_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace interlock::frequency_map {
namespace {

/** Speeds at the points, from the slowest on: strictly rising. */
using Speeds = std::array<double, points>;

constexpr Speeds positive_rpm{0,      0.029,  0.164,   0.289,   0.431,   0.640,   0.963,   1.459,
                              2.660,  5.181,  11.445,  13.464,  20.955,  27.358,  36.039,  45.548,
                              58.997, 78.710, 105.850, 141.386, 188.106, 247.388, 317.394, 397.785};
constexpr Speeds negative_rpm{0,      0.054,  0.189,   0.331,   0.614,   1.095,   2.020,   3.222,
                              3.773,  6.383,  10.636,  15.308,  20.231,  27.239,  35.238,  45.333,
                              58.497, 77.516, 103.284, 138.166, 183.915, 242.763, 312.833, 391.709};

/** The faster of both directions in thousandths, exact in a double. */
constexpr Speeds faster_drive = [] {
  Speeds drive{};
  for (std::size_t point = 0; point < points; ++point) {
    const double thousandths = std::max(positive_rpm[point], negative_rpm[point]) * 1000;
    drive[point] = static_cast<double>(static_cast<std::uint32_t>(thousandths + 0.5));
  }
  return drive;
}();

const Speeds& speeds_of(Wave wave) noexcept { return wave == Wave::positive ? positive_rpm : negative_rpm; }

double interpolated(const Speeds& speeds, std::uint32_t word) noexcept {
  const std::uint32_t below = slowest_word - std::clamp(word, fastest_word, slowest_word);
  const std::uint32_t point = std::min(below / word_step, points - 2);
  const double share = static_cast<double>(below - point * word_step) / word_step;
  return speeds[point] + share * (speeds[point + 1] - speeds[point]);
}

/** The word at a speed, rounded up: to the slower side. */
std::uint32_t inverse(const Speeds& speeds, double speed) noexcept {
  if (!(speed > 0.0)) {
    return slowest_word;
  }
  const auto* const faster = std::lower_bound(speeds.begin() + 1, speeds.end(), speed);
  if (faster == speeds.end()) {
    return fastest_word;
  }
  const auto point = static_cast<std::uint32_t>(faster - speeds.begin()) - 1;
  const double share = (speed - speeds[point]) / (speeds[point + 1] - speeds[point]);
  return slowest_word - point * word_step - static_cast<std::uint32_t>(share * word_step);
}

}  // namespace

double rpm_at(std::uint32_t word, Wave wave) noexcept { return interpolated(speeds_of(wave), word); }

std::uint32_t word_for(double rpm, Wave wave) noexcept { return inverse(speeds_of(wave), rpm); }

std::uint32_t drive_at(std::uint32_t word) noexcept {
  return static_cast<std::uint32_t>(interpolated(faster_drive, word));
}

std::uint32_t word_of(std::uint32_t drive) noexcept { return inverse(faster_drive, drive); }

}  // namespace interlock::frequency_map
