/**
 * @file
 * What the app remembers from one start to the next: JSON values by key.
 */
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "store/store.hpp"

namespace interlock {

/** One setting and when it was set. */
struct Setting {
  nlohmann::json value;
  UtcTime updated;
};

/** The settings in one transaction. */
class Settings {
 public:
  explicit Settings(Transaction& transaction) : database_(transaction.database()) {}

  /** The setting of that key, where there is one. */
  [[nodiscard]] std::optional<Setting> find(const std::string& key) const;

  /** Sets it, in place of what was there. */
  void set(const std::string& key, const nlohmann::json& value, UtcTime now);

 private:
  SQLite::Database& database_;
};

}  // namespace interlock
