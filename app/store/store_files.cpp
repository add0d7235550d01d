#include "store/store_files.hpp"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>

#include "system/printable.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;

constexpr mode_t private_folder_mode = 0700;
constexpr mode_t private_file_mode = 0600;

}  // namespace

fs::path with_suffix(fs::path file, const std::string& suffix) { return file += suffix; }

Stored<StoreLock> StoreLock::take(const fs::path& store, Kind kind) {
  const fs::path file = with_suffix(store, ".lock");
  FileDescriptor lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, private_file_mode));
  if (!lock) {
    return tl::unexpected(file_error(file, "cannot be opened", errno));
  }
  if (::flock(lock.get(), (kind == Kind::shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0) {
    return tl::unexpected(StoreError{
        StoreError::Kind::unavailable,
        store.string() + (kind == Kind::shared ? " is being restored" : " is in use by another process"), "",
        "", kind == Kind::shared ? "try again in a moment" : "stop what uses it, then try again"});
  }
  return StoreLock(std::move(lock));
}

bool has_run_before(const fs::path& folder) {
  std::error_code error;
  const fs::directory_iterator logs(folder / "log", error);
  return !error && std::any_of(begin(logs), end(logs), [](const fs::directory_entry& log) {
    std::error_code ignored;
    return log.is_regular_file(ignored) && log.file_size(ignored) > 0;
  });
}

StoreError lost_store(const fs::path& file, const std::string& problem) {
  return {StoreError::Kind::damaged,
          file.string() + ' ' + problem + ", but " + (file.parent_path() / "log").string() +
              " shows that this robot has run before",
          "", "", ways_out_of_damage};
}

bool is_no_regular_file(const fs::path& file) {
  std::error_code ignored;
  switch (fs::status(file, ignored).type()) {
    case fs::file_type::not_found:
      return fs::exists(fs::symlink_status(file, ignored));
    case fs::file_type::regular:
    case fs::file_type::none:
    case fs::file_type::unknown:
      return false;
    default:
      return true;
  }
}

Stored<void> make_private_folder(const fs::path& folder) {
  std::error_code ignored;
  if (folder.empty() || fs::is_directory(folder, ignored)) {
    return {};
  }
  if (folder.has_parent_path() && folder.parent_path() != folder) {
    if (const Stored<void> parent = make_private_folder(folder.parent_path()); !parent) {
      return parent;
    }
  }
  if (::mkdir(folder.c_str(), private_folder_mode) != 0 && errno != EEXIST) {
    return tl::unexpected(file_error(folder, "cannot be made", errno));
  }
  return {};
}

Stored<void> make_private_file(const fs::path& file) {
  if (FileDescriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, private_file_mode))) {
    return {};
  }
  if (errno == EEXIST) {
    return tl::unexpected(StoreError{StoreError::Kind::exists, file.string() + " is there already", "",
                                     "a name that is free", "choose another, or move that file away"});
  }
  return tl::unexpected(file_error(file, "cannot be made", errno));
}

Stored<UnfinishedFile> UnfinishedFile::begin(const fs::path& file) {
  FileDescriptor made(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, private_file_mode));
  if (!made) {
    return tl::unexpected(file_error(file, "cannot be made", errno));
  }
  const int fd = made.get();
  const bool alone = ::flock(fd, LOCK_EX | LOCK_NB) == 0;
  struct stat locked{};
  struct stat named{};
  const bool same = ::fstat(fd, &locked) == 0 && ::stat(file.c_str(), &named) == 0 &&
                    locked.st_ino == named.st_ino && locked.st_dev == named.st_dev;
  if (!alone || !same) {
    return tl::unexpected(StoreError{StoreError::Kind::exists,
                                     file.string() + " is being written by another process", "", "",
                                     "try again when that has ended"});
  }
  if (!S_ISREG(locked.st_mode) || locked.st_uid != ::geteuid()) {
    return tl::unexpected(StoreError{StoreError::Kind::exists, file.string() + " is somebody else's", "",
                                     "a name that is free", "choose another, or move that file away"});
  }
  if (::fchmod(fd, private_file_mode) != 0 || ::ftruncate(fd, 0) != 0) {
    return tl::unexpected(file_error(file, "cannot be made", errno));
  }
  return UnfinishedFile(std::move(made));
}

Stored<void> sync_folder(const fs::path& folder) {
  const fs::path named = folder.empty() ? fs::path(".") : folder;
  const FileDescriptor opened(::open(named.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const bool synced = opened && ::fsync(opened.get()) == 0;
  return synced ? Stored<void>() : tl::unexpected(file_error(named, "cannot be written", errno));
}

Stored<void> copy_store(const fs::path& source, const fs::path& target) {
  if (const Stored<void> made = make_private_file(target); !made) {
    return made;
  }
  copy_store_into(source, target);
  return {};
}

void copy_store_into(const fs::path& source, const fs::path& target) {
  SQLite::Database from(source.string(), SQLite::OPEN_READWRITE, store_timeout_ms);
  SQLite::Database to(target.string(), SQLite::OPEN_READWRITE, store_timeout_ms);
  SQLite::Backup copy(to, from);
  // All pages in one step, so that the copy is of one moment.
  if (copy.executeStep(-1) != SQLITE_DONE) {
    throw SQLite::Exception("the store stayed busy", SQLITE_BUSY);
  }
  to.exec("PRAGMA journal_mode = DELETE");
}

void copy_before_migration(const fs::path& file, int version) {
  const fs::path first = with_suffix(file, ".schema-" + std::to_string(version));
  fs::path copy = first;
  for (int number = 2; fs::exists(copy); ++number) {
    copy = with_suffix(first, "." + std::to_string(number));
  }
  if (const Stored<void> copied = copy_store(file, copy); !copied) {
    throw SQLite::Exception(copied.error().message(), SQLITE_CANTOPEN);
  }
}

StoreError file_error(const fs::path& file, const std::string& what, int error_number) {
  return {StoreError::Kind::unavailable,
          file.string() + " " + what + ": " + std::generic_category().message(error_number), "", "",
          error_number == ENOSPC ? "free some space" : "see that this user may write there"};
}

StoreError database_error(const fs::path& file, const SQLite::Exception& error) {
  StoreError stored{StoreError::Kind::unavailable, file.string() + ": " + printable(error.what()), "", "",
                    "see that this user may write there, and that the disk is sound"};
  switch (error.getErrorCode() & 0xff) {
    case SQLITE_FULL:
      stored.next_step = "free some space";
      break;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      stored.next_step = "another process is writing; try again in a moment";
      break;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      stored.kind = StoreError::Kind::damaged;
      stored.next_step = ways_out_of_damage;
      break;
    default:
      break;
  }
  return stored;
}

}  // namespace interlock
