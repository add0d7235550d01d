#include "store/settings.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include "store/stored_time.hpp"

namespace interlock {

std::optional<Setting> Settings::find(const std::string& key) const {
  SQLite::Statement select(database_, "SELECT value, updated FROM settings WHERE key = ?");
  select.bind(1, key);
  if (!select.executeStep()) {
    return std::nullopt;
  }
  nlohmann::json value = nlohmann::json::parse(select.getColumn(0).getString(), nullptr, false);
  if (value.is_discarded()) {
    throw SQLite::Exception("setting " + key + " holds no JSON", SQLITE_CORRUPT);
  }
  return Setting{std::move(value), stored_time(select.getColumn(1))};
}

void Settings::set(const std::string& key, const nlohmann::json& value, UtcTime now) {
  SQLite::Statement upsert(database_,
                           "INSERT INTO settings (key, value, updated) VALUES (?, ?, ?) ON CONFLICT (key) DO "
                           "UPDATE SET value = excluded.value, updated = excluded.updated");
  upsert.bind(1, key);
  upsert.bind(2, value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  upsert.bind(3, iso_8601(now));
  upsert.exec();
}

}  // namespace interlock
