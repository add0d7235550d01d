#include "store/password.hpp"

#include <sodium.h>

#include <array>
#include <cstdio>
#include <optional>

#include "store/digest.hpp"
#include "system/printable.hpp"

namespace interlock {
namespace {

constexpr std::size_t shortest = 10;
constexpr std::size_t longest = 128;
constexpr std::size_t random_length = 20;
/** 32 characters: 5 bits each. Without i, l, o and 0, 1, which look alike. */
constexpr std::string_view random_alphabet = "abcdefghjkmnpqrstuvwxyz23456789-";

/** The number of characters; 0 for what is no UTF-8. */
std::size_t characters(std::string_view text) {
  std::size_t count = 0;
  for (; !text.empty(); ++count) {
    const auto character = first_character(text);
    if (!character) {
      return 0;
    }
    text.remove_prefix(character->bytes);
  }
  return count;
}

/** What the text of a hash holds. */
struct StoredHash {
  unsigned passes = 0;
  std::size_t memory_bytes = 0;
  std::array<unsigned char, crypto_pwhash_SALTBYTES> salt{};
  std::array<unsigned char, 32> hash{};
};

template <std::size_t Size>
bool decode(std::string_view base64, std::array<unsigned char, Size>& bytes) {
  std::size_t length = 0;
  return sodium_base642bin(bytes.data(), bytes.size(), base64.data(), base64.size(), nullptr, &length,
                           nullptr, sodium_base64_VARIANT_ORIGINAL_NO_PADDING) == 0 &&
         length == Size;
}

/** Of $argon2id$v=19$m=65536,t=2,p=1$SALT$HASH; nothing when the text is of another form. */
std::optional<StoredHash> read_hash(const std::string& text) {
  StoredHash stored;
  unsigned kibibytes = 0;
  std::array<char, 23> salt{};
  std::array<char, 44> hash{};
  int length = 0;
  const int fields = std::sscanf(text.c_str(), "$argon2id$v=19$m=%u,t=%u,p=1$%22[^$]$%43[^$]%n", &kibibytes,
                                 &stored.passes, salt.data(), hash.data(), &length);
  stored.memory_bytes = std::size_t{kibibytes} * 1024;
  const bool whole = fields == 4 && static_cast<std::size_t>(length) == text.size() &&
                     stored.passes >= crypto_pwhash_argon2id_OPSLIMIT_MIN &&
                     stored.memory_bytes >= crypto_pwhash_argon2id_MEMLIMIT_MIN;
  return whole && decode(salt.data(), stored.salt) && decode(hash.data(), stored.hash) ? std::optional(stored)
                                                                                       : std::nullopt;
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
  if (is_easy_to_guess(password.text(), user)) {
    return tl::unexpected(refused(
        "the password is easy to guess: it is a common one, the user's name, a repetition or a sequence",
        "a few words that nobody would expect together"));
  }
  if (const Stored<void> started = start_sodium(); !started) {
    return tl::unexpected(started.error());
  }
  std::array<char, crypto_pwhash_STRBYTES> hash{};
  // It fails for nothing else.
  if (crypto_pwhash_str(hash.data(), password.text().data(), password.text().size(),
                        crypto_pwhash_OPSLIMIT_INTERACTIVE, crypto_pwhash_MEMLIMIT_INTERACTIVE) != 0) {
    return tl::unexpected(StoreError{StoreError::Kind::no_memory,
                                     "there is not enough memory to hash a password", "", "64 MiB free",
                                     "end other programs"});
  }
  return PasswordHash(hash.data());
}

PasswordHash::Match PasswordHash::compare(const Password& password) const {
  if (!start_sodium()) {
    return Match::wrong;
  }
  const auto stored = read_hash(text_);
  if (!stored) {
    return Match::wrong;
  }
  // Not crypto_pwhash_str_verify, to which a failed allocation is a wrong password.
  decltype(stored->hash) hash{};
  if (crypto_pwhash(hash.data(), hash.size(), password.text().data(), password.text().size(),
                    stored->salt.data(), stored->passes, stored->memory_bytes,
                    crypto_pwhash_ALG_ARGON2ID13) != 0) {
    return Match::no_memory;
  }
  return sodium_memcmp(hash.data(), stored->hash.data(), hash.size()) == 0 ? Match::right : Match::wrong;
}

}  // namespace interlock
