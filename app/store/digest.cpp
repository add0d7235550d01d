#include "store/digest.hpp"

#include <sodium.h>

#include <array>

namespace interlock {

Stored<void> start_sodium() {
  if (sodium_init() < 0) {
    return tl::unexpected(StoreError{StoreError::Kind::unavailable, "the system gives no random numbers", "",
                                     "", "see that /dev/urandom can be read"});
  }
  return {};
}

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256(hash.data(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  std::array<char, 2 * hash.size() + 1> hex{};
  return sodium_bin2hex(hex.data(), hex.size(), hash.data(), hash.size());
}

std::string random_token() {
  std::array<unsigned char, 32> bits{};
  randombytes_buf(bits.data(), bits.size());
  constexpr int variant = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
  std::array<char, sodium_base64_ENCODED_LEN(bits.size(), variant)> text{};
  return sodium_bin2base64(text.data(), text.size(), bits.data(), bits.size(), variant);
}

}  // namespace interlock
