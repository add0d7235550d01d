#include "store/schema.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "store/audit_table.hpp"
#include "store/store_files.hpp"
#include "system/printable.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;

constexpr const char* version_1 = R"sql(
CREATE TABLE users (
  name TEXT PRIMARY KEY,
  role TEXT NOT NULL CHECK (role IN ('viewer', 'engineer', 'admin')),
  enabled INTEGER NOT NULL CHECK (enabled IN (0, 1)),
  password TEXT NOT NULL,
  created TEXT NOT NULL,
  last_login TEXT
) STRICT;

CREATE TABLE sessions (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  user TEXT NOT NULL REFERENCES users (name),
  token_hash TEXT NOT NULL UNIQUE,
  created TEXT NOT NULL,
  last_seen TEXT NOT NULL
) STRICT;

CREATE TABLE settings (
  key TEXT PRIMARY KEY,
  value TEXT NOT NULL,
  updated TEXT NOT NULL
) STRICT;

CREATE TABLE audit (
  number INTEGER PRIMARY KEY,
  time TEXT NOT NULL,
  tick INTEGER,
  actor TEXT NOT NULL,
  session INTEGER,
  kind TEXT NOT NULL,
  detail TEXT NOT NULL,
  hash TEXT NOT NULL
) STRICT;

CREATE TRIGGER audit_is_not_changed BEFORE UPDATE ON audit
BEGIN SELECT RAISE(ABORT, 'the audit is only appended to'); END;

CREATE TRIGGER audit_is_not_removed BEFORE DELETE ON audit
BEGIN SELECT RAISE(ABORT, 'the audit is only appended to'); END;

CREATE TRIGGER audit_has_no_gaps BEFORE INSERT ON audit
WHEN NEW.number IS NOT (SELECT coalesce(max(number), 0) + 1 FROM audit)
BEGIN SELECT RAISE(ABORT, 'the audit is only appended to'); END;
)sql";

/** Old records may be retired: up to an anchor, which only moves on. */
constexpr const char* version_2 = R"sql(
CREATE TABLE audit_anchor (
  one INTEGER PRIMARY KEY CHECK (one = 1),
  number INTEGER NOT NULL,
  hash TEXT NOT NULL
) STRICT;

CREATE TRIGGER audit_anchor_moves_on BEFORE UPDATE ON audit_anchor
WHEN NEW.number <= OLD.number
BEGIN SELECT RAISE(ABORT, 'the anchor of the audit only moves on'); END;

CREATE TRIGGER audit_anchor_is_not_removed BEFORE DELETE ON audit_anchor
BEGIN SELECT RAISE(ABORT, 'the anchor of the audit only moves on'); END;

DROP TRIGGER audit_is_not_removed;

CREATE TRIGGER audit_is_not_removed BEFORE DELETE ON audit
WHEN OLD.number > (SELECT coalesce(max(number), 0) FROM audit_anchor)
BEGIN SELECT RAISE(ABORT, 'the audit is only appended to'); END;
)sql";

/** What registration and target belong to. What was set before there were cases is in a closed one. */
constexpr const char* version_3 = R"sql(
CREATE TABLE cases (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  state TEXT NOT NULL CHECK (state IN ('open', 'suspended', 'closed')),
  value TEXT NOT NULL
) STRICT;

CREATE UNIQUE INDEX one_case_in_hand ON cases (state <> 'closed') WHERE state <> 'closed';

CREATE TABLE case_changes (
  record INTEGER PRIMARY KEY,
  case_number INTEGER NOT NULL REFERENCES cases (number),
  value TEXT NOT NULL
) STRICT;

CREATE INDEX changes_of_a_case ON case_changes (case_number, record);

INSERT INTO cases (state, value)
SELECT 'closed', json_object('label', 'Before there were cases', 'targeting', json(value),
  'opened', json_object('time', updated, 'user', 'app'), 'changed', json_object('time', updated, 'user', 'app'))
FROM settings WHERE key = 'targeting' AND json_valid(value);

DELETE FROM settings WHERE key IN ('targeting', 'targeting_last_set', 'targeting_changes');
)sql";

/** Every registration, entry and target that was set stays known, whatever becomes of its case. */
constexpr const char* version_4 = R"sql(
CREATE TABLE registrations (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  case_number INTEGER NOT NULL,
  epoch INTEGER NOT NULL,
  source TEXT NOT NULL DEFAULT '',
  pose TEXT NOT NULL
) STRICT;

INSERT INTO registrations (case_number, epoch, pose)
SELECT 0, 0, earlier.value FROM settings, json_each(settings.value) AS earlier WHERE settings.key = 'registrations_before';

INSERT INTO registrations (case_number, epoch, pose)
SELECT 0, 0, earlier.value FROM cases, json_each(cases.value, '$.targeting.registrations_before') AS earlier;

INSERT INTO registrations (case_number, epoch, pose)
SELECT number, coalesce(json_extract(value, '$.targeting.registration_epoch'), 0),
  json_extract(value, '$.targeting.registration')
FROM cases WHERE json_type(value, '$.targeting.registration') = 'array';

CREATE TABLE points (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  case_number INTEGER NOT NULL,
  is_former INTEGER NOT NULL DEFAULT 0,
  x REAL NOT NULL,
  y REAL NOT NULL,
  z REAL NOT NULL
) STRICT;

CREATE INDEX points_by_place ON points (x);

INSERT INTO points (case_number, x, y, z)
SELECT cases.number, json_extract(point.value, '$[0]'), json_extract(point.value, '$[1]'), json_extract(point.value, '$[2]')
FROM cases, json_each(cases.value, '$.targeting') AS point
WHERE point.key IN ('entry_point', 'target_point') AND point.type = 'array';

UPDATE cases SET value = json_remove(value, '$.targeting.registrations_before');

DELETE FROM settings WHERE key = 'registrations_before';
)sql";

/** Every motion, by the number of its proposal. */
constexpr const char* version_5 = R"sql(
CREATE TABLE runs (
  number INTEGER PRIMARY KEY,
  case_number INTEGER NOT NULL,
  kind TEXT NOT NULL,
  axes TEXT NOT NULL,
  outcome TEXT NOT NULL,
  begun TEXT NOT NULL,
  note TEXT NOT NULL DEFAULT '',
  value TEXT NOT NULL,
  samples BLOB NOT NULL
) STRICT;
)sql";

constexpr std::array scripts_of_all_versions{version_1, version_2, version_3, version_4, version_5};

int pragma(SQLite::Database& database, const char* name) {
  return database.execAndGet(std::string("PRAGMA ") + name).getInt();
}

bool is_empty(SQLite::Database& database) {
  return database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0;
}

/** The problem may quote what somebody wrote into the file. */
StoreError damaged(SQLite::Database& database, const std::string& problem) {
  return {StoreError::Kind::damaged, printable(database.getFilename() + ": " + problem), "", "",
          ways_out_of_damage};
}

/** Definitions by type and name: "table users", "trigger audit_has_no_gaps". */
using Definitions = std::map<std::string, std::string>;

/** Without white space, which differs between releases. SQLite's own statistics are left out. */
Definitions definitions_in(SQLite::Database& database) {
  Definitions definitions;
  SQLite::Statement select(
      database,
      "SELECT type || ' ' || name, coalesce(sql, '') FROM sqlite_schema WHERE name NOT GLOB 'sqlite_stat*'");
  while (select.executeStep()) {
    std::string sql = select.getColumn(1).getString();
    std::erase_if(sql, [](unsigned char c) { return std::isspace(c) != 0; });
    definitions.emplace(select.getColumn(0).getString(), std::move(sql));
  }
  return definitions;
}

/** What the scripts create in an empty database. */
Definitions definitions_of(std::span<const char* const> scripts) {
  SQLite::Database database(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  for (const char* const script : scripts) {
    database.exec(script);
  }
  return definitions_in(database);
}

/** The first definition that is missing, changed or added, among those whose key begins with `type`. */
std::optional<std::string> first_difference(const Definitions& expected, const Definitions& found,
                                            std::string_view type) {
  for (const auto& [key, sql] : expected) {
    const auto same_key = found.find(key);
    if (key.starts_with(type) && (same_key == found.end() || same_key->second != sql)) {
      return key + (same_key == found.end() ? " is missing" : " was changed");
    }
  }
  for (const auto& [key, sql] : found) {
    if (key.starts_with(type) && !expected.contains(key)) {
      return key + " does not belong there";
    }
  }
  return std::nullopt;
}

Stored<void> compare_definitions(SQLite::Database& database, std::span<const char* const> scripts,
                                 std::string_view type) {
  const int version = pragma(database, "user_version");
  if (version < 0 || version > static_cast<int>(scripts.size())) {
    return tl::unexpected(
        damaged(database, "has schema " + std::to_string(version) + ", which no release wrote"));
  }
  const auto difference = first_difference(definitions_of(scripts.first(static_cast<std::size_t>(version))),
                                           definitions_in(database), type);
  return difference ? tl::unexpected(damaged(database, "is not a sound store of schema " +
                                                           std::to_string(version) + ": " + *difference))
                    : Stored<void>();
}

}  // namespace

std::span<const char* const> migrations() { return scripts_of_all_versions; }

Stored<void> check_schema(SQLite::Database& database, std::span<const char* const> scripts) {
  // Of one moment: another process may be migrating the store.
  const SQLite::Transaction reading(database);
  const int version = pragma(database, "user_version");
  if (version > static_cast<int>(scripts.size())) {
    return tl::unexpected(StoreError{
        StoreError::Kind::newer, database.getFilename() + " has schema " + std::to_string(version), "",
        "at most " + std::to_string(scripts.size()), "install the release that wrote it, or a newer one"});
  }
  if (!is_empty(database) && pragma(database, "application_id") != store_application_id) {
    return tl::unexpected(damaged(database, "is an SQLite file, but no store of Interlock"));
  }
  return compare_definitions(database, scripts, "table ");
}

Stored<void> check_definitions(SQLite::Database& database) {
  return compare_definitions(database, migrations(), "");
}

Stored<void> check_store(SQLite::Database& database) {
  if (is_empty(database)) {
    return tl::unexpected(damaged(database, "is empty"));
  }
  return check_schema(database, migrations());
}

void migrate(SQLite::Database& database, const fs::path& file, std::span<const char* const> scripts) {
  if (pragma(database, "user_version") == static_cast<int>(scripts.size())) {
    return;
  }
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  // Another process may have done it while this one waited.
  const int version = pragma(database, "user_version");
  if (version > 0 && version < static_cast<int>(scripts.size())) {
    copy_before_migration(file, version);
  }
  for (std::size_t step = static_cast<std::size_t>(version); step < scripts.size(); ++step) {
    database.exec(scripts[step]);
  }
  database.exec("PRAGMA application_id = " + std::to_string(store_application_id));
  database.exec("PRAGMA user_version = " + std::to_string(scripts.size()));
  transaction.commit();
}

Stored<void> check_contents(SQLite::Database& database, PageCheck pages, NotedHeads heads) {
  const std::string found =
      database.execAndGet(pages == PageCheck::quick ? "PRAGMA quick_check(1)" : "PRAGMA integrity_check(1)")
          .getString();
  if (found != "ok") {
    return tl::unexpected(damaged(database, found));
  }
  SQLite::Statement references(database, "PRAGMA foreign_key_check");
  if (references.executeStep()) {
    return tl::unexpected(damaged(
        database, "table " + references.getColumn(0).getString() + " refers to something that is not there"));
  }
  if (const auto chain = verify_audit(database, std::nullopt, std::move(heads)); !chain) {
    return tl::unexpected(damaged(
        database, "audit record " + std::to_string(chain.error().number) + " " + chain.error().problem));
  }
  return check_definitions(database);
}

}  // namespace interlock
