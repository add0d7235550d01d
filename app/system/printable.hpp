/**
 * @file
 * Text of others (names, paths, messages of peers) as logs, terminals and listings show it: on one line, in
 * the order in which it was written, and without commands to the terminal.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace interlock {

/** One character at the beginning of a UTF-8 text. */
struct Utf8Character {
  char32_t code_point = 0;
  std::size_t bytes = 0;
};

/** The first character of the text; nothing when the text is empty or does not begin with valid UTF-8. */
std::optional<Utf8Character> first_character(std::string_view text);

/**
 * The text, with escapes in place of what could mislead a reader:
 * - \\xNN for control characters of ASCII (C0, DEL) and for each byte that is not valid UTF-8;
 * - \\uNNNN for the controls U+0080 to U+009F, for the line separators U+2028 and U+2029, and for the
 *   controls of the writing direction (U+061C, U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069).
 */
std::string printable(std::string_view text);

/** What a reader sees of a text that `printable` leaves as it is: without white space, and without what has
 * no width. */
std::string visible(std::string_view text);

/** How many characters a text in UTF-8 has. */
std::size_t characters_in(std::string_view text);

}  // namespace interlock
