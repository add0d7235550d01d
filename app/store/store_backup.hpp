/**
 * @file
 * Copies of a store, and the way back from one.
 */
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "store/audit_chain.hpp"
#include "store/store.hpp"

namespace interlock {

/** What a sound store holds. */
struct StoreSummary {
  std::size_t users = 0;
  AuditHead head;
};

/** What a restore brought back. */
struct Restored {
  StoreSummary summary;
  std::optional<std::filesystem::path> replaced; /**< where the store is that was there before */
};

/**
 * Copies a store, of one moment while others go on writing, to the new file `target`, and checks the copy:
 * pages, references, the chain of the audit. The file appears whole or not at all.
 *
 * Refused: not_found (no store), exists (`target`), damaged, newer, unavailable.
 */
Stored<StoreSummary> backup_store(const std::filesystem::path& store, const std::filesystem::path& target);

/**
 * Puts a checked copy of `backup` in the place of the store, with an audit record of it and without sessions.
 *
 * The store that is there is kept beside as `FILE.replaced-TIME`, be it sound or not. Until the new one is
 * whole, checked and on the disk, the old one stays in its place. Refused: not_found (no backup), damaged or
 * newer (the backup), unavailable (somebody has the store open). Damaged, too: a start that compares it with
 * `heads`, which the recorder noted, would refuse it.
 */
Stored<Restored> restore_store(const std::filesystem::path& backup, const std::filesystem::path& store,
                               UtcTime now, NotedHeads heads = {});

/**
 * Begins a new store, without users, in the place of one that is missing or damaged for `reason`, with an
 * audit record of that. What is there is kept beside as `FILE.replaced-TIME`.
 *
 * Refused, unavailable: somebody has the store open.
 */
Stored<Store> begin_new_store(const std::filesystem::path& store, const StoreError& reason, UtcTime now);

}  // namespace interlock
