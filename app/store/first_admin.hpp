/**
 * @file
 * The way into a new store.
 */
#pragma once

#include <optional>

#include "store/password.hpp"
#include "store/store.hpp"

namespace interlock {

constexpr const char* first_admin_name = "admin";

/**
 * Adds the administrator `admin` with a random password, and the audit record of it, to a store that has no
 * users.
 *
 * Returns the password, to be shown once; nothing if there is a user already.
 */
Stored<std::optional<Password>> add_first_admin(Store& store, UtcTime now);

}  // namespace interlock
