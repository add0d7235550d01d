#include "store/store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "store/audit_table.hpp"
#include "store/digest.hpp"
#include "store/schema.hpp"
#include "store/store_files.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;

/** SQLite waits for no lock when it changes the journal mode, so a process that opens the same new store at
 * the same moment makes it fail at once. */
void use_write_ahead_log(SQLite::Database& database) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(store_timeout_ms);
  for (;;) {
    try {
      database.exec("PRAGMA journal_mode = WAL");
      return;
    } catch (const SQLite::Exception& error) {
      if (error.getErrorCode() != SQLITE_BUSY || std::chrono::steady_clock::now() > deadline) {
        throw;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/** What the write-ahead log shrinks to once all of it is in the store and nobody reads it. */
constexpr const char* usual_log_bytes = "4194304";

/** Nothing was ever recorded in it, which a robot that has run has done. */
bool is_unused(SQLite::Database& database) {
  return !database.tableExists("audit") ||
         (database.execAndGet("SELECT count(*) FROM audit").getInt64() == 0 &&
          audit_anchor(database) == AuditHead{});
}

Stored<std::unique_ptr<SQLite::Database>> connect(const fs::path& file, bool begun_anew) {
  try {
    auto database =
        std::make_unique<SQLite::Database>(file.string(), SQLite::OPEN_READWRITE, store_timeout_ms);
    if (const Stored<void> checked = check_schema(*database, migrations()); !checked) {
      return tl::unexpected(checked.error());
    }
    if (!begun_anew && has_run_before(file.parent_path()) && is_unused(*database)) {
      return tl::unexpected(lost_store(file, "is empty"));
    }
    use_write_ahead_log(*database);
    database->exec(std::string("PRAGMA journal_size_limit = ") + usual_log_bytes);
    // FULL: a commit is on the disk before it is acknowledged, whatever happens to the machine.
    database->exec("PRAGMA synchronous = FULL");
    database->exec("PRAGMA foreign_keys = ON");
    migrate(*database, file, migrations());
    return database;
  } catch (const SQLite::Exception& error) {
    return tl::unexpected(database_error(file, error));
  }
}

}  // namespace

Transaction::Transaction(SQLite::Database& database, Kind kind) : database_(database) {
  database_.exec(kind == Kind::writing ? "BEGIN IMMEDIATE" : "BEGIN DEFERRED");
}

Transaction::~Transaction() {
  if (open_) {
    // Some failures have SQLite undo the transaction by itself; then there is nothing left to undo.
    database_.tryExec("ROLLBACK");
  }
}

void Transaction::commit() {
  database_.exec("COMMIT");
  open_ = false;
}

Stored<Store> Store::open(const fs::path& file, bool begun_anew) {
  if (is_no_regular_file(file)) {
    return tl::unexpected(StoreError{StoreError::Kind::damaged, file.string() + " is not a regular file", "",
                                     "", ways_out_of_damage});
  }
  std::error_code ignored;
  if (!begun_anew && !fs::exists(file, ignored) && has_run_before(file.parent_path())) {
    return tl::unexpected(lost_store(file, "is missing"));
  }
  if (const Stored<void> ready =
          start_sodium().and_then([&] { return make_private_folder(file.parent_path()); });
      !ready) {
    return tl::unexpected(ready.error());
  }
  auto lock = StoreLock::take(file, StoreLock::Kind::shared);
  if (!lock) {
    return tl::unexpected(lock.error());
  }
  if (const Stored<void> made = make_private_file(file);
      !made && made.error().kind != StoreError::Kind::exists) {
    return tl::unexpected(made.error());
  }
  auto database = connect(file, begun_anew);
  if (!database) {
    return tl::unexpected(database.error());
  }
  return Store(std::move(*lock), std::move(*database));
}

Store::Store(StoreLock lock, std::unique_ptr<SQLite::Database> database)
    : lock_(std::move(lock)), database_(std::move(database)) {}

Store::Store(Store&&) noexcept = default;

Store& Store::operator=(Store&& other) noexcept {
  // The connection goes before the lock that guards it.
  database_ = std::move(other.database_);
  lock_ = std::move(other.lock_);
  commit_check_ = std::move(other.commit_check_);
  return *this;
}

Store::~Store() = default;

fs::path Store::file() const { return database_->getFilename(); }

Stored<void> Store::check(NotedHeads heads) {
  return read([&](Transaction& transaction) {
    return check_contents(transaction.database(), PageCheck::quick, std::move(heads));
  });
}

/** SQLite empties the log by itself when nobody reads it, and that is when it is to be written anew. */
Stored<void> Store::bound_log() {
  const fs::path log = with_suffix(database_->getFilename(), "-wal");
  std::error_code none;
  const auto is_long = [&] {
    const std::uintmax_t bytes = fs::file_size(log, none);
    return !none && bytes >= longest_log_bytes;
  };
  if (!is_long()) {
    return {};
  }
  constexpr int short_timeout_ms = 100;
  database_->setBusyTimeout(short_timeout_ms);
  database_->tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
  database_->setBusyTimeout(store_timeout_ms);
  if (is_long()) {
    return tl::unexpected(StoreError{
        StoreError::Kind::unavailable,
        log.string() + " is " + std::to_string(longest_log_bytes >> 20) +
            " MiB long: a process that reads the store does not end, and keeps it from being emptied",
        "", "", "end what reads the store"});
  }
  return {};
}

/** What is committed to a file without a name is lost. */
Stored<void> Store::still_in_place() {
  int moved = 0;
  const int result = sqlite3_file_control(database_->getHandle(), "main", SQLITE_FCNTL_HAS_MOVED, &moved);
  if (result == SQLITE_OK && moved == 0) {
    return {};
  }
  return tl::unexpected(StoreError{
      StoreError::Kind::unavailable,
      database_->getFilename() + " was removed or replaced by another file while it was in use", "", "",
      "put the file back, or stop the robot, then put a backup in its place with `interlock store restore "
      "FILE`"});
}

StoreError Store::caught() const {
  try {
    throw;
  } catch (const SQLite::Exception& error) {
    return database_error(database_->getFilename(), error);
  }
}

}  // namespace interlock
