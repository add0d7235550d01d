/**
 * @file
 * Messages out of a stream of bytes that comes in pieces, and into one.
 *
 * A frame is a message whose every length was checked: names printable, size one that its type can have, CRC
 * right, what version 2 adds taken off. Only then are its bytes fit for a decoder (codec.hpp).
 */
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "igtl/header.hpp"

namespace interlock::igtl {

/** Keys and values. */
using Metadata = std::vector<std::pair<std::string, std::string>>;

/** One message, checked but not yet read. */
struct Frame {
  Header header;
  ByteVector content;           /**< the body without what version 2 adds */
  std::uint32_t message_id = 0; /**< of version 2 */
  Metadata metadata;            /**< of version 2 */
};

/** A message that is skipped; the next one can be read. */
struct Refused {
  Header header;
  Fault fault;
};

/** Nobody knows where the next message begins: the connection is to be closed. */
struct Broken {
  Fault fault;
  Header header; /**< as far as it could be read */
};

/** What came of the bytes: nothing yet, or one thing. */
using Arrival = std::variant<std::monostate, Frame, Refused, Broken>;

/** Cuts a stream of bytes into messages. */
class FrameReader {
 public:
  /** Takes bytes off the front of `input` until something came of them or they are used up. */
  Arrival take(Bytes& input);

  /** Whether a message has begun and not ended. */
  [[nodiscard]] bool is_within_message() const noexcept { return !held_.empty() || skipping_ != 0; }

  /** The header of a message whose body has not ended, or null. */
  [[nodiscard]] const Header* begun() const noexcept { return in_body_ ? &header_ : nullptr; }

 private:
  bool fill(Bytes& input, std::size_t desired);
  void skip(Bytes& input);
  Arrival begin_body();
  Arrival finish();

  ByteVector held_;            /**< header, then body, as far as they came */
  Header header_;              /**< once there are 58 bytes */
  bool in_body_ = false;       /**< the header was read */
  std::uint64_t skipping_ = 0; /**< bytes of a refused body that are still to come */
};

/** The whole message in that version, with its CRC; version 2 without metadata. */
ByteVector write_frame(std::uint16_t version, std::string_view type, std::string_view device,
                       std::uint64_t timestamp, Bytes content);

}  // namespace interlock::igtl
