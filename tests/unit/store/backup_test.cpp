#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <map>

#include "store/digest.hpp"
#include "store/sessions.hpp"
#include "store/settings.hpp"
#include "store/store_backup.hpp"
#include "store/store_files.hpp"
#include "store_fixture.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;
using Kind = StoreError::Kind;

class BackupTest : public StoreTest {
 protected:
  /** A store with one user, a session and `records` audit records. */
  void make_store(int records) {
    Store store = open();
    commit(store, [&](Transaction& transaction) {
      static_cast<void>(Users(transaction).add("ann", Role::admin, some_hash, noon).value());
      session_ = Sessions(transaction).create("ann", noon).value();
      append(transaction, records);
    });
  }

  static void append(Transaction& transaction, int records) {
    for (int number = 0; number < records; ++number) {
      Audit(transaction).append({});
    }
  }

  static std::int64_t records_of(const fs::path& file) {
    Store store = Store::open(file).value();
    return seen(store, [](Transaction& transaction) { return Audit(transaction).verify().value().number; });
  }

  /** Names of all files beside the store, with the SHA-256 of what is in them. */
  [[nodiscard]] std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      std::ifstream stream(entry.path(), std::ios::binary);
      files[entry.path().filename()] = sha256_hex(std::string(std::istreambuf_iterator<char>(stream), {}));
    }
    return files;
  }

  /** Restoring is refused for a reason of that kind and changes nothing. */
  void expect_restore_refused(Kind kind) const {
    const auto before = everything();
    const auto restored = restore_store(backup_, file_, noon);
    ASSERT_FALSE(restored);
    EXPECT_EQ(restored.error().kind, kind) << restored.error().message();
    EXPECT_EQ(everything(), before);
  }

  fs::path backup_ = folder_ / "backup.db";
  NewSession session_;
};

TEST_F(BackupTest, CopiesAStoreThatIsInUse) {
  make_store(3);
  Store app = open();
  commit(app, [](Transaction& transaction) { append(transaction, 2); });
  const auto summary = backup_store(file_, backup_);
  ASSERT_TRUE(summary) << summary.error().message();
  EXPECT_EQ(summary->users, 1u);
  EXPECT_EQ(summary->head.number, 5);
  commit(app, [](Transaction& transaction) { append(transaction, 1); });
  EXPECT_EQ(records_of(backup_), 5);
}

TEST_F(BackupTest, IsOnePrivateFile) {
  make_store(1);
  const auto before = everything();
  ASSERT_TRUE(backup_store(file_, backup_));
  EXPECT_EQ(everything().size(), before.size() + 1);
  EXPECT_EQ(fs::status(backup_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(BackupTest, OverwritesNothing) {
  make_store(1);
  std::ofstream(backup_) << "mine";
  const auto before = everything();
  EXPECT_EQ(backup_store(file_, backup_).error().kind, Kind::exists);
  EXPECT_EQ(everything(), before);
}

TEST_F(BackupTest, TakesOverWhatAKilledBackupLeft) {
  make_store(3);
  const auto before = everything();
  for (const char* const left : {"backup.db.interlock-part", "backup.db.interlock-part-journal"}) {
    std::ofstream(folder_ / left) << "half of a copy";
  }
  ASSERT_TRUE(backup_store(file_, backup_));
  EXPECT_EQ(records_of(backup_), 3);
  EXPECT_FALSE(fs::exists(folder_ / "backup.db.interlock-part"));
  EXPECT_FALSE(fs::exists(folder_ / "backup.db.interlock-part-journal"));
}

TEST_F(BackupTest, LeavesTheCopyToAnotherBackupThatIsMakingIt) {
  make_store(3);
  const auto other = UnfinishedFile::begin(backup_.string() + ".interlock-part");
  ASSERT_TRUE(other);
  const auto before = everything();
  EXPECT_EQ(backup_store(file_, backup_).error().kind, Kind::exists);
  EXPECT_EQ(everything(), before);
}

TEST_F(BackupTest, FollowsNoLinkToAFileOfSomebodyElse) {
  make_store(3);
  std::ofstream(folder_ / "precious") << "mine";
  fs::create_symlink(folder_ / "precious", folder_ / "backup.db.interlock-part");
  const auto before = everything();
  EXPECT_FALSE(backup_store(file_, backup_));
  EXPECT_EQ(everything(), before);
}

TEST_F(BackupTest, NeedsAStore) {
  EXPECT_EQ(backup_store(file_, backup_).error().kind, Kind::unavailable);
  EXPECT_TRUE(everything().empty());
}

TEST_F(BackupTest, RefusesAStoreWithABrokenChain) {
  make_store(3);
  execute("DROP TRIGGER audit_is_not_removed; DELETE FROM audit WHERE number = 2");
  const auto before = everything();
  EXPECT_EQ(backup_store(file_, backup_).error().kind, Kind::damaged);
  EXPECT_EQ(everything(), before);
}

TEST_F(BackupTest, RestoreBringsBackWhatWasAndKeepsWhatIs) {
  make_store(3);
  ASSERT_TRUE(backup_store(file_, backup_));
  {
    Store app = open();
    commit(app, [](Transaction& transaction) { append(transaction, 4); });
  }
  const auto restored = restore_store(backup_, file_, noon);
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(restored->replaced, fs::path(file_.string() + ".replaced-20240501T120000.000Z"));
  EXPECT_EQ(restored->summary.head.number, 4);
  EXPECT_EQ(records_of(file_), 4);
  EXPECT_EQ(records_of(*restored->replaced), 7);
  EXPECT_EQ(records_of(backup_), 3);
}

TEST_F(BackupTest, RestoreIsRecordedWithTheHeadThatItReplaced) {
  make_store(3);
  ASSERT_TRUE(backup_store(file_, backup_));
  ASSERT_TRUE(restore_store(backup_, file_, noon));
  Store store = open();
  const auto record = seen(store, [](Transaction& transaction) { return Audit(transaction).list(1); }).at(0);
  EXPECT_EQ(record.kind, "restore");
  EXPECT_EQ(record.actor, "command line");
  EXPECT_EQ(nlohmann::json::parse(record.detail).at("replaced_head").at("number"), 3);
}

TEST_F(BackupTest, RestoreLeavesNobodyLoggedIn) {
  make_store(1);
  ASSERT_TRUE(backup_store(file_, backup_));
  ASSERT_TRUE(restore_store(backup_, file_, noon));
  Store store = open();
  EXPECT_FALSE(seen(
      store, [&](Transaction& transaction) { return Sessions(transaction).find(session_.token, noon); }));
}

TEST_F(BackupTest, RestoreMakesAStoreWhereThereIsNone) {
  make_store(3);
  ASSERT_TRUE(backup_store(file_, backup_));
  const fs::path elsewhere = folder_ / "new" / "interlock.db";
  const auto restored = restore_store(backup_, elsewhere, noon);
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_FALSE(restored->replaced);
  EXPECT_EQ(records_of(elsewhere), 4);
}

TEST_F(BackupTest, RestoreReplacesADamagedStoreAndKeepsIt) {
  make_store(3);
  ASSERT_TRUE(backup_store(file_, backup_));
  const std::string damaged(8192, 'x');
  std::ofstream(file_, std::ios::trunc) << damaged;
  std::ofstream(file_.string() + "-wal") << "log";
  const auto restored = restore_store(backup_, file_, noon);
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(everything().at(restored->replaced->filename()), sha256_hex(damaged));
  EXPECT_EQ(records_of(file_), 4);
}

TEST_F(BackupTest, RestoreKeepsWhatAKilledProcessLeftInTheLog) {
  make_store(3);
  ASSERT_TRUE(backup_store(file_, backup_));
  const fs::path killed = folder_ / "killed";
  fs::create_directory(killed);
  {
    Store app = open();
    commit(app, [](Transaction& transaction) { append(transaction, 4); });
    fs::copy_file(file_, killed / "interlock.db");
    fs::copy_file(file_.string() + "-wal", killed / "interlock.db-wal");
  }
  const auto restored = restore_store(backup_, killed / "interlock.db", noon);
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_EQ(records_of(*restored->replaced), 7);
  EXPECT_EQ(records_of(killed / "interlock.db"), 4);
}

TEST_F(BackupTest, RestoreIsRefusedWhileAnybodyHasTheStoreOpen) {
  make_store(3);
  ASSERT_TRUE(backup_store(file_, backup_));
  const Store app = open();
  expect_restore_refused(Kind::unavailable);
}

TEST_F(BackupTest, RestoreOfAMissingBackupIsRefused) {
  make_store(3);
  expect_restore_refused(Kind::unavailable);
}

class BadBackup : public BackupTest, public testing::WithParamInterface<std::pair<const char*, Kind>> {};

TEST_P(BadBackup, IsRefused) {
  make_store(3);
  ASSERT_TRUE(backup_store(file_, backup_));
  SQLite::Database(backup_.string(), SQLite::OPEN_READWRITE).exec(GetParam().first);
  expect_restore_refused(GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(
    Restore, BadBackup,
    testing::Values(
        std::pair("PRAGMA user_version = 99", Kind::newer),
        std::pair("PRAGMA application_id = 1", Kind::damaged),
        std::pair("DROP TRIGGER audit_is_not_changed; UPDATE audit SET actor = 'eve' WHERE number = 2",
                  Kind::damaged),
        std::pair("PRAGMA foreign_keys = OFF; DELETE FROM users", Kind::damaged)));

TEST_F(BackupTest, RestoreOfATruncatedOrForeignFileIsRefused) {
  make_store(300);
  ASSERT_TRUE(backup_store(file_, backup_));
  for (const std::uintmax_t size :
       {fs::file_size(backup_) - 4096, std::uintmax_t{5000}, std::uintmax_t{50}, std::uintmax_t{0}}) {
    SCOPED_TRACE(size);
    fs::resize_file(backup_, size);
    expect_restore_refused(Kind::damaged);
  }
  std::ofstream(backup_, std::ios::trunc) << std::string(8192, 'x');
  expect_restore_refused(Kind::damaged);
}

}  // namespace
}  // namespace interlock
