#include "store/store_backup.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <vector>

#include "store/audit.hpp"
#include "store/audit_table.hpp"
#include "store/schema.hpp"
#include "store/sessions.hpp"
#include "store/store_files.hpp"
#include "store/users.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;

/** Removes what is put beside a file while it is being made. */
void remove_beside(const fs::path& file) {
  std::vector<std::string> suffixes{"-wal", "-shm", "-journal", ".lock"};
  for (std::size_t version = 1; version < migrations().size(); ++version) {
    suffixes.push_back(".schema-" + std::to_string(version));
  }
  std::error_code ignored;
  for (const std::string& suffix : suffixes) {
    fs::remove(with_suffix(file, suffix), ignored);
  }
}

void remove_unfinished(const fs::path& file) {
  remove_beside(file);
  std::error_code ignored;
  fs::remove(file, ignored);
}

/** Has whatever is left of a file removed when the work on it ends, well or not. */
class Unfinished {
 public:
  explicit Unfinished(fs::path file) : file_(std::move(file)) {}
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  ~Unfinished() { remove_unfinished(file_); }

  [[nodiscard]] const fs::path& file() const { return file_; }

 private:
  fs::path file_;
};

/** Also a link to nothing. */
bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(file, ignored));
}

Stored<void> must_be_free(const fs::path& file) {
  if (is_there(file)) {
    return tl::unexpected(StoreError{StoreError::Kind::exists, file.string() + " is there already", "",
                                     "a name that is free", "choose another, or move that file away"});
  }
  return {};
}

Stored<void> must_exist(const fs::path& file, const std::string& what) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return tl::unexpected(StoreError{StoreError::Kind::unavailable,
                                     "there is no " + what + ' ' + file.string(), "",
                                     "a file that can be read", ""});
  }
  return {};
}

/** Copies a store to a private, empty file and checks the copy. */
Stored<StoreSummary> copy_checked(const fs::path& source, const fs::path& target) {
  try {
    {
      SQLite::Database database(source.string(), SQLite::OPEN_READWRITE, store_timeout_ms);
      if (const Stored<void> checked = check_store(database); !checked) {
        return tl::unexpected(checked.error());
      }
    }
    copy_store_into(source, target);
    SQLite::Database copy(target.string(), SQLite::OPEN_READWRITE, store_timeout_ms);
    return check_contents(copy, PageCheck::full).map([&] {
      const auto users = copy.execAndGet("SELECT count(*) FROM users").getInt64();
      return StoreSummary{static_cast<std::size_t>(users), verify_audit(copy, std::nullopt).value()};
    });
  } catch (const SQLite::Exception& error) {
    return tl::unexpected(database_error(source, error));
  }
}

Stored<void> rename_to_new(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) != 0) {
    return tl::unexpected(file_error(to, "cannot be made", errno));
  }
  return sync_folder(to.parent_path());
}

/** Puts the write-ahead log into the store's file. One that is damaged is left as it is. */
Stored<void> settle(const fs::path& store) {
  try {
    SQLite::Database database(store.string(), SQLite::OPEN_READWRITE, store_timeout_ms);
    database.exec("PRAGMA journal_mode = DELETE");
    return {};
  } catch (const SQLite::Exception& error) {
    StoreError failed = database_error(store, error);
    return failed.kind == StoreError::Kind::damaged ? Stored<void>() : tl::unexpected(std::move(failed));
  }
}

/** Gives the store a second name, and takes away what belongs to it alone. What is not a file is moved. */
Stored<void> keep_beside(const fs::path& store, const fs::path& kept) {
  if (is_no_regular_file(store)) {
    return ::rename(store.c_str(), kept.c_str()) == 0
               ? Stored<void>()
               : tl::unexpected(file_error(kept, "cannot be made", errno));
  }
  if (const Stored<void> settled = settle(store); !settled) {
    return settled;
  }
  if (::link(store.c_str(), kept.c_str()) != 0) {
    return tl::unexpected(file_error(kept, "cannot be made", errno));
  }
  for (const char* const part : {"-wal", "-shm", "-journal"}) {
    const fs::path file = with_suffix(store, part);
    if (::rename(file.c_str(), with_suffix(kept, part).c_str()) != 0 && errno != ENOENT) {
      return tl::unexpected(file_error(file, "cannot be moved", errno));
    }
  }
  return {};
}

/** The head of a store that is about to be replaced, null when it cannot be read any more. */
nlohmann::json head_of(const fs::path& file) {
  if (is_no_regular_file(file)) {
    return nullptr;
  }
  try {
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE, store_timeout_ms);
    SQLite::Statement head(database, "SELECT number, hash FROM audit ORDER BY number DESC LIMIT 1");
    return head.executeStep() ? nlohmann::json{{"number", head.getColumn(0).getInt64()},
                                               {"hash", head.getColumn(1).getString()}}
                              : nlohmann::json();
  } catch (const SQLite::Exception&) {
    return nullptr;
  }
}

/** Brings a copy up to date, records what it is for, and checks it as the next start will. */
Stored<AuditHead> prepare(const fs::path& copy, const nlohmann::json& detail, UtcTime now, NotedHeads heads) {
  Stored<Store> store = Store::open(copy);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const auto head = store->transact([&](Transaction& transaction) -> Stored<AuditHead> {
    for (const User& user : Users(transaction).list()) {
      Sessions(transaction).end_all_of_user(user.name);
    }
    const AuditRecord record =
        Audit(transaction)
            .append({now, std::nullopt, audit_actor::command_line, std::nullopt, AuditKind::restore, detail});
    return AuditHead{record.number, record.hash};
  });
  return head ? store->check(std::move(heads)).map([&] { return *head; }) : head;
}

/** Where the store that is replaced at that time goes. */
std::string name_suffix(UtcTime now) {
  std::string time = iso_8601(now);
  std::erase_if(time, [](char c) { return c == '-' || c == ':'; });
  return ".replaced-" + time;
}

/** With nothing in it but the record of why. */
Stored<Store> make_new(const fs::path& file, nlohmann::json detail, UtcTime now) {
  Stored<Store> store = Store::open(file, true);
  if (!store) {
    return store;
  }
  const auto recorded = store->transact([&](Transaction& transaction) -> Stored<void> {
    Audit(transaction)
        .append({now, std::nullopt, audit_actor::command_line, std::nullopt, AuditKind::restore,
                 std::move(detail)});
    return {};
  });
  return recorded ? std::move(store) : tl::unexpected(recorded.error());
}

}  // namespace

Stored<Store> begin_new_store(const fs::path& store, const StoreError& reason, UtcTime now) {
  {
    const auto lock = StoreLock::take(store, StoreLock::Kind::alone);
    if (!lock) {
      return tl::unexpected(lock.error());
    }
    if (is_there(store)) {
      if (const Stored<void> kept = keep_beside(store, with_suffix(store, name_suffix(now))); !kept) {
        return tl::unexpected(kept.error());
      }
      fs::remove(store);
    }
  }
  return make_new(store, {{"action", "new store"}, {"reason", reason.problem}}, now);
}

Stored<StoreSummary> backup_store(const fs::path& store, const fs::path& target) {
  const Stored<void> possible = must_exist(store, "store").and_then([&] { return must_be_free(target); });
  if (!possible) {
    return tl::unexpected(possible.error());
  }
  const auto lock = StoreLock::take(store, StoreLock::Kind::shared);
  if (!lock) {
    return tl::unexpected(lock.error());
  }
  const fs::path part = with_suffix(target, ".interlock-part");
  const auto held = UnfinishedFile::begin(part);
  if (!held) {
    return tl::unexpected(held.error());
  }
  const Unfinished unfinished(part);
  // A journal that a killed backup left would be played back into the copy.
  remove_beside(part);
  Stored<StoreSummary> summary = copy_checked(store, unfinished.file());
  if (!summary) {
    return summary;
  }
  const Stored<void> named = rename_to_new(unfinished.file(), target);
  return named ? summary : tl::unexpected(named.error());
}

Stored<Restored> restore_store(const fs::path& backup, const fs::path& store, UtcTime now, NotedHeads heads) {
  const Stored<void> there =
      must_exist(backup, "backup").and_then([&] { return make_private_folder(store.parent_path()); });
  if (!there) {
    return tl::unexpected(there.error());
  }
  const auto lock = StoreLock::take(store, StoreLock::Kind::alone);
  if (!lock) {
    return tl::unexpected(lock.error());
  }
  const Unfinished unfinished(with_suffix(store, ".restoring"));
  // One that was killed may have left something.
  remove_unfinished(unfinished.file());
  if (const Stored<void> made = make_private_file(unfinished.file()); !made) {
    return tl::unexpected(made.error());
  }
  Stored<StoreSummary> summary = copy_checked(backup, unfinished.file());
  if (!summary) {
    summary.error().next_step = "choose another backup";
    return tl::unexpected(summary.error());
  }
  Restored restored{*summary, std::nullopt};
  const bool replaces = is_there(store);
  const Stored<AuditHead> head =
      prepare(unfinished.file(),
              {{"action", "store"},
               {"backup", backup.filename().string()},
               {"backup_head", {{"number", summary->head.number}, {"hash", summary->head.hash}}},
               {"replaced_head", replaces ? head_of(store) : nlohmann::json()}},
              now, std::move(heads));
  if (!head) {
    StoreError refused = head.error();
    if (refused.kind == StoreError::Kind::damaged) {
      // Both names, as the copy's is gone.
      refused.problem = "a start would refuse the backup " + backup.string() + ": " + refused.problem;
      refused.next_step =
          "nothing was replaced; choose another backup, or begin anew, without its users, settings and "
          "audit, "
          "with --new-store";
    }
    return tl::unexpected(refused);
  }
  restored.summary.head = *head;
  if (replaces) {
    restored.replaced = with_suffix(store, name_suffix(now));
    if (const Stored<void> kept = keep_beside(store, *restored.replaced); !kept) {
      return tl::unexpected(kept.error());
    }
  }
  if (::rename(unfinished.file().c_str(), store.c_str()) != 0) {
    return tl::unexpected(file_error(store, "cannot be replaced", errno));
  }
  const Stored<void> synced = sync_folder(store.parent_path());
  return synced ? Stored<Restored>(std::move(restored)) : tl::unexpected(synced.error());
}

}  // namespace interlock
