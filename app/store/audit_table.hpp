/**
 * @file
 * The audit's table, read from any connection.
 */
#pragma once

#include <optional>
#include <string>

#include "store/audit_chain.hpp"
#include "store/noted_heads.hpp"
#include "store/sqlite_forward.hpp"

namespace interlock {

/** Columns of the table in the order that `audit_record` reads. */
constexpr const char* audit_columns = "number, time, tick, actor, session, kind, detail, hash";

/** The record in the statement's current row. */
AuditRecord audit_record(SQLite::Statement& row);

/** See `Audit::anchor`. Throws SQLite::Exception. */
AuditHead audit_anchor(SQLite::Database& database);

/** See `Audit::verify`. Throws SQLite::Exception. */
tl::expected<AuditHead, AuditBreak> verify_audit(SQLite::Database& database,
                                                 const std::optional<std::string>& noted,
                                                 NotedHeads heads = {});

}  // namespace interlock
