#include "igtl/crc64.hpp"

#include <array>

namespace interlock::igtl {
namespace {

constexpr std::uint64_t polynomial = 0x42F0E1EBA9EA3693u;
constexpr std::uint64_t top_bit = std::uint64_t{1} << 63u;

constexpr std::array<std::uint64_t, 256> table_of_bytes() {
  std::array<std::uint64_t, 256> table{};
  for (std::size_t byte = 0; byte < table.size(); ++byte) {
    std::uint64_t remainder = static_cast<std::uint64_t>(byte) << 56u;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder << 1u) ^ ((remainder & top_bit) != 0 ? polynomial : 0u);
    }
    table[byte] = remainder;
  }
  return table;
}

constexpr std::array<std::uint64_t, 256> table = table_of_bytes();

}  // namespace

std::uint64_t crc64(Bytes bytes) noexcept {
  std::uint64_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc = (crc << 8u) ^ table[(crc >> 56u) ^ byte];
  }
  return crc;
}

}  // namespace interlock::igtl
