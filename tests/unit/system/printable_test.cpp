#include "system/printable.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace interlock {
namespace {

TEST(Printable, KeepsTheTextOfEveryLanguage) {
  for (const char* const text : {"", "plain \"text\" \\ ~", "Größe 5 µm", "日本語", "עברית", "🙂"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, EscapesControlCharactersOfAscii) {
  EXPECT_EQ(printable(std::string("a\0b\n\x1b[31m\x7f\r\t", 12)), "a\\x00b\\x0a\\x1b[31m\\x7f\\x0d\\x09");
}

TEST(Printable, EscapesTheControlsThatUtf8Hides) {
  const std::pair<const char*, const char*> cases[] = {
      {"\xc2\x80", "\\u0080"},     {"\xc2\x9b", "\\u009b"},     {"\xd8\x9c", "\\u061c"},
      {"\xe2\x80\x8e", "\\u200e"}, {"\xe2\x80\x8f", "\\u200f"}, {"\xe2\x80\xa8", "\\u2028"},
      {"\xe2\x80\xa9", "\\u2029"}, {"\xe2\x80\xaa", "\\u202a"}, {"\xe2\x80\xae", "\\u202e"},
      {"\xe2\x81\xa6", "\\u2066"}, {"\xe2\x81\xa9", "\\u2069"}};
  for (const auto& [character, escaped] : cases) {
    EXPECT_EQ(printable("a" + std::string(character) + "b"), "a" + std::string(escaped) + "b");
  }
}

TEST(Printable, EscapesEachByteThatIsNoUtf8AndGoesOnBehindIt) {
  const std::pair<const char*, const char*> cases[] = {{"\xff", "\\xff"},
                                                       {"\x80z", "\\x80z"},
                                                       {"\xc3", "\\xc3"},
                                                       {"\xc3\xc3\xbc", "\\xc3ü"},
                                                       {"\xe2\x80", "\\xe2\\x80"},
                                                       {"\xc0\xaf", "\\xc0\\xaf"},
                                                       {"\xe0\x80\xaf", "\\xe0\\x80\\xaf"},
                                                       {"\xed\xa0\x80", "\\xed\\xa0\\x80"},
                                                       {"\xf0\x80\x80\x80", "\\xf0\\x80\\x80\\x80"},
                                                       {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"}};
  for (const auto& [bytes, escaped] : cases) {
    EXPECT_EQ(printable(bytes), escaped);
  }
}

}  // namespace
}  // namespace interlock
