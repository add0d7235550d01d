/**
 * @file
 * Users as rows of a query.
 */
#pragma once

#include <map>
#include <string>

#include "store/sqlite_forward.hpp"
#include "store/users.hpp"

namespace interlock {

/** The user in the row: name, role, enabled, created and last_login, from column `first` on. */
User user_in(SQLite::Statement& row, int first);

/** For each name the digest of name, role, state and password's hash, which the audit records with each
 * change of a user. Throws SQLite::Exception. */
std::map<std::string, std::string> user_digests(SQLite::Database& database);

}  // namespace interlock
