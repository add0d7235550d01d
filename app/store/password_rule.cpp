#include <sodium.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "store/password.hpp"

namespace interlock {
namespace {

constexpr std::size_t fewest_parts = 6;
constexpr std::size_t shortest_name = 3;

/** What the commonest passwords of ten characters and more are made of: lists of leaked passwords, and the
 * words of this product. */
constexpr auto common_words = std::to_array<std::string_view>(
    {"administrator", "passwort",   "password",  "passw0rd", "p@ssw0rd", "pa55word",  "passwd",
     "kennwort",      "interlock",  "surgical",  "surgery",  "robot",    "hospital",  "medical",
     "clinic",        "doctor",     "needle",    "engineer", "operator", "viewer",    "service",
     "support",       "default",    "admin",     "root",     "user",     "guest",     "master",
     "manager",       "system",     "server",    "computer", "internet", "login",     "welcome",
     "willkommen",    "hello",      "hallo",     "letmein",  "changeme", "change",    "secret",
     "geheim",        "test",       "temp",      "access",   "security", "private",   "iloveyou",
     "ilove",         "love",       "liebe",     "trustno1", "starwars", "superman",  "batman",
     "spiderman",     "pokemon",    "dragon",    "monkey",   "princess", "sunshine",  "football",
     "baseball",      "basketball", "fussball",  "soccer",   "hockey",   "liverpool", "chelsea",
     "arsenal",       "barcelona",  "michael",   "jennifer", "jessica",  "michelle",  "charlie",
     "daniel",        "thomas",     "jordan",    "samsung",  "google",   "facebook",  "linkedin",
     "microsoft",     "windows",    "minecraft", "whatever", "freedom",  "forever",   "flower",
     "summer",        "sommer",     "winter",    "spring",   "autumn",   "january",   "december",
     "monday",        "friday",     "mustang",   "mercedes", "porsche",  "zaq12wsx"});

constexpr std::array<std::string_view, 5> keyboard_rows{"1234567890", "qwertyuiop", "qwertzuiop", "asdfghjkl",
                                                        "zxcvbnm"};

std::string lower(std::string_view text) {
  std::string lowered(text);
  std::ranges::transform(lowered, lowered.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  });
  return lowered;
}

/** Whether the second character is one that a guesser tries after the first. */
bool follows(char first, char second) {
  const int step = second - first;
  if (step >= -1 && step <= 1) {
    return true;
  }
  return std::ranges::any_of(keyboard_rows, [&](std::string_view row) {
    const std::size_t one = row.find(first);
    const std::size_t other = row.find(second);
    return one != std::string_view::npos && other != std::string_view::npos &&
           (one + 1 == other || other + 1 == one);
  });
}

/** How many characters at `at` are a word or the name. */
std::size_t word_at(std::string_view text, std::size_t at, std::string_view name) {
  const std::string_view rest = text.substr(at);
  std::size_t most = name.size() >= shortest_name && rest.starts_with(name) ? name.size() : 0;
  for (const std::string_view word : common_words) {
    if (rest.starts_with(word)) {
      most = std::max(most, word.size());
    }
  }
  return most;
}

/** How many characters at `at` go on as the text before has begun. */
std::size_t repetition_at(std::string_view text, std::size_t at) {
  std::size_t most = 0;
  for (std::size_t from = 0; from < at; ++from) {
    std::size_t length = 0;
    while (at + length < text.size() && text[from + length] == text[at + length]) {
      ++length;
    }
    most = std::max(most, length);
  }
  constexpr std::size_t fewest = 3;
  return most >= fewest ? most : 0;
}

std::size_t run_at(std::string_view text, std::size_t at) {
  std::size_t length = 1;
  while (at + length < text.size() && follows(text[at + length - 1], text[at + length])) {
    ++length;
  }
  return length;
}

}  // namespace

bool is_easy_to_guess(std::string_view password, std::string_view user) {
  std::string text = lower(password);
  const std::string name = lower(user);
  std::size_t parts = 0;
  for (std::size_t at = 0; at < text.size(); ++parts) {
    at += std::max({word_at(text, at, name), repetition_at(text, at), run_at(text, at)});
  }
  sodium_memzero(text.data(), text.size());
  return parts < fewest_parts;
}

}  // namespace interlock
