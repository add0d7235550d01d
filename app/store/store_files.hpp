/**
 * @file
 * The files around a store: its folder, its lock, its copies.
 */
#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "store/sqlite_forward.hpp"
#include "store/store_error.hpp"
#include "system/file_descriptor.hpp"

namespace interlock {

/** How long a connection waits for another one that writes, in milliseconds. */
constexpr int store_timeout_ms = 5000;

/** `FILE` and the suffix, in the same folder. */
std::filesystem::path with_suffix(std::filesystem::path file, const std::string& suffix);

/**
 * Holds `FILE.lock`: shared by all who have the store open, or alone, by whoever puts another file in its
 * place. The system lets go of it when the process ends, however it ends.
 */
class StoreLock {
 public:
  /** Whether others may hold it, too. */
  enum class Kind { shared, alone };

  /** Refused, unavailable: somebody holds it the other way. */
  static Stored<StoreLock> take(const std::filesystem::path& store, Kind kind);

 private:
  explicit StoreLock(FileDescriptor file) : file_(std::move(file)) {}

  FileDescriptor file_;
};

/** The two ways out of a store that is lost or damaged: what to do next, for people. */
constexpr const char* ways_out_of_damage =
    "put a backup in its place with `interlock store restore FILE`, or begin anew, without its users, "
    "settings "
    "and audit, with --new-store";

/** Whether the folder has logs with something in them: the robot has run there before. */
bool has_run_before(const std::filesystem::path& folder);

/** A store that is gone although the robot has run before. */
StoreError lost_store(const std::filesystem::path& file, const std::string& problem);

/** Makes the folder and those above it that are missing, each with mode 0700. */
Stored<void> make_private_folder(const std::filesystem::path& folder);

/** Whether something that is not a regular file has that name: a folder, a pipe, a link to nothing. */
bool is_no_regular_file(const std::filesystem::path& file);

/** Makes an empty file with mode 0600. Refused, exists: something of that name is there. */
Stored<void> make_private_file(const std::filesystem::path& file);

/**
 * A file that is being made under a name of its own, private and locked for as long as this lives. A process
 * that was killed over one leaves it behind, unlocked: the next one of that name takes it over.
 */
class UnfinishedFile {
 public:
  /** Refused, exists: another process is making it, or it is not ours to overwrite. */
  static Stored<UnfinishedFile> begin(const std::filesystem::path& file);

 private:
  explicit UnfinishedFile(FileDescriptor file) : file_(std::move(file)) {}

  FileDescriptor file_;
};

/** Makes sure that names given or taken in the folder are on the disk. */
Stored<void> sync_folder(const std::filesystem::path& folder);

/** Copies what is committed in a store to the new, private file `target`, while others may go on writing.
 * The copy is one file, without a write-ahead log. Throws SQLite::Exception. */
Stored<void> copy_store(const std::filesystem::path& source, const std::filesystem::path& target);

/** As `copy_store`, to an empty file that is there. */
void copy_store_into(const std::filesystem::path& source, const std::filesystem::path& target);

/** Copies a store to `FILE.schema-VERSION`, or `FILE.schema-VERSION.N` where earlier ones are. Throws
 * SQLite::Exception. */
void copy_before_migration(const std::filesystem::path& file, int version);

/** A failure of the system as a value. */
StoreError file_error(const std::filesystem::path& file, const std::string& what, int error_number);

/** A failure of SQLite as a value. */
StoreError database_error(const std::filesystem::path& file, const SQLite::Exception& error);

}  // namespace interlock
