/** @file Messages byte by byte, as a peer sends them that need not be right. */
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "igtl/crc64.hpp"
#include "igtl/frame.hpp"

namespace interlock::igtl::test {

/** A header that says `size` and `crc`, whatever follows it. */
inline ByteVector header_of(std::string_view type, std::uint64_t size, std::uint64_t crc,
                            std::uint16_t version = 1, std::string_view device = "NAME") {
  ByteVector bytes;
  append_header(bytes, {version, std::string(type), std::string(device), 0, size, crc});
  return bytes;
}

inline ByteVector operator+(ByteVector left, const ByteVector& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/** A message with right size and CRC. */
inline ByteVector message_of(std::string_view type, const ByteVector& body, std::uint16_t version = 1,
                             std::string_view device = "NAME") {
  return header_of(type, body.size(), crc64(body), version, device) + body;
}

/** A STRING of ASCII that says so. */
inline ByteVector text_body(std::string_view text) {
  ByteVector body{0, 3};
  append_number(body, static_cast<std::uint16_t>(text.size()));
  body.insert(body.end(), text.begin(), text.end());
  return body;
}

/** A matrix of the unit rotation at x, y, z. */
inline ByteVector transform_body(float x, float y, float z) {
  ByteVector body;
  for (const float value : {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, x, y, z}) {
    append_float32(body, static_cast<double>(value));
  }
  return body;
}

/** Everything that comes of these bytes. */
inline std::vector<Arrival> arrivals(FrameReader& reader, Bytes input) {
  std::vector<Arrival> all;
  while (!input.empty()) {
    Arrival arrival = reader.take(input);
    const bool broken = std::holds_alternative<Broken>(arrival);
    if (!std::holds_alternative<std::monostate>(arrival)) {
      all.push_back(std::move(arrival));
    }
    if (broken) {
      break;
    }
  }
  return all;
}

inline std::vector<Arrival> arrivals(Bytes input) {
  FrameReader reader;
  return arrivals(reader, input);
}

}  // namespace interlock::igtl::test
