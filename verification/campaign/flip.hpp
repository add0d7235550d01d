/**
 * @file
 * A single bit of a record of 32-bit words.
 */
#ifndef INTERLOCK_CAMPAIGN_FLIP_HPP
#define INTERLOCK_CAMPAIGN_FLIP_HPP

#include <array>
#include <cstdint>
#include <cstring>

namespace interlock::campaign {

/** Flips a bit, counted from the lowest of the first word. */
template <typename Record>
void flip(Record& record, std::size_t bit) {
  std::array<std::uint32_t, sizeof(Record) / sizeof(std::uint32_t)> words;
  std::memcpy(words.data(), &record, sizeof record);
  words[bit / 32] ^= 1u << (bit % 32);
  std::memcpy(&record, words.data(), sizeof record);
}

}  // namespace interlock::campaign

#endif
