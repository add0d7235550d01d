#include "system/printable.hpp"

#include <algorithm>

namespace interlock {
namespace {

void append_hexadecimal(std::string& text, std::uint32_t number, unsigned digits) {
  constexpr std::string_view digit = "0123456789abcdef";
  while (digits-- > 0) {
    text += digit[(number >> (4u * digits)) & 0xfu];
  }
}

constexpr bool is_ascii_control(char32_t c) { return c < 0x20 || c == 0x7f; }

constexpr bool misleads(char32_t c) {
  return (c >= 0x80 && c <= 0x9f) || c == 0x2028 || c == 0x2029 || c == 0x061c || c == 0x200e ||
         c == 0x200f || (c >= 0x202a && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
}

/** White space, and what has no width. */
constexpr bool is_blank(char32_t c) {
  return c == 0x20 || c == 0xa0 || c == 0xad || c == 0x34f || c == 0x115f || c == 0x1160 || c == 0x1680 ||
         c == 0x180e || (c >= 0x2000 && c <= 0x200d) || c == 0x202f || (c >= 0x205f && c <= 0x2064) ||
         c == 0x2800 || c == 0x3000 || c == 0x3164 || (c >= 0xfe00 && c <= 0xfe0f) || c == 0xfeff ||
         c == 0xffa0 || (c >= 0xe0000 && c <= 0xe0fff);
}

/** How many bytes a character has that begins with this one; 0 where none begins so. */
constexpr std::size_t length_after(unsigned char lead) {
  if (lead < 0x80) return 1;
  if (lead < 0xc2) return 0;
  if (lead < 0xe0) return 2;
  if (lead < 0xf0) return 3;
  return lead < 0xf5 ? 4 : 0;
}

/** Whether it could have been written with fewer bytes, is half of a UTF-16 pair, or lies beyond Unicode. */
constexpr bool is_forbidden(char32_t c, std::size_t bytes) {
  return (bytes == 3 && c < 0x800) || (bytes == 4 && c < 0x10000) || (c >= 0xd800 && c <= 0xdfff) ||
         c > 0x10ffff;
}

}  // namespace

std::optional<Utf8Character> first_character(std::string_view text) {
  if (text.empty()) {
    return std::nullopt;
  }
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t bytes = length_after(lead);
  if (bytes == 0 || bytes > text.size()) {
    return std::nullopt;
  }
  char32_t code_point = bytes == 1 ? lead : lead & (0x7fu >> bytes);
  for (const char each : text.substr(1, bytes - 1)) {
    const auto byte = static_cast<unsigned char>(each);
    if ((byte & 0xc0u) != 0x80u) {
      return std::nullopt;
    }
    code_point = (code_point << 6u) | (byte & 0x3fu);
  }
  return is_forbidden(code_point, bytes) ? std::nullopt : std::optional(Utf8Character{code_point, bytes});
}

std::string printable(std::string_view text) {
  std::string line;
  line.reserve(text.size());
  while (!text.empty()) {
    const auto character = first_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    if (!character || is_ascii_control(character->code_point)) {
      line += "\\x";
      append_hexadecimal(line, static_cast<unsigned char>(text.front()), 2);
    } else if (misleads(character->code_point)) {
      line += "\\u";
      append_hexadecimal(line, character->code_point, 4);
    } else {
      line += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return line;
}

std::string visible(std::string_view text) {
  std::string seen;
  for (auto character = first_character(text); character; character = first_character(text)) {
    if (!is_blank(character->code_point)) {
      seen += text.substr(0, character->bytes);
    }
    text.remove_prefix(character->bytes);
  }
  return seen;
}

std::size_t characters_in(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char each) { return (each & 0xc0) != 0x80; }));
}

}  // namespace interlock
