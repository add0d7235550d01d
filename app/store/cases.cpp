#include "store/cases.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <string>

namespace interlock {
namespace {

constexpr std::array<std::string_view, 3> state_names{"open", "suspended", "closed"};
constexpr const char* columns = "SELECT number, state, value FROM cases ";

std::string text_of(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json json_of(const std::string& text, const std::string& owner) {
  nlohmann::json value = nlohmann::json::parse(text, nullptr, false);
  if (!value.is_object()) {
    throw SQLite::Exception(owner + " holds no JSON object", SQLITE_CORRUPT);
  }
  return value;
}

/** The case in the statement's current row. */
KeptCase kept_case(SQLite::Statement& row) {
  const std::int64_t number = row.getColumn(0).getInt64();
  const auto state = std::ranges::find(state_names, row.getColumn(1).getString());
  return {number, static_cast<CaseState>(state - state_names.begin()),
          json_of(row.getColumn(2).getString(), "case " + std::to_string(number))};
}

std::optional<KeptCase> first_of(SQLite::Statement& rows) {
  return rows.executeStep() ? std::optional(kept_case(rows)) : std::nullopt;
}

constexpr const char* is_near =
    "x BETWEEN ?1 - 0.1 AND ?1 + 0.1 AND y BETWEEN ?2 - 0.1 AND ?2 + 0.1 AND z BETWEEN ?3 - 0.1 AND ?3 + 0.1";

void bind(SQLite::Statement& statement, const std::array<double, 3>& point) {
  for (int place = 0; place < 3; ++place) {
    statement.bind(place + 1, point[static_cast<std::size_t>(place)]);
  }
}

}  // namespace

std::string_view case_state_name(CaseState state) { return state_names[static_cast<std::size_t>(state)]; }

std::optional<KeptCase> Cases::in_hand() const {
  SQLite::Statement select(database_, std::string(columns) + "WHERE state <> 'closed'");
  return first_of(select);
}

std::optional<KeptCase> Cases::find(std::int64_t number) const {
  SQLite::Statement select(database_, std::string(columns) + "WHERE number = ?");
  select.bind(1, number);
  return first_of(select);
}

std::vector<KeptCase> Cases::list(std::size_t count) const {
  SQLite::Statement select(database_, std::string(columns) + "ORDER BY number DESC LIMIT ?");
  select.bind(1, static_cast<std::int64_t>(count));
  std::vector<KeptCase> cases;
  while (select.executeStep()) {
    cases.push_back(kept_case(select));
  }
  return cases;
}

std::int64_t Cases::add(const nlohmann::json& value) {
  SQLite::Statement insert(database_, "INSERT INTO cases (state, value) VALUES ('open', ?)");
  insert.bind(1, text_of(value));
  insert.exec();
  return database_.getLastInsertRowid();
}

void Cases::change(const KeptCase& changed) {
  SQLite::Statement update(database_, "UPDATE cases SET state = ?, value = ? WHERE number = ?");
  update.bind(1, std::string(case_state_name(changed.state)));
  update.bind(2, text_of(changed.value));
  update.bind(3, changed.number);
  update.exec();
}

void Cases::remove(std::int64_t number) {
  for (const char* const statement :
       {"DELETE FROM case_changes WHERE case_number = ?", "UPDATE runs SET note = '' WHERE case_number = ?",
        "DELETE FROM cases WHERE number = ?"}) {
    SQLite::Statement remove(database_, statement);
    remove.bind(1, number);
    remove.exec();
  }
}

void Cases::note(std::int64_t number, std::int64_t record, const nlohmann::json& change) {
  SQLite::Statement insert(database_,
                           "INSERT INTO case_changes (record, case_number, value) VALUES (?, ?, ?)");
  insert.bind(1, record);
  insert.bind(2, number);
  insert.bind(3, text_of(change));
  insert.exec();
}

nlohmann::json Cases::changes(std::int64_t number, std::size_t count) const {
  SQLite::Statement select(
      database_, "SELECT value FROM case_changes WHERE case_number = ? ORDER BY record DESC LIMIT ?");
  select.bind(1, number);
  select.bind(2, static_cast<std::int64_t>(count));
  nlohmann::json found = nlohmann::json::array();
  while (select.executeStep()) {
    found.push_back(json_of(select.getColumn(0).getString(), "a change of a case"));
  }
  return found;
}

void Registrations::add(const KeptRegistration& set) {
  SQLite::Statement insert(
      database_, "INSERT INTO registrations (case_number, epoch, source, pose) VALUES (?, ?, ?, ?)");
  insert.bind(1, set.case_number);
  insert.bind(2, set.epoch);
  insert.bind(3, set.source);
  insert.bind(4, text_of(set.pose));
  insert.exec();
  SQLite::Statement forget(database_, "DELETE FROM registrations WHERE number <= ?");
  forget.bind(1, database_.getLastInsertRowid() - most);
  forget.exec();
}

void Points::add(std::int64_t case_number, const std::array<double, 3>& point) {
  SQLite::Statement replace(database_, std::string("DELETE FROM points WHERE ") + is_near);
  bind(replace, point);
  replace.exec();
  SQLite::Statement insert(database_, "INSERT INTO points (x, y, z, case_number) VALUES (?, ?, ?, ?)");
  bind(insert, point);
  insert.bind(4, case_number);
  insert.exec();
  SQLite::Statement forget(database_, "DELETE FROM points WHERE number <= ?");
  forget.bind(1, database_.getLastInsertRowid() - most);
  forget.exec();
}

void Points::leave(std::int64_t case_number) {
  SQLite::Statement update(database_, "UPDATE points SET is_former = 1 WHERE case_number = ?");
  update.bind(1, case_number);
  update.exec();
}

bool Points::is_former(std::int64_t case_number, const std::array<double, 3>& point) const {
  SQLite::Statement select(database_, std::string("SELECT 1 FROM points WHERE ") + is_near +
                                          " AND (is_former OR case_number <> ?4)");
  bind(select, point);
  select.bind(4, case_number);
  return select.executeStep();
}

std::vector<KeptRegistration> Registrations::newest_first() const {
  SQLite::Statement select(database_,
                           "SELECT case_number, epoch, source, pose FROM registrations ORDER BY number DESC");
  std::vector<KeptRegistration> all;
  while (select.executeStep()) {
    KeptRegistration& each = all.emplace_back();
    each.case_number = select.getColumn(0).getInt64();
    each.epoch = select.getColumn(1).getInt64();
    each.source = select.getColumn(2).getString();
    const auto pose = nlohmann::json::parse(select.getColumn(3).getString(), nullptr, false);
    if (!pose.is_array() || pose.size() != each.pose.size()) {
      throw SQLite::Exception("a registration holds no 16 numbers", SQLITE_CORRUPT);
    }
    pose.get_to(each.pose);
  }
  return all;
}

}  // namespace interlock
