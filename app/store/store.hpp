/**
 * @file
 * The store of one robot: users, sessions, settings, cases and the audit, in one SQLite file.
 *
 * Everything that is read or written passes through a transaction:
 *
 *     store.transact([&](Transaction& transaction) -> Stored<void> {
 *       Settings(transaction).set("log_level", "debug", now);
 *       Audit(transaction).append(...);
 *       return {};
 *     });
 *
 * `Users`, `Sessions`, `Settings`, `Cases` and `Audit` are views of a transaction and live no longer than it
 * does. They return refusals as values; failures of SQLite pass through them as exceptions, which `transact`
 * and `read` turn into a `StoreError`.
 */
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "store/noted_heads.hpp"
#include "store/sqlite_forward.hpp"
#include "store/store_error.hpp"
#include "store/store_files.hpp"
#include "system/utc_time.hpp"

namespace interlock {

/** Beyond this much write-ahead log, which only a reader that does not end can keep, nothing is written. */
constexpr std::uintmax_t longest_log_bytes = std::uintmax_t{64} << 20;

/** Name of the file in the state directory of a robot. */
constexpr const char* store_file_name = "interlock.db";

/** Everything between BEGIN and COMMIT or ROLLBACK. What was not committed is undone when it goes. */
class Transaction {
 public:
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();

  /** For the views of this folder. */
  [[nodiscard]] SQLite::Database& database() const { return database_; }

 private:
  friend class Store;

  enum class Kind { reading, writing };

  Transaction(SQLite::Database& database, Kind kind);
  void commit();

  SQLite::Database& database_;
  bool open_ = true;
};

/** One connection to the file, for use by one thread at a time. Other processes may have it open, too. */
class Store {
 public:
  /**
   * Opens the store, made if missing: folders that are missing with mode 0700, the file with 0600.
   *
   * A file of an older schema is copied beside itself as `FILE.schema-N`, then migrated in one transaction.
   * Refused, without a change to the file: a newer schema, a file that is no store, one that `restore` has in
   * hand, and, unless it is `begun_anew`, one that is missing or empty beside the logs of an earlier run.
   */
  static Stored<Store> open(const std::filesystem::path& file, bool begun_anew = false);

  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;
  ~Store();

  /**
   * Runs `work(Transaction&)`, which returns a `Stored<...>`, as the only writer of the file.
   *
   * A value: all of it is on the disk when this returns. An error, of `work` or of the file: nothing of it
   * is. Refused, unavailable, too: a reader that does not end keeps `longest_log_bytes` of the write-ahead
   * log, or the file was removed or replaced by another one since it was opened.
   */
  template <std::invocable<Transaction&> Work>
  auto transact(Work&& work) -> std::invoke_result_t<Work, Transaction&> {
    try {
      if (const Stored<void> room = bound_log(); !room) {
        return tl::unexpected(room.error());
      }
      Transaction transaction(*database_, Transaction::Kind::writing);
      auto result = std::forward<Work>(work)(transaction);
      if (result) {
        if (const Stored<void> allowed = still_in_place().and_then(commit_check_); !allowed) {
          return tl::unexpected(allowed.error());
        }
        transaction.commit();
      }
      return result;
    } catch (...) {
      return tl::unexpected(caught());
    }
  }

  /** The file. */
  [[nodiscard]] std::filesystem::path file() const;

  /** Refused, damaged: pages, references or the audit are not sound, or a head that was noted is not in it.
   * For a start: it goes over the whole audit, some 100,000 records a second. */
  Stored<void> check(NotedHeads heads);

  /** Asked right before a transaction is committed; an error undoes it and is what `transact` returns. */
  using CommitCheck = std::function<Stored<void>()>;

  /** Has `check` asked from now on, in the place of the one before. */
  void check_commits(CommitCheck check) { commit_check_ = std::move(check); }

  /** Commits whatever is to be committed. */
  static Stored<void> commit_always() { return {}; }

  /** Runs `work(Transaction&)` on one consistent state of the file, beside a writer. What it writes is not
   * kept. */
  template <std::invocable<Transaction&> Work>
  auto read(Work&& work) -> std::invoke_result_t<Work, Transaction&> {
    try {
      Transaction transaction(*database_, Transaction::Kind::reading);
      return std::forward<Work>(work)(transaction);
    } catch (...) {
      return tl::unexpected(caught());
    }
  }

 private:
  Store(StoreLock lock, std::unique_ptr<SQLite::Database> database);

  /** Refused, unavailable: the file of that name is not the one that is open. */
  Stored<void> still_in_place();

  /** Empties the write-ahead log when it is too long. */
  Stored<void> bound_log();

  /** The exception in flight as a value if it is one of SQLite; any other flies on. */
  [[nodiscard]] StoreError caught() const;

  StoreLock lock_;
  std::unique_ptr<SQLite::Database> database_;
  CommitCheck commit_check_ = commit_always;
};

}  // namespace interlock
