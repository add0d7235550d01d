#include "store/audit.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "store/audit_table.hpp"
#include "store/user_row.hpp"

namespace interlock {
namespace {

template <typename Number>
void bind_optional(SQLite::Statement& statement, int index, const std::optional<Number>& value) {
  if (value) {
    statement.bind(index, static_cast<std::int64_t>(*value));
  } else {
    statement.bind(index);
  }
}

/** "ann (1000)"; the number alone where it has no name. */
std::string os_user(uid_t uid) {
  passwd entry{};
  passwd* found = nullptr;
  std::array<char, 16384> buffer{};
  const std::string number = std::to_string(uid);
  const bool named = getpwuid_r(uid, &entry, buffer.data(), buffer.size(), &found) == 0 && found != nullptr;
  return named ? std::string(entry.pw_name) + " (" + number + ')' : number;
}

/** The user of this process, and the one who logged in at the system where that is another: behind sudo. */
void name_os_user(nlohmann::json& detail) {
  detail["os_user"] = os_user(getuid());
  std::uint32_t login = 0;
  constexpr std::uint32_t nobody_logged_in = 0xffffffff;
  if (std::ifstream("/proc/self/loginuid") >> login && login != nobody_logged_in && login != getuid()) {
    detail["login_user"] = os_user(login);
  }
}

/** Of a statement that gives the newest first. */
std::vector<AuditRecord> oldest_first(SQLite::Statement& select) {
  std::vector<AuditRecord> records;
  while (select.executeStep()) {
    records.push_back(audit_record(select));
  }
  std::reverse(records.begin(), records.end());
  return records;
}

/** What only the store or the system knows of a record. */
nlohmann::json completed(SQLite::Database& database, const AuditEntry& entry) {
  nlohmann::json detail = entry.detail;
  if (entry.kind == AuditKind::user && detail.contains("name")) {
    detail["digest"] = user_digests(database)[detail["name"].get<std::string>()];
  }
  if (entry.actor == audit_actor::command_line) {
    name_os_user(detail);
  }
  return detail;
}

}  // namespace

std::string_view audit_kind_name(AuditKind kind) {
  switch (kind) {
    case AuditKind::start:
      return "start";
    case AuditKind::login:
      return "login";
    case AuditKind::login_refused:
      return "login_refused";
    case AuditKind::logout:
      return "logout";
    case AuditKind::session_ended:
      return "session_ended";
    case AuditKind::user:
      return "user";
    case AuditKind::control:
      return "control";
    case AuditKind::proposal:
      return "proposal";
    case AuditKind::request:
      return "request";
    case AuditKind::verdict:
      return "verdict";
    case AuditKind::stop:
      return "stop";
    case AuditKind::setting:
      return "setting";
    case AuditKind::restore:
      return "restore";
    case AuditKind::bench:
      return "bench";
    case AuditKind::connection:
      return "connection";
    case AuditKind::records_lost:
      return "records_lost";
    case AuditKind::retention:
      return "retention";
    case AuditKind::acknowledgement:
      return "acknowledgement";
    case AuditKind::case_step:
      return "case";
    case AuditKind::alarm:
      return "alarm";
  }
  return "unknown";
}

AuditRecord Audit::append(const AuditEntry& entry) {
  const AuditHead last = head();
  AuditRecord record{
      last.number + 1, iso_8601(entry.time), entry.tick, entry.actor, entry.session,
      std::string(audit_kind_name(entry.kind)),
      // What a stranger sent need not be UTF-8, and is recorded all the same.
      completed(database_, entry).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), ""};
  record.hash = audit_hash(record, last.hash);
  SQLite::Statement insert(
      database_, std::string("INSERT INTO audit (") + audit_columns + ") VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, record.number);
  insert.bind(2, record.time);
  bind_optional(insert, 3, record.tick);
  insert.bind(4, record.actor);
  bind_optional(insert, 5, record.session);
  insert.bind(6, record.kind);
  insert.bind(7, record.detail);
  insert.bind(8, record.hash);
  insert.exec();
  return record;
}

std::vector<AuditRecord> Audit::list(std::size_t count, const AuditFilter& filter) const {
  SQLite::Statement select(
      database_,
      std::string("SELECT ") + audit_columns +
          " FROM audit WHERE (?1 IS NULL OR number < ?1) AND (?2 IS NULL OR kind = ?2) AND (?3 IS NULL "
          "OR actor = ?3) AND (?4 IS NULL OR instr(lower(detail), lower(?4))) AND (?5 IS NULL OR time >= "
          "?5) ORDER BY number DESC LIMIT ?6");
  // What is not bound is NULL.
  const auto bind = [&](int place, const auto& value) {
    if (value) {
      select.bind(place, *value);
    }
  };
  bind(1, filter.before);
  bind(2, filter.kind);
  bind(3, filter.actor);
  bind(4, filter.text);
  bind(5, filter.since ? std::optional(iso_8601(*filter.since)) : std::nullopt);
  select.bind(6, static_cast<std::int64_t>(count));
  return oldest_first(select);
}

std::vector<AuditRecord> Audit::between(std::int64_t first, std::int64_t last,
                                        std::initializer_list<AuditKind> kinds, std::size_t count) const {
  std::string names;
  for (const AuditKind kind : kinds) {
    names += (names.empty() ? "'" : ", '") + std::string(audit_kind_name(kind)) + "'";
  }
  SQLite::Statement select(database_, std::string("SELECT ") + audit_columns +
                                          " FROM audit WHERE number BETWEEN ? AND ? AND kind IN (" + names +
                                          ") ORDER BY number DESC LIMIT ?");
  select.bind(1, first);
  select.bind(2, last);
  select.bind(3, static_cast<std::int64_t>(count));
  return oldest_first(select);
}

std::int64_t Audit::newest_of(AuditKind kind) const {
  SQLite::Statement select(database_, "SELECT number FROM audit WHERE kind = ? ORDER BY number DESC LIMIT 1");
  select.bind(1, std::string(audit_kind_name(kind)));
  return select.executeStep() ? select.getColumn(0).getInt64() : 0;
}

AuditHead Audit::head() const {
  SQLite::Statement select(database_, "SELECT number, hash FROM audit ORDER BY number DESC LIMIT 1");
  return select.executeStep() ? AuditHead{select.getColumn(0).getInt64(), select.getColumn(1).getString()}
                              : AuditHead{};
}

std::vector<AuditRecord> Audit::before_last_days(int days) const {
  SQLite::Statement select(
      database_, std::string("SELECT ") + audit_columns +
                     " FROM audit WHERE number < (SELECT coalesce(min(number), 1 + (SELECT max(number) "
                     "FROM audit)) FROM audit WHERE substr(time, 1, 10) IN (SELECT substr(time, 1, 10) FROM "
                     "audit GROUP BY 1 ORDER BY max(number) DESC LIMIT ?)) ORDER BY number");
  select.bind(1, days);
  std::vector<AuditRecord> records;
  while (select.executeStep()) {
    records.push_back(audit_record(select));
  }
  return records;
}

AuditHead Audit::anchor() const { return audit_anchor(database_); }

AuditRecord Audit::retire(const AuditHead& last, AuditEntry entry) {
  entry.kind = AuditKind::retention;
  entry.detail["removed_to"] = last.number;
  entry.detail["hash"] = last.hash;
  entry.detail["users"] = user_digests(database_);
  AuditRecord record = append(entry);
  SQLite::Statement move(
      database_,
      "INSERT INTO audit_anchor VALUES (1, ?1, ?2) ON CONFLICT (one) DO UPDATE SET number = ?1, "
      "hash = ?2");
  move.bind(1, last.number);
  move.bind(2, last.hash);
  move.exec();
  SQLite::Statement remove(database_, "DELETE FROM audit WHERE number <= ?");
  remove.bind(1, last.number);
  remove.exec();
  return record;
}

tl::expected<AuditHead, AuditBreak> Audit::verify(const std::optional<std::string>& noted) const {
  return verify_audit(database_, noted);
}

}  // namespace interlock
