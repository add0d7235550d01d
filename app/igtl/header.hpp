/**
 * @file
 * The 58 bytes that begin each message, and how large what follows them may be.
 */
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "igtl/fault.hpp"
#include "igtl/wire.hpp"

namespace interlock::igtl {

inline constexpr std::size_t header_bytes = 58;
inline constexpr std::size_t type_width = 12;
inline constexpr std::size_t device_width = 20;

/** Bodies of unknown types, and bodies of a wrong size, up to here are skipped; a peer with larger ones is
 * left. */
inline constexpr std::uint64_t longest_skipped = 64u * 1024u;
/** What version 2 may add to a body: extended header and metadata. */
inline constexpr std::uint64_t longest_extension = 64u * 1024u;

struct Header {
  std::uint16_t version = 1;
  std::string type;
  std::string device;
  std::uint64_t timestamp = 0; /**< seconds and their fraction, 32 bits each */
  std::uint64_t body_size = 0;
  std::uint64_t crc = 0; /**< of the body */

  bool operator==(const Header&) const = default;
};

/** The header in exactly `header_bytes` bytes; its names are printable, its version is 1 or 2. */
tl::expected<Header, Fault> read_header(Bytes bytes);

/** Appends the header; names are cut to their fields. */
void append_header(ByteVector& bytes, const Header& header);

/** Whether this app knows what the body of such a message looks like. */
bool is_known_type(std::string_view type) noexcept;

/** Whether the content of a message of that type can have that size; content is a body without what version
 * 2 adds. Every size suits an unknown type. */
bool is_size_of(std::string_view type, std::uint64_t content_bytes) noexcept;

/** The largest body of that type that is read at all. */
std::uint64_t ceiling_of(std::string_view type, std::uint16_t version) noexcept;

/** Printable ASCII: from blank to tilde. */
bool is_printable(std::string_view text) noexcept;

/** The text in a field that is padded with zeros; nothing when anything follows its end. */
tl::expected<std::string, Fault> read_field(Bytes field, Fault otherwise);

}  // namespace interlock::igtl
