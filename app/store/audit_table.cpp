#include "store/audit_table.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <utility>

#include "store/audit_check.hpp"

namespace interlock {
namespace {

std::optional<std::int64_t> optional_number(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getInt64());
}

}  // namespace

AuditHead audit_anchor(SQLite::Database& database) {
  // A backup of the first schema is looked at before it is migrated.
  if (!database.tableExists("audit_anchor")) {
    return {};
  }
  SQLite::Statement select(database, "SELECT number, hash FROM audit_anchor");
  return select.executeStep() ? AuditHead{select.getColumn(0).getInt64(), select.getColumn(1).getString()}
                              : AuditHead{};
}

AuditRecord audit_record(SQLite::Statement& row) {
  return {row.getColumn(0).getInt64(),  row.getColumn(1).getString(),      optional_number(row.getColumn(2)),
          row.getColumn(3).getString(), optional_number(row.getColumn(4)), row.getColumn(5).getString(),
          row.getColumn(6).getString(), row.getColumn(7).getString()};
}

tl::expected<AuditHead, AuditBreak> verify_audit(SQLite::Database& database,
                                                 const std::optional<std::string>& noted, NotedHeads heads) {
  constexpr std::size_t part = 1000;
  AuditCheck check(noted, std::move(heads));
  while (check.go_on(database, part)) {
  }
  return check.result();
}

}  // namespace interlock
