#include "store/audit_table.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <nlohmann/json.hpp>

namespace interlock {
namespace {

std::optional<std::int64_t> optional_number(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getInt64());
}

/** Whether this record says that those up to the anchor were removed. */
bool accounts_for(const AuditRecord& record, const AuditHead& anchor) {
  const auto detail = nlohmann::json::parse(record.detail, nullptr, false);
  return record.kind == "retention" && detail.is_object() &&
         detail.value("removed_to", nlohmann::json()) == anchor.number &&
         detail.value("hash", nlohmann::json()) == anchor.hash;
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
                                                 const std::optional<std::string>& noted) {
  SQLite::Statement records(database, std::string("SELECT ") + audit_columns + " FROM audit ORDER BY number");
  const AuditHead anchor = audit_anchor(database);
  AuditChain chain(anchor);
  bool accounted = anchor == AuditHead{};
  bool noted_found = !noted || *noted == chain.head().hash;
  while (records.executeStep()) {
    const AuditRecord record = audit_record(records);
    if (const auto followed = chain.follow(record); !followed) {
      return tl::unexpected(followed.error());
    }
    accounted = accounted || accounts_for(record, anchor);
    noted_found = noted_found || *noted == chain.head().hash;
  }
  if (!accounted) {
    return tl::unexpected(
        AuditBreak{anchor.number, "and those before it are missing: no record says that they were retired"});
  }
  if (!noted_found) {
    return tl::unexpected(AuditBreak{
        chain.head().number + 1,
        "is missing, or an earlier one was written anew: the chain is sound up to "
        "record " +
            std::to_string(chain.head().number) + ", but none of its records has the hash " + *noted});
  }
  return chain.head();
}

}  // namespace interlock
