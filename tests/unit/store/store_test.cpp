#include "store/store.hpp"

#include <gmock/gmock.h>

#include "store/first_admin.hpp"
#include "store/settings.hpp"
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

}  // namespace
}  // namespace interlock
