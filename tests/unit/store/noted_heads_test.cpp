#include "store/noted_heads.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "store/audit_check.hpp"
#include "store/store_backup.hpp"
#include "store_fixture.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Verified = tl::expected<AuditHead, AuditBreak>;

constexpr const char* without_triggers =
    "DROP TRIGGER audit_is_not_changed; DROP TRIGGER audit_is_not_removed; DROP TRIGGER audit_has_no_gaps;";

/** A store with an administrator and an engineer, and what the recorder noted of it. */
class NotedHeadsTest : public StoreTest {
 protected:
  void SetUp() override {
    Store store = open();
    add(store, "ann", Role::admin);
    add(store, "bob", Role::engineer);
  }

  static void add(Store& store, const std::string& name, Role role) {
    commit(store, [&](Transaction& transaction) {
      static_cast<void>(Users(transaction).add(name, role, some_hash, noon).value());
      Audit(transaction)
          .append({noon, std::nullopt, "ann", 1, AuditKind::user, {{"action", "add"}, {"name", name}}});
    });
  }

  /** Records happen, and the recorder notes the last of them. */
  void work(int records) {
    Store store = open();
    commit(store, [&](Transaction& transaction) {
      for (int i = 0; i < records; ++i) {
        Audit(transaction).append({noon, std::nullopt, "ann", 1, AuditKind::request, {{"i", i}}});
      }
      heads_.push_back({iso_8601(noon), Audit(transaction).head()});
    });
  }

  [[nodiscard]] Verified verify() const {
    Store store = open();
    return seen(store, [&](Transaction& transaction) {
      AuditCheck check(std::nullopt, heads_);
      while (check.go_on(transaction.database(), 3)) {
      }
      return check.result();
    });
  }

  /** What the check of a sound audit says of the heads. */
  [[nodiscard]] HeadComparison comparison() const {
    Store store = open();
    return seen(store, [&](Transaction& transaction) {
      AuditCheck check(std::nullopt, heads_);
      while (check.go_on(transaction.database(), 3)) {
      }
      EXPECT_TRUE(check.result());
      return check.comparison();
    });
  }

  /** All heads but the compared ones are excused by that record, with that doubt. */
  void expect_excused(std::size_t compared, std::int64_t record, const std::string& action,
                      const std::string& doubt) const {
    const HeadComparison found = comparison();
    EXPECT_EQ(found.compared, compared);
    ASSERT_EQ(found.excuses.size(), 1U);
    EXPECT_EQ(found.excuses[0].heads, heads_.size() - compared);
    EXPECT_EQ(found.excuses[0].record.number, record);
    EXPECT_EQ(found.excuses[0].record.action, action);
    EXPECT_THAT(found.excuses[0].doubt, HasSubstr(doubt));
    EXPECT_EQ(found.excuses[0].doubt.empty(), doubt.empty());
  }

  void expect_broken(std::int64_t number, const std::string& problem) const {
    const Verified verified = verify();
    ASSERT_FALSE(verified);
    EXPECT_EQ(verified.error().number, number) << verified.error().problem;
    EXPECT_THAT(verified.error().problem, HasSubstr(problem));
  }

  /** To put them back as a careful forger does. */
  [[nodiscard]] std::string triggers_of_the_audit() const {
    SQLite::Database database(file_.string());
    return database
        .execAndGet(
            "SELECT group_concat(sql, '; ') || ';' FROM sqlite_schema "
            "WHERE type = 'trigger' AND tbl_name = 'audit'")
        .getString();
  }

  NotedHeads heads_;
  fs::path backup_ = folder_ / "backup.db";
};

TEST_F(NotedHeadsTest, AnAuditThatHasThemAllIsSound) {
  work(4);
  work(4);
  const Verified verified = verify();
  ASSERT_TRUE(verified) << verified.error().problem;
  EXPECT_EQ(*verified, heads_.back().head);
}

TEST_F(NotedHeadsTest, RecordsCutOffAreFound) {
  work(4);
  work(4);
  execute(std::string(without_triggers) + "DELETE FROM audit WHERE number > 7");
  expect_broken(10, "is missing: the audit ends at record 7, but the recorder noted it at " + iso_8601(noon));
}

TEST_F(NotedHeadsTest, AChainWrittenAnewIsFound) {
  work(4);
  execute(std::string(without_triggers) + "DELETE FROM audit WHERE number > 4");
  const NotedHeads noted = heads_;
  work(6);
  heads_ = noted;
  expect_broken(6, "is not the one that the recorder noted");
}

TEST_F(NotedHeadsTest, AnOlderCopyOfTheStoreIsFound) {
  work(4);
  ASSERT_TRUE(backup_store(file_, backup_));
  work(4);
  fs::copy_file(backup_, file_, fs::copy_options::overwrite_existing);
  expect_broken(10, "an older copy of the store was put in place");
  work(1);
  expect_broken(10, "is missing");
}

TEST_F(NotedHeadsTest, ARestoreAccountsForWhatItReplaced) {
  work(4);
  ASSERT_TRUE(backup_store(file_, backup_));
  work(4);
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(restore_store(backup_, file_, noon + std::chrono::seconds(again)));
    EXPECT_TRUE(verify()) << verify().error().problem;
    work(1);
    EXPECT_TRUE(verify()) << verify().error().problem;
    work(20);
    EXPECT_TRUE(verify()) << verify().error().problem;
  }
}

TEST_F(NotedHeadsTest, HeadsThatARestoreExcusesAreNotCountedAsCompared) {
  work(4);
  ASSERT_TRUE(backup_store(file_, backup_));
  work(4);
  work(4);
  EXPECT_EQ(comparison().compared, 3U);
  EXPECT_TRUE(comparison().excuses.empty());
  ASSERT_TRUE(restore_store(backup_, file_, noon, heads_));
  expect_excused(1, 7, "store", "no head was noted since");
  const ExcusingRecord record = comparison().excuses[0].record;
  EXPECT_EQ(record.kind, "restore");
  EXPECT_EQ(record.actor, "command line");
  EXPECT_EQ(record.time, iso_8601(noon));
  EXPECT_FALSE(record.os_user.empty());
  work(1);
  expect_excused(2, 7, "store", "");
}

TEST_F(NotedHeadsTest, ANewStoreExcusesNoHeadThatWasNotedAfterIt) {
  work(4);
  fs::remove(file_);
  ASSERT_TRUE(begin_new_store(file_, StoreError{StoreError::Kind::damaged, "is missing", "", "", ""}, noon));
  expect_excused(0, 1, "new store", "no head was noted since");
  work(4);
  expect_excused(1, 1, "new store", "");
  heads_.front().time = iso_8601(noon + std::chrono::seconds(31));
  expect_excused(1, 1, "new store", "head 6 was noted after it, at 2024-05-01T12:00:31.000Z");
}

TEST_F(NotedHeadsTest, HeadsOfRetiredRecordsAreNotCountedAsCompared) {
  work(4);
  work(4);
  {
    Store store = open();
    commit(store, [](Transaction& transaction) {
      Audit audit(transaction);
      const AuditRecord eighth = audit.list(100).at(7);
      audit.retire({eighth.number, eighth.hash}, {.time = noon, .tick = {}, .actor = "ann", .session = {}});
    });
  }
  expect_excused(1, 11, "", "no head was noted since");
  work(1);
  expect_excused(2, 11, "", "");
  const AuditHead lower{1, std::string(64, 'a')};
  heads_.insert(heads_.begin() + 1, {{iso_8601(noon), {9, lower.hash}}, {iso_8601(noon), lower}});
  expect_excused(2, 11, "", "it retired the records up to 8, but record 9 was noted, too");
}

TEST_F(NotedHeadsTest, ARestoreAccountsForNothingThatItDidNotReplace) {
  work(4);
  ASSERT_TRUE(backup_store(file_, backup_));
  work(4);
  work(4);
  execute(std::string(without_triggers) + "DELETE FROM audit WHERE number > 10");
  const auto refused = restore_store(backup_, file_, noon, heads_);
  ASSERT_FALSE(refused) << "a start would refuse it";
  EXPECT_EQ(refused.error().kind, StoreError::Kind::damaged);
  EXPECT_THAT(refused.error().message(), HasSubstr("audit record 10 is missing"));
  EXPECT_THAT(refused.error().message(), HasSubstr(backup_.string()));
  ASSERT_TRUE(restore_store(backup_, file_, noon));
  expect_broken(10, "is missing");
}

TEST_F(NotedHeadsTest, ABackupIsRestoredAfterANewStoreTookThePlace) {
  work(4);
  ASSERT_TRUE(backup_store(file_, backup_));
  work(4);
  fs::remove(file_);
  ASSERT_TRUE(begin_new_store(file_, StoreError{StoreError::Kind::damaged, "is missing", "", "", ""}, noon));
  work(1);
  ASSERT_TRUE(verify()) << verify().error().problem;
  const auto restored = restore_store(backup_, file_, noon, heads_);
  ASSERT_TRUE(restored) << restored.error().message();
  work(1);
  EXPECT_TRUE(verify()) << verify().error().problem;
}

TEST_F(NotedHeadsTest, AForgedBackupIsNotRestored) {
  work(4);
  const NotedHeads noted = heads_;
  const std::string triggers = triggers_of_the_audit();
  execute(std::string(without_triggers) + "DELETE FROM audit WHERE number > 4;" + triggers);
  work(9);
  fs::rename(file_, backup_);
  const auto refused = restore_store(backup_, file_, noon, noted);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("audit record 6 is not the one that the recorder noted"));
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(NotedHeadsTest, ANewStoreAccountsForTheOneThatWasLost) {
  work(4);
  fs::remove(file_);
  heads_.push_back(heads_.back());
  ASSERT_TRUE(begin_new_store(file_, StoreError{StoreError::Kind::damaged, "is missing", "", "", ""}, noon));
  EXPECT_TRUE(verify()) << verify().error().problem;
  work(9);
  EXPECT_TRUE(verify()) << verify().error().problem;
}

TEST_F(NotedHeadsTest, RecordsThatWereRetiredAreLeftToTheirFile) {
  work(4);
  work(4);
  Store store = open();
  commit(store, [](Transaction& transaction) {
    Audit audit(transaction);
    const AuditRecord eighth = audit.list(100).at(7);
    audit.retire({eighth.number, eighth.hash}, {.time = noon, .tick = {}, .actor = "ann", .session = {}});
  });
  EXPECT_TRUE(verify()) << verify().error().problem;
  execute("UPDATE users SET role = 'admin' WHERE name = 'bob'");
  expect_broken(11, "user bob has another role");
}

TEST_F(NotedHeadsTest, AUserWhoWasChangedInSqlIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"UPDATE users SET role = 'admin' WHERE name = 'bob'", "user bob has another role"},
      {"UPDATE users SET role = 'engineer', password = 'x' WHERE name = 'bob'",
       "user bob has another role, pass"},
      {"UPDATE users SET password = '$argon2id$some', enabled = 0 WHERE name = 'bob'",
       "user bob has another"},
      {"DELETE FROM users WHERE name = 'bob'", "user bob is missing"},
      {"INSERT INTO users VALUES ('eve', 'admin', 1, 'x', '', NULL)", "user eve was added without a record"}};
  for (const auto& [sql, problem] : cases) {
    execute(sql);
    expect_broken(2, problem);
    if (problem == std::string("user bob is missing")) {
      execute("INSERT INTO users VALUES ('bob', 'engineer', 1, '$argon2id$some', '', NULL)");
      EXPECT_TRUE(verify());
    }
  }
}

TEST_F(NotedHeadsTest, AFileIsReadWithoutTheLineThatWasCutOff) {
  const fs::path file = folder_ / "audit-heads";
  EXPECT_TRUE(read_noted_heads(file)->empty()) << "a missing one";
  const std::string hash(64, 'a');
  std::ofstream(file) << "2024-05-01T12:00:00.000Z 7 " << hash << "\n2024-05-01T12:00:09.000Z 8 aa\n"
                      << "2024-05-01T12:00:10.000Z 9 " << hash << '\n';
  const auto heads = read_noted_heads(file);
  ASSERT_TRUE(heads);
  ASSERT_EQ(heads->size(), 2U);
  EXPECT_EQ(heads->front().time, "2024-05-01T12:00:00.000Z");
  EXPECT_EQ(heads->back().head, (AuditHead{9, hash}));
}

TEST_F(NotedHeadsTest, AFolderInPlaceOfTheFileIsNotTakenForNoHeads) {
  const fs::path file = folder_ / "audit-heads";
  fs::create_directory(file);
  const auto heads = read_noted_heads(file);
  ASSERT_FALSE(heads);
  EXPECT_THAT(heads.error().message(), HasSubstr("audit-heads is not a regular file"));
}

TEST_F(NotedHeadsTest, NoRecorderIsNoReasonToWait) {
  EXPECT_FALSE(report_head(folder_ / "nobody.sock", {7, std::string(64, 'a')}));
  EXPECT_FALSE(report_head(std::string(200, 'x'), {7, std::string(64, 'a')}));
}

TEST_F(NotedHeadsTest, OfARestoreIsNotedBehindALineThatWasCutOff) {
  const fs::path file = folder_ / "audit-heads";
  const NotedHead noted{"2026-01-01T00:00:00.000Z", {7, std::string(64, 'a')}};
  EXPECT_FALSE(note_head(file, noted)) << "the recorder makes the file";
  std::ofstream(file) << "2025-12-31T23:59:59.000Z 6 aaaa";
  EXPECT_TRUE(note_head(file, noted));
  const NotedHeads read = read_noted_heads(file).value();
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].time, noted.time);
  EXPECT_EQ(read[0].head, noted.head);
}

}  // namespace
}  // namespace interlock
