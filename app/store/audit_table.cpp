#include "store/audit_table.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

namespace interlock {
namespace {

std::optional<std::int64_t> optional_number(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getInt64());
}

}  // namespace

AuditRecord audit_record(SQLite::Statement& row) {
  return {row.getColumn(0).getInt64(),  row.getColumn(1).getString(),      optional_number(row.getColumn(2)),
          row.getColumn(3).getString(), optional_number(row.getColumn(4)), row.getColumn(5).getString(),
          row.getColumn(6).getString(), row.getColumn(7).getString()};
}

tl::expected<AuditHead, AuditBreak> verify_audit(SQLite::Database& database,
                                                 const std::optional<std::string>& noted) {
  SQLite::Statement records(database, std::string("SELECT ") + audit_columns + " FROM audit ORDER BY number");
  AuditChain chain;
  bool noted_found = !noted || *noted == chain.head().hash;
  while (records.executeStep()) {
    if (const auto followed = chain.follow(audit_record(records)); !followed) {
      return tl::unexpected(followed.error());
    }
    noted_found = noted_found || *noted == chain.head().hash;
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
