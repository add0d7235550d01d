#include "igtl/header.hpp"

#include <algorithm>
#include <array>

namespace interlock::igtl {
namespace {

/** Sizes `least`, `least + step`, .. up to `most`. */
struct Sizes {
  std::string_view type;
  std::uint64_t least;
  std::uint64_t step;
  std::uint64_t most;
};

constexpr std::uint64_t longest_array = std::uint64_t{1} << 20u;

constexpr std::array<Sizes, 12> known_sizes{{
    {"TRANSFORM", 48, 1, 48},
    {"STRING", 4, 1, 4 + 65535},
    {"STATUS", 31, 1, 31 + 4096},
    {"POINT", 0, 136, 1000 * 136},
    {"POSITION", 12, 4, 28},
    {"TDATA", 0, 70, 255 * 70},
    {"STT_TDATA", 36, 1, 36},
    {"RTS_TDATA", 1, 1, 1},
    {"STP_TDATA", 0, 1, 0},
    {"NDARRAY", 2, 1, longest_array},
    {"SENSOR", 10, 8, 10 + 255 * 8},
    {"CAPABILITY", 0, 12, 255 * 12},
}};

constexpr Sizes query_sizes{"GET_", 0, 1, 0};

const Sizes* sizes_of(std::string_view type) noexcept {
  if (type.starts_with(query_sizes.type)) {
    return &query_sizes;
  }
  const auto found = std::ranges::find(known_sizes, type, &Sizes::type);
  return found == known_sizes.end() ? nullptr : &*found;
}

}  // namespace

bool is_printable(std::string_view text) noexcept {
  return std::ranges::all_of(text, [](char each) { return each >= ' ' && each <= '~'; });
}

tl::expected<std::string, Fault> read_field(Bytes field, Fault otherwise) {
  const auto end = std::ranges::find(field, std::uint8_t{0});
  if (std::any_of(end, field.end(), [](std::uint8_t byte) { return byte != 0; })) {
    return tl::unexpected(otherwise);
  }
  std::string text(field.begin(), end);
  if (!is_printable(text)) {
    return tl::unexpected(otherwise);
  }
  return text;
}

tl::expected<Header, Fault> read_header(Bytes bytes) {
  Header header;
  header.version = read_number<std::uint16_t>(bytes, 0);
  if (header.version != 1 && header.version != 2) {
    return tl::unexpected(Fault::version);
  }
  auto type = read_field(bytes.subspan(2, type_width), Fault::type_name);
  if (!type || type->empty()) {
    return tl::unexpected(Fault::type_name);
  }
  auto device = read_field(bytes.subspan(2 + type_width, device_width), Fault::device_name);
  if (!device) {
    return tl::unexpected(device.error());
  }
  header.type = std::move(*type);
  header.device = std::move(*device);
  header.timestamp = read_number<std::uint64_t>(bytes, 34);
  header.body_size = read_number<std::uint64_t>(bytes, 42);
  header.crc = read_number<std::uint64_t>(bytes, 50);
  return header;
}

void append_header(ByteVector& bytes, const Header& header) {
  append_number(bytes, header.version);
  append_field(bytes, header.type, type_width);
  append_field(bytes, header.device, device_width);
  append_number(bytes, header.timestamp);
  append_number(bytes, header.body_size);
  append_number(bytes, header.crc);
}

bool is_known_type(std::string_view type) noexcept { return sizes_of(type) != nullptr; }

bool is_size_of(std::string_view type, std::uint64_t content_bytes) noexcept {
  const Sizes* sizes = sizes_of(type);
  if (sizes == nullptr) {
    return true;
  }
  if (type == "POSITION") {
    return content_bytes == 12 || content_bytes == 24 || content_bytes == 28;
  }
  return content_bytes >= sizes->least && content_bytes <= sizes->most &&
         (content_bytes - sizes->least) % sizes->step == 0;
}

std::uint64_t ceiling_of(std::string_view type, std::uint16_t version) noexcept {
  const Sizes* sizes = sizes_of(type);
  const std::uint64_t content = sizes == nullptr ? longest_skipped : std::max(sizes->most, longest_skipped);
  return version == 1 ? content : content + longest_extension;
}

}  // namespace interlock::igtl
