#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "store/audit.hpp"
#include "store/audit_file.hpp"
#include "store_fixture.hpp"

namespace interlock {
namespace {

using testing::HasSubstr;
using Verified = tl::expected<AuditHead, AuditBreak>;

constexpr const char* unguarded =
    "DROP TRIGGER audit_is_not_removed; DROP TRIGGER audit_anchor_moves_on; DROP TRIGGER "
    "audit_anchor_is_not_removed;";

/** Ten records, a day apart. */
class RetentionTest : public StoreTest {
 protected:
  void SetUp() override {
    commit(store_, [&](Transaction& transaction) {
      for (int day = 0; day < 10; ++day) {
        Audit(transaction).append(entry(day));
      }
    });
  }

  static AuditEntry entry(int day) {
    return {noon + std::chrono::days(day), 42, "ann", 7, AuditKind::proposal, {{"day", day}}};
  }

  Verified verify(const std::optional<std::string>& noted = std::nullopt) {
    return seen(store_, [&](Transaction& transaction) { return Audit(transaction).verify(noted); });
  }

  std::vector<AuditRecord> list() {
    return seen(store_, [](Transaction& transaction) { return Audit(transaction).list(100); });
  }

  /** Retires all records but those of the last days; returns the hash of the last of them. */
  std::string retire_all_but(int days) {
    std::string hash;
    commit(store_, [&](Transaction& transaction) {
      Audit audit(transaction);
      const std::vector<AuditRecord> old = audit.before_last_days(days);
      hash = old.back().hash;
      audit.retire({old.back().number, hash}, entry(20));
    });
    return hash;
  }

  std::size_t older_than_the_last(int days) {
    return seen(store_,
                [&](Transaction& transaction) { return Audit(transaction).before_last_days(days).size(); });
  }

  Verified verify_file(const std::filesystem::path& file,
                       const std::optional<std::string>& noted = std::nullopt) {
    const Stored<Verified> verified = verify_audit_file(file, noted);
    EXPECT_TRUE(verified) << verified.error().message();
    return *verified;
  }

  Store store_ = open();
};

TEST_F(RetentionTest, TheLastDaysWithRecordsStay) {
  EXPECT_EQ(older_than_the_last(99), 0U);
  EXPECT_EQ(older_than_the_last(10), 0U);
  EXPECT_EQ(older_than_the_last(6), 4U);
  EXPECT_EQ(older_than_the_last(0), 10U);
}

TEST_F(RetentionTest, AClockThatJumpedMakesNothingOld) {
  commit(store_, [&](Transaction& transaction) { Audit(transaction).append(entry(4000)); });
  EXPECT_EQ(older_than_the_last(11), 0U) << "forwards: one day more";
  EXPECT_EQ(older_than_the_last(7), 4U);
  commit(store_, [&](Transaction& transaction) { Audit(transaction).append(entry(5)); });
  EXPECT_EQ(older_than_the_last(11), 0U) << "and back: a day that was there";
  EXPECT_EQ(older_than_the_last(1), 5U) << "records of that day stay, and what came in between";
}

TEST_F(RetentionTest, ChainVerifiesBehindWhatWasRetired) {
  const std::string head = verify()->hash;
  const std::string anchor = retire_all_but(6);
  const std::vector<AuditRecord> left = list();
  EXPECT_EQ(left.front().number, 5);
  EXPECT_EQ(left.back().kind, "retention");
  EXPECT_EQ(left.back().number, 11);
  ASSERT_TRUE(verify()) << verify().error().problem;
  EXPECT_EQ(verify()->number, 11);
  EXPECT_TRUE(verify(head));
  EXPECT_TRUE(verify(anchor));
}

TEST_F(RetentionTest, MayBeRepeatedAndMayTakeAll) {
  retire_all_but(6);
  retire_all_but(4);
  EXPECT_EQ(list().front().number, 8);
  EXPECT_TRUE(verify());
  retire_all_but(0);
  EXPECT_EQ(list().size(), 1U);
  EXPECT_TRUE(verify());
  commit(store_, [](Transaction& transaction) { Audit(transaction).append(entry(30)); });
  EXPECT_EQ(verify()->number, 14);
}

TEST_F(RetentionTest, NothingElseIsRemoved) {
  retire_all_but(6);
  for (const char* const sql : {"DELETE FROM audit WHERE number = 5", "DELETE FROM audit_anchor",
                                "UPDATE audit_anchor SET number = 3"}) {
    EXPECT_THROW(execute(sql), SQLite::Exception) << sql;
  }
}

TEST_F(RetentionTest, RemovalThatNoRecordAccountsForIsFound) {
  const AuditRecord fifth = list().at(4);
  execute("INSERT INTO audit_anchor VALUES (1, 5, '" + fifth.hash +
          "'); DELETE FROM audit WHERE number <= 5");
  const Verified verified = verify();
  ASSERT_FALSE(verified);
  EXPECT_EQ(verified.error().number, 5);
  EXPECT_THAT(verified.error().problem, HasSubstr("no record says that they were retired"));
}

TEST_F(RetentionTest, MovedAnchorIsFound) {
  retire_all_but(6);
  const AuditRecord sixth = list().at(1);
  ASSERT_EQ(sixth.number, 6);
  execute(std::string(unguarded) + "UPDATE audit_anchor SET number = 6, hash = '" + sixth.hash +
          "'; DELETE FROM audit WHERE number <= 6");
  EXPECT_FALSE(verify());
}

TEST_F(RetentionTest, LostAnchorIsFound) {
  retire_all_but(6);
  execute(std::string(unguarded) + "DELETE FROM audit_anchor");
  EXPECT_FALSE(verify());
}

TEST_F(RetentionTest, ExportedRecordsVerifyByThemselves) {
  const std::filesystem::path file = folder_ / "audit.jsonl";
  const std::string fourth = list().at(3).hash;
  ASSERT_TRUE(write_audit_file(file, {}, list()));
  EXPECT_EQ(verify_file(file)->hash, verify()->hash);
  EXPECT_TRUE(verify_file(file, fourth));
  EXPECT_FALSE(verify_file(file, std::string(64, 'a')));
  retire_all_but(6);
  const std::filesystem::path rest = folder_ / "rest.jsonl";
  ASSERT_TRUE(write_audit_file(rest, {4, fourth}, list()));
  EXPECT_EQ(verify_file(rest)->number, 11);
}

TEST_F(RetentionTest, ChangedFileIsFound) {
  const std::filesystem::path file = folder_ / "audit.jsonl";
  ASSERT_TRUE(write_audit_file(file, {}, list()));
  std::ifstream stream(file);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  text.replace(text.find("day\\\":6"), 8, "day\\\":8");
  std::ofstream(file, std::ios::trunc) << text;
  const Verified verified = verify_file(file);
  ASSERT_FALSE(verified);
  EXPECT_EQ(verified.error().number, 7);
}

TEST_F(RetentionTest, FileThatIsThereIsNotOverwrittenAndOtherFilesAreRefused) {
  const std::filesystem::path file = folder_ / "audit.jsonl";
  std::ofstream(file) << "mine";
  const Stored<void> refused = write_audit_file(file, {}, list());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, StoreError::Kind::exists);
  const Stored<Verified> verified = verify_audit_file(file, std::nullopt);
  ASSERT_FALSE(verified);
  EXPECT_EQ(verified.error().kind, StoreError::Kind::damaged);
}

}  // namespace
}  // namespace interlock
