/**
 * @file
 * Times as a column holds them.
 */
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include "system/utc_time.hpp"

namespace interlock {

/** The time in a column. Throws SQLite::Exception (SQLITE_CORRUPT) where it is none. */
inline UtcTime stored_time(const SQLite::Column& column) {
  const std::string text = column.getString();
  const std::optional<UtcTime> time = parse_iso_8601(text);
  if (!time) {
    throw SQLite::Exception("'" + text + "' in column " + column.getName() + " is no time", SQLITE_CORRUPT);
  }
  return *time;
}

}  // namespace interlock
