#include "store/password.hpp"

#include <sodium.h>

#include <array>

#include "store/digest.hpp"

namespace interlock {
namespace {

constexpr std::size_t shortest = 10;
constexpr std::size_t longest = 128;
constexpr std::size_t random_length = 20;
/** 32 characters: 5 bits each. Without i, l, o and 0, 1, which look alike. */
constexpr std::string_view random_alphabet = "abcdefghjkmnpqrstuvwxyz23456789-";

/** The number of characters; 0 for what is no UTF-8. Length and shape of the sequences are all that matters
 * here. */
std::size_t characters(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size(); ++count) {
    const auto lead = static_cast<unsigned char>(text[at]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    if (length == 0 || lead > 0xf4 || at + length > text.size()) {
      return 0;
    }
    for (std::size_t next = at + 1; next < at + length; ++next) {
      if ((static_cast<unsigned char>(text[next]) & 0xc0u) != 0x80u) {
        return 0;
      }
    }
    at += length;
  }
  return count;
}

StoreError refused(std::string problem, std::string expected) {
  return {StoreError::Kind::invalid, std::move(problem), "password", std::move(expected), ""};
}

}  // namespace

Password::Password(std::string&& text) : text_(text.begin(), text.end()) {
  sodium_memzero(text.data(), text.size());
  text.clear();
}

Password& Password::operator=(Password&& other) noexcept {
  text_.swap(other.text_);
  return *this;
}

Password::~Password() { sodium_memzero(text_.data(), text_.size()); }

Stored<Password> Password::random() {
  static_assert(random_alphabet.size() == 32);
  return start_sodium().map([] {
    std::string text;
    text.reserve(random_length);
    while (text.size() < random_length) {
      text += random_alphabet[randombytes_uniform(random_alphabet.size())];
    }
    return Password(std::move(text));
  });
}

Stored<PasswordHash> PasswordHash::of_new(const Password& password, std::string_view user) {
  const std::size_t length = characters(password.text());
  if (length < shortest || length > longest) {
    return tl::unexpected(
        refused("the password is too short, too long or no UTF-8 text",
                std::to_string(shortest) + " to " + std::to_string(longest) + " characters"));
  }
  if (password.text() == user) {
    return tl::unexpected(refused("the password is the user's name", "a password that is not the name"));
  }
  if (const Stored<void> started = start_sodium(); !started) {
    return tl::unexpected(started.error());
  }
  std::array<char, crypto_pwhash_STRBYTES> hash{};
  if (crypto_pwhash_str(hash.data(), password.text().data(), password.text().size(),
                        crypto_pwhash_OPSLIMIT_INTERACTIVE, crypto_pwhash_MEMLIMIT_INTERACTIVE) != 0) {
    return tl::unexpected(StoreError{StoreError::Kind::unavailable,
                                     "there is not enough memory to hash a password", "", "64 MiB free",
                                     "end other programs"});
  }
  return PasswordHash(hash.data());
}

bool PasswordHash::matches(const Password& password) const {
  return start_sodium() &&
         crypto_pwhash_str_verify(text_.c_str(), password.text().data(), password.text().size()) == 0;
}

}  // namespace interlock
