/** @file Doubles that are no numbers, for the doors of every function. */
#pragma once

#include <array>
#include <limits>
#include <random>

namespace interlock::test {

inline constexpr std::array not_numbers{std::numeric_limits<double>::quiet_NaN(),
                                        std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity()};

using Generator = std::mt19937_64;

inline double between(Generator& generator, double lowest, double highest) {
  return std::uniform_real_distribution<double>(lowest, highest)(generator);
}

}  // namespace interlock::test
