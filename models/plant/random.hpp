/**
 * @file
 * Seeded randomness that gives the same numbers with every standard library.
 */
#ifndef INTERLOCK_PLANT_RANDOM_HPP
#define INTERLOCK_PLANT_RANDOM_HPP

#include <cstdint>
#include <random>

namespace interlock::plant {

/** One independent stream of random numbers. Streams of one seed do not disturb each other. */
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(mix(seed ^ mix(stream + 1))) {}

  /** True with a chance of one half. */
  bool coin() { return (engine_() >> 63) != 0; }

  /** True with the given chance, 0 to 1. */
  bool chance(double probability) {
    // The standard distributions differ between libraries; the upper 53 bits make an exact double in [0, 1).
    return static_cast<double>(engine_() >> 11) * 0x1p-53 < probability;
  }

  /** A number from 0 to `bound` - 1; `bound` is not 0. */
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((engine_() >> 32) * bound) >> 32);
  }

 private:
  static constexpr std::uint64_t mix(std::uint64_t value) {
    value += 0x9e3779b97f4a7c15u;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
    return value ^ (value >> 31);
  }

  std::mt19937_64 engine_;
};

}  // namespace interlock::plant

#endif
