#include "igtl/frame.hpp"

#include <algorithm>

#include "igtl/crc64.hpp"

namespace interlock::igtl {
namespace {

constexpr std::size_t extended_header_bytes = 12;
constexpr std::size_t metadata_entry_bytes = 8;

/** Lengths of what version 2 adds to the content. */
struct Extension {
  std::size_t header = 0;
  std::size_t index = 0; /**< of the metadata */
  std::size_t texts = 0; /**< of the metadata */
};

tl::expected<Extension, Fault> extension_of(Bytes body) {
  if (body.size() < extended_header_bytes) {
    return tl::unexpected(Fault::extended_header);
  }
  const Extension extension{read_number<std::uint16_t>(body, 0), read_number<std::uint16_t>(body, 2),
                            read_number<std::uint32_t>(body, 4)};
  if (extension.header < extended_header_bytes || extension.header > body.size()) {
    return tl::unexpected(Fault::extended_header);
  }
  const std::size_t left = body.size() - extension.header;
  if (extension.index > left || extension.texts > left - extension.index) {
    return tl::unexpected(Fault::metadata);
  }
  return extension;
}

std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

tl::expected<Metadata, Fault> metadata_of(Bytes index, Bytes texts) {
  if (index.empty() && texts.empty()) {
    return Metadata{};
  }
  if (index.size() < 2 ||
      index.size() != 2 + metadata_entry_bytes * std::size_t{read_number<std::uint16_t>(index, 0)}) {
    return tl::unexpected(Fault::metadata);
  }
  Metadata metadata;
  for (std::size_t at = 2; at < index.size(); at += metadata_entry_bytes) {
    const std::size_t key = read_number<std::uint16_t>(index, at);
    const std::size_t value = read_number<std::uint32_t>(index, at + 4);
    if (key > texts.size() || value > texts.size() - key) {
      return tl::unexpected(Fault::metadata);
    }
    metadata.emplace_back(text_of(texts.first(key)), text_of(texts.subspan(key, value)));
    texts = texts.subspan(key + value);
  }
  if (!texts.empty()) {
    return tl::unexpected(Fault::metadata);
  }
  return metadata;
}

/** Takes off what version 2 adds. */
tl::expected<void, Fault> unwrap(Frame& frame, Bytes body) {
  if (frame.header.version == 1) {
    frame.content.assign(body.begin(), body.end());
    return {};
  }
  const auto extension = extension_of(body);
  if (!extension) {
    return tl::unexpected(extension.error());
  }
  const std::size_t content = body.size() - extension->header - extension->index - extension->texts;
  const Bytes after = body.subspan(extension->header + content);
  auto metadata = metadata_of(after.first(extension->index), after.subspan(extension->index));
  if (!metadata) {
    return tl::unexpected(metadata.error());
  }
  frame.message_id = read_number<std::uint32_t>(body, 8);
  frame.metadata = std::move(*metadata);
  const Bytes kept = body.subspan(extension->header, content);
  frame.content.assign(kept.begin(), kept.end());
  return {};
}

}  // namespace

Arrival FrameReader::take(Bytes& input) {
  skip(input);
  if (skipping_ != 0 || (!in_body_ && !fill(input, header_bytes))) {
    return {};
  }
  if (!in_body_) {
    Arrival arrival = begin_body();
    if (!std::holds_alternative<std::monostate>(arrival)) {
      return arrival;
    }
  }
  return fill(input, header_bytes + static_cast<std::size_t>(header_.body_size)) ? finish() : Arrival{};
}

/** Whether there are as many bytes now. */
bool FrameReader::fill(Bytes& input, std::size_t desired) {
  const std::size_t taken = std::min(desired - held_.size(), input.size());
  held_.insert(held_.end(), input.begin(), input.begin() + static_cast<std::ptrdiff_t>(taken));
  input = input.subspan(taken);
  return held_.size() == desired;
}

void FrameReader::skip(Bytes& input) {
  const auto dropped = static_cast<std::size_t>(std::min<std::uint64_t>(skipping_, input.size()));
  skipping_ -= dropped;
  input = input.subspan(dropped);
}

/** Judges the header before a byte of the body is kept. */
Arrival FrameReader::begin_body() {
  auto header = read_header(held_);
  if (!header) {
    Header legible;
    legible.device = read_field(Bytes(held_).subspan(2 + type_width, device_width), {}).value_or("");
    return Broken{header.error(), std::move(legible)};
  }
  if (header->body_size > ceiling_of(header->type, header->version)) {
    return Broken{Fault::too_large, std::move(*header)};
  }
  const bool unsuitable = header->version == 1 && !is_size_of(header->type, header->body_size);
  if (unsuitable || !is_known_type(header->type)) {
    held_.clear();
    skipping_ = header->body_size;
    const Fault fault = unsuitable ? Fault::wrong_size : Fault::unknown_type;
    return Refused{std::move(*header), fault};
  }
  header_ = std::move(*header);
  in_body_ = true;
  return {};
}

Arrival FrameReader::finish() {
  const Bytes body = Bytes(held_).subspan(header_bytes);
  Frame frame{std::move(header_), {}, 0, {}};
  const auto unwrapped = crc64(body) == frame.header.crc
                             ? unwrap(frame, body)
                             : tl::expected<void, Fault>(tl::unexpect, Fault::checksum);
  held_.clear();
  in_body_ = false;
  if (!unwrapped) {
    return Refused{std::move(frame.header), unwrapped.error()};
  }
  if (!is_size_of(frame.header.type, frame.content.size())) {
    return Refused{std::move(frame.header), Fault::wrong_size};
  }
  return frame;
}

ByteVector write_frame(std::uint16_t version, std::string_view type, std::string_view device,
                       std::uint64_t timestamp, Bytes content) {
  ByteVector body;
  if (version == 2) {
    append_number(body, static_cast<std::uint16_t>(extended_header_bytes));
    append_number(body, std::uint16_t{2});
    append_number(body, std::uint32_t{0});
    append_number(body, std::uint32_t{0});
  }
  body.insert(body.end(), content.begin(), content.end());
  if (version == 2) {
    append_number(body, std::uint16_t{0});
  }
  ByteVector bytes;
  append_header(bytes,
                {version, std::string(type), std::string(device), timestamp, body.size(), crc64(body)});
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

}  // namespace interlock::igtl
