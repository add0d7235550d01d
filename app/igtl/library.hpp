/**
 * @file
 * The way into and out of Debian's libopenigtlink. Private to this folder.
 */
#pragma once

#include <igtlMessageHeader.h>

#include <algorithm>
#include <string_view>

#include "igtl/header.hpp"

namespace interlock::igtl {

/**
 * What the library makes of that content, which must have been proved safe for it; null when it refuses. The
 * library knows version 1 only, hence gets a header of its own making.
 */
template <typename LibraryMessage>
typename LibraryMessage::Pointer unpacked(std::string_view type, Bytes content) {
  ByteVector bytes;
  append_header(bytes, {1, std::string(type), "", 0, content.size(), 0});
  const auto header = ::igtl::MessageHeader::New();
  header->InitPack();
  std::ranges::copy(bytes, static_cast<std::uint8_t*>(header->GetPackPointer()));
  header->Unpack();
  typename LibraryMessage::Pointer message = LibraryMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  if (static_cast<std::size_t>(message->GetPackBodySize()) != content.size()) {
    return nullptr;
  }
  std::ranges::copy(content, static_cast<std::uint8_t*>(message->GetPackBodyPointer()));
  constexpr int without_crc = 0;  // which was held against the frame
  return (message->Unpack(without_crc) & ::igtl::MessageHeader::UNPACK_BODY) != 0 ? message : nullptr;
}

/** The body that the library makes of its message. */
template <typename Pointer>
ByteVector packed(const Pointer& message) {
  message->Pack();
  const auto* body = static_cast<const std::uint8_t*>(message->GetPackBodyPointer());
  return {body, body + message->GetPackBodySize()};
}

}  // namespace interlock::igtl
