/**
 * @file
 * Users as rows of a query.
 */
#pragma once

#include "store/sqlite_forward.hpp"
#include "store/users.hpp"

namespace interlock {

/** The user in the row: name, role, enabled, created and last_login, from column `first` on. */
User user_in(SQLite::Statement& row, int first);

}  // namespace interlock
