/**
 * @file
 * `interlock user add|passwd|list`. They work while the app runs, on the same store.
 */
#pragma once

#include <ostream>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/store_place.hpp"

namespace interlock::cli {

struct UserOptions {
  StorePlace place;
  std::string name;
  std::string role;
  bool password_from_stdin = false;
  bool json = false;
};

/** Adds a user; the store is made if there is none. */
Result<void> add_user(const UserOptions& options, const Installation& installation, std::ostream& output);

/** Gives a user a new password and ends the sessions of the user. */
Result<void> change_password(const UserOptions& options, const Installation& installation,
                             std::ostream& output);

Result<void> list_users(const UserOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
