/**
 * @file
 * Passwords: which ones are good enough, and how they are kept.
 */
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "store/store_error.hpp"

namespace interlock {

// Passwords, and what is kept of them.

/** The text of a password. Its memory is overwritten when it goes. */
class Password {
 public:
  /** Takes the text over and overwrites where it came from. */
  explicit Password(std::string&& text);
  Password(Password&&) noexcept = default;
  Password& operator=(Password&& other) noexcept;
  Password(const Password&) = delete;
  Password& operator=(const Password&) = delete;
  ~Password();

  /** 20 characters that cannot be mistaken for one another, 100 bits of them random. */
  static Stored<Password> random();

  /** Never null, also when empty: the library that hashes it must not be given null. */
  [[nodiscard]] std::string_view text() const {
    return text_.empty() ? std::string_view("") : std::string_view(text_.data(), text_.size());
  }

 private:
  /** Not a string: a short one would leave a copy behind when it is moved. */
  std::vector<char> text_;
};

/** Argon2id hash of a password, with its salt and its cost. */
class PasswordHash {
 public:
  /** A hash that was stored. */
  explicit PasswordHash(std::string text) : text_(std::move(text)) {}

  /**
   * Hashes a new password of a user; takes about a tenth of a second and 64 MiB.
   *
   * Refused, invalid: fewer than 10 or more than 128 characters, not UTF-8, or easy to guess as
   * `store/password.hpp` says; no_memory.
   */
  static Stored<PasswordHash> of_new(const Password& password, std::string_view user);

  /** What came of comparing a password. */
  enum class Match { right, wrong, no_memory };

  /** Whether the password is the one; takes as long and as much memory as hashing it. */
  [[nodiscard]] Match compare(const Password& password) const;

  [[nodiscard]] const std::string& text() const { return text_; }

  bool operator==(const PasswordHash&) const = default;

 private:
  std::string text_;
};

// Which new passwords are too easy to guess.

/**
 * Whether the password has fewer than 6 parts that a guesser does not get for free. As one part each count:
 * - the user's name and each word of a list of those that common passwords are made of, in any case;
 * - a run of equal characters, of neighbours in the alphabet or on a keyboard's row, in either direction;
 * - a repetition of what is before it.
 *
 * So refused are `aaaaaaaaaa`, `1234567890`, `qwertyuiop`, `password12` and the name repeated. The rule keeps
 * the commonest guesses out; it measures no strength.
 */
bool is_easy_to_guess(std::string_view password, std::string_view user);

}  // namespace interlock
