/**
 * @file
 * The tables of the store, and how an older file gets them.
 */
#pragma once

#include <filesystem>
#include <span>

#include "store/noted_heads.hpp"
#include "store/sqlite_forward.hpp"
#include "store/store_error.hpp"

namespace interlock {

/** What `PRAGMA application_id` of a store says: "ILKS". */
constexpr int store_application_id = 0x494c4b53;

/** One script for each version of the schema: script N brings a store of version N to N + 1. None is ever
 * changed. */
std::span<const char* const> migrations();

/** Refused: a file that is neither empty nor a store, or whose tables are not those that the scripts create
 * for its version (damaged); a newer version than `scripts` create (newer). */
Stored<void> check_schema(SQLite::Database& database, std::span<const char* const> scripts);

/** As `check_schema` of this release; an empty file is refused, too. */
Stored<void> check_store(SQLite::Database& database);

/** Refused, damaged: tables, indexes or triggers are not those that this release creates for the version of
 * the store. Not part of `check_store`, so that `audit verify` can still name a record that was changed
 * behind a trigger that was dropped. Throws SQLite::Exception. */
Stored<void> check_definitions(SQLite::Database& database);

/**
 * Brings a store to the newest version, in one transaction. A store that is not empty is copied beside `file`
 * before.
 *
 * Throws SQLite::Exception; the store is then as it was.
 */
void migrate(SQLite::Database& database, const std::filesystem::path& file,
             std::span<const char* const> scripts);

/** How well `check_contents` looks at the pages. */
enum class PageCheck {
  quick, /**< not whether indexes and tables agree */
  full
};

/** Refused, damaged: pages, references, the audit, or tables, indexes and triggers are not sound. `heads` are
 * as in `AuditCheck`. Throws SQLite::Exception. */
Stored<void> check_contents(SQLite::Database& database, PageCheck pages, NotedHeads heads = {});

}  // namespace interlock
