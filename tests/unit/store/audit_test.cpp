#include "store/audit.hpp"

#include <gmock/gmock.h>

#include "store/audit_check.hpp"
#include "store/digest.hpp"
#include "store_fixture.hpp"

namespace interlock {
namespace {

using testing::HasSubstr;

constexpr const char* drop_triggers =
    "DROP TRIGGER audit_is_not_changed; DROP TRIGGER audit_is_not_removed; DROP TRIGGER audit_has_no_gaps;";

class AuditTest : public StoreTest {
 protected:
  using Verified = tl::expected<AuditHead, AuditBreak>;

  void append(int count) {
    commit(store_, [&](Transaction& transaction) {
      for (int number = 0; number < count; ++number) {
        Audit(transaction)
            .append({noon, 42, "ann", 7, AuditKind::proposal, {{"id", number}, {"state", "checked"}}});
      }
    });
  }

  Verified verify(const std::optional<std::string>& noted = std::nullopt) {
    return seen(store_, [&](Transaction& transaction) { return Audit(transaction).verify(noted); });
  }

  std::vector<AuditRecord> list(std::size_t count, const AuditFilter& filter = {}) {
    return seen(store_, [&](Transaction& transaction) { return Audit(transaction).list(count, filter); });
  }

  void expect_break(std::int64_t number, const std::string& problem) {
    const Verified verified = verify();
    ASSERT_FALSE(verified);
    EXPECT_EQ(verified.error().number, number);
    EXPECT_THAT(verified.error().problem, HasSubstr(problem));
  }

  Store store_ = open();
};

TEST_F(AuditTest, EmptyChainIsSoundAndBeginsAtZeros) {
  const Verified verified = verify();
  ASSERT_TRUE(verified);
  EXPECT_EQ(*verified, (AuditHead{0, std::string(64, '0')}));
}

TEST_F(AuditTest, RecordIsKeptAsItWasGiven) {
  append(1);
  const AuditRecord record = list(1).at(0);
  EXPECT_EQ(to_json(record), (nlohmann::json{{"number", 1},
                                             {"time", "2024-05-01T12:00:00.000Z"},
                                             {"tick", 42},
                                             {"actor", "ann"},
                                             {"session", 7},
                                             {"kind", "proposal"},
                                             {"detail", {{"id", 0}, {"state", "checked"}}},
                                             {"hash", record.hash}}));
}

TEST_F(AuditTest, TheNewestOfAKindIsFoundAmongOthers) {
  append(3);
  const auto newest_of = [this](AuditKind kind) {
    return seen(store_, [kind](Transaction& transaction) { return Audit(transaction).newest_of(kind); });
  };
  EXPECT_EQ(newest_of(AuditKind::proposal), 3);
  EXPECT_EQ(newest_of(AuditKind::stop), 0);
}

TEST_F(AuditTest, CanonicalEncodingIsAsDocumented) {
  const AuditRecord record{1, "2024-05-01T12:00:00.000Z", std::nullopt, "ann", 7, "login", "{}", ""};
  EXPECT_EQ(canonical_encoding(record, std::string(64, '0')),
            "17:interlock-audit-1,64:" + std::string(64, '0') +
                ",1:1,24:2024-05-01T12:00:00.000Z,0:,3:ann,1:7,5:login,2:{},");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(AuditTest, EveryFieldAndThePreviousHashAreSealed) {
  const AuditRecord record{1, "2024-05-01T12:00:00.000Z", 1, "ann", 7, "login", "{}", ""};
  const std::string zeros(64, '0');
  std::vector<AuditRecord> others(7, record);
  others[0].number = 2;
  others[1].time = "2024-05-01T12:00:00.001Z";
  others[2].tick.reset();
  others[3].actor = "bob";
  others[4].session.reset();
  others[5].kind = "logout";
  others[6].detail = "{ }";
  for (const AuditRecord& other : others) {
    EXPECT_NE(audit_hash(other, zeros), audit_hash(record, zeros));
  }
  EXPECT_NE(audit_hash(record, std::string(64, '1')), audit_hash(record, zeros));
}

TEST_F(AuditTest, ChainOfManyIsSound) {
  append(1000);
  const Verified verified = verify();
  ASSERT_TRUE(verified) << verified.error().problem;
  EXPECT_EQ(verified->number, 1000);
  EXPECT_EQ(verified->hash, list(1).at(0).hash);
}

TEST_F(AuditTest, ListIsOldestFirstAndPages) {
  append(5);
  const auto numbers = [&](std::size_t count, std::optional<std::int64_t> before) {
    std::vector<std::int64_t> found;
    for (const AuditRecord& record : list(count, {.before = before})) {
      found.push_back(record.number);
    }
    return found;
  };
  EXPECT_THAT(numbers(2, std::nullopt), testing::ElementsAre(4, 5));
  EXPECT_THAT(numbers(2, 4), testing::ElementsAre(2, 3));
  EXPECT_THAT(numbers(9, 2), testing::ElementsAre(1));
  EXPECT_THAT(numbers(9, 1), testing::IsEmpty());
}

TEST_F(AuditTest, ListHasWhatTheFilterLetsThrough) {
  append(3);
  commit(store_, [&](Transaction& transaction) {
    Audit(transaction)
        .append(
            {noon + std::chrono::hours(1), 43, "bob", 8, AuditKind::stop, {{"reason", "A wire at 100 %"}}});
  });
  const auto numbers = [&](const AuditFilter& filter) {
    std::vector<std::int64_t> found;
    for (const AuditRecord& record : list(9, filter)) {
      found.push_back(record.number);
    }
    return found;
  };
  EXPECT_THAT(numbers({.kind = "stop"}), testing::ElementsAre(4));
  EXPECT_THAT(numbers({.actor = "ann"}), testing::ElementsAre(1, 2, 3));
  EXPECT_THAT(numbers({.text = "a WIRE"}), testing::ElementsAre(4));
  EXPECT_THAT(numbers({.text = "100 %"}), testing::ElementsAre(4)) << "no pattern, but what stands there";
  EXPECT_THAT(numbers({.since = noon + std::chrono::minutes(1)}), testing::ElementsAre(4));
  EXPECT_THAT(numbers({.before = 3, .kind = "proposal"}), testing::ElementsAre(1, 2));
  EXPECT_THAT(numbers({.kind = "proposal", .actor = "bob"}), testing::IsEmpty());
}

TEST_F(AuditTest, RefusedTransactionLeavesNoRecord) {
  const auto refused = store_.transact([](Transaction& transaction) -> Stored<void> {
    Audit(transaction).append({});
    return tl::unexpected(StoreError{});
  });
  EXPECT_FALSE(refused);
  EXPECT_EQ(verify()->number, 0);
}

TEST_F(AuditTest, TextThatIsNoUtf8IsRecordedAndVerifies) {
  commit(store_, [](Transaction& transaction) {
    Audit(transaction)
        .append({noon,
                 std::nullopt,
                 audit_actor::nobody,
                 std::nullopt,
                 AuditKind::login_refused,
                 {{"name", "\xff\xfe"}}});
  });
  EXPECT_EQ(verify()->number, 1);
}

TEST_F(AuditTest, TableRefusesChangeRemovalReplacementAndGaps) {
  append(3);
  for (const char* const sql :
       {"UPDATE audit SET actor = 'eve' WHERE number = 2", "DELETE FROM audit WHERE number = 3",
        "DELETE FROM audit", "INSERT OR REPLACE INTO audit SELECT * FROM audit WHERE number = 2",
        "INSERT INTO audit SELECT 9, time, tick, actor, session, kind, detail, hash FROM audit LIMIT 1",
        "INSERT INTO audit SELECT NULL, time, tick, actor, session, kind, detail, hash FROM audit LIMIT 1"}) {
    EXPECT_THROW(execute(sql), SQLite::Exception) << sql;
  }
  EXPECT_EQ(verify()->number, 3);
}

class ChangedField : public AuditTest, public testing::WithParamInterface<const char*> {};

TEST_P(ChangedField, IsFound) {
  append(5);
  execute(std::string(drop_triggers) + "UPDATE audit SET " + GetParam() + " WHERE number = 3");
  expect_break(3, "was changed");
}

INSTANTIATE_TEST_SUITE_P(Audit, ChangedField,
                         testing::Values("detail = '{}'", "actor = 'eve'", "tick = 43", "tick = NULL",
                                         "session = NULL", "kind = 'login'",
                                         "time = '2024-05-01T12:00:00.001Z'", "hash = 'beef'"));

TEST_F(AuditTest, RemovedRecordIsFound) {
  append(5);
  execute(std::string(drop_triggers) + "DELETE FROM audit WHERE number = 3");
  expect_break(3, "is missing: record 4");
}

TEST_F(AuditTest, RemovedRecordIsFoundThoughTheRestIsRenumbered) {
  append(5);
  execute(std::string(drop_triggers) +
          "DELETE FROM audit WHERE number = 3; UPDATE audit SET number = number - 1 WHERE number > 3");
  expect_break(3, "does not belong behind the one before");
}

TEST_F(AuditTest, RemovedFirstRecordIsFound) {
  append(2);
  execute(std::string(drop_triggers) + "DELETE FROM audit WHERE number = 1");
  expect_break(1, "is missing");
}

TEST_F(AuditTest, SwappedRecordsAreFound) {
  append(5);
  execute(std::string(drop_triggers) +
          "UPDATE audit SET number = -2 WHERE number = 2; UPDATE audit SET number = 2 WHERE number = 4;"
          "UPDATE audit SET number = 4 WHERE number = -2;");
  expect_break(2, "was changed");
}

TEST_F(AuditTest, RecordForgedWithItsHashBreaksTheNextOne) {
  append(5);
  AuditRecord forged = list(3).at(0);
  ASSERT_EQ(forged.number, 3);
  forged.actor = "eve";
  const std::string hash = audit_hash(forged, list(1, {.before = 3}).at(0).hash);
  execute(std::string(drop_triggers) + "UPDATE audit SET actor = 'eve', hash = '" + hash +
          "' WHERE number = 3");
  expect_break(4, "does not belong behind the one before");
}

TEST_F(AuditTest, TruncationShowsAgainstANotedHeadOnly) {
  append(5);
  const std::string noted = verify()->hash;
  EXPECT_TRUE(verify(noted));
  append(2);
  EXPECT_EQ(verify(noted)->number, 7);
  execute(std::string(drop_triggers) + "DELETE FROM audit WHERE number > 4");
  EXPECT_TRUE(verify());
  const Verified truncated = verify(noted);
  ASSERT_FALSE(truncated);
  EXPECT_EQ(truncated.error().number, 5);
  EXPECT_THAT(truncated.error().problem, HasSubstr(noted));
}

class PartsOf : public AuditTest, public testing::WithParamInterface<std::size_t> {
 protected:
  /** One part; whether more are to be followed. */
  bool go_on(AuditCheck& check) {
    return seen(store_,
                [&](Transaction& transaction) { return check.go_on(transaction.database(), GetParam()); });
  }
};

TEST_P(PartsOf, AChainGiveTheAnswerOfTheWholeThoughItGrowsMeanwhile) {
  append(6);
  AuditCheck check;
  ASSERT_TRUE(go_on(check) || GetParam() > 6);
  append(1);
  while (go_on(check)) {
  }
  ASSERT_TRUE(check.result());
  EXPECT_EQ(*check.result(), *verify());
  EXPECT_EQ(check.result()->number, 7);
}

TEST_P(PartsOf, AChainFindABreakInALaterPart) {
  append(6);
  AuditCheck check;
  go_on(check);
  execute(std::string(drop_triggers) +
          "DELETE FROM audit WHERE number = 5; INSERT INTO audit SELECT 8, time, "
          "tick, actor, session, kind, detail, hash FROM audit WHERE number = 6");
  while (go_on(check)) {
  }
  ASSERT_FALSE(check.result());
  EXPECT_EQ(check.result().error().number, GetParam() > 6 ? 7 : 5);
}

TEST_P(PartsOf, AChainBeginAnewWhenRecordsWereRetiredMeanwhile) {
  append(6);
  AuditCheck check;
  go_on(check);
  const AuditRecord fifth = list(1, {.before = 6}).at(0);
  commit(store_, [&](Transaction& transaction) {
    Audit(transaction)
        .retire({fifth.number, fifth.hash}, {.time = noon,
                                             .tick = std::nullopt,
                                             .actor = audit_actor::command_line,
                                             .session = std::nullopt,
                                             .detail = nlohmann::json::object()});
  });
  while (go_on(check)) {
  }
  ASSERT_TRUE(check.result());
  EXPECT_EQ(*check.result(), *verify());
  EXPECT_EQ(check.result()->number, 7);
}

INSTANTIATE_TEST_SUITE_P(Audit, PartsOf, testing::Values(1, 2, 3, 100));

TEST_F(AuditTest, HeadOfAnEmptyChainIsInEveryChain) {
  append(1);
  EXPECT_TRUE(verify(std::string(64, '0')));
}

}  // namespace
}  // namespace interlock
