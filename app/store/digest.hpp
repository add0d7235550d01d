/**
 * @file
 * What the store takes from libsodium besides passwords.
 */
#pragma once

#include <string>
#include <string_view>

#include "store/store_error.hpp"

namespace interlock {

/** Makes libsodium ready; harmless when it is. Refused, unavailable: the system gives no random numbers. */
Stored<void> start_sodium();

/** SHA-256 as 64 hex digits. */
std::string sha256_hex(std::string_view bytes);

/** 256 random bits as base64url without padding, 43 characters. */
std::string random_token();

}  // namespace interlock
