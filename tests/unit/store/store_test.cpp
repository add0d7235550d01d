#include "store/store.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "store/first_admin.hpp"
#include "store/settings.hpp"
#include "store/store_backup.hpp"
#include "store_fixture.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

fs::perms mode_of(const fs::path& path) { return fs::status(path).permissions(); }

TEST_F(StoreTest, OpeningMakesPrivateFoldersAndFiles) {
  file_ = folder_ / "a" / "b" / "interlock.db";
  Store store = open();
  commit(store, [](Transaction& transaction) { Settings(transaction).set("key", 1, noon); });
  EXPECT_EQ(mode_of(folder_ / "a"), fs::perms::owner_all);
  EXPECT_EQ(mode_of(folder_ / "a" / "b"), fs::perms::owner_all);
  for (const auto& entry : fs::directory_iterator(file_.parent_path())) {
    EXPECT_EQ(mode_of(entry.path()), fs::perms::owner_read | fs::perms::owner_write) << entry.path();
  }
}

TEST_F(StoreTest, RefusedTransactionLeavesNothing) {
  Store store = open();
  const auto refused = store.transact([](Transaction& transaction) -> Stored<void> {
    Settings(transaction).set("key", 1, noon);
    return tl::unexpected(StoreError{StoreError::Kind::invalid, "no", "", "", ""});
  });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, StoreError::Kind::invalid);
  EXPECT_FALSE(seen(store, [](Transaction& transaction) { return Settings(transaction).find("key"); }));
}

TEST_F(StoreTest, ExceptionOfTheCallerUndoesTheTransactionAndFliesOn) {
  Store store = open();
  EXPECT_THROW(static_cast<void>(store.transact([](Transaction& transaction) -> Stored<void> {
                 Settings(transaction).set("key", 1, noon);
                 throw std::logic_error("of the caller");
               })),
               std::logic_error);
  EXPECT_FALSE(seen(store, [](Transaction& transaction) { return Settings(transaction).find("key"); }));
}

TEST_F(StoreTest, WhatAReaderWritesIsNotKept) {
  Store store = open();
  static_cast<void>(seen(store, [](Transaction& transaction) {
    Settings(transaction).set("key", 1, noon);
    return 0;
  }));
  EXPECT_FALSE(seen(store, [](Transaction& transaction) { return Settings(transaction).find("key"); }));
}

TEST_F(StoreTest, FirstAdminIsAddedOnceAndMayLogIn) {
  Store store = open();
  const auto password = add_first_admin(store, noon);
  ASSERT_TRUE(password && *password);
  const auto login = authenticate(store, "admin", **password);
  ASSERT_TRUE(login && *login);
  EXPECT_EQ((*login)->user.role, Role::admin);
  const auto again = add_first_admin(store, noon);
  ASSERT_TRUE(again);
  EXPECT_FALSE(*again);
  const auto records = seen(store, [](Transaction& transaction) { return Audit(transaction).list(10); });
  ASSERT_EQ(records.size(), 1u);
  EXPECT_THAT(records[0].detail, testing::Not(HasSubstr((*password)->text())));
}

/** A robot that has run: its store has records, and there are logs. */
class LostStore : public StoreTest {
 protected:
  LostStore() {
    Store store = open();
    static_cast<void>(add_first_admin(store, noon).value());
    fs::create_directory(folder_ / "log");
    std::ofstream(folder_ / "log" / "interlock-app.log") << "ready";
  }

  void expect_lost(const std::string& problem) const {
    const bool was_there = fs::exists(file_);
    const auto opened = Store::open(file_);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().kind, StoreError::Kind::damaged);
    EXPECT_THAT(opened.error().message(), HasSubstr(problem));
    EXPECT_THAT(opened.error().message(), HasSubstr("store restore"));
    EXPECT_THAT(opened.error().message(), HasSubstr("--new-store"));
    EXPECT_EQ(fs::exists(file_), was_there) << "none was made";
  }
};

TEST_F(LostStore, AMissingOneIsNotReplaced) {
  fs::remove(file_);
  expect_lost("is missing");
}

TEST_F(LostStore, AnEmptiedOneIsNotReplaced) {
  std::ofstream(file_, std::ios::trunc).flush();
  expect_lost("is empty");
}

TEST_F(LostStore, OneWithTablesButWithoutRecordsIsNotReplaced) {
  execute("DROP TRIGGER audit_is_not_removed; DELETE FROM audit; DELETE FROM users");
  expect_lost("is empty");
}

TEST_F(LostStore, OneWhoseUsersWereDeletedIsNotSound) {
  execute("DELETE FROM users");
  const auto checked = open().check({});
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().message(), HasSubstr("user admin is missing"));
}

TEST_F(LostStore, OneWithADamagedPageIsNotSound) {
  EXPECT_TRUE(open().check({}));
  const auto page = [&] {
    SQLite::Database database(file_.string(), SQLite::OPEN_READWRITE, 5000);
    database.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    return database.execAndGet("SELECT rootpage FROM sqlite_schema WHERE name = 'settings'").getInt();
  }();
  std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(std::streamoff{page - 1} * 4096);
  file << std::string(4096, 'x');
  file.close();
  const auto checked = open().check({});
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().kind, StoreError::Kind::damaged);
}

TEST_F(LostStore, BeginningANewOneKeepsTheOldOneAndIsRecorded) {
  std::ofstream(file_, std::ios::trunc) << std::string(8192, 'x');
  const auto damaged = Store::open(file_);
  ASSERT_FALSE(damaged);
  auto store = begin_new_store(file_, damaged.error(), noon);
  ASSERT_TRUE(store) << store.error().message();
  EXPECT_EQ(fs::file_size(file_.string() + ".replaced-20240501T120000.000Z"), 8192U);
  const auto records = seen(*store, [](Transaction& transaction) { return Audit(transaction).list(10); });
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].kind, "restore");
  EXPECT_THAT(records[0].detail, HasSubstr("new store"));
  EXPECT_THAT(records[0].detail, HasSubstr("os_user"));
}

TEST_F(StoreTest, NothingIsCommittedToAFileThatWasRemovedOrReplaced) {
  Store store = open();
  const auto append = [&] {
    return store.transact([](Transaction& transaction) -> Stored<void> {
      Audit(transaction).append({});
      return {};
    });
  };
  ASSERT_TRUE(append());
  const fs::path moved = folder_ / "moved.db";
  fs::rename(file_, moved);
  const auto expect_refused = [&] {
    const Stored<void> refused = append();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, StoreError::Kind::unavailable);
    EXPECT_THAT(refused.error().message(), HasSubstr("was removed or replaced by another file"));
  };
  expect_refused();
  std::ofstream(file_) << "another";
  expect_refused();
  fs::rename(moved, file_);
  EXPECT_TRUE(append()) << "it is back";
  EXPECT_EQ(seen(store, [](Transaction& transaction) { return Audit(transaction).head(); }).number, 2);
}

TEST_F(StoreTest, ARecordOfTheCommandLineNamesTheUserOfTheSystem) {
  Store store = open();
  commit(store, [](Transaction& transaction) {
    Audit(transaction).append({noon, {}, audit_actor::command_line, {}, AuditKind::setting, {{"key", 1}}});
    Audit(transaction).append({noon, {}, "ann", {}, AuditKind::setting, {{"key", 1}}});
  });
  const auto records = seen(store, [](Transaction& transaction) { return Audit(transaction).list(10); });
  const auto named = nlohmann::json::parse(records.at(0).detail).at("os_user").get<std::string>();
  EXPECT_THAT(named, HasSubstr(std::to_string(getuid())));
  EXPECT_EQ(records.at(1).detail, R"({"key":1})");
}

TEST_F(StoreTest, TheLogIsBoundedWhileAReaderDoesNotEndAndShrinksAfterwards) {
  const fs::path log = file_.string() + "-wal";
  constexpr std::size_t bytes = std::size_t{1} << 20;
  char filling = 'a';
  Store store = open();
  const auto write = [&] {
    // Other bytes each time: SQLite leaves pages alone that stay the same.
    filling = filling == 'z' ? 'a' : static_cast<char>(filling + 1);
    return store.transact([&](Transaction& transaction) -> Stored<void> {
      Settings(transaction).set("key", std::string(bytes, filling), noon);
      return {};
    });
  };
  ASSERT_TRUE(write());
  {
    SQLite::Database reader(file_.string(), SQLite::OPEN_READONLY);
    reader.exec("BEGIN");
    static_cast<void>(reader.execAndGet("SELECT count(*) FROM settings").getInt());
    Stored<void> written = write();
    for (int i = 0; written && i < 200; ++i) {
      written = write();
    }
    ASSERT_FALSE(written) << "the log grew to " << fs::file_size(log);
    EXPECT_EQ(written.error().kind, StoreError::Kind::unavailable);
    EXPECT_THAT(written.error().message(), HasSubstr("end what reads the store"));
    EXPECT_LT(fs::file_size(log), longest_log_bytes + 4 * bytes);
  }
  ASSERT_TRUE(write());
  EXPECT_LT(fs::file_size(log), longest_log_bytes / 4);
}

}  // namespace
}  // namespace interlock
