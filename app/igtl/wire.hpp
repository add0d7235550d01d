/**
 * @file
 * Numbers as they stand on the wire: big-endian, at any address.
 */
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace interlock::igtl {

/** Bytes that somebody else keeps. */
using Bytes = std::span<const std::uint8_t>;
/** Bytes of one's own. */
using ByteVector = std::vector<std::uint8_t>;

inline constexpr std::size_t status_name_width = 20;
inline constexpr std::uint8_t float64_elements = 11; /**< of an NDARRAY */

/** Never by a cast: fields of a body stand at odd addresses, which some processors cannot read. */
template <std::unsigned_integral Number>
constexpr Number read_number(Bytes bytes, std::size_t at) noexcept {
  Number number = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    number = static_cast<Number>((static_cast<std::uint64_t>(number) << 8u) | bytes[at + i]);
  }
  return number;
}

/** Appends a number, its highest byte first. */
template <std::unsigned_integral Number>
void append_number(ByteVector& bytes, Number number) {
  for (std::size_t i = sizeof(Number); i-- > 0;) {
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> (8u * i)));
  }
}

/** The number of 32 bits at that byte. */
constexpr double read_float32(Bytes bytes, std::size_t at) noexcept {
  return static_cast<double>(std::bit_cast<float>(read_number<std::uint32_t>(bytes, at)));
}

/** The number of 64 bits at that byte. */
constexpr double read_float64(Bytes bytes, std::size_t at) noexcept {
  return std::bit_cast<double>(read_number<std::uint64_t>(bytes, at));
}

/** Appends a number in 32 bits. */
inline void append_float32(ByteVector& bytes, double value) {
  append_number(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

/** Appends a number in 64 bits. */
inline void append_float64(ByteVector& bytes, double value) {
  append_number(bytes, std::bit_cast<std::uint64_t>(value));
}

/** A text in a field of that width: cut, or filled with zeros. */
inline void append_field(ByteVector& bytes, std::string_view text, std::size_t width) {
  const std::string_view kept = text.substr(0, width);
  bytes.insert(bytes.end(), kept.begin(), kept.end());
  bytes.resize(bytes.size() + width - kept.size());
}

}  // namespace interlock::igtl
