#include <string>

#include "service/targeting.hpp"
#include "store/settings.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr const char* last_set_key = "targeting_last_set";
constexpr const char* changes_key = "targeting_changes";
constexpr const char* reported_field = "reported_position";

/** What is kept under the key; an empty one of that kind when there is none. */
json kept_history(Transaction& transaction, const char* key, json::value_t kind) {
  auto setting = Settings(transaction).find(key);
  return setting && setting->value.type() == kind ? std::move(setting->value) : json(kind);
}

/** Who, when and from where. */
json origin_of(const AuditEntry& entry, std::int64_t number) {
  return {{"record", number},
          {"time", iso_8601(entry.time)},
          {"tick", entry.tick ? json(*entry.tick) : json()},
          {"user", entry.actor},
          {"source", entry.detail.at("source")},
          {"client", entry.detail.at("client")}};
}

bool is_report_alone(const json& fields) { return fields.size() == 1 && fields.contains(reported_field); }

}  // namespace

void note_targeting_change(Transaction& transaction, const AuditEntry& entry, std::int64_t number) {
  const json origin = origin_of(entry, number);
  const json& fields = entry.detail.at("new");
  json last_set = kept_history(transaction, last_set_key, json::value_t::object);
  for (const auto& [field, value] : fields.items()) {
    last_set[field] = origin;
  }
  Settings(transaction).set(last_set_key, last_set, entry.time);
  if (is_report_alone(fields)) {
    return;
  }
  json change = origin;
  change["old"] = entry.detail.at("old");
  change["new"] = fields;
  json changes = kept_history(transaction, changes_key, json::value_t::array);
  changes.insert(changes.begin(), std::move(change));
  if (changes.size() > most_targeting_changes) {
    changes.erase(changes.begin() + most_targeting_changes, changes.end());
  }
  Settings(transaction).set(changes_key, changes, entry.time);
}

json targeting_history(Transaction& transaction, UtcTime now) {
  return {{"now", iso_8601(now)},
          {"last_set", kept_history(transaction, last_set_key, json::value_t::object)},
          {"changes", kept_history(transaction, changes_key, json::value_t::array)}};
}

}  // namespace interlock
