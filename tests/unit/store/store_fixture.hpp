/**
 * @file
 * A fresh store in a folder of its own.
 */
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "store/audit.hpp"
#include "store/password.hpp"
#include "store/store.hpp"
#include "store/users.hpp"

namespace interlock {

constexpr UtcTime noon{std::chrono::seconds(1714564800)};

/** Of no password that a test gives: hashing takes long, and most rules do not ask for it. */
inline const PasswordHash some_hash{"$argon2id$some"};

class StoreTest : public testing::Test {
 protected:
  StoreTest() {
    std::string pattern = std::filesystem::temp_directory_path() / "interlock-store-XXXXXX";
    folder_ = mkdtemp(pattern.data());
    file_ = folder_ / "interlock.db";
  }

  ~StoreTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Store open() const {
    Stored<Store> store = Store::open(file_);
    if (!store) {
      throw std::runtime_error(store.error().message());
    }
    return std::move(*store);
  }

  /** Does something in one transaction that nothing refuses. */
  template <typename Work>
  static void commit(Store& store, Work&& work) {
    const auto done = store.transact([&](Transaction& transaction) -> Stored<void> {
      work(transaction);
      return {};
    });
    ASSERT_TRUE(done) << done.error().message();
  }

  /** Looks at something. */
  template <typename Look>
  static auto seen(Store& store, Look&& look) {
    using Value = std::invoke_result_t<Look, Transaction&>;
    return store.read([&](Transaction& transaction) -> Stored<Value> { return look(transaction); }).value();
  }

  /** SQL past all rules of the store, as a forger has it. */
  void execute(const std::string& sql) const {
    SQLite::Database database(file_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, 5000);
    database.exec(sql);
  }

  std::filesystem::path folder_;
  std::filesystem::path file_;
};

}  // namespace interlock
